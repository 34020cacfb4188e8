"""A season that another program holds: it is said, and counted, and nobody waits for ever."""

import re
import sqlite3
from contextlib import closing, contextmanager
from pathlib import Path

import pytest
import streamlit as st

from app.state import estate, season_held, seasons_folder
from app.views import plots as plots_view
from app.words import texts
from fieldmon.errors import FileProblem
from fieldmon.monitoring.changes import transactions
from fieldmon.monitoring.file import connections
from tests.app.driving import broken, go, press, texts_of
from tests.pages import Page


@contextmanager
def another_program(path, how="EXCLUSIVE"):
    """Hold a season's file as another program does."""
    with closing(sqlite3.connect(path, isolation_level=None)) as db:
        db.execute(f"BEGIN {how}")
        yield db
        db.execute("ROLLBACK")


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(connections, "_PATIENCE_S", 0.2)
    monkeypatch.setattr(transactions, "_GLANCE_S", 0.01)
    monkeypatch.setattr(connections, "_ASK_AGAIN_S", 0.02)
    monkeypatch.setattr(connections, "_MOMENT_S", 0.0)


class Place(list):
    """Stands for a place on the page: what was shown there."""

    html = list.append

    def empty(self):
        self.append("")


def test_who_waits_is_told_for_what_and_for_how_long_until_it_is_over(monkeypatch):
    places = []

    def wait(_, tell, **__):
        for waited_s in (1.2, 2.4):
            tell(waited_s)
        return True

    monkeypatch.setattr(season_held, "wait_until_free", wait)
    monkeypatch.setattr(st, "empty", lambda: places.append(Place()) or places[-1])
    season_held.wait(Path("<b>Gate.gpkg"))
    (place,) = places
    assert [re.findall(r"\d seconds?", one) for one in place] == [["1 second"], ["2 seconds"], []]
    assert place[-1] == ""
    page = Page(place[0])
    assert "<b>Gate" in page.text
    assert ("div", {"class": "held", "role": "status"}) in page.elements


def test_a_season_that_stays_held_is_a_sentence_and_nothing_is_left_on_the_page(
    monkeypatch, speaking
):
    place = Place()
    monkeypatch.setattr(st, "empty", lambda: place)
    monkeypatch.setattr(season_held, "wait_until_free", lambda _, tell, **__: tell(3.0) or False)
    with pytest.raises(FileProblem, match=r"Another program holds the season .*Gate"):
        season_held.wait(Path("Gate.gpkg"))
    assert place[-1] == ""
    speaking("he")
    with pytest.raises(FileProblem, match="תוכנה אחרת"):
        season_held.wait(Path("Gate.gpkg"))


@pytest.mark.usefixtures("impatient")
def test_a_page_of_a_held_season_says_so_where_its_map_would_be_and_comes_back(season_app):
    path = seasons_folder.path_of("Gate 2026")
    with another_program(path):
        season_app.run()
        assert not season_app.exception
        assert "Another program holds the season" in texts_of(season_app)
        assert texts.NO_MAP["season"] in texts_of(season_app)
        assert season_app.button(key="no_map_again").label == "Try again"
    press(season_app, "Try again")
    assert not season_app.error
    assert "Another program" not in texts_of(season_app)


@pytest.mark.usefixtures("impatient")
def test_a_tap_on_a_season_that_cannot_be_written_says_so_and_records_nothing(season_app, season):
    go(season_app, "scout")
    before = len(season().history.inspections)
    with another_program(seasons_folder.path_of("Gate 2026"), "IMMEDIATE"):
        season_app.button(key="scout_clean").click().run()
        assert not season_app.exception
        assert "Another program holds the season" in season_app.error[0].value
    assert len(season().history.inspections) == before


@pytest.mark.usefixtures("impatient")
def test_all_plots_are_shown_but_the_one_that_another_program_holds(season_app, season):
    there = season().path
    (there.parent / "Free.gpkg").write_bytes(there.read_bytes())
    with another_program(there):
        go(season_app, "plots")
        assert not season_app.exception
        (said,) = season_app.warning
        assert said.value.startswith("Another program holds the season")
        assert "Free" in season_app.dataframe[0].value["plot"].tolist()


@pytest.mark.usefixtures("impatient", "season_app")
def test_a_season_is_looked_at_again_until_another_program_holds_it_no_more(season, monkeypatch):
    there, name = season().path, "Gate 2026"
    broken(there.with_name("Broken.gpkg"))
    runs = []
    monkeypatch.setattr(st, "rerun", lambda: runs.append(1))
    with another_program(there):
        _, problems = estate.plots()
        assert [one.held for one in problems] == ["", name]
        plots_view._watch([name])
        assert not runs
    plots_view._watch([name])
    assert runs == [1]
