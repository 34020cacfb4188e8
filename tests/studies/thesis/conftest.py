"""The reference of the published simulator stands beside the repository, never in it."""

import os
from pathlib import Path

import pytest

from fieldmon.studies.thesis.chapter4.study import NoPriorStudy, run_no_prior
from tests.paths import SHARED

_REFERENCE = SHARED / "reference" / "no_prior"


@pytest.fixture(scope="session")
def no_prior() -> Path:
    if not _REFERENCE.is_dir():
        if os.environ.get("FIELDMON_REQUIRE_DATA"):
            pytest.fail(f"the reference folder {_REFERENCE} must be here, but it is not")
        pytest.skip(f"the reference folder {_REFERENCE} is not on this machine")
    return _REFERENCE


@pytest.fixture(scope="session")
def everything() -> NoPriorStudy:
    """Return all tables, made once for the tests of studies and report."""
    return run_no_prior("all", 12, 1)
