"""pydeck's layers as the browser gets them: compact JSON, written once, under its address."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
import shapely
from pydeck import Layer
from pydeck.bindings.json_tools import default_serialize

from ...state.map_store import JSON, STORE
from . import colours

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

# layers are not changed once made; their texts go when they do
_WRITTEN: WeakKeyDictionary[Layer, bytes] = WeakKeyDictionary()


class ArraysLayer(Layer):
    """A layer of pydeck's whose data are arrays, sent as bytes beside its JSON.

    Parameters
    ----------
    arrays
        The bytes by the names under which the browser knows them.
    """

    def __init__(self, kind: str, arrays: dict[str, bytes], **settings: object) -> None:
        super().__init__(kind, None, **settings)  # type: ignore[no-untyped-call]  # pydeck's own
        self.arrays = arrays


def published(layer: Layer) -> dict[str, str]:
    """Return where the browser finds a layer: its name, and the addresses of its parts."""
    text = _WRITTEN.get(layer)
    if text is None:
        text = _WRITTEN[layer] = _json(layer).encode()
    parts = layer.arrays if isinstance(layer, ArraysLayer) else {}
    return {
        "id": layer.id,
        "url": STORE.publish(text, JSON),
        **{name: STORE.publish(data) for name, data in parts.items()},
    }


def _json(thing: object) -> str:
    return json.dumps(thing, sort_keys=True, default=_attributes, separators=(",", ":"))


def _attributes(thing: object) -> object:
    made = default_serialize(thing)
    if isinstance(made, dict):
        made.pop("arrays", None)
    return made


def of_grid(grid: PlantGrid) -> list[float]:
    """Return what a plot covers: west, south, east, north."""
    return _bounds(grid.frame.lonlat(shapely.get_coordinates(grid.drivable_m)))


def _bounds(corners: NDArray[np.float64]) -> list[float]:
    return [*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist()]


def boundary(field: Field, *, dark: bool = False) -> Layer:
    """Return the plot's outline, holes and no-go areas."""
    return outline(field, "boundary", colours.OUTLINE_IN_DARK if dark else colours.OUTLINE)


def outline(field: Field, name: str, colour: colours.Colour) -> Layer:
    """Return the same in a colour, under a name."""
    rings = [
        {"path": np.round(shapely.get_coordinates(ring), 7).tolist()}
        for area in (field.boundary, field.no_go)
        for ring in shapely.get_rings(shapely.get_parts(area))
    ]
    return Layer(
        "PathLayer",
        rings,
        id=name,
        get_path="path",
        get_color=list(colour),
        get_width=0.5,
        width_min_pixels=1.5,
        width_max_pixels=3,  # a line, however small the plot is that fills the map
    )
