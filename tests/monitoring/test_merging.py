"""Two copies of a season that went apart: all that is in either comes together, once each."""

import os
import random
import shutil
import sqlite3
from collections import Counter
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime, time, timedelta
from functools import cache
from itertools import combinations, permutations
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest

from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import (
    Season,
    batches,
    findings,
    inspection_table,
    label_table,
    merging,
    phone_tables,
    photos,
    schema,
    season_log,
    settings_log,
    treatments,
)
from fieldmon.monitoring.applications import Application
from fieldmon.monitoring.day_ahead import WHOLE, DayAhead
from fieldmon.monitoring.findings import Finding, _SentFindings
from fieldmon.monitoring.history import Treatment
from fieldmon.monitoring.photos import Photo
from fieldmon.monitoring.scouts import Scout
from fieldmon.monitoring.settings import MonitoringSettings, as_json, from_json
from fieldmon.monitoring.treatments import TreatedPlace
from fieldmon.plot import local_clock
from fieldmon.plot.grid import plant_numbers
from tests.monitoring.phone import JPEG
from tests.monitoring.seasons import BEGINS, a_plot, a_season, state
from tests.monitoring.test_outside_changes import outside

PAIRS = int(os.environ.get("FIELDMON_MERGES", "40"))
PLOT = a_plot()
GRID = PLOT.grid
LABEL = plant_numbers(GRID)
SETTINGS = MonitoringSettings(BEGINS)
SEASON = SimpleNamespace(plot=PLOT, plant_numbers=LABEL)
WHO = "Ann", "Ben"


class Clock(datetime):
    """A computer's clock, which somebody may set back; it never shows a moment twice."""

    @classmethod
    def begin(cls):
        cls.shows, cls.shown = datetime(2026, 4, 10, tzinfo=UTC), set()

    @classmethod
    def now(cls, tz=None):
        while cls.shows in cls.shown:
            cls.shows += timedelta(microseconds=1)
        cls.shown.add(cls.shows)
        return cls.shows.astimezone(tz)


def record(db, rng, who):
    """Record a few results, some of them twice, as a person does; sometimes take something back."""
    n = rng.randrange(1, 5)
    plant = np.array([rng.randrange(4) for _ in range(n)])
    result = np.array([rng.choice((CLEAN, FOUND)) for _ in range(n)])
    on = np.datetime64(BEGINS) + rng.randrange(3)
    told = np.full(n, 0.3 if who == "Ann" else np.nan)
    found = Inspections.of(plant, result, on, detects=told)
    store(db, found, who)
    if rng.random() < 0.3:
        store(db, found, who)  # the same once more
    counting = [fid for (fid,) in db.execute("SELECT fid FROM inspections WHERE undone = 0")]
    if counting and rng.random() < 0.3:
        undone(db, *batches.undo_one(db, rng.choice(counting)))
    elif rng.random() < 0.2 and any(not one.undone for one in batches.all_of(db)):
        undone(db, *batches.undo(db, None))


def store(db, found, who):
    """Record findings, with their entry in the log."""
    batch = batches.begin(db, "findings", "taps", who)
    if len(found) == 2:  # in earlier versions what brought nothing new had used a number up
        db.execute("UPDATE batches SET fid = fid + 1 WHERE fid = ?", (batch,))
        batch += 1
    rows = inspection_table.rows(found, GRID, LABEL, SETTINGS, (batch, who))
    new = int(inspection_table.store(db, rows).sum())
    batches.end(db, batch, new)
    if new:
        states = season_log.states(db, [batch])
        said = inspection_table.in_words(found, [])
        season_log.append(db, "seen", who, states=states, batch=batch, source="taps", **said)


def undone(db, changed, said):
    """Note in the log what was undone."""
    season_log.append(db, "undone", states=season_log.states(db, changed), said=said)


def some_findings(rng):
    """Return what phones save: of few plants, some with no time, some with a photo."""
    told = []
    for k in range(2):
        at = datetime.combine(BEGINS + timedelta(days=3), time(9), UTC)
        plant, result = rng.randrange(4), rng.choice((CLEAN, FOUND))
        on = BEGINS + timedelta(days=rng.randrange(3))  # of an earlier day: it has no time
        told.append(
            (rng.choice(WHO), Finding(f"f{k}", at, plant, result, on=on), rng.random() < 0.8)
        )
    return told


