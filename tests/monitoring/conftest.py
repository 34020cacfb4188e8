"""Seasons that tests of this room begin from."""

import shutil
import sqlite3
from contextlib import closing

import pytest

from fieldmon.monitoring import Season, kept_open
from fieldmon.monitoring.file import schema
from tests.monitoring.seasons import BEGINS, a_season, some_results


@pytest.fixture(autouse=True)
def opened_once():
    """Let a test open each season's file once, as pages and commands do."""
    with kept_open():
        yield


@pytest.fixture(scope="session")
def recorded(tmp_path_factory):
    """Make a season with a route and twelve inspections, three of them finds; once."""
    path = tmp_path_factory.mktemp("recorded") / "season.gpkg"
    season = a_season(path)
    season.plan(BEGINS)
    season.record(some_results(season, n=12, found=[2, 3, 4]), "monday.csv", "Ann")
    made = path.read_bytes()
    yield path
    assert path.read_bytes() == made, "a test wrote to the season of which others take copies"


@pytest.fixture
def path(recorded, tmp_path):
    """Give a copy of that season."""
    return shutil.copy(recorded, tmp_path / "season.gpkg")


@pytest.fixture(scope="session")
def begun(tmp_path_factory):
    """Begin a season, once; return its file."""
    return a_season(tmp_path_factory.mktemp("begun") / "season.gpkg").path


@pytest.fixture
def season(begun, tmp_path):
    """Give a season in which nothing was done yet, a copy for each test."""
    return Season(shutil.copy(begun, tmp_path / "season.gpkg"))


@pytest.fixture
def db():
    """Give an empty season in memory: its tables, and nothing in them."""
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
        schema.lay_out(connection)
        yield connection


@pytest.fixture
def other(path, tmp_path):
    """Give another copy of `path`."""
    return shutil.copy(path, tmp_path / "other.gpkg")
