"""Inspections of two copies: those that both begin with stay if they come out as they are."""

import random
import sqlite3

import pytest

from fieldmon.monitoring.file import schema
from fieldmon.monitoring.merging import merged_inspections
from fieldmon.monitoring.merging.merge import merge_copies
from tests.monitoring.merging.copies import PAIRS, apart, content, copied, held, record


def test_what_both_copies_hold_stays_untouched_and_nothing_comes_out_otherwise(monkeypatch):
    """As if every row were written anew, which only the rows after the common ones are."""
    stayed = 0
    for seed in range(PAIRS):
        one, other = apart(seed)
        whole = copied(one)
        counted = "SELECT value FROM fieldmon WHERE key = ?"
        before = one.execute(counted, (schema.INSPECTIONS_CHANGED,)).fetchone()
        if content(one) == content(other) and merge_copies(one, other).merged.contradictions == ():
            after = one.execute(counted, (schema.INSPECTIONS_CHANGED,)).fetchone()
            stayed += held(one) != [] and before == after
        else:
            merge_copies(one, other)
        with monkeypatch.context() as anew:
            anew.setattr(merged_inspections, "n_staying", lambda *_: 0)
            merge_copies(whole, other)
        assert content(one) == content(whole)
        for db in (one, other, whole):
            db.close()
    assert stayed


@pytest.mark.parametrize("change", [
    "UPDATE inspections SET notes = NULL WHERE fid = 2",  # comes out as an empty text
    "UPDATE inspections SET batch = 9 WHERE fid = 2",
    "UPDATE inspections SET undone = 1 WHERE fid = 2",
    "INSERT INTO inspections (fid, undone, {0}) SELECT 9, 0, {0} FROM inspections WHERE fid = 2",
    "UPDATE inspections SET detects = 0.25 WHERE fid = 2",
    "UPDATE inspections SET fid = 9 WHERE fid = 2",
    "UPDATE inspections SET digest = NULL WHERE fid = 2",
    "UPDATE batches SET fid = 5 WHERE fid = 1",
])  # fmt: skip
@pytest.mark.parametrize("where", ["one", "both"])
def test_rows_that_come_out_otherwise_do_not_stay(monkeypatch, change, where):
    one, other = (sqlite3.connect(":memory:", isolation_level=None) for _ in range(2))
    schema.lay_out(one)
    for clock in range(3):
        record(one, random.Random(clock), "Ann")
    if "INSERT" in change:
        one.execute("UPDATE inspections SET undone = 1 WHERE fid = 2")
    one.backup(other)
    names = ", ".join(name for name in schema.INSPECTIONS.names if name != "undone")
    for db in (one,) if where == "one" else (one, other):
        db.execute(change.format(names))
    whole = copied(one)
    merge_copies(one, other)
    monkeypatch.setattr(merged_inspections, "n_staying", lambda *_: 0)
    merge_copies(whole, other)
    assert content(one) == content(whole)
    for db in (one, other, whole):
        db.close()


@pytest.mark.parametrize("seed", range(20))
def test_a_batch_is_the_same_in_both_copies_where_each_of_its_rows_is(seed):
    rng, said = random.Random(seed), (None, "", "a", ",", "a,", ",a", "a,a")
    told = (None, None, 0.3, 0.84)
    both = [sqlite3.connect(":memory:", isolation_level=None) for _ in range(2)]
    for db in both:
        schema.lay_out(db)
    answers = []
    for batch in range(1, 60):
        n = rng.randrange(1, 4)
        rows = [[rng.choice(said[-6:]) + str(k), 1, *rng.choices(said, k=2), rng.choice(told)]
                for k in range(n)]  # fmt: skip
        others = [[*row] for row in rows]
        if rng.random() < 0.6:
            at = rng.randrange(5)
            rng.choice(others)[at] = rng.choice(told if at == 4 else said)
        for db, written in zip(both, (rows, others), strict=True):
            into = "INSERT INTO inspections (batch, digest, undone, who, notes, detects)"
            db.executemany(f"{into} VALUES ({batch}, ?, ?, ?, ?, ?)", written)
        alike = rows == others and not any(None in row[:4] for row in rows)
        answers.append(alike)
        assert merged_inspections.is_same_batch(both, batch, n) == alike
    assert {*answers} == {True, False}
    for db in both:
        db.close()


def test_a_batch_in_which_something_stands_twice_is_no_batch_that_stays():
    db = sqlite3.connect(":memory:", isolation_level=None)
    schema.lay_out(db)
    into = "INSERT INTO inspections (batch, digest, undone, who, notes)"
    db.executemany(f"{into} VALUES (1, ?, ?, 'Ann', '')", [("a", 1), ("a", 0)])
    assert not merged_inspections.is_same_batch((db, db), 1, 2)
    db.close()
