"""The map on a page: named for those who cannot see it, and each tap heard once."""

import pytest
import streamlit as st

from app.show import field_map
from app.show.maps import deck
from tests.app.driving import go, layer


def test_the_map_says_what_is_on_it(app):
    (chart,) = app.get("deck_gl_json_chart")
    n, stops = len(layer(app, "plants")["data"]), len(layer(app, "numbers")["data"])
    assert stops > 3
    assert f"Map of plot Gate: {n} plants, " in chart.proto.alt
    go(app, "plot")
    assert "0 stops on the route" in app.get("deck_gl_json_chart")[0].proto.alt


def test_what_is_tapped_is_told_by_its_layer_and_can_be_tapped_again(session):
    heard = []
    session["map"] = st.empty  # stands for the chart's state
    for name in ("plants", f"plants{deck.RENAMED}", "plants"):
        session["map"] = Tapped({name: [{"i": 7}]})
        field_map._tapped("map", heard.append)
        # the layer has another name from now on: Streamlit selects nothing on it any more
        assert session["renamed map"] == ({"plants"} if len(heard) % 2 else frozenset())
    assert heard == [{"plants": [{"i": 7}]}] * 3


class Tapped:
    def __init__(self, objects):
        self.selection = self
        self.objects = objects


def test_a_legend_is_shown_for_each_layer_that_has_one(monkeypatch):
    said = []
    monkeypatch.setattr(st, "caption", said.append)
    field_map.signs(["plants", "hot", "route"])
    (caption,) = said
    assert caption.count(" · ") == 1
    assert "hot spots" in caption
    assert "green ring" in caption


@pytest.mark.parametrize("page", ["today", "map", "plot", "simulate"])
def test_every_map_has_an_outline_below_all_else(app, page):
    go(app, page)
    first = layer(app, "boundary")
    assert first is not None
