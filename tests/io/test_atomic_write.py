"""Files appear whole or not at all."""

import errno
import os

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
    with pytest.raises(FileProblem, match=r"No space left on device\); nothing was changed"):
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
