"""Shapes that stand in a column of a table (WKT, WKB in hex), as QGIS and databases export them."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import shapely
from shapely.errors import GEOSException

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import WGS84, Layer, text
from fieldmon.io.formats.wkb import closed, understood
from fieldmon.io.import_report import ImportMessage, dropped, guessed, seen
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

_WKT = re.compile(
    r"\s*(?:SRID\s*=\s*(\d+)\s*;)?\s*((?:(?:MULTI)?(?:POINT|LINESTRING|POLYGON)|GEOMETRYCOLLECTION)"
    r"\s*(?:ZM|Z|M)?\s*(?:\(.*\)|EMPTY))\s*",
    re.IGNORECASE | re.DOTALL,
)
_CURVES = re.compile(
    r"\s*(?:SRID\s*=\s*\d+\s*;)?\s*(CIRCULARSTRING|COMPOUNDCURVE|CURVEPOLYGON|MULTICURVE|MULTISURFACE"
    r"|POLYHEDRALSURFACE|TIN|TRIANGLE)\s*(?:ZM|Z|M)?\s*(?:\(|EMPTY)",
    re.IGNORECASE,
)
_HEX = re.compile(r"\s*(?:\\x|0x)?((?:[\dA-F]{2}){9,})\s*", re.IGNORECASE)
_ORDERS: dict[int, Literal["big", "little"]] = {0: "big", 1: "little"}
#: kinds of shapes in WKB: points, lines, areas and collections of them; then curves and surfaces
_KINDS, _COLLECTION, _CURVED = range(1, 18), 7, range(8, 18)
#: what stands with the kind: that a system follows, and, as some write it, heights and measures
_WITH_SYSTEM, _KIND = 0x20000000, 0x0FFFFFFF
_LOOKED_AT = 50


class _Cell(NamedTuple):
    """A shape as it stands in a cell: as text or as bytes; neither where it is a curve."""

    wkt: str | None
    wkb: bytes | None
    srid: int


def with_shapes(layer: Layer, stated: str | None) -> Layer:
    """Return a table with its column of shapes as geometry; as it is where it has none.

    Parameters
    ----------
    layer
        The table.
    stated
        The coordinate system that a file beside it states, or None.

    Raises
    ------
    FileProblem
        Where shapes are curves.
    """
    name = _column(layer)
    if name is None:
        return layer
    cells = [_read(text(v)) for v in layer.columns[name]]
    curved = [k for k, cell in enumerate(cells) if cell and cell.wkt is None is cell.wkb]
    if curved:
        raise _about_curves(layer.name, name, curved[0])
    there = np.array([cell is not None for cell in cells], dtype=bool)
    as_text, as_bytes = (
        np.array([cell and cell[part] for cell in cells], dtype=object) for part in (0, 1)
    )
    try:
        geometry, mended = understood(as_bytes, as_text)
        shapely.get_coordinates(geometry[shapely.get_type_id(geometry) == _COLLECTION])
    except (NotImplementedError, GEOSException):  # curves in a collection
        raise _about_curves(layer.name, name, int(np.flatnonzero(there)[0])) from None
    limits.check(
        "vertices", int(shapely.get_num_coordinates(geometry).sum()), limits.VERTICES, layer.name
    )
    messages = [
        seen(worded("Shapes are in column {name!r}.", name=name)),
        *_about(layer, name, geometry, int(mended.sum())),
    ]
    systems = {cell.srid for cell in cells if cell and cell.srid}
    crs = f"EPSG:{systems.pop()}" if len(systems) == 1 else stated
    if crs is None and _could_be_degrees(geometry):
        crs = WGS84
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
        if some and all(_read(cell) is not None for cell in some):
            return name
    return None


def _read(cell: str) -> _Cell | None:
    """Return the shape that a cell holds, not understood yet; None where it holds none."""
    if found := _WKT.fullmatch(cell):
        return _Cell(found[2], None, int(found[1] or 0))
    if _CURVES.match(cell):
        return _Cell(None, None, 0)
    found = _HEX.fullmatch(cell)
    raw = bytes.fromhex(found[1]) if found else b"\xff"
    if (order := _ORDERS.get(raw[0])) is None:
        return None
    code = int.from_bytes(raw[1:5], order)
    if (code & _KIND) % 1000 not in _KINDS or (code & _KIND) > 4000:
        return None
    srid = int.from_bytes(raw[5:9], order) if code & _WITH_SYSTEM else 0
    return _Cell(None, None if (code & _KIND) % 1000 in _CURVED else raw, srid)


def _about_curves(file: str, column: str, record: int) -> FileProblem:
    return FileProblem(
        worded(
            "Shapes must have straight edges, but column {column!r} of {file} holds curves or "
            'surfaces, the first in record {number}. Make them straight first ("segmentize" in a '
            "GIS, ST_CurveToLine in a database).",
            column=column,
            file=file,
            number=record + 1,
        )
    )


def _about(
    layer: Layer, name: str, geometry: NDArray[np.object_], n_closed: int
) -> list[ImportMessage]:
    messages = [closed(n_closed)] if n_closed else []
    said = np.array([bool(text(v)) for v in layer.columns[name]], dtype=bool)
    if (n := int((shapely.is_missing(geometry) & said).sum())) > 0:
        messages.append(
            dropped(worded("{n} {n:shape|shapes} cannot be understood; left out.", n=n), name)
        )
    return messages


def _could_be_degrees(geometry: NDArray[np.object_]) -> bool:
    xy = shapely.get_coordinates(geometry)
    return bool(len(xy)) and bool((np.abs(xy) <= (180, 90)).all())
