"""`fieldmon share`: hours go to the seasons that are due, and each route is a file."""

import csv
import json
import shutil
from contextlib import redirect_stdout
from datetime import date
from io import StringIO

import numpy as np
import pytest

from fieldmon.cli.main import app
from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, MITES, ZIP, filled_in

NEXT = "2026-11-03"


def table(path):
    """Return the rows of a table that begins with a spreadsheet's mark."""
    with path.open(encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def bend(tmp_path_factory):
    """Begin a season on another plot by its command, once; return its file."""
    file = tmp_path_factory.mktemp("begun") / "bend.gpkg"
    words = ["init", file, ZIP, "--feature", "Bend", "--records", MITES, "--begins", BEGINS]
    with redirect_stdout(StringIO()):
        app([str(word) for word in words], standalone_mode=False)
    return file


@pytest.fixture
def seasons(begun, bend, tmp_path):
    """Return the files of two seasons, copies for each test."""
    shutil.copy(begun, tmp_path / "nursery.gpkg")
    shutil.copy(bend, tmp_path / "bend.gpkg")
    return "nursery.gpkg", "bend.gpkg"


def test_two_share_the_plots_by_a_table(run, seasons, tmp_path):
    (tmp_path / "crew.csv").write_text(
        "name,who,hours,start\nRex,robot,1.5,06:00\nAnn,scout,1,07:00\n"
    )
    code, out, err, made = run(
        *("share", *seasons, "--date", BEGINS, "--robots", "crew.csv", "-o", "monday"),
        *("--format", "geojson", "--format", "gpx"),
    )
    assert code == 0, err
    rows = {row["plot"]: row for row in table(tmp_path / "monday" / "plan.csv")}
    assert rows.keys() == {"nursery", "bend"}
    assert {row["who"]: row["from"] for row in rows.values()} == {
        "Rex": f"{BEGINS}T06:00:00", "Ann": f"{BEGINS}T07:00:00",
    }  # fmt: skip
    named = {name for row in rows.values() for name in row["file"].split()}
    assert {path.name for path in made} == named | {"monday", "plan.csv"}
    assert "From plot to plot takes 15 minutes, wherever they lie" in out
    for row in rows.values():
        main, gpx = row["file"].split()
        line, *stops = json.loads((tmp_path / "monday" / main).read_text())["features"]
        assert len(stops) == int(row["plants"]) > 0
        assert line["properties"]["start"] == row["from"]
        assert gpx.endswith(".gpx")
        assert f"{row['plot']}, {row['who']}: from {row['from'][11:16]}, " in out
    assert "chance to find what is there 69 % (Ann)" in err


def worked(file):
    """Record that half of a season's plants were inspected on its first day."""
    season = Season(file)
    plants = np.arange((len(season.plot.grid) + 1) // 2)
    season.record(Inspections.of(plants, np.full(len(plants), CLEAN), date.fromisoformat(BEGINS)))


def test_what_was_just_seen_is_not_due(run, seasons, tmp_path):
    words = ("share", *seasons, "--hours", 1, "--move", 0)
    worked(seasons[0])
    code, out, err, made = run(*words, "--date", NEXT)
    assert code == 0, err
    assert "Left out: nursery (inspected 1 day ago, not due)." in out
    assert {path.name for path in made} == {f"day-{NEXT}", "01-bend.geojson", "plan.csv"}
    left_out = {
        row["plot"]: row["left_out"] for row in table(tmp_path / f"day-{NEXT}" / "plan.csv")
    }
    assert left_out == {"bend": "", "nursery": "inspected 1 day ago, not due"}
    code, _, err, _ = run(*words, "--date", NEXT, "--all", "-o", "both")
    assert code == 0, err
    assert len(table(tmp_path / "both" / "plan.csv")) == 2


def test_where_no_plot_is_due_none_is_planned_and_the_way_out_is_said(run, seasons, tmp_path):
    for season in seasons:
        worked(season)
    words = ("share", *seasons, "--hours", 1, "--date", NEXT)
    code, out, err, made = run(*words)
    assert code == 2
    for name in ("nursery", "bend"):
        assert f"Left out: {name} (inspected 1 day ago, not due)." in out
    assert "Plan those seen since with --all, or another day with --date." in err
    assert not made
    assert run(*words, "--all", "-o", "both")[0] == 0
    assert {row["plot"] for row in table(tmp_path / "both" / "plan.csv")} == {"nursery", "bend"}


def test_nothing_that_is_in_the_folder_is_touched(run, seasons, tmp_path):
    (tmp_path / "plan.csv").write_text("file\nnursery.gpkg\n")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    code, _, err, made = run("share", *seasons, "--date", BEGINS, "--hours", 1, "-o", ".")
    assert code == 2
    assert "must go into a new or empty folder" in err
    assert not made
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_the_seasons_robot_works_where_nobody_else_is_told(run, seasons, tmp_path):
    season, other = seasons
    words = ("share", season, "--date", BEGINS, "--format", ".geojson")
    assert run("change", season, "--look", 120)[0] == 0
    code, _, err, _ = run(*words, "-o", "own")
    assert code == 0, err

    def stops(folder):
        (file,) = (tmp_path / folder).glob("01-*.geojson")
        _, *stops = json.loads(file.read_text())["features"]
        return {one["properties"]["inspect_s"] for one in stops}

    (own,) = stops("own")
    assert own >= 120
    code, _, err, _ = run(*words, "--look", 30, "-o", "told")
    assert code == 0, err
    assert stops("told").pop() < 40
    code, _, err, _ = run(*words, other, "--hours", 1, "-o", "two")
    assert code == 2
    assert "must work with one robot, but they have several (" in err
    assert ": a robot; " in err
    code, _, err, _ = run(*words, other, "--hours", 1, "--scout", "-o", "two")
    assert code == 0, err


@pytest.mark.parametrize("planned_before", [False, True])
def test_a_crews_detection_reaches_the_season_and_each_keeps_its_own(
    run, season, tmp_path, planned_before
):
    if planned_before:
        run("plan", season, "--date", BEGINS, "-o", "own.csv", "--no-bound")
    for name, detection in (("Ben", 0.3), ("Rex", 0.6)):
        (tmp_path / "low.csv").write_text(f"name,who,hours,detection\n{name},scout,1,{detection}\n")
        words = ("share", season, "--date", BEGINS, "--all", "--robots", "low.csv")
        code, _, err, _ = run(*words, "--format", "csv", "-o", name)
        assert code == 0, err
        assert "reads results" not in err
        (route,) = (tmp_path / name).glob("01-*.csv")
        filled_in(route, {0}, 5)
        code, out, err, _ = run("record", season, route)
        assert code == 0, err
        said = f"{name}, {BEGINS}: 5 inspections find {detection:.0%} of what is there, as was"
        assert said.replace("%", " %") in out
    kept = Season(season)
    told = set(zip(kept.inspections.who, kept.history.detections.tolist(), strict=True))
    assert told == {("Ben", 0.3), ("Rex", 0.6)}
    _, out, _, _ = run("log", season)
    assert "told to find 30 % of what is there" in out
    _, out, _, _ = run("status", season)
    assert "Ben, 2026-11-02: 5 inspections find 30 % of what is there, as was said with them" in out
    assert "the season's own is 84 %." in out
    assert "Inspections of that day find" not in out


def test_days_of_several_lengths_are_asked_for_one(run, seasons):
    code, _, err, made = run("share", *seasons, "--date", BEGINS, "-o", "day")
    assert code == 2
    assert "The day must have one length, but the seasons have 1 and " in err
    assert not made


def test_a_plot_without_time_and_who_has_none_are_said(run, seasons, tmp_path):
    code, out, err, _ = run("share", *seasons, "--date", BEGINS, "--hours", 0.3, "-o", "day")
    assert code == 0, err
    (waits,) = (row["plot"] for row in table(tmp_path / "day" / "plan.csv") if not row["file"])
    assert f"Left out: {waits} (no time)." in out
    code, out, err, _ = run("share", seasons[0], "--date", BEGINS, "--robots", 2, "-o", "day2")
    assert code == 0, err
    assert "Without a plot: robot-2." in out
    assert table(tmp_path / "day2" / "plan.csv")[-1]["who"] == "robot-2"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--date", "2026-11-01"), "At least one season must have begun and be due"),
        (("--format", "xyz"), "but not as 'xyz'"),
        (("--robots", "crew.csv"), "Leave them out"),
        (("--move", "-1"), "--move must be 0 minutes or more"),
    ],
)
def test_what_cannot_be_shared_is_a_sentence_and_writes_nothing(run, begun, tmp_path, words, says):
    (tmp_path / "crew.csv").write_text("name,lon,lat\nRex,35.15,30.36\n")
    code, _, err, made = run("share", begun, "-o", "day", *words)
    assert code == 2
    assert says in err
    assert not made
