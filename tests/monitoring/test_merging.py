"""Two copies of a season that went apart: all that is in either comes together, once each."""

import os
import random
import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season, batches, inspection_table, merging, phone_tables, schema
from fieldmon.monitoring.day_ahead import WHOLE, DayAhead
from fieldmon.monitoring.settings import MonitoringSettings
from fieldmon.plot.grid import row_label
from tests.monitoring.seasons import BEGINS, a_plot, a_season, state

PAIRS = int(os.environ.get("FIELDMON_MERGES", "40"))
GRID = a_plot().grid
LABEL = row_label(GRID)
SETTINGS = MonitoringSettings(BEGINS)


def record(db, rng, who, clock):
    """Record a few results, some of them twice, as a person does; sometimes take something back."""
    n = rng.randrange(1, 5)
    plant = np.array([rng.randrange(12) for _ in range(n)])
    result = np.array([rng.choice((CLEAN, FOUND)) for _ in range(n)])
    on = np.datetime64(BEGINS) + rng.randrange(3)
    batch = batches.begin(db, "findings", f"file {clock}", who)
    db.execute("UPDATE batches SET at = ? WHERE fid = ?", (f"2026-04-06T{clock:06d}", batch))
    found = Inspections.of(plant, result, on)
    rows = inspection_table.rows(found, GRID, LABEL, SETTINGS, (batch, who))
    batches.end(db, batch, int(inspection_table.store(db, rows).sum()))
    counting = [fid for (fid,) in db.execute("SELECT fid FROM inspections WHERE undone = 0")]
    if counting and rng.random() < 0.3:
        batches.undo_one(db, rng.choice(counting))


def apart(seed):
    """Return two copies of a season, in memory, in which different people went on."""
    rng = random.Random(seed)
    one, other = (sqlite3.connect(":memory:", isolation_level=None) for _ in range(2))
    schema.lay_out(one)
    clock = iter(range(10**6))
    for _ in range(rng.randrange(4)):
        record(one, rng, "Ann", next(clock))
    one.backup(other)
    for _ in range(rng.randrange(6)):
        db, who = rng.choice(((one, "Ann"), (other, "Ben")))
        record(db, rng, who, next(clock))
    return one, other


COLUMNS = "digest, plant, date, result, inspections.who, batches.at"


def held(db, more=""):
    """Return all rows, each with the batch it came with."""
    joined = f"SELECT {COLUMNS}{more} FROM inspections JOIN batches ON batches.fid = batch"  # noqa: S608
    return db.execute(joined).fetchall()


def content(db):
    """Return all that is in a file, in its order."""
    return {table.name: db.execute(f"SELECT * FROM {table.name} ORDER BY fid").fetchall()  # noqa: S608
            for table in merging.TAKEN}  # fmt: skip


def that_count(db):
    """Return what is recorded and not taken back."""
    counts = "SELECT digest FROM inspections WHERE undone = 0 AND digest IS NOT NULL"
    return {*db.execute(counts)}


def copied(db):
    """Return a copy to merge into."""
    copy = sqlite3.connect(":memory:", isolation_level=None)
    db.backup(copy)
    return copy


@pytest.mark.parametrize("first", range(0, PAIRS, 20))
def test_merged_is_the_union_once_each_and_the_same_either_way(first):
    """500 pairs with FIELDMON_MERGES=500."""
    for seed in range(first, min(first + 20, PAIRS)):
        one, other = apart(seed)
        ours, theirs = copied(one), copied(other)
        new, gone, *_ = merging.merge(ours, other)
        assert new == len(that_count(ours) - that_count(one))
        assert gone == len(that_count(one) - that_count(ours))
        merging.merge(theirs, one)
        assert content(ours) == content(theirs)
        assert sorted(held(ours)) == sorted({*held(one), *held(other)})  # nothing lost, none twice
        taken_back = {row[:-1] for db in (one, other) for row in held(db, ", inspections.undone")
                      if row[-1]}  # fmt: skip
        wanted = {row[0] for row in {*held(one), *held(other)} - taken_back}
        counting = [row[0] for row in held(ours, ", inspections.undone") if not row[-1]]
        assert sorted(counting) == sorted(wanted)
        numbers = dict(ours.execute("SELECT fid, rows FROM batches").fetchall())
        rows = "SELECT batch, count(*) FROM inspections GROUP BY batch"
        assert numbers == dict(ours.execute(rows).fetchall())
        # a batch is undone if none of its rows counts any more
        undone = dict(ours.execute("SELECT fid, undone FROM batches").fetchall())
        rows = "SELECT batch, count(*) = sum(undone = 1) FROM inspections GROUP BY batch"
        assert undone == dict(ours.execute(rows).fetchall())
        again = copied(ours)
        merging.merge(again, other)
        assert content(again) == content(ours)
        for db in (one, other, ours, theirs, again):
            db.close()


