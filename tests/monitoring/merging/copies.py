"""Copies of a season in which different people went on."""

import os
import random
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime, time, timedelta
from functools import cache
from types import SimpleNamespace
from unittest import mock

import numpy as np

from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.file import label_table, phone_tables, schema
from fieldmon.monitoring.inspecting import batches, inspection_table, undone_batches
from fieldmon.monitoring.merging import merged_rows
from fieldmon.monitoring.merging.merge import merge_copies
from fieldmon.monitoring.phones import findings, photos
from fieldmon.monitoring.phones.photos import Photo
from fieldmon.monitoring.phones.scouts import Scout
from fieldmon.monitoring.phones.sent_findings import Finding, SentFindings
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.settings import MonitoringSettings, as_json, from_json
from fieldmon.monitoring.treating.applications import Application
from fieldmon.plot import local_clock
from fieldmon.plot.grid import plant_numbers
from tests.monitoring.phone import JPEG
from tests.monitoring.seasons import BEGINS, a_plot

PAIRS = int(os.environ.get("FIELDMON_MERGES", "20"))
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
        undone(db, *undone_batches.undo_one(db, rng.choice(counting)))
    elif rng.random() < 0.2 and any(not one.undone for one in batches.all_of(db)):
        undone(db, *undone_batches.undo(db, None))


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
    letter = SentFindings([finding, undone][: 1 + (rng.random() < 0.2)], (now, now), now,
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
    done = merge_copies(db, other)
    states = season_log.states(db)
    said = {"new": done.merged.new, "entries": len(told), "theirs": told, "numbers": done.numbers}
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
    tables = {table.name: ", ".join(("fid", *table.names)) for table in merged_rows.TAKEN}
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


def result(plant, what, day=1, **columns):
    on = np.datetime64(BEGINS) + day
    return Inspections.of(np.atleast_1d(plant), np.atleast_1d(what), on, **columns)


SPRAYED = Application("Acarol", operator="Ann", began=time(7))


FIRST = datetime(2026, 4, 10, 9, tzinfo=UTC)
