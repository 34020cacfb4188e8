"""What a process copies is gone after it, even if it was killed; what a living one has stays."""

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from fieldmon.compute import working_folder as folders
from fieldmon.compute.working_folder import clear, working_folder

pytestmark = pytest.mark.skipif(folders.fcntl is None, reason="no locks of this kind")

_WORKS = """
from pathlib import Path
from fieldmon.compute.working_folder import working_folder
with working_folder() as folder:
    (Path(folder) / "season.gpkg").write_bytes(b"x" * 100)
    print(folder, flush=True)
    input()
"""


@pytest.fixture
def parent(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    folders._clear_once.cache_clear()
    return tmp_path


@pytest.fixture
def working(parent):  # noqa: ARG001 - the process takes it too
    """Give another process that works in a folder, and the folder."""
    with subprocess.Popen(
        [sys.executable, "-c", _WORKS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        yield process, Path(process.stdout.readline().strip())
        process.kill()


def test_a_folder_is_empty_and_gone_in_the_end_even_if_the_work_fails(parent):
    def fails():
        with working_folder() as folder:
            assert list(Path(folder).iterdir()) == []
            (Path(folder) / "season.gpkg").touch()
            raise KeyError(folder)

    with pytest.raises(KeyError, match="fieldmon-"):
        fails()
    assert list(parent.iterdir()) == []


def test_what_a_killed_process_left_is_cleared_by_the_next(parent, working):
    process, folder = working
    assert (folder / "season.gpkg").exists()
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert (folder / "season.gpkg").exists()
    with working_folder() as mine:
        assert list(parent.iterdir()) == [Path(mine).parent]


def test_what_a_living_process_has_stays(parent, working):
    _, folder = working
    assert clear(parent) == 0
    with working_folder() as mine:
        assert clear(parent) == 0
        assert Path(mine).exists()
    assert (folder / "season.gpkg").exists()


def test_what_was_not_made_here_stays(parent):
    for name in ("fieldmon-files-ann", "fieldmon-pictures", "others"):
        (parent / name).mkdir()
    (parent / "others" / "held").touch()
    (parent / "fieldmon-link").symlink_to(parent / "others")
    (parent / "fieldmon-file").touch()
    before = sorted(parent.rglob("*"))
    assert clear(parent) == 0
    assert sorted(parent.rglob("*")) == before


def test_what_another_user_has_stays(parent, monkeypatch):
    (parent / "fieldmon-abc").mkdir()
    (parent / "fieldmon-abc" / "held").touch()
    me = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: me + 1)
    assert clear(parent) == 0
    monkeypatch.setattr(os, "getuid", lambda: me)
    assert clear(parent) == 1
