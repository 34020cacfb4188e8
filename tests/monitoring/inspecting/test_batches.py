"""Everything recorded is a batch, and what is taken back is marked, never deleted."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.inspecting import batches, undone_batches
from fieldmon.monitoring.inspecting.batches import Batch
from fieldmon.plot.grid import plant_numbers


def recorded(db, rows, source="x", who="", kind="findings"):
    """Open a batch, add so many inspections or treatments to it, and close it."""
    number = batches.begin(db, kind, source, who)
    table = "inspections" if kind == "findings" else "treatments"
    for k in range(rows):
        db.execute(f"INSERT INTO {table} (batch, digest) VALUES (?, ?)", (number, f"{number} {k}"))  # noqa: S608
    batches.end(db, number, rows)
    return number


def test_batches_are_listed_with_the_last_one_first(db):
    first = recorded(db, 2, "monday.csv", "Ann")
    second = recorded(db, 1, "soap", kind="treatment")
    listed = batches.all_of(db)
    assert [batch.number for batch in listed] == [second, first]
    assert listed[1] == Batch(first, listed[1].at, "findings", "monday.csv", "Ann", 2, undone=False)
    assert listed[1].at.endswith("Z")


def test_a_batch_that_added_nothing_was_none(db):
    recorded(db, 0)
    assert batches.all_of(db) == ()


def test_a_batch_says_how_many_of_its_plants_were_found_and_of_which_days(season):
    results = Inspections.of(np.array([1, 2, 3]), np.array([0, 1, 1]), np.datetime64("2026-11-16"))
    several = season.record(results, "day.csv").batch
    one = season.record(
        Inspections.of(np.array([4]), np.array([2]), np.datetime64("2026-11-17")), "typed in"
    ).batch
    numbered = plant_numbers(season.plot.grid, np.array([4]))
    row, plant = int(numbered.line[0]), int(numbered.number[0])
    said = season.contents([several, one, 99])
    assert set(said) == {several, one}
    assert (said[several].n, said[several].found) == (3, 2)
    assert (said[several].first, said[several].last) == ("2026-11-16", "2026-11-16")
    assert (said[one].row, said[one].plant, said[one].result) == (row, plant, "skipped")
    undone = f"Undone: row {row}, plant {plant} on 2026-11-17 (skipped)."
    assert season.undo() == undone
    assert season.undo() == f"Batch {several} was undone: 3 inspections from day.csv."


def test_what_was_taken_back_of_a_batch_is_not_counted_unless_all_of_it_was(season):
    results = Inspections.of(np.array([1, 2, 3]), np.array([0, 1, 1]), np.datetime64("2026-11-16"))
    batch = season.record(results, "day.csv").batch
    with season.store.reading() as db:
        found = "SELECT max(fid) FROM inspections WHERE batch = ? AND result = 'found'"
        (one,) = db.execute(found, (batch,)).fetchone()
    season.undo(inspection=one)
    said = season.contents([batch])[batch]
    assert (said.n, said.found, said.counting) == (2, 1, 2)
    with pytest.raises(SettingError, match="both are given: batch 1 and inspection 1"):
        season.undo(1, 1)
    season.undo(batch)
    said = season.contents([batch])[batch]
    assert (said.n, said.found, said.counting) == (3, 2, 0)


def test_findings_are_added_to_batches_of_findings_that_count_and_to_no_others(db):
    counts, undone = recorded(db, 2), recorded(db, 1, "y")
    soap = recorded(db, 1, kind="treatment")
    undone_batches.undo(db, undone)
    batches.must_count(db, counts)
    for other in (undone, soap, soap + 1):
        with pytest.raises(SettingError, match=f"batch {other} does not"):
            batches.must_count(db, other)
