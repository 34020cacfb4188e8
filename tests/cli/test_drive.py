"""`fieldmon drive`: a day driven on a plot, or recorded in a season."""

from datetime import datetime
from zoneinfo import ZoneInfo

import pytest
from rosbags.highlevel import AnyReader

from fieldmon.drive.bag import read_bag
from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.one_drive import one_drive
from fieldmon.drive.season_day import SeasonDay
from fieldmon.errors import ObservationError
from fieldmon.monitoring import Season
from fieldmon.monitoring.phones.scouts import let_in
from tests.cli.estate import BEGINS, ZIP, table

PLOT = ("drive", ZIP, "--feature", "Nursery", "--hours", "0.3", "--date", BEGINS)


def test_a_day_is_driven_as_charged_and_its_tables_written(run, tmp_path):
    code, out, err, made = run(*PLOT, "-o", "day.csv")
    assert code == 0, err
    assert "plants inspected" in out
    assert {path.name for path in made} == {"day.csv", "day.stops.csv"}
    (day,) = table(tmp_path / "day.csv")
    assert (day["robot"], day["stuck"], day["charged_s"]) == ("charged", "0", day["driven_s"])
    assert len(table(tmp_path / "day.stops.csv")) == int(day["stops"]) > 10


def test_a_day_is_driven_with_wheels_and_kept_as_a_bag(run, tmp_path):
    words = ("--robot", "mujoco", "--rover", "--hours", "0.05", "-o", "day.csv", "--bag", "d.mcap")
    code, out, err, made = run(*PLOT[:4], *words)
    assert code == 0, err
    assert "0 plants touched" in out
    assert "reach of plants to each side 0.25 m" in err
    assert {"d.mcap", "d.rviz", "d.foxglove.json"} <= {path.name for path in made}
    (day,) = table(tmp_path / "day.csv")
    assert 0 < float(day["worst_cross_track_m"]) < 0.1


def test_a_day_on_a_plot_begins_when_it_is_told_to(run, tmp_path):
    words = (*PLOT, "--hours", "0.05", "--bag", "day.mcap")
    for start, told in (("06:00", ()), ("07:30", ("--start", "07:30"))):
        code, _, err, _ = run(*words, *told)
        assert code == 0, err
        with AnyReader([tmp_path / "day.mcap"]) as bag:
            begins = datetime.fromtimestamp(bag.start_time / 1e9, ZoneInfo("Asia/Jerusalem"))
        assert f"{begins:%F %H:%M}" == f"{BEGINS} {start}"
    code, _, err, _ = run(*words, "--start", "7.30")
    assert (code, err) == (2, "--start must be a time as HH:MM, but it is '7.30'.\n")
    code, _, err, _ = run(*words, "--start", "07:30", "--robot", "vda5050")
    assert code == 2
    assert "--start goes with a simulated robot" in err


@pytest.fixture
def short(run, season):
    """Return the file of a season of short days: a robot's whole day is recorded stop by stop."""
    assert run("change", season, "--hours", "0.12")[0] == 0
    return season


def test_made_up_finds_are_not_recorded_unless_it_is_said(run, season):
    code, _, err, _ = run("drive", season, "--date", BEGINS)
    assert code == 2
    assert "--made-up" in err
    assert len(Season(season).history.inspections) == 0


def test_a_day_of_a_season_is_one_batch_and_is_not_driven_twice(run, short):
    code, _, err, _ = run("drive", short, "--date", BEGINS, "--made-up")
    assert code == 0, err
    (batch,) = Season(short).batches()
    assert "made up" in batch.source
    code, out, _, _ = run("drive", short, "--date", BEGINS, "--made-up")
    assert code == 0
    assert "goes on after plant" in out
    assert f"{batch.rows} inspections of the day before that are in the season." in out
    assert Season(short).batches() == (batch,)


