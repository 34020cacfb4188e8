"""`fieldmon correct`: what another program changed is somebody's correction."""

import shlex
import sqlite3
from contextlib import closing
from datetime import UTC, date, datetime, time, timedelta

import numpy as np
import pyogrio

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.plot import local_clock
from tests.cli.estate import BEGINS


def test_until_somebody_takes_it_every_command_refuses_what_another_program_changed(run, season):
    Season(season).record(Inspections.of(np.arange(3), np.zeros(3, int), BEGINS), "taps")
    with closing(sqlite3.connect(season)) as db:
        db.execute("UPDATE inspections SET result = 'found' WHERE fid = 2")
        db.commit()
    for command in ("status", "plan", "undo", "report"):
        code, _, err, made = run(command, season)
        assert (code, made) == (2, set())
        assert "row 2 of the layer inspections" in err
        assert "fieldmon correct" in err
    code, _, err, _ = run("correct", season, "--who", " ")
    assert (code, "--who must name" in err) == (2, True)
    code, out, _, _ = run("correct", season, "--who", "Ann")
    assert code == 0
    assert out.startswith("1 correction taken, by Ann.\nchanges of another program taken as ")
    code, out, _, _ = run("status", season, "--batches")
    assert code == 0
    assert "1 correction by Ann" in out
    assert "Nothing was changed" in run("correct", season, "--who", "Ann")[1]


def test_the_time_alone_of_an_inspection_is_corrected(run, season):
    kept = Season(season)
    told = Inspections.of(np.arange(2), np.array([0, 1]), BEGINS, second=[22_000, 80_000])
    kept.record(told, "taps")
    for words in (["--inspection", "2"], ["--time", "07:00"], ["--date", BEGINS]):
        said = run("correct", season, "--who", "Ann", *words)[2]
        assert "--inspection must be given with --date or --time" in said
    words = ["correct", season, "--who", "Ann", "--time", "07:00", "--inspection"]
    assert "an inspection 9 that still counts" in run(*words, "9")[2]
    code, out, _, _ = run(*words, "2")
    assert (code, out.endswith("is now time 07:00:00\n")) == (0, True)
    logged = Season(season).log()[-1].sentence()
    assert logged.startswith("corrected: found at row")
    assert logged.endswith("is now time 07:00:00")
    held = Season(season).history.inspections
    assert held.second.tolist() == [22_000, 7 * 3600]
    assert held.result.tolist() == [0, 1]
    assert Season(season).verify() == ()
    run("undo", season)
    assert Season(season).history.inspections.second.tolist() == [22_000, 80_000]


def test_a_correction_that_contradicts_what_is_recorded_is_refused_until_it_is_confirmed(
    run, season
):
    kept = Season(season)
    kept.record(Inspections.of(np.arange(2), np.array([0, 1]), BEGINS), "taps")
    # a found plant is moved onto one that is clean
    with closing(sqlite3.connect(season)) as db:
        db.execute(
            "UPDATE inspections SET geom = (SELECT geom FROM inspections WHERE plant = 0) "
            "WHERE plant = 1"
        )
        db.commit()
    code, _, err, made = run("correct", season, "--who", "Ann")
    assert (code, made) == (2, set())
    place = f"Row 1, plant 1 on {BEGINS}: recorded as clean, now found."
    assert place in err
    assert "Confirm with: --contradicting" in err
    assert run("correct", season, "--who", "Ann", "--contradicting")[0] == 0
    assert Season(season).history.inspections.plant.tolist() == [0, 0]
    # what contradicts already is no news
    with closing(sqlite3.connect(season)) as db:
        db.execute("UPDATE inspections SET notes = 'below' WHERE undone = 0 AND result = 'found'")
        db.commit()
    assert run("correct", season, "--who", "Ann")[0] == 0


def test_a_time_that_puts_clean_and_found_at_one_minute_must_be_confirmed(run, season):
    kept, at = Season(season), [8 * 3600, 9 * 3600, 10 * 3600]
    told = Inspections.of(np.zeros(3, int), np.array([0, 1, 0]), BEGINS, second=at)
    kept.record(told, "taps", confirmed=True)
    words = ["correct", season, "--who", "Ann", "--inspection", "1", "--time"]
    assert run(*words, "08:30")[0] == 0
    assert run(*words, "10:05")[0] == 0
    code, _, err, _ = run(*words, "09:00")
    place = f"Row 1, plant 1 on {BEGINS}: recorded as found, now clean."
    assert (code, place in err, "--contradicting" in err) == (2, True, True)
    assert run(*words, "09:00", "--contradicting")[0] == 0


def test_a_time_alone_must_have_come_and_the_day_stays_in_order(run, season, monkeypatch):
    kept = Season(season)
    told = Inspections.of(np.arange(2), np.array([0, 1]), BEGINS, second=[22_000, 30_000])
    kept.record(told, "taps")
    # 12:00 on the plot
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2026, 11, 2, 10, tzinfo=UTC))
    words = ["correct", season, "--who", "Ann", "--inspection"]
    code, _, err, _ = run(*words, "1", "--time", "12:01")
    assert (code, f"moment that has come, but {BEGINS} 12:01 has not" in err) == (2, True), err
    assert Season(season).history.inspections.second.tolist() == [22_000, 30_000]
    assert run(*words, "1", "--time", "12:00")[0] == 0
    held = Season(season).history.inspections
    assert (held.plant.tolist(), held.second.tolist()) == ([1, 0], [30_000, 12 * 3600])
    # its day alone, to today: the time it keeps is still to come
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2026, 11, 3, 5, tzinfo=UTC))
    code, _, err, _ = run(*words, "1", "--date", "2026-11-03")
    assert (code, "but 2026-11-03 12:00 has not" in err) == (2, True), err


