"""What phones send shows on an open page without a press."""

import pytest
import streamlit as st

from app.actions import news
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.phones import scouts
from tests.app.chosen import in_season
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def looks(monkeypatch):
    """Return what is looked at again and again, and how often a page was drawn anew."""
    made, drawn = [], []

    def fragment(work, run_every):
        def look(*arguments):
            made.append(lambda: work(*arguments))
            assert run_every == news.LOOK_S

        return look

    monkeypatch.setattr(st, "fragment", fragment)
    monkeypatch.setattr(st, "rerun", lambda: drawn.append(1))
    return made, drawn


def test_a_page_is_drawn_anew_once_a_phone_sent_something(tmp_path, looks):
    made, drawn = looks
    season = a_season(tmp_path / "news.gpkg")
    choices = in_season(season)
    news.watch(choices)
    assert not made, "nobody has a code"
    scouts.let_in(season, "Ann")
    news.watch(choices)
    (look,) = made
    look()
    assert not drawn
    news.hold()
    news.watch(choices)
    assert len(made) == 1, "a dialog is open"
    season.record(Inspections.of([1], [0], BEGINS), "phone", "Ann")
    look()
    assert len(drawn) == 1
