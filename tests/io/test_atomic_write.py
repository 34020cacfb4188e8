"""Files appear whole or not at all."""

import errno
import os
import sqlite3
from contextlib import closing

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.atomic_write import write_whole


def test_a_file_is_written_and_replaced(tmp_path):
    path = tmp_path / "a.json"
    write_whole(path, b"one")
    write_whole(path, b"two")
    assert path.read_bytes() == b"two"
    assert list(tmp_path.iterdir()) == [path]


def test_on_a_full_disk_the_old_file_stays_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "a.json"
    write_whole(path, b"one")

    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FileProblem, match=r"No space left on device\)\. Make room"):
        write_whole(path, b"two")
    assert path.read_bytes() == b"one"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_or_a_device_is_not_written_over(tmp_path):
    with pytest.raises(FileProblem, match="it is a folder"):
        write_whole(tmp_path, b"one")
    with pytest.raises(FileProblem, match="not a plain file"):
        write_whole("/dev/null", b"one")


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(FileProblem, match="none must exist"):
        write_whole(tmp_path / "none" / "a.json", b"one")


def database(path, *tables):
    with closing(sqlite3.connect(path)) as db:
        for name in tables:
            db.execute(f"CREATE TABLE {name} (key)")
        db.commit()
    return path.read_bytes()


@pytest.mark.parametrize("damage", [b"", b"x"])
def test_a_season_is_never_written_over_be_it_damaged(tmp_path, damage):
    path = tmp_path / "season.gpkg"
    held = database(path, "fieldmon")
    held = held[:100] + damage * 20 + held[100 + 20 * len(damage) :]
    path.write_bytes(held)
    with pytest.raises(FileProblem, match="but it holds a season"):
        write_whole(path, b"a route")
    assert path.read_bytes() == held


def test_a_season_that_another_program_holds_is_not_written_over(tmp_path):
    path = tmp_path / "season.gpkg"
    database(path, "fieldmon")
    with closing(sqlite3.connect(path)) as db:
        db.execute("BEGIN EXCLUSIVE")
        with pytest.raises(FileProblem, match="but it holds a season"):
            write_whole(path, b"a route")


def test_another_database_is_written_over_as_any_file(tmp_path):
    path = tmp_path / "day.gpkg"
    database(path, "stops")
    write_whole(path, b"a route")
    assert path.read_bytes() == b"a route"


def test_a_new_file_is_open_to_whom_the_umask_says_which_is_never_touched(tmp_path, monkeypatch):
    before = os.umask(0o077)
    try:
        monkeypatch.setattr(os, "umask", lambda _: pytest.fail("the umask is of all threads"))
        write_whole(tmp_path / "private", b"one")
    finally:
        monkeypatch.undo()
        os.umask(before)
    write_whole(tmp_path / "usual", b"one")
    (tmp_path / "plain").touch()
    modes = [(tmp_path / name).stat().st_mode & 0o777 for name in ("private", "usual", "plain")]
    assert modes == [0o600, modes[2], modes[2]]


def test_a_name_that_is_too_long_is_a_sentence(tmp_path):
    with pytest.raises(FileProblem, match="could not be written"):
        write_whole(tmp_path / ("a" * 250), b"one")
