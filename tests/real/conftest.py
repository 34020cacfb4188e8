"""Real files stand beside the repository, never in it."""

import os
from pathlib import Path

import pytest

from tests.paths import SHARED

_DATA = SHARED / "data"


@pytest.fixture(scope="session")
def shared() -> Path:
    if not _DATA.is_dir():
        if os.environ.get("FIELDMON_REQUIRE_DATA"):
            pytest.fail(f"the real data folder {_DATA} must be here, but it is not")
        pytest.skip(f"the real data folder {_DATA} is not on this machine")
    return _DATA
