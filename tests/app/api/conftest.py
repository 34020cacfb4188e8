"""A season that is served, and keys for it."""

import shutil
from types import SimpleNamespace

import pytest

from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import scouts
from tests.monitoring.seasons import BEGINS, a_season, some_results


@pytest.fixture(scope="session")
def planned_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("planned") / "season.gpkg"
    season = a_season(path)
    season.plan(BEGINS)
    season.record(some_results(season, n=4, found=[2]), "monday.csv", "Old")
    return path


@pytest.fixture
def served(planned_file, tmp_path, monkeypatch):
    """Serve a season of its own; give it, its folder, and Ann's key."""
    monkeypatch.setenv("FIELDMON_SEASONS", str(tmp_path))
    season = Season(shutil.copy(planned_file, tmp_path / "season.gpkg"))
    return SimpleNamespace(season=season, folder=tmp_path, key=scouts.let_in(season, "Ann"))
