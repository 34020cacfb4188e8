"""`fieldmon init`: a season begins."""

from datetime import date, time, timedelta

import pandas as pd
import pytest

from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, MITES, ZIP


def test_a_season_keeps_what_it_is_told_and_what_the_files_said(run, tmp_path):
    code, out, err, made = run(
        *["init", "s.gpkg", ZIP, "--feature", "Nursery", "--observations", MITES],  # the old name
        *["--begins", BEGINS, "--start", "05:45", "--sampler", "bouncy", "--every", 3],
        *["--flag-only", "--spread", 0.03, "--seed", 9, "--hours", 2, "--look", 25],
    )
    assert code == 0, err
    assert made == {tmp_path / "s.gpkg"}
    assert "Next: fieldmon plan s.gpkg -o route.geojson" in out
    season = Season(tmp_path / "s.gpkg")
    settings = season.settings
    assert (settings.begins, settings.starts) == (date.fromisoformat(BEGINS), time(5, 45))
    assert (settings.sampler, settings.sampler_settings) == ("bouncy", {"every": 3})
    assert (settings.robot.hours, settings.robot.look_s, settings.seed) == (2.0, 25.0, 9)
    assert (settings.belief.treated, settings.belief.spread.rate_per_day) == (False, 0.03)
    kept = [(message.source, message.sentence) for message in season.messages()]
    assert ("mite_records.csv", "Counts are in column 'count'.") in kept
    assert ("paran_estate.zip", "Plots are named by column 'name'.") in kept
    assert all(sentence in err for _, sentence in kept)


def test_the_next_command_can_be_pasted_where_the_name_has_a_space(run):
    code, out, err, _ = run("init", "Nursery 2026.gpkg", ZIP, "--feature", "Nursery")
    assert code == 0, err
    assert "Next: fieldmon plan 'Nursery 2026.gpkg' -o route.geojson" in out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--begins", "soon"], "YYYY-MM-DD"),
        (["--feature", "Moon"], "none is called 'Moon'"),
        (["--spread", "2"], "2"),
    ],
)
def test_what_cannot_begin_is_a_sentence_and_no_file(run, words, says):
    code, _, err, made = run("init", "s.gpkg", ZIP, "--feature", "Nursery", *words)
    assert (code, made) == (2, set())
    assert says in err


def test_a_season_begins_with_what_an_earlier_one_learnt(run, tmp_path):
    last = ["init", "last.gpkg", ZIP, "--feature", "Nursery", "--begins", BEGINS]
    later = str(date.fromisoformat(BEGINS) + timedelta(days=1))
    begin = ["init", "s.gpkg", ZIP, "--feature", "Nursery", "--begins", later]
    assert run(*last)[0] == 0
    code, _, err, made = run(*begin, "--earlier", "last.gpkg")
    assert (code, made) == (2, set())
    assert "last.gpkg nothing was inspected" in err
    assert run("plan", "last.gpkg", "--no-bound", "--date", BEGINS, "-o", "day.csv")[0] == 0
    day = tmp_path / "day.csv"
    seen = pd.read_csv(day).head(30)
    seen["result"] = "clean"
    seen.to_csv(day, index=False)
    code, _, err, _ = run("record", "last.gpkg", "day.csv")
    assert code == 0, err
    code, out, err, _ = run(*begin, "--earlier", "last.gpkg")
    assert code == 0, err
    said = f"Begun with what was learnt on Nursery until {BEGINS}, which counts little"
    assert said in out
    assert said in run("status", "s.gpkg")[1]
    # it must have ended, though it is the same plot
    _, _, err, made = run("init", "early.gpkg", *begin[2:-1], BEGINS, "--earlier", "last.gpkg")
    assert f"begins on {BEGINS}, but that on Nursery goes on until {BEGINS}" in err
    assert not made
    # another pest teaches nothing of this one, and that is said
    begin[1] = "mites.gpkg"
    _, out, _, _ = run(*begin, "--earlier", "last.gpkg", "--pest", "spider-mite")
    assert "does not count: it was of another pest" in out
