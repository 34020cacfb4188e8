"""Shapes that stand as text in a column of a table (WKT), as QGIS and databases export them."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.formats.wkb import closed
from fieldmon.io.import_report import ImportMessage, dropped, guessed, seen
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

_WKT = re.compile(
    r"\s*(?:SRID\s*=\s*(\d+)\s*;)?\s*((?:(?:MULTI)?(?:POINT|LINESTRING|POLYGON)|GEOMETRYCOLLECTION)"
    r"\s*(?:ZM|Z|M)?\s*(?:\(.*\)|EMPTY))\s*",
    re.IGNORECASE | re.DOTALL,
)
_LOOKED_AT = 50
_WGS84 = "OGC:CRS84"


def with_shapes(layer: Layer, stated: str | None) -> Layer:
    """Return a table with its column of shapes as geometry; as it is where it has none.

    Parameters
    ----------
    layer
        The table.
    stated
        The coordinate system that a file beside it states, or None.
    """
    name = _column(layer)
    if name is None:
        return layer
    cells = [_WKT.fullmatch(text(v)) for v in layer.columns[name]]
    bare = np.array([m.group(2) if m else None for m in cells], dtype=object)
    geometry = shapely.from_wkt(bare, on_invalid="ignore")
    there = np.array([m is not None for m in cells], dtype=bool)
    lost = shapely.is_missing(geometry) & there
    geometry[lost] = shapely.from_wkt(bare[lost], on_invalid="fix")
    limits.check(
        "vertices", int(shapely.get_num_coordinates(geometry).sum()), limits.VERTICES, layer.name
    )
    messages = [
        seen(worded("Shapes are in column {name!r}.", name=name)),
        *_about(layer, name, geometry, lost),
    ]
    systems = {m.group(1) for m in cells if m and m.group(1) not in {None, "0"}}
    crs = f"EPSG:{systems.pop()}" if len(systems) == 1 else stated
    if crs is None and _could_be_degrees(geometry):
        crs = _WGS84
        said = worded(
            "They name no coordinate system and were read as longitude and latitude (WGS 84)."
        )
        messages.append(guessed(said, name))
    columns = {own: values for own, values in layer.columns.items() if own != name}
    every = (*layer.messages, *messages)
    return replace(layer, columns=columns, geometry=geometry, crs=crs, messages=every)


def _column(layer: Layer) -> str | None:
    """Return the first column all of whose cells are shapes, or empty."""
    for name, values in layer.columns.items():
        some = [cell for v in values[:_LOOKED_AT] if (cell := text(v))]
        if some and all(map(_WKT.fullmatch, some)):
            return name
    return None


def _about(
    layer: Layer, name: str, geometry: NDArray[np.object_], lost: NDArray[np.bool_]
) -> list[ImportMessage]:
    missing = shapely.is_missing(geometry)
    messages = [closed(n)] if (n := int((lost & ~missing).sum())) else []
    said = np.array([bool(text(v)) for v in layer.columns[name]], dtype=bool)
    if (n := int((missing & said).sum())) > 0:
        messages.append(
            dropped(worded("{n} {n:shape|shapes} cannot be understood; left out.", n=n), name)
        )
    return messages


def _could_be_degrees(geometry: NDArray[np.object_]) -> bool:
    xy = shapely.get_coordinates(geometry)
    return bool(len(xy)) and bool((np.abs(xy) <= (180, 90)).all())
