"""Layers reach the browser as pydeck writes them, compact, each written and published once."""

import json

import numpy as np
import pydeck as pdk
import pytest
import shapely

from app.show.maps import deck
from app.state.map_store import JSON, STORE
from fieldmon.plot.field import Field
from tests.app.chosen import CORNER, a_plot


def a_layer(**more):
    return pdk.Layer("ScatterplotLayer", [{"p": [1.5, 2.0]}], id="one", get_position="p", **more)


def test_a_layer_is_published_as_pydeck_s_own_json_without_white_space():
    layer = a_layer(get_fill_color=[1, 2, 3])
    sent = deck.published(layer)
    kind, text = STORE.get(sent["url"])
    theirs = json.loads(pdk.Deck(layers=[layer], map_provider=None).to_json())["layers"]
    assert (kind, json.loads(text)) == (JSON, theirs[0])
    assert b" " not in text
    assert sent["id"] == "one"


def test_the_same_content_has_one_address_and_another_content_another():
    first, same, other = (deck.published(a_layer(get_radius=r))["url"] for r in (1, 1, 2))
    assert first == same != other


def test_arrays_travel_beside_the_json_and_not_in_it():
    ranks, places = bytes(range(5)), b"\0" * 128
    layer = deck.ArraysLayer("PlantsLayer", {"ranks": ranks, "places": places}, id="p", radius=1.5)
    sent = deck.published(layer)
    assert STORE.get(sent["ranks"])[1] == ranks
    assert STORE.get(sent["places"])[1] == places
    made = json.loads(STORE.get(sent["url"])[1])
    assert (made["@@type"], made["id"], made["radius"]) == ("PlantsLayer", "p", 1.5)
    assert "arrays" not in made


def test_what_must_be_in_view_holds_every_plant_and_little_else():
    plot = a_plot()
    west, south, east, north = deck.of_grid(plot.grid)
    lonlat = plot.grid.lonlat()
    assert (lonlat.min(axis=0) >= [west, south]).all()
    assert (lonlat.max(axis=0) <= [east, north]).all()
    outline = [*CORNER, CORNER[0] + 0.0006, CORNER[1] + 0.0006]
    assert [west, south, east, north] == pytest.approx(outline, abs=2e-6)


def test_outline_holes_and_no_go_areas_are_drawn():
    plot = a_plot()
    hole = shapely.box(35.1502, 30.3602, 35.1503, 30.3603)
    around = shapely.MultiPolygon([plot.field.boundary.geoms[0] - hole])
    field = Field("holed", around, no_go=shapely.MultiPolygon([hole]))
    drawn = [np.array(row["path"]) for row in deck.boundary(field).data]
    assert len(drawn) == 3
    assert drawn[1] == pytest.approx(np.array(around.geoms[0].interiors[0].coords))
    light, dark = (deck.boundary(field, dark=dark).get_color for dark in (False, True))
    assert sum(dark) > sum(light)


def test_an_outline_stays_a_line_where_a_small_plot_fills_the_map():
    sent = json.loads(deck.outline(a_plot().field, "boundary", (0, 0, 0)).to_json())
    assert sent["widthMaxPixels"] <= 3
