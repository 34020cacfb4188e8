"""`fieldmon study run`: a study of one's own plots."""

from contextlib import nullcontext
from dataclasses import replace
from datetime import date

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from shapely import box

from fieldmon.cli.pest_options import PestOptions
from fieldmon.cli.study_run import StudyOptions, _tell, _tell_charged
from fieldmon.errors import FileProblem
from fieldmon.simulation import executor, results
from fieldmon.simulation.design import study_of
from fieldmon.simulation.worker import simulate_chunk
from tests.cli.estate import MITES, ZIP, square
from tests.paths import ROOT

FEW = ["--seeds", 3, "--days", 2, "--workers", 1, "--date", "2026-11-02"]


@pytest.fixture
def here(monkeypatch):
    """Return what lets all be simulated in this process from now on.

    Others are started by the test of a sampler of one's own, which they must find.
    """
    return lambda: monkeypatch.setattr(executor, "cluster", lambda *_: nullcontext(executor.here()))


def test_samplers_are_compared_on_a_plot_and_the_seasons_kept(run, tmp_path, here):
    here()
    words = ["study", "run", ZIP, "--feature", "Nursery", "--hours", 2, "--hours", 4, *FEW]
    code, out, err, _ = run(*words, "--sampler", "naive", "--sampler", "dynamic", "-o", "mine")
    assert code == 0, err
    assert sum(line.startswith(("naive", "dynamic")) for line in out.splitlines()) == 4
    assert sum("(best)" in line for line in out.splitlines()) == 2
    assert "one that holds 0 is no sure difference" in out
    table = results.seasons(tmp_path / "mine")
    assert table.num_rows == 2 * 2 * 3
    assert set(table["plot"].to_pylist()) == {"Nursery"}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--sampler", "best"], "best"),
        (["-o", "seasons.csv", "--feature", "Nursery", *FEW], "seasons.csv is the name of a file"),
        (["--infested", "2"], "between 0 and 1"),
        (["--date", "today"], "YYYY-MM-DD"),
        (["--pest", "mote"], "one of thesis, spider-mite"),
        (["--pest", "thesis", "--spread", "0.2"], "--spread goes without --pest"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "run", ZIP, *words)
    assert (code, made) == (2, set())
    assert says in err


def test_a_study_says_how_plots_are_planted_and_which_times_are_charged(tmp_path, capsys):
    file = tmp_path / "plots.gpkg"
    square().to_file(file)
    usual = StudyOptions(file)
    _tell_charged(usual.design().robot_times)
    (few,) = usual.plots()
    out, err = capsys.readouterr()
    assert "rows 4.00 m and plants 3.00 m apart" in out
    assert "guessed: row spacing 4 m [--row-spacing]" in err
    assert "time added for a row change, as in simulated drives: 9 s" in err
    told = StudyOptions(file, row_spacing=2.5, plant_spacing=1.5, bearing=0.0, robot_times="thesis")
    _tell_charged(told.design().robot_times)
    (many,) = told.plots()
    out, err = capsys.readouterr()
    assert "rows 2.50 m and plants 1.50 m apart" in out
    assert not {"guessed:", "simulated"} & {*err.split()}
    assert many.about_plants > 3 * few.about_plants
    farther = square(name="told", row_m=2.5, geometry=box(35.2, 30.36, 35.201, 30.361))
    pd.concat([square(), farther]).to_file(file)
    usual.plots()
    _, err = capsys.readouterr()
    assert "guessed: row spacing 4 m (plot) [--row-spacing]" in err
    assert "guessed: plant spacing 3 m [--plant-spacing]" in err


def test_times_are_charged_as_they_were_chosen_and_other_studies_go_on(tmp_path):
    file = tmp_path / "plots.gpkg"
    square().to_file(file)
    usual, thesis = (
        StudyOptions(file, hours=[1.0], sampler=["snake"], seeds=1, days=1, robot_times=times)
        for times in (None, "thesis")
    )
    (plot,), seasons, keys = usual.plots(), [], []
    for asked in (usual.design(), thesis.design()):
        study = study_of((plot,), asked)
        (chunk,) = study.chunks()
        keys.append(chunk.key)
        seasons += study.simulate(chunk.setting, chunk.seeds)
    assert seasons[0]["visited_pct"] != seasons[1]["visited_pct"]
    assert keys[0] != keys[1]
    assert "robot_times" not in usual.design().content
    assert thesis.design().content["robot_times"] == "thesis"


