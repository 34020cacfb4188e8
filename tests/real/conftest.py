"""Real files stand beside the repository, never in it."""

from pathlib import Path

import pytest

_DATA = Path(__file__).resolve().parents[3] / "shared" / "data"


@pytest.fixture(scope="session")
def shared() -> Path:
    if not _DATA.is_dir():
        pytest.skip(f"the real data folder {_DATA} is not on this machine")
    return _DATA
