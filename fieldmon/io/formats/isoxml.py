"""Partfields of an ISOXML (TASKDATA.XML), as terminals of tractors keep them.

Source: ISO 11783-10:2015, annex D: partfields (PFD) have polygons (PLN) of line strings (LSG) of
points (PNT), in degrees WGS 84. A ring need not end where it begins: it is closed by its type.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from shapely.errors import ShapelyError

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import WGS84, Layer
from fieldmon.io.import_report import ImportMessage, dropped, seen
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

_BOUNDARY, _EXTERIOR, _INTERIOR = "1", "1", "2"
_POLYGONS = {
    "2": "treatment zone",
    "3": "water surface",
    "4": "building",
    "5": "road",
    "6": "obstacle",
    "7": "flag",
    "8": "other area",
    "9": "main field",
    "10": "headland",
}
_LINES = {
    "3": "tram line",
    "4": "sampling route",
    "5": "guidance line",
    "6": "drainage",
    "7": "fence",
    "8": "flag",
    "9": "obstacle",
}
_NO_SHAPE = (ShapelyError, ValueError, TypeError, KeyError)


class _Part(NamedTuple):
    """One shape of a partfield, and what it is."""

    name: str
    kind: str
    shape: shapely.Geometry


class _Builder(ET.TreeBuilder):
    """Builds the elements, and refuses what expands into others."""

    def doctype(self, *_: object) -> None:
        """Refuse a document type: ISOXML has none."""
        raise FileProblem(
            worded(
                "An ISOXML must not define a document type of its own, but "
                "this one does. Do not trust it."
            )
        )


def read_isoxml(path: Path, name: str) -> Layer:
    """Return partfields as areas, and their lines and points, with name and kind."""
    parts: list[_Part] = []
    others: dict[str, int] = {}
    broken: list[str] = []
    trees, messages = _trees(path, name)
    for tree in trees:
        for partfield in tree.iter("PFD"):
            found, left, bad = _parts_of(partfield)
            parts += found
            broken += bad
            for kind in left:
                others[kind] = others.get(kind, 0) + 1
            limits.check("features", len(parts), limits.FEATURES, name)
    if others:
        told = ", ".join(f"{kind} ({n})" for kind, n in others.items())
        messages.append(
            seen(
                worded(
                    "Areas that are no outlines of partfields were passed over: {told}.", told=told
                )
            )
        )
    messages += [
        dropped(worded("Its shape cannot be understood; left out."), one) for one in broken
    ]
    if not parts:
        raise FileProblem(
            worded(
                "{name} must hold at least one partfield with an outline, but "
                "it holds none. Export the partfields with their boundaries.",
                name=name,
            )
        )
    return _layer(name, parts, messages)


def _layer(name: str, parts: list[_Part], messages: list[ImportMessage]) -> Layer:
    geometry = _objects([part.shape for part in parts])
    limits.check(
        "vertices", int(shapely.get_num_coordinates(geometry).sum()), limits.VERTICES, name
    )
    columns = {
        "name": _objects([part.name for part in parts]),
        "kind": _objects([part.kind for part in parts]),
    }
    return Layer(name, columns, geometry, WGS84, tuple(messages))


def _trees(path: Path, name: str) -> tuple[list[ET.Element], list[ImportMessage]]:
    """Return the file's elements and those of the files that it leads to, beside it."""
    main = _tree(path, name)
    trees, messages = [main], []
    beside = {other.name.casefold(): other for other in path.parent.iterdir()}
    for reference in main.iter("XFR"):
        called = f"{reference.get('A', '')}.XML"
        other = beside.get(called.casefold())
        if other is not None and other != path:
            trees.append(_tree(other, called))
        elif called.startswith("PFD"):
            messages.append(
                dropped(
                    worded(
                        "It leads to {called}, which is not beside it: those partfields lack.",
                        called=called,
                    )
                )
            )
    return trees, messages


def _tree(path: Path, name: str) -> ET.Element:
    try:
        # a document type, where entities would be defined, is refused by the builder
        return ET.parse(path, ET.XMLParser(target=_Builder())).getroot()  # noqa: S314
    except (ET.ParseError, ValueError, LookupError) as bad:
        raise FileProblem(
            worded(
                "{name} must be a whole ISOXML, but it cannot be read "
                "({bad}). Export or download it again.",
                name=name,
                bad=bad,
            )
        ) from bad


def _parts_of(partfield: ET.Element) -> tuple[list[_Part], list[str], list[str]]:
    """Return the shapes of a partfield, the kinds of areas passed over, and what is broken."""
    name = partfield.get("C") or partfield.get("B") or partfield.get("A") or "partfield"
    polygons = partfield.findall("PLN")
    left = [
        _POLYGONS.get(p.get("A", ""), "other area") for p in polygons if p.get("A") != _BOUNDARY
    ]
    parts, broken = [], []
    try:
        areas = [a for p in polygons if p.get("A") == _BOUNDARY for a in _areas(p)]
        if areas:
            parts.append(_Part(name, "partfield", shapely.MultiPolygon(areas)))
    except _NO_SHAPE:
        broken.append(name)
    for kind, called, shape in _others(partfield):
        if shape is None:
            broken.append(f"{name}, {called or kind}")
        else:
            parts.append(_Part(called or name, kind, shape))
    return parts, left, broken


def _areas(polygon: ET.Element) -> list[shapely.Polygon]:
    """Return the areas of a polygon: its outer rings, each with the holes that lie in it."""
    rings = [(ring.get("A"), _positions(ring)) for ring in polygon.findall("LSG")]
    outer = [shapely.Polygon(xy) for kind, xy in rings if kind == _EXTERIOR]
    holes = [shapely.LinearRing(xy) for kind, xy in rings if kind == _INTERIOR]
    return [
        shapely.Polygon(
            area.exterior,
            [
                hole
                for hole in holes
                if len(outer) == 1 or area.contains(shapely.Point(hole.coords[0]))
            ],
        )
        for area in outer
    ]


def _others(partfield: ET.Element) -> Iterator[tuple[str, str, shapely.Geometry | None]]:
    """Yield kind, name and shape of lines and points; no shape where it is broken."""
    lines = [*partfield.findall("LSG"), *partfield.iterfind(".//GPN/LSG")]
    for line in lines:
        kind = _LINES.get(line.get("A", ""), "line")
        try:
            xy = _positions(line)
            # a guidance line may be one point and a bearing (A+): it is no line here
            shape = shapely.LineString(xy) if len(xy) > 1 else shapely.Point(xy[0])
        except (*_NO_SHAPE, IndexError):
            yield kind, line.get("B", ""), None
            continue
        yield kind, line.get("B", ""), shape
    for point in partfield.findall("PNT"):
        try:
            yield "point", point.get("B", ""), shapely.Point(_position(point))
        except _NO_SHAPE:
            yield "point", point.get("B", ""), None


def _positions(line: ET.Element) -> list[tuple[float, float]]:
    return [_position(point) for point in line.findall("PNT")]


def _position(point: ET.Element) -> tuple[float, float]:
    """Return longitude and latitude: attributes D (east) and C (north)."""
    return float(point.attrib["D"]), float(point.attrib["C"])


def _objects(values: list[object] | list[str] | list[shapely.Geometry]) -> NDArray[np.object_]:
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column