def test_where_nothing_is_corrected_there_is_no_batch(run, season):
    kept = Season(season)
    kept.record(Inspections.of(np.arange(2), np.zeros(2, int), BEGINS, second=[28_800] * 2), "taps")
    kept.correct_time(1, time(8, 30), "Ann")
    words = ["correct", season, "--who", "Ann", "--inspection", "1"]
    for more in (["--time", "08:30"], ["--date", BEGINS], ["--date", BEGINS, "--time", "08:30"]):
        code, _, err, _ = run(*words, *more)
        assert (code, f"of {BEGINS} 08:30 already: there is nothing to correct" in err) == (2, True)
    before = [one.number for one in kept.batches()]
    with closing(sqlite3.connect(season)) as db:
        db.execute("UPDATE inspections SET geom = NULL, line = 99, notes = '' WHERE fid = 1")
        db.commit()
    assert "Nothing was changed" in run("correct", season, "--who", "Ann")[1]
    kept = Season(season)
    assert ([one.number for one in kept.batches()], kept.verify()) == (before, ())
    with closing(sqlite3.connect(season)) as db:
        assert db.execute(
            "SELECT geom IS NULL, line, batch FROM inspections WHERE fid = 1"
        ).fetchone() == (0, 1, 2)
        # one of two says something else
        db.execute("UPDATE inspections SET geom = NULL WHERE fid = 1")
        db.execute("UPDATE inspections SET result = 'found' WHERE fid = 2")
        db.commit()
    assert "1 correction taken" in run("correct", season, "--who", "Ann")[1]
    assert Season(season).history.inspections.result.tolist() == [1, 0]
    run("undo", season)
    assert Season(season).history.inspections.result.tolist() == [0, 0]
    assert check_against_log(Season(season)) == ()


def test_a_time_that_the_clock_left_out_is_refused(run, season, monkeypatch):
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2027, 3, 27, 12, tzinfo=UTC))
    told = Inspections.of(np.arange(1), np.zeros(1, int), "2027-03-26", second=[3600])
    Season(season).record(told, "taps")
    words = ["correct", season, "--who", "Ann", "--inspection", "1", "--time"]
    code, _, err, _ = run(*words, "02:30")
    assert (code, "2027-03-26 02:30 is none: clocks were put forward" in err) == (2, True), err
    assert run(*words, "03:00")[0] == 0


def test_the_day_of_an_inspection_is_corrected_and_days_stay_in_order(run, season, monkeypatch):
    kept, begins = Season(season), date.fromisoformat(str(BEGINS))
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2026, 11, 5, 12, tzinfo=UTC))
    at = [np.datetime64(begins + timedelta(days=k)) for k in (0, 1, 1)]
    told = Inspections.of(np.arange(3), np.array([0, 1, 0]), np.array(at), second=[22_000] * 3)
    kept.record(told, "taps")
    words = ["correct", season, "--who", "Ann", "--inspection", "3", "--date"]
    for wrong, says in (
        (["2026-11-01"], "must be of this season, which began on 2026-11-02"),
        (["2026-11-06"], "must be of a moment that has come, but 2026-11-06 has not: on the plot"),
        (["2026-11-05", "--time", "23:59"], "but 2026-11-05 23:59 has not"),
        (["2.11."], "--date must be a day as YYYY-MM-DD"),
    ):
        code, _, err, _ = run(*words, *wrong)
        assert (code, says in err) == (2, True), err
    before = Season(season).history.inspections
    assert before.plant.tolist() == [0, 1, 2]
    code, out, err, _ = run(*words, "2026-11-02", "--time", "05:00")
    assert code == 0, err
    assert "2026-11-02" in out
    held = Season(season).history
    assert held.inspections.plant.tolist() == [2, 0, 1]
    assert held.days.tolist() == [0, 0, 1]
    assert held.inspections.second.tolist() == [5 * 3600, 22_000, 22_000]
    assert Season(season).verify() == ()
    run("undo", season)
    assert Season(season).history.inspections.date.tolist() == before.date.tolist()


def test_an_exported_layer_that_was_changed_is_recorded_as_corrections_or_not_at_all(
    run, season, tmp_path
):
    Season(season).record(Inspections.of(np.arange(2), np.array([0, 1]), BEGINS), "taps")
    layer = pyogrio.read_dataframe(season, layer="inspections")
    layer.loc[0, ["result", "count"]] = ["found", 3]
    layer.loc[1, "count"] = 5
    pyogrio.write_dataframe(layer, tmp_path / "edited.gpkg")
    code, _, err, _ = run("record", season, "edited.gpkg")
    assert (code, Season(season).history.inspections.result.tolist()) == (2, [0, 1])
    assert "2 inspections in edited.gpkg were exported from" in err
    words = shlex.split(err.split("corrections with: fieldmon ")[1].split(". Where")[0])
    assert words == ["correct", str(season), "edited.gpkg", "--who", "NAME"]
    code, out, err, _ = run(*words)
    assert (code, out.splitlines()[0]) == (0, "2 corrections taken, by NAME."), err
    assert Season(season).history.inspections.count.tolist() == [3, 5]
    code, out, err, _ = run("record", season, "edited.gpkg")
    assert (code, "0 new, 2 known" in out, "exported" in err) == (0, True, False), err
    assert "are given. Give one of them" in run(*words, "--inspection", 1, "--time", "07:00")[2]
    assert "is a season" in run("correct", season, season, "--who", "Ann")[2]
