"""The folder of a study: whole parts, of one study, for any reader of Parquet."""

import json
from dataclasses import replace

import pyarrow.parquet as pq
import pytest

from fieldmon.errors import FileProblem, SettingError
from fieldmon.simulation import executor, results
from fieldmon.simulation.design import Design, study_of
from fieldmon.simulation.experiment import run
from fieldmon.simulation.results import MANIFEST, SCHEMA, StudyFolder
from fieldmon.simulation.worker import RefusedPlot
from tests.simulation.study_plots import DAY, SMALL, plot

SHORT = Design(samplers=("naive", "bouncy"), n_days=2, n_seeds=3)


def simulated(folder, plots, asked=SHORT):
    store = StudyFolder(folder, plots, asked)
    run(study_of(plots, asked), executor.here(), store)
    return store


def test_seasons_come_back_in_the_order_of_their_settings(tmp_path):
    simulated(tmp_path, [plot(name="b"), plot(30.0, "a")])
    table = results.seasons(tmp_path)
    order = [(r["plot"], r["sampler"], r["seed"]) for r in table.to_pylist()]
    assert order == sorted(order)
    assert len(order) == 2 * 2 * 3
    assert set(table.column_names) == set(SCHEMA.names)


def test_a_season_that_two_parts_hold_counts_once(tmp_path):
    store = simulated(tmp_path, [plot()])
    once = results.seasons(tmp_path)
    rows = [row for row in once.to_pylist() if row["sampler"] == "naive" and row["seed"] > 1]
    store.keep(("naive", "cut in another way"), rows)
    assert results.seasons(tmp_path).equals(once)


def test_seasons_of_a_pest_have_no_spread_though_an_older_fieldmon_named_one(tmp_path):
    store = simulated(tmp_path, [plot()])
    rows = [row | {"spread": None} for row in results.seasons(tmp_path).to_pylist()]
    half = [row for row in rows if row["sampler"] == "naive"]
    for seeds in ((1, 2), (2, 3)):  # and parts that overlap
        part = [row for row in half if row["seed"] in seeds]
        store.keep(("naive", f"continued from {seeds[0]}"), part)
    assert results.seasons(tmp_path).to_pylist() == rows


def test_the_dataset_is_read_by_any_reader_of_parquet(tmp_path):
    simulated(tmp_path, [plot()])
    table = pq.read_table(tmp_path)
    assert table.num_rows == 6
    assert set(table["sampler"].to_pylist()) == {"naive", "bouncy"}


def test_the_manifest_says_what_was_asked_for(tmp_path):
    simulated(tmp_path, [plot()])
    said = json.loads((tmp_path / MANIFEST).read_text(encoding="utf-8"))
    assert list(said) == [
        *("samplers", "hours", "look_s", "infested", "spread"),
        *("n_days", "n_seeds", "first_seed", "first_day", "plots"),
    ]
    assert said["plots"] == [f"plot {plot().digest}"]


def test_what_is_there_is_known(tmp_path):
    store = simulated(tmp_path, [plot()])
    again = StudyFolder(tmp_path, [plot()], SHORT)
    keys = [chunk.key for chunk in study_of([plot()], SHORT).chunks()]
    assert all(again.holds(key) for key in keys)
    store.part(keys[0]).unlink()
    assert [again.holds(key) for key in keys] == [False, *[True] * (len(keys) - 1)]


def test_a_folder_with_another_study_is_refused(tmp_path):
    StudyFolder(tmp_path, [plot()], SMALL)
    StudyFolder(tmp_path, [plot()], SMALL)
    for plots, asked in (([plot()], Design()), ([plot(41.0)], SMALL)):
        with pytest.raises(SettingError, match="another study"):
            StudyFolder(tmp_path, plots, asked)


def test_what_another_study_has_otherwise_is_named(tmp_path):
    StudyFolder(tmp_path, [plot()], SMALL)
    later = replace(plot(), day=DAY + 1)
    says = r"its first day \(--date\) is 2026-11-02, not 2026-11-03\. Choose"
    with pytest.raises(SettingError, match=says):
        StudyFolder(tmp_path, [later], SMALL)
    with pytest.raises(SettingError, match=r"03, and it differs in days\."):
        StudyFolder(tmp_path, [later], replace(SMALL, n_days=9))
    with pytest.raises(SettingError, match=r": it differs in plots or records\."):
        StudyFolder(tmp_path, [plot(41.0)], SMALL)


def test_a_study_of_before_that_does_not_say_its_first_day_goes_on_and_says_it(tmp_path):
    StudyFolder(tmp_path, [plot()], SMALL)
    manifest = tmp_path / MANIFEST
    said = json.loads(manifest.read_text(encoding="utf-8"))
    before = {name: value for name, value in said.items() if name != "first_day"}
    manifest.write_text(json.dumps(before), encoding="utf-8")
    assert results.first_day(tmp_path) is None
    with pytest.raises(SettingError, match=r"in plots, records or first day \(--date\)\."):
        StudyFolder(tmp_path, [replace(plot(), day=DAY + 1)], SMALL)
    StudyFolder(tmp_path, [plot()], SMALL)
    assert json.loads(manifest.read_text(encoding="utf-8")) == said
    assert results.first_day(tmp_path) == DAY.item()


def test_seasons_of_a_sampler_whose_file_has_changed_are_not_mixed_with_those_of_before(tmp_path):
    file, folder = tmp_path / "own.py", tmp_path / "study"
    code = "from fieldmon.samplers.sweeps import Naive\nclass Mine(Naive):\n    pass\n"
    file.write_text(code)
    asked = replace(SMALL, samplers=(f"{file}:Mine", "naive"))
    StudyFolder(folder, [plot()], asked)
    file.write_text(f"{code}    more = 1\n")
    says = r"another study.*: its seasons of Mine are of other code than the file's\. Choose"
    with pytest.raises(SettingError, match=says):
        StudyFolder(folder, [plot()], asked)
    with pytest.raises(SettingError, match=r": it differs in samplers\."):
        StudyFolder(folder, [plot()], SMALL)
    file.write_text(code)
    StudyFolder(folder, [plot()], asked)


@pytest.mark.parametrize("text", ["", "[1]", '{"first_day": 3}', '{"first_day": "today"}'])
def test_a_manifest_that_was_cut_or_changed_is_a_sentence(tmp_path, text):
    (tmp_path / MANIFEST).write_text(text)
    with pytest.raises(FileProblem, match="must say what the study in its folder is"):
        results.first_day(tmp_path)


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileProblem, match="folder to write to"):
        StudyFolder(tmp_path / "file", [plot()], SMALL)


def test_a_folder_without_seasons_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="finished seasons"):
        results.seasons(tmp_path)


def test_a_plot_without_room_is_refused_and_the_others_go_on(tmp_path):
    store = simulated(tmp_path, [plot(), plot(1.0, "tiny")])
    assert set(store.refused) == {"tiny"}
    assert set(results.seasons(tmp_path)["plot"].to_pylist()) == {"plot"}
    store.keep(("naive", "x"), RefusedPlot("other", "It is wet."))
    assert store.refused["other"] == "It is wet."
    assert not store.holds(("naive", "x"))