def test_what_stood_back_for_something_undone_counts_again_and_merging_keeps_it_so():
    came_back = 0
    for seed in range(PAIRS):
        one, other = apart(seed)
        ours, theirs = copied(one), copied(other)
        merging.merge(ours, other)
        merging.merge(theirs, one)
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
            batches.undo(ours, number)
            assert {row[0] for row in that_count(ours)} == before - (own - others)
            came_back += len(own & others)
        merging.merge(theirs, ours)  # to whom nobody said so yet
        assert that_count(theirs) == that_count(ours)
        again = copied(ours)
        merging.merge(again, other)
        assert that_count(again) == that_count(ours)
        for db in (one, other, ours, theirs, again):
            db.close()
    assert came_back


def test_what_both_copies_hold_stays_untouched_and_nothing_comes_out_otherwise(monkeypatch):
    """As if every row were written anew, which only the rows after the common ones are."""
    stayed = 0
    for seed in range(PAIRS):
        one, other = apart(seed)
        whole = copied(one)
        counted = "SELECT value FROM fieldmon WHERE key = ?"
        before = one.execute(counted, (schema.INSPECTIONS_CHANGED,)).fetchone()
        if content(one) == content(other) and merging.merge(one, other).settings == ():
            after = one.execute(counted, (schema.INSPECTIONS_CHANGED,)).fetchone()
            stayed += held(one) != [] and before == after
        else:
            merging.merge(one, other)
        with monkeypatch.context() as anew:
            anew.setattr(merging, "_n_staying", lambda *_: 0)
            merging.merge(whole, other)
        assert content(one) == content(whole)
        for db in (one, other, whole):
            db.close()
    assert stayed


@pytest.mark.parametrize("change", [
    "UPDATE inspections SET notes = NULL WHERE fid = 2",  # comes out as an empty text
    "UPDATE inspections SET batch = 9 WHERE fid = 2",
    "UPDATE inspections SET undone = 1 WHERE fid = 2",
    "INSERT INTO inspections SELECT 9, {names}, 0 FROM inspections WHERE fid = 2",
    "UPDATE inspections SET fid = 9 WHERE fid = 2",
    "UPDATE inspections SET digest = NULL WHERE fid = 2",
    "UPDATE batches SET fid = 5 WHERE fid = 1",
])  # fmt: skip
@pytest.mark.parametrize("where", ["one", "both"])
def test_rows_that_come_out_otherwise_do_not_stay(monkeypatch, change, where):
    one, other = (sqlite3.connect(":memory:", isolation_level=None) for _ in range(2))
    schema.lay_out(one)
    for clock in range(3):
        record(one, random.Random(clock), "Ann", clock)
    if "INSERT" in change:
        one.execute("UPDATE inspections SET undone = 1 WHERE fid = 2")
    one.backup(other)
    names = ", ".join(schema.INSPECTIONS.names[:-1])
    for db in (one,) if where == "one" else (one, other):
        db.execute(change.format(names=names))
    whole = copied(one)
    merging.merge(one, other)
    monkeypatch.setattr(merging, "_n_staying", lambda *_: 0)
    merging.merge(whole, other)
    assert content(one) == content(whole)
    for db in (one, other, whole):
        db.close()


@pytest.mark.parametrize("seed", range(20))
def test_a_batch_is_the_same_in_both_copies_where_each_of_its_rows_is(seed):
    rng, said = random.Random(seed), (None, "", "a", ",", "a,", ",a", "a,a")
    both = [sqlite3.connect(":memory:", isolation_level=None) for _ in range(2)]
    for db in both:
        schema.lay_out(db)
    answers = []
    for batch in range(1, 60):
        n = rng.randrange(1, 4)
        rows = [[rng.choice(said[-6:]) + str(k), 1, *rng.choices(said, k=2)] for k in range(n)]
        others = [[*row] for row in rows]
        if rng.random() < 0.6:
            rng.choice(others)[rng.randrange(4)] = rng.choice(said)
        for db, written in zip(both, (rows, others), strict=True):
            into = "INSERT INTO inspections (batch, digest, undone, who, notes)"
            db.executemany(f"{into} VALUES ({batch}, ?, ?, ?, ?)", written)
        alike = rows == others and not any(None in row for row in rows)
        answers.append(alike)
        assert merging._same(both, batch, n) == alike
    assert {*answers} == {True, False}
    for db in both:
        db.close()


def test_a_batch_in_which_something_stands_twice_is_no_batch_that_stays():
    db = sqlite3.connect(":memory:", isolation_level=None)
    schema.lay_out(db)
    into = "INSERT INTO inspections (batch, digest, undone, who, notes)"
    db.executemany(f"{into} VALUES (1, ?, ?, 'Ann', '')", [("a", 1), ("a", 0)])
    assert not merging._same((db, db), 1, 2)
    db.close()


def test_every_table_of_a_season_is_merged_or_must_be_the_same_or_follows_from_them():
    follows = {schema.META, schema.DAYS, schema.PLANT_STATE, schema.HOT_SPOTS, schema.LEARNT}
    follows |= {schema.MORNINGS, schema.INSPECTION_LOTS}
    # what stays ours and is told of the other's
    logged = {schema.LOG}
    merged = {*merging.SAME, *merging.TAKEN, *logged, *phone_tables.TABLES}
    assert merged | follows == set(schema.TABLES)


