"""Each thing that SQLite may say of a season's file becomes a sentence that says what to do."""

import sqlite3
from pathlib import Path

import pytest

from fieldmon.errors import FieldmonError
from fieldmon.monitoring.file.file_problems import damaged, no_file, sentences

SEASON, COPY = Path("season.gpkg"), Path("copy.gpkg")


def told(words, code):
    """Return what SQLite says with its code, as Python hands it on."""
    error = sqlite3.DatabaseError(words)
    error.sqlite_errorcode = code
    return error


@pytest.mark.parametrize(
    ("problem", "said"),
    [
        (OverflowError("too big"), "A number must be small enough for season.gpkg"),
        (told("file is not a database", sqlite3.SQLITE_NOTADB), "season.gpkg must be the file of"),
        (told("database is locked", sqlite3.SQLITE_BUSY), "has held it for 7 seconds"),
        (told("locked", sqlite3.SQLITE_BUSY_SNAPSHOT), "has held it for 7 seconds"),
        (told("database or disk is full", sqlite3.SQLITE_FULL), "on the disk for copy.gpkg"),
        (told("disk I/O error", sqlite3.SQLITE_IOERR_WRITE), "disk must take.*written to copy"),
        (told("disk I/O error", sqlite3.SQLITE_IOERR_READ), "season.gpkg is damaged"),
        (told("readonly database", sqlite3.SQLITE_READONLY_DIRECTORY), "Check its permissions"),
        (told("no such file", sqlite3.SQLITE_CANTOPEN), "Check its permissions"),
        (told("interrupted", sqlite3.SQLITE_INTERRUPT), "must come to an end"),
        (told("disk image is malformed", sqlite3.SQLITE_CORRUPT), "season.gpkg is damaged"),
        # words that stand in names of tables, too
        (told("no such table: full", sqlite3.SQLITE_ERROR), "season.gpkg is damaged"),
        (told("no such column: locked", sqlite3.SQLITE_ERROR), "season.gpkg is damaged"),
        (sqlite3.DatabaseError("what is packed is no zlib"), "season.gpkg is damaged"),
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