@pytest.mark.parametrize("records", [None, MITES])
def test_the_same_command_goes_on_the_day_after(tmp_path, monkeypatch, records):
    asked = StudyOptions(
        ZIP, tmp_path / "study", "Nursery", records, sampler=["naive"], seeds=1, days=1
    )
    monkeypatch.setattr("fieldmon.cli.study_run.day_on", lambda _, told: told or date(2026, 11, 2))
    first = asked.plots()
    results.StudyFolder(asked.output, first, asked.design())
    monkeypatch.setattr("fieldmon.cli.study_run.day_on", lambda _, told: told or date(2026, 11, 3))
    assert [plot.digest for plot in asked.plots()] == [plot.digest for plot in first]
    (told,) = replace(asked, on="2026-11-03").plots()
    assert told.day == np.datetime64("2026-11-03")
    (elsewhere,) = replace(asked, output=tmp_path / "other").plots()
    assert elsewhere.day == told.day


def test_visits_are_as_far_apart_as_asked_and_other_studies_go_on(tmp_path):
    file = tmp_path / "plots.gpkg"
    square().to_file(file)
    daily, weekly = (
        StudyOptions(
            file, hours=[1.0], sampler=["naive"], infested=[0.3], seeds=1, days=8, visit_every=every
        )
        for every in (1, 7)
    )
    (plot,), found, keys = daily.plots(), [], []
    for asked in (daily.design(), weekly.design()):
        study = study_of((plot,), asked)
        (chunk,) = study.chunks()
        keys.append(chunk.key)
        found += [row["found_by_day"] for row in study.simulate(chunk.setting, chunk.seeds)]
    assert np.all(np.array(found[0]) > 0)
    assert (np.array(found[1]) > 0).tolist() == [True, *[False] * 6, True]
    assert keys[0] != keys[1]
    assert "visit_every" not in daily.design().content
    assert weekly.design().content["visit_every"] == 7


def test_a_folder_that_cannot_be_made_is_told_in_words(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(FileProblem, match=r"but it is not \(Not a directory\)\. Choose another"):
        results.StudyFolder(tmp_path / "file" / "study", (), StudyOptions(tmp_path).design())


def test_how_much_more_a_sampler_loses_is_told_season_by_season(capsys):
    alike = {"hours": 4.0, "look_s": 40.0, "infested": 0.02, "spread": 0.1, "plot": "A"}
    lost = {"naive": [12, 25, 33], "dynamic": [10, 20, 30]}
    rows = [
        {"sampler": name, **alike, "seed": seed, "detection_pct": 90.0, "infested_plant_days": n}
        for name, each in lost.items()
        for seed, n in enumerate(each)
    ]
    _tell(pa.Table.from_pylist(rows[::-1]))
    _, dynamic, naive, _ = capsys.readouterr().out.splitlines()
    assert dynamic.startswith("dynamic")
    assert dynamic.endswith(" 20  (best)")
    # differences 2, 5 and 3: mean 3.3, and by Student's t 4.30 * 1.53 / sqrt(3) to each side
    assert naive.endswith(" 23  +3.3 (-0.5 to +7.1)")
    assert dynamic.split()[4:6] == ["0.1", "3"]
    _tell(pa.Table.from_pylist([row | {"spread": None} for row in rows], results.SCHEMA))
    _, of_pest, *_ = capsys.readouterr().out.splitlines()
    assert of_pest == dynamic.replace("0.1", "   ")


def test_seasons_of_a_pest_have_no_spread(tmp_path):
    file = tmp_path / "plots.gpkg"
    square().to_file(file)
    usual = StudyOptions(file, hours=[1.0], sampler=["snake"], seeds=1, days=1)
    of_pest = replace(usual, pest_options=PestOptions(pest="thesis"))
    for asked, spread in ((usual, 0.1), (of_pest, None)):
        (chunk,) = study_of(asked.plots(), asked.design()).chunks()
        (season,) = simulate_chunk(chunk.setting, chunk.seeds, 1)
        assert season["spread"] == spread


def test_a_sampler_of_ones_own_is_compared_under_its_name(run, tmp_path, here):
    page = (ROOT / "docs" / "own_sampler.md").read_text(encoding="utf-8")
    text = page.split("```python\n")[1].split("```")[0]
    (tmp_path / "my_sampler.py").write_text(text, encoding="utf-8")
    words = ["study", "run", ZIP, "--feature", "Nursery", "--hours", 1, *FEW]
    own = ["--sampler", "my_sampler.py:Mine", "--sampler", "naive", "-o", "mine"]
    code, out, err, _ = run(*words, *own)
    assert code == 0, err
    assert "http://127.0.0.1:" in err
    assert {line.split()[0] for line in out.splitlines()} >= {"Mine", "naive"}
    assert set(results.seasons(tmp_path / "mine")["sampler"].to_pylist()) == {"Mine", "naive"}
    refused = text.replace("plants.append(at)", "plants.append(-1)")
    (tmp_path / "my_sampler.py").write_text(refused, encoding="utf-8")
    here()
    code, _, err, _ = run(*words, *own)
    assert (code, "Mine must answer plants from 0 on" in err) == (2, True)
