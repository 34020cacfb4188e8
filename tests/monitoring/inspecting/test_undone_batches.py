"""What was recorded is taken back without being lost, and counts again."""

import sqlite3
from contextlib import closing
from datetime import time, timedelta

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.inspecting import batches, undone_batches
from fieldmon.monitoring.season.undoing import undo_with_batches
from fieldmon.plot.grid import plant_numbers
from tests.monitoring.inspecting.test_batches import recorded
from tests.monitoring.seasons import BEGINS, a_plot_with_named_rows, a_season


def counting(db, table="inspections"):
    return db.execute(f"SELECT count(*) FROM {table} WHERE undone = 0").fetchone()[0]  # noqa: S608


def test_the_last_batch_that_counts_is_undone_and_its_rows_stay(db):
    recorded(db, 2, "first")
    recorded(db, 3, "second")
    assert undone_batches.undo(db, None)[1] == "Batch 2 was undone: 3 inspections from second."
    assert undone_batches.undo(db, None)[1] == "Batch 1 was undone: 2 inspections from first."
    assert counting(db) == 0
    assert db.execute("SELECT count(*) FROM inspections").fetchone() == (5,)
    with pytest.raises(SettingError, match="something to undo, but there is nothing"):
        undone_batches.undo(db, None)


def test_what_was_undone_calls_a_row_by_the_name_that_says_more_than_its_number(tmp_path):
    season = a_season(tmp_path / "s.gpkg", a_plot_with_named_rows())
    numbered = plant_numbers(season.plot.grid, np.arange(80))
    for line in (101, 102):
        here = np.flatnonzero((numbered.line == line) & (numbered.number == 2))
        one = here, np.array([FOUND]), np.datetime64("2026-11-17")
        season.record(Inspections.of(*one), "typed in")
    assert season.undo() == "Undone: row 102 · Top, plant 2 on 2026-11-17 (found)."
    said = season.undo(inspection=1)
    assert said == "Undone: row 101 · 5A, plant 2 on 2026-11-17 (found)."


def test_any_batch_is_undone_by_its_number_but_once(db):
    recorded(db, 2, "first")
    recorded(db, 1, "soap", kind="treatment")
    assert "Batch 1 was undone" in undone_batches.undo(db, 1)[1]
    assert (counting(db), counting(db, "treatments")) == (0, 1)
    with pytest.raises(SettingError, match="called batch 1 that still counts"):
        undone_batches.undo(db, 1)


def test_undoing_the_inspections_of_a_batch_one_by_one_undoes_the_batch(db):
    recorded(db, 2)
    undone_batches.undo_one(db, 1)
    assert [batch.undone for batch in batches.all_of(db)] == [False]
    undone_batches.undo_one(db, 2)
    assert [batch.undone for batch in batches.all_of(db)] == [True]
    with pytest.raises(SettingError, match="inspection 2 that still counts"):
        undone_batches.undo_one(db, 2)


def test_what_was_taken_back_alone_stays_so_when_its_batch_counts_again(season):
    plants, on = np.array([1, 2, 3]), np.datetime64(BEGINS)
    batch = season.record(Inspections.of(plants, np.array([0, 1, 1]), on), "day.csv").batch
    with season.store.reading() as db:
        wanted = "SELECT fid FROM inspections WHERE batch = ? AND plant = 2"
        (one,) = db.execute(wanted, (batch,)).fetchone()
    season.undo(inspection=one)
    before = season.history.states(0).copy()
    season.undo(batch)
    other = season.record(Inspections.of(plants[2:], np.array([1]), on), "again.csv").batch
    said = f"Batch {batch} counts again: 1 inspection. 1 more counts in another batch already."
    assert season.redo(batch) == said
    assert np.array_equal(season.history.states(0), before)
    assert len(season.history.inspections.on(BEGINS)) == 2, "the same result counts once"
    season.undo(other)
    assert np.array_equal(season.history.states(0), before)


def test_a_treatment_that_was_undone_counts_again(season):
    season.treat(BEGINS, 0.5, plants=np.arange(438) < 20)
    batch = season.batches()[0].number
    season.undo(batch)
    assert not season.treatments()
    assert season.redo(batch) == f"Batch {batch} counts again: 1 treatment."
    assert len(season.treatments()) == 1


