"""Batches of two copies: numbers in the log lead to them, however often they are merged."""

import random
from datetime import timedelta
from unittest import mock

import numpy as np
import pytest

from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes import logged_days, season_log
from fieldmon.monitoring.merging import merged_batches
from fieldmon.plot import local_clock
from tests.monitoring.merging.copies import (
    PAIRS,
    WHO,
    Clock,
    apart,
    copies_of,
    merge,
    record,
    result,
    store,
    told_of,
)
from tests.monitoring.seasons import BEGINS


def as_earlier_versions_did(monkeypatch):
    """Let merges number all batches anew, from 1, and note nothing of it."""
    numbered, noted = merged_batches.of_both, season_log.append

    def from_one(copies):
        merged = numbered(copies).items()
        return {key: {**row, "fid": number} for number, (key, row) in enumerate(merged, 1)}

    def nothing_noted(db, kind, who="", **said):
        noted(db, kind, who, **{name: told for name, told in said.items() if name != "numbers"})

    monkeypatch.setattr(merged_batches, "of_both", from_one)
    monkeypatch.setattr(season_log, "append", nothing_noted)


@pytest.mark.parametrize("earlier", [False, True])
def test_numbers_in_the_log_lead_to_the_same_batches_after_any_number_of_merges(
    monkeypatch, earlier
):
    moved, found, not_found = 0, 0, 0
    for seed in range(PAIRS // 2):
        both = apart(seed)
        rng = random.Random(seed)
        told = told_of(both[0]) | told_of(both[1])
        with mock.patch.object(local_clock, "datetime", Clock), monkeypatch.context() as as_then:
            if earlier:
                as_earlier_versions_did(as_then)
            for _ in range(4):
                db, other = rng.sample(both, 2)
                merge(db, other)
                for one, who in zip(both, WHO, strict=True):
                    assert season_log.differing(one) == ()
                    for digest, batch in told_of(one).items():
                        assert batch == told[digest] or (earlier and batch is None)
                        found, not_found = found + (batch is not None), not_found + (batch is None)
                    Clock.shows += timedelta(microseconds=50)
                    record(one, rng, who)
                    told = told_of(one) | told
        moved += any(entry.numbers for one in both for entry in season_log.entries(one))
        for one in both:
            one.close()
    assert moved
    assert not_found <= earlier * found / 10


def test_a_batch_that_was_gone_before_an_earlier_version_merged_is_missed(monkeypatch):
    one, other = copies_of(2)
    on = np.datetime64(BEGINS)
    for db, plants in ((one, (1, 2, 3)), (other, (7,))):
        for plant in plants:
            store(db, Inspections.of(np.array([plant]), np.array([FOUND]), on), "Ann")
    one.execute("DELETE FROM inspections WHERE batch = 2")
    one.execute("DELETE FROM batches WHERE fid = 2")
    as_earlier_versions_did(monkeypatch)
    merge(one, other)
    (said,) = season_log.differing(one)
    assert said.startswith("The batch 2 that entry 3 (")


def test_batches_that_get_another_number_are_said_to(path, other):
    theirs, ours = Season(other), Season(path)
    theirs.record(result(9, FOUND), "theirs", "Ben")
    ours.record(result(3, FOUND), "ours", "Ann")
    number = {one.source: one.number for one in ours.batches()}["ours"]
    assert ours.log()[-1].what["batch"] == number
    done = ours.merge(theirs)
    moved = {one.source: one.number for one in ours.batches()}["ours"] != number
    assert moved
    assert done.moved
    assert ours.log()[-1].sentence().endswith("; batches were numbered anew")
    assert not ours.merge(theirs).moved
    again = theirs.merge(ours)
    assert not again.moved
    assert not theirs.log()[-1].sentence().endswith("anew")


def test_what_was_recorded_twice_uses_no_number_up(path):
    season = Season(path)
    first = season.record(result(3, FOUND)).batch
    assert season.record(result(3, FOUND)).batch is None
    assert season.record(result(4, FOUND)).batch == first + 1


def test_a_batch_is_undone_by_the_number_that_the_log_shows(path, other):
    theirs, ours = Season(other), Season(path)
    theirs.record(result(9, FOUND, day=2), "theirs", "Ben")
    old = ours.record(result([3, 4], [FOUND, FOUND], day=3), "ours", "Ann").batch
    ours.undo(old)
    new = ours.record(result(5, FOUND, day=3), "again", "Ann").batch
    ours.merge(theirs)
    seen, undone, again = (entry.sentence() for entry in ours.log()[-4:-1])
    assert seen.endswith(f"batch {old}; batch {old} is batch {old + 1} now")
    assert undone.startswith(f"Batch {old} was undone")
    assert undone.endswith(f"; batch {old} is batch {old + 1} now")
    assert again.endswith(f"batch {new}; batch {new} is batch {new + 1} now")
    with ours.store.reading() as db:  # what was undone was not worked
        told = logged_days.planned_and_seen(db, BEGINS + timedelta(days=3))
    assert [one.at for one in told] == [ours.log()[-2].at]
    ours.undo(new + 1)
    assert ours.history.inspections.plant.tolist().count(5) == 0
    assert ours.verify() == ()
