"""The map itself: layers become the page's JSON, seen from where the whole plot is in view."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
import pydeck as pdk
import shapely
from pydeck.bindings.json_tools import default_serialize

from . import colours

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

Layer = pdk.Layer
#: room for a map, width and height: a whole page, most or half of it beside something else
PAGE_PX, MOST_PX, HALF_PX, PHONE_PX = (720, 480), (620, 480), (500, 480), (340, 380)
_TILE_PX = 512
# after a layer's name: the same layer once more
RENAMED = "~"
# layers are not changed once made; their texts go when they do
_WRITTEN: WeakKeyDictionary[Layer, str] = WeakKeyDictionary()


class Deck(pdk.Deck):
    """A deck whose JSON has no white space, and whose layers are written once each.

    Half the size and several times the speed; a layer that is shown again costs nothing.
    Layers in `renamed` have another id in the page: what was tapped on them is not selected there
    any more, and Streamlit no longer fades everything else.
    """

    renamed: frozenset[str] = frozenset()

    def to_json(self) -> str:
        """Return the deck as compact JSON."""
        layers, self.layers = self.layers, []
        try:
            frame = _json(self)
        finally:
            self.layers = layers
        texts = ",".join(self._named(layer) for layer in layers)
        return frame.replace('"layers":[]', f'"layers":[{texts}]', 1)

    def _named(self, layer: Layer) -> str:
        text, name = _layer_json(layer), json.dumps(layer.id)
        if layer.id not in self.renamed:
            return text
        return text.replace(f'"id":{name}', f'"id":{json.dumps(layer.id + RENAMED)}', 1)


def _layer_json(layer: Layer) -> str:
    text = _WRITTEN.get(layer)
    if text is None:
        text = _WRITTEN[layer] = _json(layer)
    return text


def _json(thing: object) -> str:
    return json.dumps(thing, sort_keys=True, default=default_serialize, separators=(",", ":"))


def deck(
    grid: PlantGrid, layers: list[Layer], room_px: tuple[int, int] = PAGE_PX
) -> Deck:  # fmt: skip
    """Return the map of a plot; its first view depends on the plot and the room for it alone."""
    return Deck(
        layers=layers,
        initial_view_state=view(
            grid.frame.lonlat(shapely.get_coordinates(grid.drivable_m)), room_px
        ),
        map_provider=None,
        tooltip={"html": "{t}", "style": {"fontSize": "13px"}},
    )


def outline(
    field: Field, room_px: tuple[int, int] = PAGE_PX, *, dark: bool = False
) -> Deck:  # fmt: skip
    """Return the map of a plot on which no plants are laid yet."""
    return Deck(
        layers=[boundary(field, dark=dark)],
        initial_view_state=view(shapely.get_coordinates(field.boundary), room_px),
        map_provider=None,
    )


def view(corners: NDArray[np.float64], room_px: tuple[int, int]) -> pdk.ViewState:
    """Return the view that holds corners ``(n, 2)`` lon/lat where there is so much room."""
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    low, high = (_mercator(lat) for lat in (south, north))
    room = [
        np.log2(360.0 * px * 0.85 / (_TILE_PX * span))
        for px, span in zip(room_px, (east - west, high - low), strict=True)
        if span > 0
    ]
    return pdk.ViewState(
        longitude=float((west + east) / 2),
        latitude=float((south + north) / 2),
        zoom=float(min([*room, 21.0])),
        max_zoom=24,
        bearing=0,
        pitch=0,
    )


def boundary(field: Field, *, dark: bool = False) -> Layer:
    """Return the plot's outline, holes and no-go areas."""
    rings = [
        {"path": np.round(shapely.get_coordinates(ring), 7).tolist()}
        for area in (field.boundary, field.no_go)
        for ring in shapely.get_rings(shapely.get_parts(area))
    ]
    return Layer(
        "PathLayer",
        rings,
        id="boundary",
        get_path="path",
        get_color=list(colours.OUTLINE_IN_DARK if dark else colours.OUTLINE),
        get_width=0.5,
        width_min_pixels=1.5,
    )


def _mercator(lat: float) -> float:
    return float(np.rad2deg(np.log(np.tan(np.pi / 4 + np.deg2rad(lat) / 2))))
