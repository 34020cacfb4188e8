"""Each thing that SQLite may say of a season's file becomes a sentence that says what to do."""

import sqlite3
from pathlib import Path

import pytest

from fieldmon.errors import FieldmonError
from fieldmon.monitoring.file_problems import damaged, no_file, sentences

SEASON, COPY = Path("season.gpkg"), Path("copy.gpkg")


@pytest.mark.parametrize(
    ("problem", "said"),
    [
        (OverflowError("too big"), "A number must be small enough for season.gpkg"),
        (sqlite3.DatabaseError("file is not a database"), "season.gpkg must be the file of a"),
        (sqlite3.OperationalError("database is locked"), "has held it for 7 seconds"),
        (sqlite3.OperationalError("database or disk is full"), "on the disk for copy.gpkg"),
        (sqlite3.OperationalError("attempt to write a readonly database"), "Check its permissions"),
        (sqlite3.DatabaseError("disk image is malformed"), "season.gpkg is damaged"),
    ],
)
def test_what_is_wrong_is_said_and_what_to_do(problem, said):
    with pytest.raises(FieldmonError, match=said), sentences(SEASON, 7.0, COPY):
        raise problem


def test_what_is_no_problem_of_the_file_stays_as_it_is():
    with pytest.raises(KeyError), sentences(SEASON, 7.0):
        raise KeyError


def test_a_missing_and_a_damaged_file_say_how_to_go_on():
    assert "fieldmon init" in str(no_file(SEASON))
    assert "is damaged (page 3 is gone)" in str(damaged(SEASON, "page  3\nis gone"))
