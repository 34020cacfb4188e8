"""The map's first view holds the whole plot; its JSON is compact and each layer written once."""

import json

import numpy as np
import pydeck as pdk
import pytest
import shapely

from app.show.maps import deck
from fieldmon.plot.field import Field
from tests.app.chosen import a_plot

WORLD = 512


def on_screen(view, lonlat):
    """Return pixels from the middle of the map, by Web Mercator."""
    y = np.rad2deg(np.log(np.tan(np.pi / 4 + np.deg2rad(lonlat[:, 1]) / 2)))
    middle = np.rad2deg(np.log(np.tan(np.pi / 4 + np.deg2rad(view.latitude) / 2)))
    px = WORLD * 2.0**view.zoom / 360
    return np.abs(np.stack([lonlat[:, 0] - view.longitude, y - middle], axis=1)) * px


@pytest.mark.parametrize("room", [deck.PAGE_PX, deck.MOST_PX, deck.HALF_PX, deck.PHONE_PX])
@pytest.mark.parametrize("span", [(0.004, 0.001), (0.001, 0.004), (0.002, 0.002)])
@pytest.mark.parametrize("lat", [-34.0, 0.0, 30.3, 52.0])
def test_the_whole_plot_is_in_view_and_fills_it(room, span, lat):
    corners = np.array([[35.0, lat], [35.0 + span[0], lat + span[1]]])
    away = on_screen(deck.view(corners, room), corners)
    share = (away * 2 / room).max(axis=0)
    assert share.max() == pytest.approx(0.85, abs=0.01)


def test_the_view_depends_on_the_plot_alone():
    plot = a_plot()
    empty, full = (deck.deck(plot.grid, layers) for layers in ([], [deck.boundary(plot.field)]))
    assert empty.initial_view_state.to_json() == full.initial_view_state.to_json()
    assert empty.map_provider is None


def test_an_outline_is_seen_from_where_the_plot_is_seen_later():
    plot = a_plot()
    early, later = (
        deck.outline(plot.field).initial_view_state,
        deck.deck(plot.grid, []).initial_view_state,
    )
    assert early.zoom == pytest.approx(later.zoom, abs=0.1)
    assert (early.longitude, early.latitude) == pytest.approx(
        (later.longitude, later.latitude), abs=1e-4
    )


def test_outline_holes_and_no_go_areas_are_drawn():
    plot = a_plot()
    hole = shapely.box(35.1502, 30.3602, 35.1503, 30.3603)
    around = shapely.MultiPolygon([plot.field.boundary.geoms[0] - hole])
    field = Field("holed", around, no_go=shapely.MultiPolygon([hole]))
    assert len(deck.boundary(field).data) == 3
    light, dark = (deck.boundary(field, dark=dark).get_color for dark in (False, True))
    assert sum(dark) > sum(light)


def test_json_is_what_pydeck_writes_without_white_space():
    layer = pdk.Layer("ScatterplotLayer", [{"p": [1.5, 2.0]}], id="one", get_position="p")
    ours = deck.Deck(layers=[layer], map_provider=None)
    theirs = pdk.Deck(layers=[layer], map_provider=None)
    assert json.loads(ours.to_json()) == json.loads(theirs.to_json())
    assert " " not in ours.to_json().replace("Scatterplot Layer", "")
    assert ours.to_json() == ours.to_json()


def test_a_renamed_layer_has_another_id_and_the_same_content():
    layers = [pdk.Layer("ScatterplotLayer", [{"p": [1, 2]}], id=name, get_position="p")
              for name in ("plants", "plants-part")]  # fmt: skip
    made = deck.Deck(layers=layers, map_provider=None)
    made.renamed = frozenset({"plants"})
    first, second = json.loads(made.to_json())["layers"]
    assert (first["id"], second["id"]) == ("plants~", "plants-part")
    assert first["data"] == second["data"]