def tell(db, rng, told):
    """Record what a phone saved; the other copy may do so too. Sometimes its last is undone."""
    who, finding, photo = rng.choice(told)
    now, undone = Clock.now(UTC), Finding(f"u{finding.id}", finding.at, undoes=finding.id)
    letter = _SentFindings([finding, undone][: 1 + (rng.random() < 0.2)], (now, now), now,
                           timedelta())  # fmt: skip
    change = SimpleNamespace(db=db, reaches=lambda _: None)
    findings._take(SEASON, change, Scout(who, None, ""), letter)
    if photo:
        photos.keep_of(db, who, Photo(f"p{finding.id}", finding.id, JPEG, finding.at))


def choose(db, rng):
    """Change some settings."""
    now = from_json(settings_log.now(db))
    hours, seed = rng.choice((4.0, 5.0, 6.0)), rng.choice((1, 2, 3))
    one = replace(now, robot=now.robot.with_hours(hours))
    settings_log.change(db, rng.choice((one, replace(now, seed=seed), replace(one, seed=seed))))
    season_log.append(db, "changed", states={"settings": season_log.settings_state(db)})


def keep_labels(db, rng):
    """Replace the table of labels."""
    days = rng.choice((7, 14, 21))
    more = [ProductLabel("Old", waiting_days=3)] if rng.random() < 0.5 else []
    kept = (ProductLabel("Acarol", waiting_days=days), *more)
    if kept != label_table.read(db):
        label_table.write(db, kept)
        states = {"labels": season_log.labels_state(db)}
        season_log.append(db, "labels", labels=len(kept), source="labels.csv", states=states)


def apart(seed):
    """Return two copies of a season, in memory, in which different people went on."""
    held, Clock.shows, shown = gone_apart(seed)
    Clock.shown = {*shown}
    both = tuple(sqlite3.connect(":memory:", isolation_level=None) for _ in held)
    for db, whole in zip(both, held, strict=True):
        db.deserialize(whole)
    return both


@cache
def gone_apart(seed):
    """Return what is in two such copies, and what the clock shows and showed then."""
    rng = random.Random(seed)
    Clock.begin()
    one, other = (sqlite3.connect(":memory:", isolation_level=None) for _ in range(2))
    schema.lay_out(one)
    told = some_findings(rng)

    def work(db, who):
        if rng.random() < 0.2:  # a clock is set back
            Clock.shows -= timedelta(microseconds=rng.randrange(200))
        # as a rule it goes on by more than that
        Clock.shows += timedelta(microseconds=rng.randrange(100))
        kinds = (
            *(lambda: record(db, rng, who),) * 3,
            *(lambda: tell(db, rng, told),) * 3,
            *(lambda: choose(db, rng),) * 2,
            lambda: keep_labels(db, rng),
        )
        rng.choice(kinds)()

    with mock.patch.object(local_clock, "datetime", Clock):
        settings_log.write(one, as_json(SETTINGS))
        season_log.begin(one, "a new season")
        for _ in range(rng.randrange(5)):
            work(one, "Ann")
        one.backup(other)
        for _ in range(rng.choice((0, 4, 8, 12))):
            work(*rng.choice(((one, "Ann"), (other, "Ben"))))
    with closing(one), closing(other):
        return (one.serialize(), other.serialize()), Clock.shows, frozenset(Clock.shown)


def merge(db, other):
    """Merge as a season does, which notes the other's log."""
    told = season_log.taken_in(db, other)
    done = merging.merge(db, other)
    states = season_log.states(db)
    said = {"new": done.new, "entries": len(told), "theirs": told, "numbers": done.numbers}
    season_log.append(db, "merged", states=states, **said)
    return done


def told_of(db):
    """Return when, from where and by whom the batch of each entry of the log was recorded."""
    wanted = "SELECT at, source, who, kind FROM batches WHERE fid = ?"
    told = {}
    for entry in season_log.entries(db):
        if (batch := entry.what.get("batch")) is not None:
            number = entry.numbers.get(batch, batch)
            told[entry.digest] = db.execute(wanted, (number,)).fetchone()
    return told


COLUMNS = "digest, plant, date, result, inspections.who, batches.at"


def held(db, more=""):
    """Return all rows, each with the batch it came with."""
    joined = f"SELECT {COLUMNS}{more} FROM inspections JOIN batches ON batches.fid = batch"  # noqa: S608
    return db.execute(joined).fetchall()


