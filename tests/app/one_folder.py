"""One folder of seasons for many tests, empty for each."""

import tempfile
from pathlib import Path

import pytest

from app.state import last_heard


@pytest.fixture(autouse=True)
def seasons_folder(of_each_test, monkeypatch):
    """Let each test have an empty folder of seasons, in the same place.

    What the app keeps of a season stands under its path and what its file says: plans and maps of
    the one that all begin with are made once.
    """
    folder = of_each_test / "seasons"
    if folder.exists():  # seasons of another test stay: no file gets the inode of one
        folder.rename(Path(tempfile.mkdtemp(prefix="before", dir=of_each_test)) / "seasons")
    folder.mkdir()
    monkeypatch.setenv("FIELDMON_SEASONS", str(folder))
    monkeypatch.setattr(last_heard, "_HEARD", {})
    monkeypatch.setattr(last_heard, "_KEYS", set())
    return folder
