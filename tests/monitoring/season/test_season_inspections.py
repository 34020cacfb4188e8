"""What was found is recorded once, and can be taken back."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from fieldmon.errors import ContradictionError, ImportDoubt, ObservationError, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring.estimates.verifying import check_against_log
from tests.monitoring.seasons import BEGINS, clock_on, on, some_results


def test_the_same_results_twice_change_nothing(season):
    results = some_results(season, found=[1])
    first = season.record(results, "monday.csv", "Ann")
    before = season.path.read_bytes()
    again = season.record(results, "monday.csv", "Ann")
    assert (first.new, first.known) == (5, 0)
    assert (again.new, again.known, again.batch) == (0, 5, None)
    assert len(season.history.inspections) == 5
    assert len(season.batches()) == 1
    assert len(season.path.read_bytes()) == len(before)


def test_the_log_says_how_many_of_what_was_brought_were_new(season):
    counted = some_results(season, 5, found=[1])
    counted = replace(counted, count=np.where(counted.result == FOUND, 4.0, np.nan))
    season.record(counted, "monday.csv")
    plants = np.array([*counted.plant, 400, 401])
    result = np.array([*counted.result, FOUND, CLEAN], np.int8)
    count = np.array([*counted.count, 2.0, np.nan])
    again = Inspections.of(plants, result, np.datetime64(BEGINS, "D"), count=count)
    assert season.record(again, "copy.gpkg").new == 2
    seen = [entry.what for entry in season.log() if entry.kind == "seen"]
    assert [(one["found"], one["clean"]) for one in seen] == [(1, 4), (1, 1)]


def test_missing_texts_of_pandas_are_none_and_are_filled_in_like_them(season):
    frame = pd.DataFrame({"plant": [20, 21], "who": ["Ann", np.nan], "notes": [np.nan, "ok"]})
    for given in (frame, frame.assign(plant=[22, 23]).convert_dtypes()):
        told = Inspections.of(given.plant, [1, 0], BEGINS, who=given.who, notes=given.notes)
        season.record(told, who="Ben")
    with season.store.reading() as db:
        kept = db.execute("SELECT who, notes FROM inspections").fetchall()
    assert kept == [("Ann", ""), ("Ben", "ok")] * 2


def test_what_was_found_on_a_day_that_has_not_come_is_doubted_once(season, monkeypatch):
    clock_on(monkeypatch, 3)
    season.record(Inspections.of([2], [CLEAN], on(3)))
    later = Inspections.of([3, 4], [FOUND, CLEAN], [on(3), on(6)])
    for record, told in ((season.record, later), (season.record_instead, later.take([1]))):
        with pytest.warns(ImportDoubt, match=f"{on(6)} has not: it is {on(3)} on the") as said:
            record(told)
        assert [one.filename for one in said] == [__file__]
        season.record(told)  # it is known, and was doubted
        season.undo()
    clock_on(monkeypatch, -1)  # a season that has not begun is a rehearsal
    season.record(later)


def test_a_find_that_counts_0_is_refused(season):
    told = Inspections.of([5, 6], [CLEAN, FOUND], BEGINS, count=[0, 0])
    for record in (season.record, season.record_instead):
        with pytest.raises(ObservationError, match=r"result 2 counts 0\. Say clean"):
            record(told)


def test_what_was_not_inspected_stays_unknown(season):
    results = some_results(season)
    season.record(results, "half a day")
    states = season.history.states(0)
    assert (states[results.plant] == 0).all()
    assert (np.delete(states, results.plant) == -1).all()


def test_undoing_a_batch_gives_back_the_state_before_and_deletes_nothing(season):
    season.record(some_results(season), "first")
    before, plan_before = season.evening(BEGINS), season.plan(BEGINS, keep=False).route.plant
    season.record(some_results(season, found=[0, 2]), "second", "Ann")
    assert not np.array_equal(season.evening(BEGINS), before)
    assert "5 inspections from second" in season.undo()
    assert np.array_equal(season.evening(BEGINS), before)
    assert np.array_equal(season.plan(BEGINS, keep=False).route.plant, plan_before)
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM inspections").fetchone() == (10,)
    assert [batch.undone for batch in season.batches()] == [True, False]


def test_what_an_undo_leaves_is_what_all_days_worked_out_anew_come_to(season):
    def derived():
        with season.store.reading() as db:
            days = db.execute("SELECT day, inspected, found, expected_left, digest FROM days")
            states = db.execute("SELECT fid, chance, state, last_inspected FROM plant_state")
            return days.fetchall(), states.fetchall()

    for day in (0, 1, 3):
        season.record(some_results(season, 5, day, found=(2,)), f"day {day}")
    season.undo()
    left = derived()
    season.rebuild()
    assert derived() == left


def test_what_was_undone_can_be_recorded_again(season):
    results = some_results(season, found=[3])
    season.record(results, "x")
    season.undo()
    assert season.record(results, "x").new == 5


def test_one_inspection_can_be_undone(season):
    results = some_results(season, found=[0])
    season.record(results, "x")
    with season.store.reading() as db:
        (fid,) = db.execute("SELECT fid FROM inspections WHERE result = 'found'").fetchone()
    assert "found" in season.undo(inspection=fid)
    assert len(season.history.inspections) == 4
    assert season.status(BEGINS).found == 0


def test_there_must_be_something_to_undo(season):
    with pytest.raises(SettingError, match="nothing"):
        season.undo()
    with pytest.raises(SettingError, match="inspection 7"):
        season.undo(inspection=7)


@pytest.mark.parametrize(
    ("plant", "result", "day", "columns", "says"),
    [
        (99_999, 0, "2026-04-06", {}, "from another plot"),
        (-1, 0, "2026-04-06", {}, "from another plot"),
        (3, 7, "2026-04-06", {}, "2 .skipped., but that of inspection 1 of 1 is 7"),
        (3, 0, "NaT", {}, "must have a date"),
        (3, 0, "2026-04-05", {}, "began on 2026-04-06"),
        (3, 0, "2036-04-05", {}, "lasts"),
        (3, 0, "2026-04-06", {"count": np.array([-2.0])}, "0 or more"),
        (3, 0, "2026-04-06", {"second": np.array([90_000.0])}, "within its day"),
        (3, 0, "2026-04-06", {"count": np.array([1.0, 2.0])}, "must have 1 entries"),
    ],
)
def test_results_that_do_not_fit_are_a_sentence_and_leave_no_trace(
    season, plant, result, day, columns, says
):
    with pytest.raises((ObservationError, SettingError), match=says):
        season.record(
            Inspections.of(np.array([plant]), np.array([result]), np.datetime64(day), **columns),
            "x",
        )
    assert season.batches() == ()
    assert len(season.history.inspections) == 0


@pytest.mark.parametrize("results", [None, [1, 2], "day.csv"])
def test_what_are_no_inspections_is_refused_in_a_sentence(season, results):
    with pytest.raises(SettingError, match="must be Inspections, but it is"):
        season.record(results)


def test_several_files_are_recorded_all_or_none(season):
    good, more = some_results(season, 3), some_results(season, 3, day=1)
    elsewhere = Inspections.of([10**6], [CLEAN], np.datetime64(BEGINS, "D"))
    with pytest.raises(ObservationError, match="0 to"):
        season.record_all([(good, "a.csv"), (elsewhere, "b.csv")])
    assert not len(season.history.inspections)
    assert season.batches() == ()
    done = season.record_all([(good, "a.csv"), (more, "b.csv"), (good, "again.csv")], "Ann")
    assert [(one.new, one.known) for one in done] == [(3, 0), (3, 0), (0, 3)]
    assert [one.source for one in season.batches()] == ["b.csv", "a.csv"]
    assert check_against_log(season) == ()
    written = season.evening(BEGINS)
    season.rebuild()
    assert season.evening(BEGINS).tolist() == written.tolist()


def test_files_that_contradict_one_another_are_refused_together(season):
    found, clean = some_results(season, 3, found=[0]), some_results(season, 3)
    with pytest.raises(ContradictionError):
        season.record_all([(found, "a.csv"), (clean, "b.csv")])
    assert season.batches() == ()