def content(db):
    """Return all that is in a file, in its order."""
    tables = {table.name: ", ".join(("fid", *table.names)) for table in merging.TAKEN}
    tables |= {table.name: ", ".join(table.names) for table in phone_tables.TABLES}
    return {name: db.execute(f"SELECT {names} FROM {name} ORDER BY 1").fetchall()  # noqa: S608
            for name, names in tables.items()}  # fmt: skip


def that_count(db):
    """Return what is recorded and not taken back."""
    counts = "SELECT digest FROM inspections WHERE undone = 0 AND digest IS NOT NULL"
    return {*db.execute(counts)}


def copied(db):
    """Return a copy to merge into."""
    copy = sqlite3.connect(":memory:", isolation_level=None)
    db.backup(copy)
    return copy


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
        new, gone, *_ = merge(ours, other)
        assert new == len(that_count(ours) - that_count(one))
        assert gone == len(that_count(one) - that_count(ours))
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
        assert merge(again, other).differing == ()
        assert content(again) == content(ours)
        unchanged = copied(one)
        assert merge(unchanged, one).numbers == {}
        for db in (one, other, ours, theirs, again, unchanged):
            db.close()


def as_earlier_versions_did(monkeypatch):
    """Let merges number all batches anew, from 1, and note nothing of it."""
    numbered, noted = merging._merged_batches, season_log.append

    def from_one(copies):
        merged = numbered(copies).items()
        return {key: {**row, "fid": number} for number, (key, row) in enumerate(merged, 1)}

    def nothing_noted(db, kind, who="", **said):
        noted(db, kind, who, **{name: told for name, told in said.items() if name != "numbers"})

    monkeypatch.setattr(merging, "_merged_batches", from_one)
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


IN_ORDER = {
    "settings": "SELECT changed, name, value FROM settings ORDER BY fid",
    "batches": "SELECT at, kind, source, who FROM batches ORDER BY fid",
}


def test_what_one_copy_alone_chose_holds_and_what_both_did_is_said():
    chosen_by = set()
    for seed in range(PAIRS):
        one, other = apart(seed)
        ours = copied(one)
        differing = merge(ours, other).differing
        for wanted in IN_ORDER.values():
            together = ours.execute(wanted).fetchall()
            for db in (one, other):  # each copy's own order, whatever its clock says
                rows = db.execute(wanted).fetchall()
                assert [row for row in together if row in rows] == rows
        rows = [[*db.execute(IN_ORDER["settings"])] for db in (one, other)]
        now, *values = (settings_log.now(db) for db in (ours, one, other))
        said = []
        for name in now:
            own = [row for row in rows[0] if row not in rows[1] and row[1] == name]
            others = [row for row in rows[1] if row not in rows[0] and row[1] == name]
            chosen_by.add((name, bool(own), bool(others)))
            if not (own and others):
                assert now[name] == values[1 if others else 0][name]
            elif values[0][name] != values[1][name]:
                assert now[name] in {each[name] for each in values}
                said.append(f"The setting {name} differs")
        kept, *tables = (label_table.read(db) for db in (ours, one, other))
        own, others = ({*season_log.labels_kept(db)} for db in (one, other))
        chosen_by.add(("labels", bool(own - others), bool(others - own)))
        if not (own - others and others - own):
            assert kept == tables[1 if others - own else 0]
        elif tables[0] != tables[1]:
            assert kept in tables
            said.append("The table of labels differs")
        assert [sentence.startswith(start) for sentence, start in zip(
            differing, said, strict=True)] == [True] * len(said)  # fmt: skip
        for db in (one, other, ours):
            db.close()
    each = {(name, *by) for name in ("robot", "labels") for by in ((0, 1), (1, 0), (1, 1))}
    assert each <= chosen_by


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
            batches.undo(ours, number)
            assert inspection_table.not_what_they_say(ours) == []
            assert photos_shown(ours) >= not_taken_back(ours, brought) - twice
        for db in (one, other, ours, theirs):
            db.close()
    assert of_both


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
        if content(one) == content(other) and merging.merge(one, other).differing == ():
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
    merging.merge(one, other)
    monkeypatch.setattr(merging, "_n_staying", lambda *_: 0)
    merging.merge(whole, other)
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
        assert merging._is_same_batch(both, batch, n) == alike
    assert {*answers} == {True, False}
    for db in both:
        db.close()


