"""Everything recorded is a batch, and what is taken back is marked, never deleted."""

import pytest

from fieldmon.errors import SettingError
from fieldmon.monitoring import batches
from fieldmon.monitoring.batches import Batch


def recorded(db, rows, source="x", who="", kind="findings"):
    """Open a batch, add so many inspections or treatments to it, and close it."""
    number = batches.begin(db, kind, source, who)
    table = "inspections" if kind == "findings" else "treatments"
    for k in range(rows):
        db.execute(f"INSERT INTO {table} (batch, digest) VALUES (?, ?)", (number, f"{number} {k}"))  # noqa: S608
    batches.end(db, number, rows)
    return number


def counting(db, table="inspections"):
    return db.execute(f"SELECT count(*) FROM {table} WHERE undone = 0").fetchone()[0]  # noqa: S608


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


def test_the_last_batch_that_counts_is_undone_and_its_rows_stay(db):
    recorded(db, 2, "first")
    recorded(db, 3, "second")
    assert batches.undo(db, None)[1] == "Batch 2 was undone: 3 findings from second."
    assert batches.undo(db, None)[1] == "Batch 1 was undone: 2 findings from first."
    assert counting(db) == 0
    assert db.execute("SELECT count(*) FROM inspections").fetchone() == (5,)
    with pytest.raises(SettingError, match="something to undo, but there is nothing"):
        batches.undo(db, None)


def test_any_batch_is_undone_by_its_number_but_once(db):
    recorded(db, 2, "first")
    recorded(db, 1, "soap", kind="treatment")
    assert "Batch 1 was undone" in batches.undo(db, 1)[1]
    assert (counting(db), counting(db, "treatments")) == (0, 1)
    with pytest.raises(SettingError, match="called batch 1 that still counts"):
        batches.undo(db, 1)


def test_undoing_the_inspections_of_a_batch_one_by_one_undoes_the_batch(db):
    recorded(db, 2)
    batches.undo_one(db, 1)
    assert [batch.undone for batch in batches.all_of(db)] == [False]
    batches.undo_one(db, 2)
    assert [batch.undone for batch in batches.all_of(db)] == [True]
    with pytest.raises(SettingError, match="inspection 2 that still counts"):
        batches.undo_one(db, 2)


def test_findings_are_added_to_batches_of_findings_that_count_and_to_no_others(db):
    counts, undone = recorded(db, 2), recorded(db, 1, "y")
    soap = recorded(db, 1, kind="treatment")
    batches.undo(db, undone)
    batches.must_count(db, counts)
    for other in (undone, soap, soap + 1):
        with pytest.raises(SettingError, match=f"batch {other} does not"):
            batches.must_count(db, other)
