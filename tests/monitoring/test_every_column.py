"""Every column of inspections comes through whatever a season does with them, and none is lost."""

import shutil
import sqlite3
from contextlib import closing

import numpy as np
import pytest

from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS
from fieldmon.infestation.inspections import CLEAN, FOUND, RESULT_NAMES, Inspections
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes import outside_changes, season_log
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.inspecting.certifier_tables import csv_bytes, inspections_table
from fieldmon.monitoring.inspecting.inspection_table import time_text
from tests.monitoring.seasons import BEGINS, a_plot, a_season

DAY = np.datetime64(BEGINS)
#: of each column what is said of one inspection, and what of another: a new one needs a line here
SAID = {
    "plant": (5, 6),
    "date": (DAY, DAY + 1),
    "second": (3600.0, 7265.0),
    "result": (FOUND, CLEAN),
    "count": (3.0, np.nan),
    "who": ("Ada", "Bob"),
    "notes": ("webs", "nothing here"),
    "detects": (0.25, 0.5),
}


def saying(which, **other):
    return Inspections(
        **{c.name: np.array([other.get(c.name, SAID[c.name][which])], c.dtype) for c in COLUMNS}
    )


def as_kept(inspections):
    """Return an inspection as the season's file has it, by its names."""
    one = {c.kept: getattr(inspections, c.name)[0] for c in COLUMNS}
    own = {c.kept: c.to_file(getattr(inspections, c.name))[0] for c in BESIDE}
    count = None if np.isnan(one["count"]) else float(one["count"])
    return own | {
        "plant": int(one["plant"]), "date": str(one["date"]), "count": count,
        "time": time_text(one["time"]), "result": RESULT_NAMES[int(one["result"])],
    }  # fmt: skip


def holds(season, *expected):
    """Hold that a season, and its file opened again, say this in every column."""
    for one in (season, Season(season.path)):
        for column in COLUMNS:
            told = np.concatenate([getattr(said, column.name) for said in expected])
            np.testing.assert_array_equal(getattr(one.inspections, column.name), told, column.name)
    assert Season(season.path).verify() == ()
    assert check_against_log(season) == ()


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    return a_season(tmp_path_factory.mktemp("empty") / "season.gpkg", a_plot(0.0004, 0.0003)).path


@pytest.fixture
def season(empty, tmp_path):
    """Give a season with one inspection that says something in every column."""
    season = Season(shutil.copy(empty, tmp_path / "season.gpkg"))
    season.record(saying(0), "monday.csv")
    return season


def outside(season, statement, values):
    with closing(sqlite3.connect(season.path)) as db:
        db.execute(statement, values)
        db.commit()


def test_every_column_has_something_to_say():
    assert {*SAID} == {column.name for column in COLUMNS}
    for column in COLUMNS:
        here, there = SAID[column.name]
        assert here != there
        assert here != column.empty


def test_it_comes_back_from_undo(season):
    holds(season, saying(0))
    season.undo()
    holds(season, Inspections.none())
    season.redo(1)
    holds(season, saying(0))


def test_it_comes_through_an_export_and_a_file(season, empty, tmp_path):
    season.record(saying(1))
    data = csv_bytes([inspections_table(season)])
    read = read_inspections(Upload("all.csv", data), season.plot.grid).value
    other = Season(shutil.copy(empty, tmp_path / "other.gpkg"))
    other.record(read)
    holds(other, saying(0), saying(1))


def test_it_comes_through_a_correction_of_another_program(season):
    values = as_kept(saying(1))
    sets = ", ".join(f"{name} = ?" for name in values)
    outside(season, f"UPDATE inspections SET {sets}", (*values.values(),))  # noqa: S608 - ours
    assert season.correct("Cid") == 1
    holds(season, saying(1))
    season.undo()
    holds(season, saying(0))


def test_it_comes_through_a_correction_in_a_copy(season, tmp_path):
    copy = Season(shutil.copy(season.path, tmp_path / "copy.gpkg"))
    values = as_kept(saying(1))
    sets = ", ".join(f"{name} = ?" for name in values)
    outside(copy, f"UPDATE inspections SET {sets}", (*values.values(),))  # noqa: S608 - ours
    assert season.take_corrections(copy.path, "copy.gpkg", "Cid") == 1
    holds(season, saying(1))
    season.undo()
    holds(season, saying(0))


def test_it_comes_to_what_holds_instead(season):
    told = saying(1, plant=SAID["plant"][0], date=DAY)
    assert season.record_instead(told).corrected == 1
    holds(season, told)
    season.undo()
    holds(season, saying(0))


def test_it_stays_where_what_holds_instead_says_nothing(season):
    told = saying(0, result=CLEAN, count=np.nan)
    silent = {column.name: column.empty for column in BESIDE}
    assert season.record_instead(saying(0, result=CLEAN, count=np.nan, **silent)).corrected == 1
    holds(season, told)


def test_it_comes_from_a_draft(season):
    values = as_kept(saying(1))
    names, marks = ", ".join(values), ", ".join("?" * len(values))
    outside(season, f"INSERT INTO inspections ({names}) VALUES ({marks})", (*values.values(),))  # noqa: S608 - ours
    holds(Season(season.path), saying(0), saying(1))


def test_it_comes_from_another_copy(season, empty, tmp_path):
    other = Season(shutil.copy(empty, tmp_path / "other.gpkg"))
    other.record(saying(1), "tuesday.csv")
    back = Season(shutil.copy(season.path, tmp_path / "back.gpkg"))
    season.merge(other)
    holds(season, saying(0), saying(1))
    other.merge(back)
    holds(other, saying(0), saying(1))
    season.merge(other)
    holds(season, saying(0), saying(1))


@pytest.mark.parametrize("column", BESIDE, ids=lambda column: column.name)
def test_it_is_kept_where_one_copy_alone_says_it_of_a_row_of_both(season, tmp_path, column):
    silent = Season(shutil.copy(season.path, tmp_path / "silent.gpkg"))
    with closing(sqlite3.connect(silent.path)) as db:
        db.execute("UPDATE fieldmon SET value = '1' WHERE key = 'open'")  # as if we wrote it
        db.execute(f"UPDATE inspections SET {column.kept} = NULL")  # noqa: S608 - ours
        db.execute("UPDATE fieldmon SET value = '0' WHERE key = 'open'")
        db.commit()
    back = Season(shutil.copy(silent.path, tmp_path / "back.gpkg"))
    silent.merge(season)
    holds(silent, saying(0))
    season.merge(back)
    holds(season, saying(0))


def test_it_comes_from_a_copy_that_is_recorded(season, empty, tmp_path):
    read = read_inspections(season.path, season.plot.grid).value
    other = Season(shutil.copy(empty, tmp_path / "other.gpkg"))
    other.record(read)
    holds(other, saying(0))


@pytest.mark.parametrize("column", BESIDE, ids=lambda column: column.name)
def test_what_another_program_changes_of_it_is_noticed_and_logged(season, column):
    value = as_kept(saying(1))[column.kept]
    with closing(sqlite3.connect(season.path)) as db:
        before = season_log.states(db, [1])
        db.execute(f"UPDATE inspections SET {column.kept} = ?", (value,))  # noqa: S608 - ours
        assert bool(outside_changes.waiting(db)) == column.watched
        assert (season_log.states(db, [1]) != before) == column.watched
