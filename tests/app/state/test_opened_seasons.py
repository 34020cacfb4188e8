"""Pages and phones share one season a file, and another file of that name is another season."""

import shutil
from concurrent.futures import ThreadPoolExecutor

import pytest

from app.state.opened_seasons import opened
from fieldmon.errors import FileProblem
from tests.monitoring.seasons import a_season


def test_all_who_ask_get_the_same_until_the_file_is_another(tmp_path):
    a_season(tmp_path / "a.gpkg")
    with ThreadPoolExecutor(4) as threads:
        got = list(threads.map(opened, [tmp_path / "a.gpkg"] * 8))
    assert len({id(season) for season in got}) == 1
    shutil.copy(tmp_path / "a.gpkg", tmp_path / "b.gpkg")
    (tmp_path / "b.gpkg").replace(tmp_path / "a.gpkg")
    assert opened(tmp_path / "a.gpkg") is not got[0]


def test_a_season_that_is_not_there_is_a_sentence(tmp_path):
    with pytest.raises(FileProblem):
        opened(tmp_path / "none.gpkg")
