"""The address leads back to a season."""

import pytest
import streamlit as st

from app.state import plot_source
from app.words import texts
from tests.app.driving import go, opened, texts_of


def test_the_first_click_after_a_reload_stays_in_the_season(season_app):
    go(season_app, "field")
    assert season_app.selectbox(key="season").value == "Gate 2026"
    again = opened("Gate 2026")
    for page in ("season", "compare", "today"):
        go(again, page)
    assert again.selectbox(key="season").value == "Gate 2026"
    assert "first day of the season" in texts_of(again)
    assert again.query_params["season"] == "Gate 2026"


@pytest.mark.usefixtures("session")
def test_the_address_names_own_files_and_seasons_but_not_the_sample(monkeypatch):
    address = {}
    monkeypatch.setattr(st, "query_params", address)
    assert plot_source.chosen() == texts.SAMPLE
    plot_source.keep_in_address("Gate 2026")
    assert address == {"season": "Gate 2026"}
    plot_source.begin_from_address()
    assert plot_source.chosen() == "Gate 2026"
    plot_source.open_season("Pond 2026")
    plot_source.begin_from_address()  # as the next run does
    assert plot_source.chosen() == "Pond 2026"
    plot_source.keep_in_address(texts.SAMPLE)
    assert address == {}