def test_a_batch_in_which_something_stands_twice_is_no_batch_that_stays():
    db = sqlite3.connect(":memory:", isolation_level=None)
    schema.lay_out(db)
    into = "INSERT INTO inspections (batch, digest, undone, who, notes)"
    db.executemany(f"{into} VALUES (1, ?, ?, 'Ann', '')", [("a", 1), ("a", 0)])
    assert not merging._is_same_batch((db, db), 1, 2)
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
    return Inspections.of(np.atleast_1d(plant), np.atleast_1d(what), on, **columns)


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
        told = season_log.planned_and_seen(db, BEGINS + timedelta(days=3))
    assert [one.at for one in told] == [ours.log()[-2].at]
    ours.undo(new + 1)
    assert ours.history.inspections.plant.tolist().count(5) == 0
    assert ours.verify() == ()


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
    season.change(replace(season.settings, seed=5), season.settings)
    there.change(replace(there.settings, seed=7), there.settings)
    done = season.merge(Season(other))
    assert "recorded as found, now clean" in done.contradictions[0]
    (said,) = (said for said in done.contradictions if "The setting season differs" in said)
    assert said.endswith("seed 5 here, seed 7 there. What was chosen last counts: seed 7.")
    assert season.settings.seed == 7
    assert sorted(season.history.on(1).result.tolist()) == [CLEAN, FOUND]


@pytest.mark.parametrize("both", [True, False])
def test_labels_that_were_replaced_do_not_come_back(path, other, both):
    ours, theirs = Season(path), Season(other)
    if both:
        ours.keep_labels([ProductLabel("Acarol", waiting_days=7), ProductLabel("Old")])
    theirs.keep_labels([ProductLabel("Acarol", waiting_days=21)])
    theirs.keep_labels([last := ProductLabel("Acarol", waiting_days=3)])
    done = ours.merge(theirs)
    assert ours.labels() == (last,)
    said = (
        "The table of labels differs (Acarol, Old): each copy replaced it. What was kept last "
        "counts, as a whole: the one there."
    )
    assert done.contradictions == ((said,) if both else ())
    assert theirs.merge(ours).contradictions == ()
    assert theirs.labels() == (last,)
    assert ours.verify() == ()


SPRAYED = Application("Acarol", operator="Ann", began=time(7))


@pytest.mark.parametrize("first", ["here", "there"])
@pytest.mark.parametrize("way", ["here", "there"])
def test_a_spraying_that_both_recorded_counts_once_with_the_stricter_of_what_labels_added(
    path, other, tmp_path, first, way
):
    third = Season(shutil.copy(path, tmp_path / "third.gpkg"))  # nothing but what was said
    here, there = Season(path), Season(other)
    here.keep_labels([ProductLabel("Acarol", waiting_days=7, reentry_hours=24.0)])
    there.keep_labels(
        [ProductLabel("Acarol", waiting_days=14, reentry_hours=12.0, irac_groups=("6",))]
    )
    for one in (here, there) if first == "here" else (there, here):
        one.treat(BEGINS, 0.5, application=SPRAYED)
    third.treat(BEGINS, 0.5, application=SPRAYED)
    third.treat(BEGINS, 0.5, application=replace(SPRAYED, operator="Ben"))
    season, copy = (here, there) if way == "here" else (there, here)
    evening = season.evening(BEGINS)
    done = season.merge(copy)
    waits, hours = ((7, 14), (24, 12)) if way == "here" else ((14, 7), (12, 24))
    group = "none here, 6 there" if way == "here" else "6 here, none there"
    assert done.treatments == 0
    said = (
        f"The treatment with Acarol on {BEGINS} was recorded in both, and labels added different "
        f"values: waiting days {waits[0]} here, {waits[1]} there, re-entry hours {hours[0]} here, "
        f"{hours[1]} there, group {group}. It counts once; the longer waits and all groups hold."
    )
    assert done.contradictions[1:] == (said,)
    np.testing.assert_array_equal(season.evening(BEGINS), evening)
    strictest = replace(SPRAYED, waiting_days=14, reentry_hours=24.0, irac_groups=("6",))
    assert [one.application for one in season.treatments()] == [strictest]
    n = len(season.log())
    again = season.merge(copy)
    assert (again.contradictions, again.treatments, len(season.log())) == ((), 0, n)
    copy.merge(season)
    assert [one.application for one in copy.treatments()] == [strictest]
    assert season.merge(third).treatments == 1
    bens = replace(SPRAYED, operator="Ben")
    assert [one.application for one in season.treatments()] == [strictest, bens]
    assert (season.verify(), copy.verify()) == ((), ())
    left = [replace(SPRAYED, waiting_days=7, reentry_hours=24.0),
            replace(SPRAYED, waiting_days=14, reentry_hours=12.0, irac_groups=("6",))]  # fmt: skip
    assert "still" in copy.undo(copy.treatments()[0].batch)
    assert [one.application for one in copy.treatments()] == left[first == "here" :][:1]
    assert "still" not in copy.undo(copy.treatments()[0].batch)
    assert copy.treatments() == ()
    assert copy.verify() == ()


