"""What both copies recorded counts once, and what one took back is taken back."""

import shutil
import sqlite3
from contextlib import closing

import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.inspecting import batches, undone_batches
from fieldmon.monitoring.merging.merge import merge_copies
from tests.monitoring.merging.copies import PAIRS, apart, copied, merge, result, that_count


def test_what_stood_back_for_something_undone_counts_again_and_merging_keeps_it_so():
    came_back = 0
    for seed in range(PAIRS):
        one, other = apart(seed)
        ours, theirs = copied(one), copied(other)
        merge(ours, other)
        merge(theirs, one)
        for number in [one.number for one in batches.all_of(ours) if not one.undone]:
            if number % 2 == seed % 2:
                continue
            own = {
                row[0]
                for row in ours.execute(
                    "SELECT digest FROM inspections WHERE batch = ? AND undone = 0", (number,)
                )
            }
            others = {
                row[0]
                for row in ours.execute(
                    "SELECT digest FROM inspections WHERE batch <> ? AND undone <> 1", (number,)
                )
            }
            before = {row[0] for row in that_count(ours)}
            undone_batches.undo(ours, number)
            assert {row[0] for row in that_count(ours)} == before - (own - others)
            came_back += len(own & others)
        merge_copies(theirs, ours)  # to whom nobody said so yet
        assert that_count(theirs) == that_count(ours)
        again = copied(ours)
        merge_copies(again, other)
        assert that_count(again) == that_count(ours)
        for db in (one, other, ours, theirs, again):
            db.close()
    assert came_back


def test_what_was_taken_back_and_recorded_again_at_once_counts_in_the_merged_season(path, other):
    season = Season(path)
    batch = season.record(result(30, CLEAN), "taps", "Ann").batch
    season.record(result(31, FOUND), "taps", "Ann", into=batch)
    with season.store.reading() as db:
        (found,) = db.execute("SELECT fid FROM inspections WHERE plant = 31").fetchone()
    there = Season(shutil.copy(path, other))  # knows the first of both
    season.undo(inspection=found)
    season.record(result(31, FOUND), "taps", "Ann", into=batch)
    done = season.merge(there)
    assert (done.new, done.taken_back) == (0, 0)
    there.merge(season)
    for one in (season, there):
        assert 31 in one.history.inspections.plant
        assert one.verify() == ()


def test_what_stands_back_here_and_was_taken_back_there_does_not_count_again(path, other):
    season = Season(path)
    there = Season(shutil.copy(path, other))
    ann, bob = (one.record(result(30, FOUND), "taps", who) for one, who in
                ((season, "Ann"), (there, "Bob")))  # fmt: skip
    season.merge(there)
    there.merge(season)
    there.undo(max(one.number for one in there.batches()))  # Bob's: it stands back for Ann's
    for first, second in ((season, there), (there, season)):
        first.merge(second)
    assert ann.new == bob.new == 1
    for one in (season, there):
        assert 30 in one.history.inspections.plant
        one.undo(max(batch.number for batch in one.batches() if not batch.undone))
        assert 30 not in one.history.inspections.plant, "what both took back counts again"


@pytest.mark.parametrize("way", ["ours", "theirs"])
def test_a_note_written_in_either_copy_is_kept(path, other, way):
    noted, bare = (path, other) if way == "ours" else (other, path)
    with closing(sqlite3.connect(noted)) as db:
        db.execute("UPDATE inspections SET notes = 'webs' WHERE fid = 4")
        db.commit()
    season = Season(path)
    season.merge(Season(other))
    assert season.history.inspections.notes.tolist().count("webs") == 1
    assert "webs" not in Season(bare).history.inspections.notes.tolist() or bare == path