def test_what_counts_in_another_batch_is_not_said_to_count_again(season):
    seen = Inspections.of(np.arange(3), np.array([0, 1, 1]), np.datetime64(BEGINS))
    treated = np.arange(438) < 20
    for add in (
        lambda: season.record(seen, "day.csv").batch,
        lambda: season.record(seen.take(slice(1)), "tap").batch,
        lambda: season.treat(BEGINS, 0.5, plants=treated).batch,
    ):
        one, other = (undone(season, add()) for _ in range(2))
        season.redo(one)
        said = season.redo(other)
        assert said == f"Nothing of batch {other} counts again: it counts in another already."
        season.undo(one)
        season.undo(other)


def undone(season, batch):
    """Take a batch back, and return its number."""
    season.undo(batch)
    return batch


def all_of(season):
    """Return every inspection and correction of a season, as they stand in its file."""
    with season.store.reading() as db:
        return [
            db.execute(f"SELECT * FROM {table} ORDER BY fid").fetchall()  # noqa: S608 - ours
            for table in ("inspections", "outside_changes", "batches")
        ]


def seen(plants, results, **more):
    return Inspections.of(np.array(plants), np.array(results), np.datetime64(BEGINS), **more)


def corrected_outside(season):
    with closing(sqlite3.connect(season.path)) as db:
        db.execute("UPDATE inspections SET result = 'found', notes = 'mites' WHERE plant = 1")
        db.execute("UPDATE inspections SET who = 'Eve' WHERE fid = 2")
        db.execute("DELETE FROM inspections WHERE plant = 3")
        db.commit()
    season.correct("Ann")


CORRECTIONS = {
    "time": lambda season: season.correct_time(2, time(6), "Ann"),
    "day": lambda season: season.correct_time(2, time(6), "Ann", BEGINS + timedelta(days=1)),
    "instead": lambda season: season.record_instead(seen([1, 2], [FOUND, FOUND]), "me", "Ann"),
    "outside": corrected_outside,
}


@pytest.mark.parametrize("correct", CORRECTIONS.values(), ids=CORRECTIONS)
def test_corrections_that_were_undone_count_again_as_they_did(season, correct):
    season.record(seen([1, 2, 3], [0, 0, 1], second=[100.0, np.nan, 300.0]), "day.csv", "Bo")
    season.record(seen([2], [0], notes=np.array(["webs"], object)), "more.csv", "Cy")
    correct(season)
    batch, after = season.batches()[0].number, all_of(season)
    for _ in range(2):
        done = undo_with_batches(season)
        assert done.batch == batch
        assert all_of(season) != after
        assert f"Batch {batch} counts again: " in season.redo(batch)
        assert all_of(season) == after
    assert Season(season.path).verify() == ()
    assert check_against_log(season) == ()


def test_a_correction_that_was_corrected_itself_counts_again_below_that(season):
    season.record(seen([1], [0], second=[100.0]), "day.csv")
    for hour in (6, 7):
        season.correct_time(1, time(hour), "Ann")
    last, first = (one.number for one in season.batches()[:2])
    after = all_of(season)
    season.undo(first)
    assert season.history.inspections.second.tolist() == [7 * 3600]
    season.redo(first)
    assert season.history.inspections.second.tolist() == [7 * 3600]
    season.undo(last)
    assert season.history.inspections.second.tolist() == [6 * 3600]
    season.redo(last)
    assert all_of(season) == after
    for number in (last, first):
        season.undo(number)
    with pytest.raises(SettingError, match=f"batch {first} was undone. Let that count again first"):
        season.redo(last)
    season.redo(first)
    season.redo(last)
    assert all_of(season) == after
    assert season.verify() == ()


@pytest.mark.parametrize(
    "since", [lambda season: season.correct_time(1, time(9), "Bo"), lambda season: season.undo(1)]
)
def test_corrections_do_not_count_again_over_what_was_done_since(season, since):
    season.record(seen([1, 2], [0, 0], second=[100.0, 200.0]), "day.csv")
    season.correct_time(1, time(8), "Ann")
    season.undo()
    since(season)
    before = all_of(season)
    with pytest.raises(SettingError, match="What batch 2 corrected must"):
        season.redo(2)
    assert all_of(season) == before
    assert season.verify() == ()


def test_of_corrections_one_that_was_taken_back_alone_stays_so(season):
    season.record(seen([1, 2], [0, 0]), "day.csv")
    season.record_instead(seen([1, 2], [FOUND, FOUND]), "me")
    batch = season.batches()[0].number
    season.undo(inspection=1)
    after = all_of(season)
    season.undo(batch)
    season.redo(batch)
    assert season.history.states(0)[[1, 2]].tolist() == [0, 1]
    assert all_of(season) == after