FIRST = datetime(2026, 4, 10, 9, tzinfo=UTC)


def sprayed(db, at, said, filled, *, noted=True):
    """Record a spraying of which a label filled in something; earlier versions noted none of it."""
    now = FIRST + timedelta(minutes=at)
    with mock.patch.object(local_clock, "utc_now", return_value=now):
        batch = batches.begin(db, "treatment", said.product, said.operator)
    place = TreatedPlace(PLOT.field.boundary, np.ones(len(GRID), bool), 0.5)
    whole = place, BEGINS, replace(said, **filled)
    treatment = Treatment(0, place.plants, 0.5)
    new = treatments.store(db, treatment, whole, batch, local_clock.LocalClock("UTC"), filled)
    batches.end(db, batch, new)
    if new and not noted:
        row = treatments._rows(db, f"batch = {batch}")[0] | {"by_label": None}
        undone = "UPDATE treatments SET by_label = NULL, digest = ? WHERE batch = ?"
        db.execute(undone, (treatments.digest_of(row), batch))


def copies_of(n):
    """Return so many copies, in memory, of a season in which nothing was done."""
    one = sqlite3.connect(":memory:", isolation_level=None)
    schema.lay_out(one)
    settings_log.write(one, as_json(SETTINGS))
    season_log.begin(one, "a new season")
    return [one, *(copied(one) for _ in range(n - 1))]


def begun_again(at, db, other):
    """Let another copy be of a season that was begun at another moment; "": too old to say it."""
    other.execute("UPDATE settings SET changed = ?", (at,))
    if not at:
        db.execute("UPDATE settings SET changed = ''")


def looks_for(db, name):
    """Let a season look for a pest from now on."""
    chosen = from_json(settings_log.now(db))
    settings_log.change(db, replace(chosen, pest=replace(shipped_pest("spider-mite"), name=name)))


def test_seasons_begun_apart_are_none_and_copies_of_another_pest_are_not_merged():
    one, other = copies_of(2)
    merging.refuse_strangers(one, other)
    begun_again("2026-04-05T06:00:00.000000Z", one, other)
    apart = r"the other on 2026-04-05 06:00:00.000000 UTC: they are two seasons\. Leave each in its"
    with pytest.raises(FileProblem, match=apart):
        merging.merge(one, other)
    one, other = copies_of(2)
    looks_for(one, "mites")
    merging.merge(copied(one), other)  # one named its pest later
    looks_for(other, "flies")
    merging.refuse_strangers(one, other)
    wrong = "looks for mites and the other for flies: finds would become those of another pest"
    with pytest.raises(FileProblem, match=wrong):
        merging.merge(one, other)
    begun_again("", one, other)
    with pytest.raises(FileProblem, match=wrong):
        merging.refuse_strangers(one, other)


def test_a_pest_that_both_chose_differently_is_named_not_dumped():
    one, other = copies_of(2)
    looks_for(one, "mites")
    chosen = from_json(settings_log.now(one))
    settings_log.change(other, replace(chosen, pest=replace(chosen.pest, detection=0.5)))
    (said,) = merging.merge(one, other).differing
    assert said == (
        "The setting pest differs: mites (this copy's figures) here, mites (the other copy's "
        "figures) there. What was chosen last counts: mites (the other copy's figures)."
    )


def counting(db):
    return db.execute("SELECT batch, waiting_days FROM treatments WHERE undone = 0").fetchall()