def test_a_day_that_is_stopped_says_what_is_kept_and_writes_its_table(
    run, short, tmp_path, monkeypatch
):
    visit, left = ChargedRobot.visit, iter([True] * 3)

    def stopped(robot, errand):
        if not next(left, False):
            raise KeyboardInterrupt
        return visit(robot, errand)

    monkeypatch.setattr(ChargedRobot, "visit", stopped)
    let_in(Season(short), "Ann", (1, 2))
    words = ("drive", short, "--date", BEGINS, "--made-up", "-o", "day.csv", "--bag")
    code, _, err, made = run(*words, "nowhere/day.mcap")
    assert (code, made) == (2, set())
    code, out, err, made = run(*words, "day.mcap")
    assert code == 130
    assert f"3 results of {BEGINS} in the season; the same command goes on" in out
    # half a day was written, and the last line does not deny it
    assert "nothing was written" not in err
    finds = [one for one, _, _ in read_bag(tmp_path / "day.mcap", ("/finds",))]
    assert len(finds) == 3
    assert {"day.rviz", "day.foxglove.json"} <= {path.name for path in made}
    assert "Ann is out with a route of their own; the robot leaves rows 1-2 to them." in err
    assert len(table(tmp_path / "day.stops.csv")) == 3
    assert len(Season(short).history.inspections) == 3
    _, _, err, _ = run("plan", short, "--date", BEGINS, "--no-bound", "-o", "r.csv")
    assert "those who are out have their own" in err
    monkeypatch.setattr(ChargedRobot, "visit", visit)
    first = [tmp_path / name for name in ("day.mcap", "day.csv", "day.stops.csv")]
    held = [path.read_bytes() for path in first]
    (tmp_path / "day-2.csv").write_text("of a run whose bag failed", encoding="utf-8")
    _, out, _, made = run(*words, "day.mcap")
    assert "follows what is left of the plan given out last" in out
    assert [path.read_bytes() for path in first] == held
    second = {"day-3.mcap", "day-3.rviz", "day-3.foxglove.json", "day-3.csv", "day-3.stops.csv"}
    assert second <= {path.name for path in made}
    assert table(tmp_path / "day-3.csv")[0]["stops_before"] == "3"


def test_a_day_past_midnight_says_so_and_writes_its_tables(run, season, tmp_path):
    run("change", season, "--start", "23:56", "--hours", "0.15")
    code, _, err, _ = run("drive", season, "--date", BEGINS, "--made-up", "-o", "day.csv")
    assert code == 0, err
    assert "past midnight, to 00:05: a result with a time after that is of 2026-11-03" in err
    held = Season(season).history.inspections
    assert set(held.date.astype(str)) == {BEGINS, "2026-11-03"}
    assert len(table(tmp_path / "day.stops.csv")) == len(held)


@pytest.mark.parametrize("n", [0, 3])
def test_a_day_that_breaks_off_writes_what_was_driven(run, season, tmp_path, monkeypatch, n):
    tell, left = SeasonDay.tell, iter([True] * n)
    (tmp_path / "day.mcap").write_bytes(b"an earlier one")

    def refused(day, found, at_s=None):
        if not next(left, False):
            raise ObservationError("The file is full.")
        tell(day, found, at_s)

    monkeypatch.setattr(SeasonDay, "tell", refused)
    words = ("--date", BEGINS, "--made-up", "-o", "day.csv", "--bag", "day.mcap")
    code, out, err, _ = run("drive", season, *words)
    assert code == 2
    assert "The file is full." in err
    assert f"{n} results" in out
    assert len(table(tmp_path / "day.stops.csv")) == n
    assert len([*read_bag(tmp_path / "day.mcap", ("/finds",))]) == n


def test_where_no_broker_answers_it_is_a_sentence(run):
    code, _, err, _ = run(*PLOT, "--robot", "vda5050", "--broker", "127.0.0.1:1")
    assert code == 2
    assert "MQTT broker must answer" in err


def test_a_season_that_another_command_drives_is_refused(run, season):
    with one_drive(season, "fieldmon/A"):
        code, _, err, _ = run("drive", season, "--date", BEGINS, "--made-up")
    assert code == 2
    assert "but fieldmon/A drives season.gpkg now. Wait for its end, or give the season a" in err
    assert len(Season(season).history.inspections) == 0
    run("change", season, "--robots", "2")
    with one_drive(season, "a team (fieldmon)", is_team=True):
        code, _, err, _ = run("drive", season, "--date", BEGINS, "--robot", "vda5050")
    assert code == 2
    assert "but a team (fieldmon) drives season.gpkg now. Wait for its end: one command" in err


def test_a_day_on_a_plot_that_is_stopped_writes_what_was_driven(run, tmp_path, monkeypatch):
    visit, left = ChargedRobot.visit, iter([True] * 3)

    def stopped(robot, errand):
        if not next(left, False):
            raise KeyboardInterrupt
        return visit(robot, errand)

    monkeypatch.setattr(ChargedRobot, "visit", stopped)
    code, out, err, _ = run(*PLOT, "-o", "day.csv", "--bag", "day.mcap")
    assert code == 130
    assert "the same command begins it anew" in out
    assert "nothing was written" not in err
    assert len(table(tmp_path / "day.stops.csv")) == 3
    assert len([*read_bag(tmp_path / "day.mcap", ("/finds",))]) == 3


@pytest.mark.parametrize(
    "words", [["--hours", "0.1"], ["--start", "07:30"], ["--sampler", "naive"], ["--scout"]]
)
def test_what_a_season_keeps_is_refused_and_nothing_is_driven(run, season, words):
    kept = season.read_bytes()
    code, _, err, made = run("drive", season, "--made-up", *words)
    assert (code, made) == (2, set())
    assert f"A season keeps what was chosen when it began, but {words[0]} was given" in err
    assert season.read_bytes() == kept
