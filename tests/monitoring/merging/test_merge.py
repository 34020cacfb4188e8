"""Two copies of a season that went apart: all that is in either comes together, once each."""

from collections import Counter

import pytest

from fieldmon.compute.wording import Worded
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.inspecting import batches, inspection_table, undone_batches
from tests.monitoring.merging.copies import (
    PAIRS,
    apart,
    content,
    copied,
    held,
    merge,
    that_count,
    told_of,
)


def undone_by_phones(*both):
    """Return the digests of findings that were taken back from a phone."""
    undone = {one for db in both for (one,) in db.execute("SELECT undoes FROM tellings")}
    made = "SELECT t.id, digest FROM tellings t JOIN inspections i ON i.fid = t.inspection"
    return {mark for db in both for one, mark in db.execute(made) if one in undone}


@pytest.mark.parametrize("first", range(0, PAIRS, 20))
def test_merged_is_the_union_once_each_and_the_same_either_way(first):
    """500 pairs with FIELDMON_MERGES=500."""
    for seed in range(first, min(first + 20, PAIRS)):
        one, other = apart(seed)
        ours, theirs = copied(one), copied(other)
        done = merge(ours, other).merged
        assert done.new == len(that_count(ours) - that_count(one))
        assert done.taken_back == len(that_count(one) - that_count(ours))
        assert sum(n for _, n in done.of_new.by) == done.new
        assert all(isinstance(said, Worded) for said in done.contradictions)
        merge(theirs, one)
        for db, before in ((ours, one), (theirs, other)):
            assert season_log.differing(db) == ()
            assert told_of(db) == told_of(before)
        assert content(ours) == content(theirs)
        assert sorted(held(ours)) == sorted({*held(one), *held(other)})  # nothing lost, none twice
        taken_back = {row[:-1] for db in (one, other) for row in held(db, ", inspections.undone")
                      if row[-1]}  # fmt: skip
        by_phones = undone_by_phones(one, other)
        wanted = {row[0] for row in {*held(one), *held(other)} - taken_back}
        counting = [row[0] for row in held(ours, ", inspections.undone") if not row[-1]]
        assert len(counting) == len({*counting})
        assert {*counting} - by_phones == wanted - by_phones
        numbers = dict(ours.execute("SELECT fid, rows FROM batches").fetchall())
        rows = "SELECT batch, count(*) FROM inspections GROUP BY batch"
        assert numbers == dict(ours.execute(rows).fetchall())
        # a batch is undone if none of its rows counts any more
        undone = dict(ours.execute("SELECT fid, undone FROM batches").fetchall())
        rows = "SELECT batch, count(*) = sum(undone = 1) FROM inspections GROUP BY batch"
        assert undone == dict(ours.execute(rows).fetchall())
        again = copied(ours)
        assert merge(again, other).merged.contradictions == ()
        assert content(again) == content(ours)
        unchanged = copied(one)
        assert merge(unchanged, one).numbers == {}
        for db in (one, other, ours, theirs, again, unchanged):
            db.close()


def not_taken_back(db, brought):
    """Return photos of findings, as copies brought them, of which something was not taken back."""
    of_batch = "FROM inspections i JOIN batches b ON b.fid = batch"
    left = {*db.execute(f"SELECT digest, at {of_batch} WHERE i.undone <> 1")}
    return {photo for rows in brought for photo, *row in rows if tuple(row) in left}


def photos_shown(db):
    wanted = (
        "SELECT p.photo FROM photos p JOIN tellings t ON t.id = p.telling "
        "JOIN inspections i ON i.fid = t.inspection WHERE i.undone = 0"
    )
    return {photo for (photo,) in db.execute(wanted)}


def test_a_photo_is_shown_as_long_as_its_finding_counts_in_either_copy():
    of_both = 0
    told = (
        "SELECT p.photo, i.digest, b.at FROM photos p JOIN tellings t ON t.id = p.telling "
        "JOIN inspections i ON i.fid = t.inspection JOIN batches b ON b.fid = i.batch"
    )
    for seed in range(PAIRS):
        one, other = apart(seed)
        ours, theirs = copied(one), copied(other)
        merge(ours, other)
        merge(theirs, one)
        brought = [{*db.execute(told)} for db in (one, other)]
        wanted = not_taken_back(ours, brought)
        assert photos_shown(ours) == wanted
        assert photos_shown(theirs) == wanted
        each = [{row[0] for row in rows - others} for rows, others in (brought, brought[::-1])]
        of_both += len(each[0] & each[1] & wanted)
        # where somebody else had said the same in one copy, a finding has another digest there
        marks = {row[:2] for rows in brought for row in rows}
        twice = {photo for photo, n in Counter(photo for photo, _ in marks).items() if n > 1}
        for number in [one.number for one in batches.all_of(ours) if not one.undone][::2]:
            undone_batches.undo(ours, number)
            assert inspection_table.not_what_they_say(ours) == []
            assert photos_shown(ours) >= not_taken_back(ours, brought) - twice
        for db in (one, other, ours, theirs):
            db.close()
    assert of_both