@pytest.fixture
def other(path, tmp_path):
    return shutil.copy(path, tmp_path / "other.gpkg")


def result(plant, what, day=1, **columns):
    on = np.datetime64(BEGINS) + day
    return Inspections.of(np.array([plant]), np.array([what]), on, **columns)


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


def test_what_is_new_and_what_was_taken_back_are_counted_apart(path, other):
    counted = len(Season(path).history.inspections)
    theirs = Season(other)
    theirs.undo()
    gone = counted - len(theirs.history.inspections)
    theirs.record(result(9, FOUND), "taps", "Ben")
    season = Season(path)
    done = season.merge(theirs)
    assert gone > 1
    assert (done.new, done.taken_back) == (1, gone)
    assert season.log()[-1].what["new"] == 1
    again = season.merge(theirs)
    assert (again.new, again.taken_back) == (0, 0)


def test_two_people_who_worked_apart_find_both_days_in_one_season(path, other):
    Season(path).record(result(3, FOUND), "taps", "Ann")
    Season(other).record(result(9, FOUND), "taps", "Ben")
    Season(other).treat(BEGINS, 0.5)
    Season(other).plan(BEGINS)
    before = other.read_bytes()
    season = Season(path)
    done = season.merge(Season(other))
    assert (done.new, done.contradictions) == (1, ())
    assert other.read_bytes() == before
    assert state(path) == 14
    assert len(season.history.treatments) == 1
    assert [batch.who for batch in season.batches()] == ["", "Ben", "Ann", "Ann"]
    again = Season(other)
    again.merge(Season(path))
    np.testing.assert_array_equal(season.evening(BEGINS), again.evening(BEGINS))
    np.testing.assert_array_equal(season.kept_route(BEGINS), again.kept_route(BEGINS))


def test_what_the_copies_tell_differently_is_listed_and_both_are_kept(path, other):
    season, there = Season(path), Season(other)
    season.record(result(3, FOUND), "taps")
    there.record(result(3, CLEAN), "taps")
    there.change(MonitoringSettings(**(vars(there.settings) | {"seed": 7})), there.settings)
    done = season.merge(Season(other))
    assert "recorded as found, now clean" in done.contradictions[0]
    (said,) = (said for said in done.contradictions if "The setting season differs" in said)
    assert said.endswith("seed 1 here, seed 7 there. What was chosen last counts: seed 7.")
    assert season.settings.seed == 7
    assert sorted(season.history.on(1).result.tolist()) == [CLEAN, FOUND]


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


def test_routes_planned_in_both_copies_keep_their_order_and_the_last_one_counts(path, other):
    for file, plant in ((path, 40), (path, 41), (other, 50)):
        season = Season(file)
        season.record(Inspections.of(np.array([plant]), np.array([CLEAN]), np.datetime64(BEGINS)))
        season.plan(BEGINS)
    last = season.kept_route(BEGINS)
    plan = DayAhead.of(season, BEGINS).plan_of(WHOLE)
    merged, again = Season(path), Season(other)
    merged.merge(Season(other))
    again.merge(Season(path))
    with merged.store.reading() as db:
        routes = db.execute("SELECT day, revision, fid, stops FROM routes ORDER BY fid").fetchall()
        stops = dict(db.execute("SELECT route, count(*) FROM stops GROUP BY route").fetchall())
    assert [row[1] for row in routes] == [1, 2, 3, 4]  # of before, and of each copy
    assert all(stops[fid] == n for _, _, fid, n in routes)
    for one in (merged, again):
        np.testing.assert_array_equal(one.kept_route(BEGINS), last)
        assert DayAhead.of(one, BEGINS).plan_of(WHOLE) == plan  # a phone goes on by it


def test_a_copy_that_brings_nothing_leaves_the_routes_of_a_day_as_they_are(path, tmp_path):
    season = Season(path)
    first, on = season.settings, BEGINS + timedelta(days=4)
    for hours in (0.5, 1.0, 0.5):  # the first route is given out again after another
        before = season.settings
        season.change(replace(first, robot=first.robot.with_hours(hours)), before)
        season.plan(on)
    season.plan_crew(BEGINS, ("Ann",))  # after routes of a later day
    wanted = "SELECT fid, day, who, revision, digest FROM routes ORDER BY fid"
    with season.store.reading() as db:
        routes = db.execute(wanted).fetchall()
    kept = season.kept_route(on).tolist()
    season.merge(Season(shutil.copy(path, tmp_path / "same.gpkg")))
    with season.store.reading() as db:
        assert db.execute(wanted).fetchall() == routes
    assert season.kept_route(on).tolist() == kept


def test_another_season_is_no_copy_of_this_one(path, tmp_path):
    stranger = a_season(tmp_path / "stranger.gpkg", a_plot(width=0.0009))
    before = path.read_bytes()
    with pytest.raises(FileProblem, match="differ in the layer arrays"):
        Season(path).merge(stranger)
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA quick_check").fetchone() == ("ok",)
    assert Season(path).batches() == Season(path).batches()
    assert len(path.read_bytes()) == len(before)
