"""Pages and phones share one season a file, and another file of that name is another season."""

import shutil
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import pytest

from app.state import cached, opened_seasons
from app.state.opened_seasons import opened
from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import FOUND
from tests.monitoring.inspecting.test_drafts import PLANT, add
from tests.monitoring.seasons import a_plot, a_season


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


def test_another_season_is_opened_while_one_cannot_be(tmp_path, monkeypatch):
    a_season(tmp_path / "b.gpkg")
    held, season = Event(), opened_seasons.Season

    def waiting(path):
        if path.name == "a.gpkg":
            held.wait()
            raise FileProblem("held")
        return season(path)

    monkeypatch.setattr(opened_seasons, "Season", waiting)
    with ThreadPoolExecutor(2) as threads:
        waits = [threads.submit(opened, tmp_path / "a.gpkg") for _ in range(2)]
        assert opened(tmp_path / "b.gpkg").path.name == "b.gpkg"
        assert not opened_seasons.is_open(tmp_path / "a.gpkg")
        held.set()
        for one in waits:
            with pytest.raises(FileProblem, match="held"):
                one.result()
    with pytest.raises(FileProblem, match="held"):
        opened(tmp_path / "a.gpkg")  # tried again


@pytest.mark.parametrize("ask", [opened, cached.season])
def test_a_finding_that_qgis_adds_while_the_season_is_open_counts_when_it_is_asked_for(
    tmp_path, ask
):
    a_season(tmp_path / "a.gpkg")
    before = ask(tmp_path / "a.gpkg")
    add(tmp_path / "a.gpkg")
    season = ask(tmp_path / "a.gpkg")
    assert season is before
    assert season.history.states(0)[PLANT] == FOUND
    add(tmp_path / "a.gpkg", plant=PLANT + 1, date=None)
    assert "no date" in ask(tmp_path / "a.gpkg").drafts[0]


def test_another_season_that_is_copied_into_the_file_is_the_one_that_is_shown(tmp_path):
    was = opened(a_season(tmp_path / "a.gpkg").path)
    other = a_season(tmp_path / "b.gpkg", a_plot(width=0.0009))
    assert opened(was.path) is was
    shutil.copyfile(other.path, was.path)
    now = opened(was.path)
    assert len(now.plot.grid) == len(other.plot.grid)
    assert now is opened(was.path)
    assert (now.revision, now.path) == (was.revision, was.path)
    assert now.key != was.key, "nothing that was shown of the other is shown of it"