@pytest.mark.parametrize("said", [None, 3])
@pytest.mark.parametrize("noted", [True, False])
def test_treatments_of_which_nobody_knows_whether_they_are_one_both_count_and_are_listed(
    said, noted
):
    one, other = copies_of(2)
    sprayed(one, 0, SPRAYED, {"waiting_days": 7}, noted=noted)
    if said is None:
        sprayed(other, 1, SPRAYED, {"waiting_days": 14})
    else:
        sprayed(other, 1, replace(SPRAYED, waiting_days=said), {})
    ours = copied(one)
    done = merging.merge(ours, other)
    if noted and said is None:
        assert "It counts once" in done.differing[0]
        assert counting(ours) == [(1, 7)]
        return
    why = "" if noted else " (an earlier version did not note whether a label added that)"
    doubt = (
        f"Treatments with Acarol on {BEGINS}, batches 1 and 2, say the same but for waiting days "
        f"7 here, {said or 14} there{why}. Both count; if they are one, undo a batch."
    )
    assert done.differing == (doubt,)
    assert done.treatments == 1
    assert counting(ours) == [(1, 7), (2, said or 14)]
    assert merging.merge(ours, other).differing == ()


@pytest.mark.parametrize(
    ("efficacy", "said"),
    [
        (0.7, SPRAYED),
        (0.5, replace(SPRAYED, operator="Paco")),
        (0.5, Application("acarol ")),
    ],
)
def test_two_treatments_of_one_day_and_product_of_the_same_plants_are_named(
    path, other, efficacy, said
):
    here, there = Season(path), Season(other)
    here.treat(BEGINS, 0.5, application=SPRAYED)
    there.treat(BEGINS, efficacy, application=said)
    there.treat(BEGINS, 0.5, application=replace(SPRAYED, product="Oil"))
    there.treat(BEGINS + timedelta(days=1), 0.5, application=SPRAYED)
    done = here.merge(there)
    n = len(here.plot.grid)
    twice = (
        f"Two treatments of {n} plants with Acarol on {BEGINS}: batches 2 and 3. Both count; undo "
        "one if it was the same."
    )
    assert done.contradictions[-1] == twice
    assert [one for one in done.contradictions if one.startswith("Two treatments")] == [twice]
    assert len(here.treatments()) == 4
    assert here.merge(there).contradictions == ()


def test_two_treatments_of_other_plants_are_not_named(path, other):
    here, there = Season(path), Season(other)
    n = len(here.plot.grid)
    here.treat(BEGINS, 0.5, application=SPRAYED, plants=np.arange(n) < 5)
    there.treat(BEGINS, 0.7, application=SPRAYED, plants=np.arange(n) > 4)
    assert not [one for one in here.merge(there).contradictions if "Two treatments" in one]


def test_what_an_earlier_version_recorded_is_known_by_all_its_values():
    one, other = copies_of(2)
    sprayed(one, 0, SPRAYED, {"waiting_days": 7}, noted=False)
    sprayed(other, 1, SPRAYED, {"waiting_days": 7})
    assert merging.merge(one, other).differing == ()
    assert counting(one) == [(1, 7)]


