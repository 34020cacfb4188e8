"""Inspections come out of a season's file alike, kept in lots or read row by row."""

import shutil
import sqlite3
from contextlib import closing

import numpy as np
import pytest

from fieldmon.infestation import inspection_columns
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.inspecting import inspection_lots
from tests.monitoring.seasons import BEGINS

# SQLite tells nobody of a row that another one replaces
REPLACED = (
    "REPLACE INTO inspections (plant, day, date, result, digest, undone) "
    "SELECT plant, day, date, 'found', digest, 0 FROM inspections WHERE fid = 20"
)
COLUMNS = tuple(column.name for column in inspection_columns.COLUMNS)


@pytest.fixture(scope="module")
def in_lots(recorded, tmp_path_factory):
    """Give a season of a hundred inspections in lots of eight rows."""
    path = shutil.copy(recorded, tmp_path_factory.mktemp("lots") / "season.gpkg")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(schema, "LOT_BITS", 3)
        with closing(sqlite3.connect(path)) as db:  # the file's own triggers know the size
            for event in ("insert", "update", "delete"):
                db.execute(f"DROP TRIGGER inspections_{event}_counted")
                db.execute(f"DROP TRIGGER IF EXISTS inspections_{event}_replacing")
            schema.count_inspections(db)
            db.commit()
        season = Season(path)
        k, rng = 90, np.random.default_rng(1)
        plants, results = rng.permutation(len(season.plot.grid))[:k], rng.integers(0, 3, k)
        season.record(
            Inspections.of(
                plants,
                results,
                np.datetime64(BEGINS) + rng.integers(1, 5, k),
                second=np.where(rng.random(k) < 0.5, np.nan, rng.integers(0, 86_400, k)),
                count=np.where((rng.random(k) < 0.5) | (results != FOUND), np.nan, 7.5),
                who=rng.choice(["Ann", "דנה", ""], k).astype(object),
                notes=rng.choice(["", "ends in nothing\0", "🌿"], k).astype(object),
                detects=rng.choice([np.nan, 0.3, 1 / 3], k),
            ),
            "taps",
        )
    return path


@pytest.fixture
def path(in_lots, tmp_path, monkeypatch):
    monkeypatch.setattr(schema, "LOT_BITS", 3)
    return shutil.copy(in_lots, tmp_path / "season.gpkg")


def lots(path):
    with closing(sqlite3.connect(path)) as db:
        return [lot for (lot,) in db.execute("SELECT lot FROM inspection_lots ORDER BY lot")]


def row_by_row(path):
    """Return the inspections of a season whose lots were forgotten."""
    with closing(sqlite3.connect(path)) as db:
        db.execute("DELETE FROM inspection_lots")
        return inspection_lots.load(db, BEGINS)


def as_it_is(path):
    with closing(sqlite3.connect(path)) as db:
        return inspection_lots.load(db, BEGINS)


def assert_the_same(one, other):
    assert len(one) == len(other)
    for name in COLUMNS:
        ours, theirs = getattr(one, name), getattr(other, name)
        assert ours.dtype == theirs.dtype
        np.testing.assert_array_equal(ours, theirs)


def test_every_column_comes_out_of_lots_as_it_comes_out_of_the_rows(path):
    assert len(lots(path)) == 102 // 8
    assert_the_same(as_it_is(path), row_by_row(path))


def test_a_lot_that_is_not_full_is_not_kept(path):
    (last,) = sqlite3.connect(path).execute("SELECT max(fid) FROM inspections").fetchone()
    assert max(lots(path)) == (last + 1) // 8 - 1


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE inspections SET result = 'found' WHERE fid = 20",
        "UPDATE inspections SET notes = 'otherwise' WHERE fid = 20",
        "UPDATE inspections SET undone = 1 WHERE fid = 20",
        "UPDATE inspections SET fid = 1000 WHERE fid = 20",
        "DELETE FROM inspections WHERE fid = 20",
    ],
)
def test_whoever_changes_a_row_does_away_with_its_lot_alone(path, change):
    before = lots(path)
    with closing(sqlite3.connect(path)) as db:
        db.execute(change)
        db.commit()
    assert set(before) - set(lots(path)) == {2}
    assert_the_same(as_it_is(path), row_by_row(path))


@pytest.mark.parametrize(
    "change",
    [
        REPLACED,
        "UPDATE inspection_lots SET columns = X'00'",
        "UPDATE inspection_lots SET content = 'of another'",
    ],
)
def test_a_lot_that_is_not_what_it_was_is_read_row_by_row(path, change):
    with closing(sqlite3.connect(path)) as db:
        db.execute(change)
        db.commit()
    assert_the_same(as_it_is(path), row_by_row(path))


def test_lots_that_unpack_to_more_than_all_may_are_read_row_by_row(path, monkeypatch):
    monkeypatch.setattr(inspection_lots, "_MOST_BYTES", 1000)  # room for two or three
    made, columns = [], inspection_lots._columns
    monkeypatch.setattr(
        inspection_lots, "_columns", lambda data: made.append(len(data)) or columns(data)
    )
    read = as_it_is(path)
    assert 0 < sum(made) <= 1000
    assert len(made) < len(lots(path))
    assert_the_same(read, row_by_row(path))


def test_row_numbers_of_another_program_may_be_any(path):
    with closing(sqlite3.connect(path)) as db:
        for number, fid in enumerate((-5, 0, 1 << 40)):
            db.execute("UPDATE inspections SET fid = ? WHERE fid = ?", (fid, 30 + number))
        inspection_lots.keep(db)
        db.commit()
    assert {-1, 0, 3, 4} <= set(lots(path))
    assert_the_same(as_it_is(path), row_by_row(path))


def test_what_is_undone_or_recorded_later_is_seen(path):
    season = Season(path)
    season.undo()
    assert len(Season(path).history.inspections) == 12
    on = np.datetime64(BEGINS) + 6
    season.record(Inspections.of(np.arange(20), np.zeros(20, int), on), "more")
    assert_the_same(Season(path).history.inspections, row_by_row(path))


def test_what_is_no_text_where_texts_belong_stays_in_its_rows(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE inspections SET notes = X'FF00' WHERE fid = 20")
        inspection_lots.keep(db)
        db.commit()
    assert 2 not in lots(path)
    assert b"\xff\x00" in as_it_is(path).notes.tolist()


def test_every_change_of_a_row_is_counted(path):
    def counted():
        with closing(sqlite3.connect(path)) as db:
            key = (schema.INSPECTIONS_CHANGED,)
            return int(db.execute("SELECT value FROM fieldmon WHERE key = ?", key).fetchone()[0])

    before, season = counted(), Season(path)
    on = np.datetime64(BEGINS) + 7
    season.record(Inspections.of(np.arange(3), np.zeros(3, int), on), "x")
    assert counted() == before + 3
    season.undo()
    assert counted() == before + 6
    season.plan(BEGINS)
    assert counted() == before + 6