@pytest.mark.parametrize("first", range(0, PAIRS // 2, 20))
def test_treatments_of_three_copies_come_out_the_same_in_every_order(first):
    """250 times three with FIELDMON_MERGES=500."""
    for seed in range(first, min(first + 20, PAIRS // 2)):
        rng = random.Random(seed)
        copies = copies_of(3)
        moments = iter(rng.sample(range(100), 12))
        for db in copies:
            for _ in range(rng.randrange(1, 4)):
                said = replace(SPRAYED, waiting_days=rng.choice((None, None, None, 7)))
                filled = {} if said.waiting_days else {"waiting_days": rng.choice((7, 14))}
                filled |= rng.choice(({}, {"reentry_hours": 12.0}))
                sprayed(db, next(moments), said, filled, noted=rng.random() < 0.8)
            if rng.random() < 0.3:
                batches.undo(db, None)
        outcomes = []
        for order in permutations(copies):
            ours = copied(order[0])
            for each in order[1:]:
                before = treatments.counting(ours)
                applied = [*before, *treatments.counting(each)]
                done = merge(ours, each)
                n_new, known = done.treatments, frozenset().union(*before)
                now = frozenset().union(*treatments.counting(ours))
                assert any(done.gone) == any(marks.isdisjoint(now) for marks in applied)
                assert n_new == sum(not marks & known for marks in treatments.counting(ours))
            rows = content(ours)["treatments"]
            for each in order:
                assert merge(ours, each).differing == ()
            assert content(ours)["treatments"] == rows
            marks = treatments.counting(ours)
            assert not any(a & b for a, b in combinations(marks, 2))
            live = treatments._rows(ours, "undone <> 1")
            assert all(any(treatments.known_by(row) & one for one in marks) for row in live)
            assert treatments.not_what_they_say(ours) == []
            # undoing leaves what merging would leave
            number = live[0]["batch"] if live else None
            if number is not None:
                batches.undo(ours, number)
                undone = content(ours)["treatments"]
                merge(ours, order[0])
                assert content(ours)["treatments"] == undone
            outcomes.append(rows)
            ours.close()
        assert all(rows == outcomes[0] for rows in outcomes)
        for db in copies:
            db.close()


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
    with pytest.raises(FileProblem, match="one is of another plot than the other") as refused:
        Season(path).merge(stranger)
    advice = str(refused.value).partition("planting. ")[2]
    other = shutil.copy(stranger.path, tmp_path / "named.gpkg")
    outside(other, "UPDATE plots SET name = 'Gate'", "DELETE FROM outside_changes")
    with pytest.raises(FileProblem, match="one is of the plot מטע Paran and the other of Gate"):
        Season(path).merge(Season(other))
    here = Season(path)
    begins = replace(here.settings, begins=BEGINS + timedelta(1))
    later = Season.create(tmp_path / "later.gpkg", here.plot, here.observations, begins)
    with pytest.raises(FileProblem, match="other on 2026-04-07: they are two seasons") as refused:
        Season(path).merge(later)
    assert str(refused.value).endswith(advice), "what is done about it is the same"
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA quick_check").fetchone() == ("ok",)
    assert path.read_bytes() == before


def test_a_spraying_undone_in_one_copy_is_named_with_the_wait_that_ends(path, other):
    here = Season(path)
    here.treat(BEGINS, 0.5, application=replace(SPRAYED, waiting_days=14))
    there = Season(shutil.copy(path, other))
    there.undo()
    done = there.merge(here)
    said = (
        f"The treatment with Acarol on {BEGINS} counted {{}}, but was undone {{}}: it does not "
        f"count, nor do its warnings and its wait (harvest from {BEGINS + timedelta(days=15)}). "
        f"If it was done, record it again with: fieldmon treat"
    )
    assert done.contradictions == (said.format("there", "here"),)
    n = len(there.log())
    done = here.merge(there)
    assert done.contradictions == (said.format("here", "there"),)
    assert here.treatments() == ()
    assert f"; undone there: Acarol on {BEGINS}" in here.log()[-1].sentence()
    assert (here.merge(there).contradictions, len(there.log())) == ((), n)
    here.treat(BEGINS, 0.5, application=replace(SPRAYED, waiting_days=14))
    assert there.merge(here).contradictions == ()
    assert len(there.treatments()) == 1


@pytest.mark.parametrize("way", ["here", "there"])
def test_a_spraying_that_both_recorded_is_named_where_each_undid_another_recording(
    path, other, way
):
    for copy in (path, other):
        Season(copy).treat(BEGINS, 0.5, application=SPRAYED)
    here = Season(path)
    here.merge(Season(other))
    there = Season(shutil.copy(path, other))
    first, second = sorted(one.number for one in here.batches() if one.kind == "treatment")
    here.undo(first)
    there.undo(second)
    one, another = (here, there) if way == "here" else (there, here)
    done = one.merge(another)
    said = (
        f"The treatment with Acarol on {BEGINS} counted in both, but each undid another recording "
        f"of it: it does not count, nor do its warnings. If it was done, record it again with: "
        f"fieldmon treat"
    )
    assert done.contradictions == (said,)
    assert f"; undone there: Acarol on {BEGINS}" in one.log()[-1].sentence()
    assert one.treatments() == ()
    one.treat(BEGINS, 0.5, application=SPRAYED)
    assert one.merge(another).contradictions == ()
    another.merge(one)
    assert (len(one.treatments()), len(another.treatments())) == (1, 1)
