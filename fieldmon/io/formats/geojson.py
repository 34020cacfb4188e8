"""GeoJSON, read feature by feature: one bad feature is dropped and named, the rest is kept."""

from __future__ import annotations

import gc
import json
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from shapely.errors import ShapelyError

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import WGS84, Layer
from fieldmon.io.formats.wkb import closed
from fieldmon.io.import_report import ImportMessage, dropped, seen
from fieldmon.io.parse.text import decode
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

_GEOMETRIES = frozenset(
    {
        "Point",
        "MultiPoint",
        "LineString",
        "MultiLineString",
        "Polygon",
        "MultiPolygon",
        "GeometryCollection",
    }
)

#: what a geometry that is none may raise
_NOT_GEOMETRY = (
    *(ShapelyError, ValueError, TypeError, LookupError, AttributeError),
    *(RecursionError, OverflowError),
)


def read_geojson(path: Path, name: str, encoding: str | None) -> Layer:
    """Return the one layer of a GeoJSON file (also newline-delimited)."""
    content, messages = decode(path.read_bytes(), encoding)
    root = _parsed(content, name)
    features = _features(root, name)
    limits.check("features", len(features), limits.FEATURES, name)
    geometry, more = _geometries(features, name)
    properties = [_properties(feature) for feature in features]
    columns = _columns(properties, name)
    crs, crs_messages = _crs(root)
    return Layer(name, columns, geometry, crs, (*messages, *more, *crs_messages))


@contextmanager
def _no_collection() -> Iterator[None]:
    """Keep Python from looking for garbage where millions of lists are made and none is left."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def _parsed(content: str, name: str) -> dict[str, Any]:
    try:
        with _no_collection():
            root = json.loads(content)
    except json.JSONDecodeError as bad:
        lines = _line_by_line(content)
        if lines is None:
            raise FileProblem(
                worded(
                    "{name} must be whole GeoJSON, but it breaks off or errs "
                    "in line {lineno}: {msg}. Export or download it again.",
                    name=name,
                    lineno=bad.lineno,
                    msg=bad.msg,
                )
            ) from bad
        root = lines
    except (RecursionError, ValueError) as bad:
        raise FileProblem(
            worded(
                "{name} must be GeoJSON as map programs write it, but it is "
                "nested or numbered beyond reason. Do not trust this file.",
                name=name,
            )
        ) from bad
    if isinstance(root, list):
        root = {"type": "FeatureCollection", "features": root}
    if not isinstance(root, dict):
        raise FileProblem(
            worded(
                "{name} must be GeoJSON, but it holds no object. Choose another file.", name=name
            )
        )
    return root


def _line_by_line(content: str) -> list[Any] | None:
    """Return the features of newline-delimited GeoJSON, or None where it is none."""
    lines = [line.strip("\x1e \t\r") for line in content.split("\n")]
    try:
        return [json.loads(line) for line in lines if line]
    except (RecursionError, ValueError):
        return None


def _features(root: dict[str, Any], name: str) -> list[dict[str, Any]]:
    kind = root.get("type")
    if kind == "FeatureCollection" and isinstance(root.get("features"), list):
        return [f if isinstance(f, dict) else {} for f in root["features"]]
    if kind == "Feature":
        return [root]
    if isinstance(kind, str) and kind in _GEOMETRIES:
        return [{"type": "Feature", "properties": {}, "geometry": root}]
    if kind == "Topology":
        raise FileProblem(
            worded("{name} is TopoJSON. Export it as GeoJSON or GeoPackage.", name=name)
        )
    if "rings" in root or "geometryType" in root:
        raise FileProblem(
            worded("{name} is Esri JSON. Export it as GeoJSON or GeoPackage.", name=name)
        )
    raise FileProblem(
        worded(
            "{name} must be a GeoJSON feature or collection of features, but "
            "its type is {kind!r}. Export it as GeoJSON.",
            name=name,
            kind=kind,
        )
    )


def _crs(root: dict[str, Any]) -> tuple[str | None, list[ImportMessage]]:
    """Return what the old `crs` member says; without one it is WGS84 (RFC 7946)."""
    stated = root.get("crs")
    if stated is None:
        return WGS84, []
    if not isinstance(stated, dict) or stated.get("type") == "link":
        raise ChoiceNeeded(
            worded(
                "The file leaves its coordinate system to another file or "
                "address, which is not followed. Name the coordinate system."
            ),
            "crs",
        )
    properties = stated.get("properties")
    name = properties.get("name") if isinstance(properties, dict) else None
    if isinstance(name, str):
        return name, []
    return None, [seen(worded("The file says that its coordinate system is unknown."))]


def _properties(feature: dict[str, Any]) -> dict[str, Any]:
    properties = feature.get("properties")
    own = properties if isinstance(properties, dict) else {}
    if "id" in feature and "id" not in own:
        return {**own, "id": feature["id"]}
    return own


def _columns(properties: list[dict[str, Any]], file: str) -> dict[str, NDArray[np.object_]]:
    names = dict.fromkeys(name for row in properties for name in row)
    limits.check("columns", len(names), limits.COLUMNS, file)
    columns = {}
    for name in names:
        values = np.empty(len(properties), dtype=object)
        values[:] = [_cell(row.get(name)) for row in properties]
        columns[name] = values
    return columns


def _cell(value: object) -> object:
    if value is None or isinstance(value, str | int | float):
        return value
    return json.dumps(value, ensure_ascii=False)


def _geometries(
    features: list[dict[str, Any]], name: str
) -> tuple[NDArray[np.object_], list[ImportMessage]]:
    stated = [feature.get("geometry") for feature in features]
    geometry = np.full(len(features), None, dtype=object)
    broken = []
    n_vertices = 0
    together = _whole_polygons(stated)
    for i, one in enumerate(stated):
        if one is None:
            continue
        try:
            geometry[i] = _geometry(one) if together is None else together[i]
        except _NOT_GEOMETRY:
            broken.append(i)
            continue
        if together is None:
            n_vertices += int(shapely.get_num_coordinates(geometry[i]))
            limits.check("vertices", n_vertices, limits.VERTICES, name)
    n_vertices = int(shapely.get_num_coordinates(geometry).sum())
    limits.check("vertices", n_vertices, limits.VERTICES, name)
    there = ~shapely.is_missing(geometry)
    n_open = sum(_is_open(one) for one, kept in zip(stated, there, strict=True) if one and kept)
    messages = [
        dropped(
            worded("The geometry cannot be understood and is left out."),
            f"feature {i + 1}",
            many="{n} geometries cannot be understood and are left out",
        )
        for i in broken
    ]
    return geometry, [*messages, *([closed(n_open)] if n_open else [])]


def _whole_polygons(stated: list[Any]) -> NDArray[np.object_] | None:
    """Return the geometries of a file of nothing but good polygons, all at once; else None."""
    try:
        if not stated or any(one["type"] != "Polygon" for one in stated):
            return None
        rings = [ring for one in stated for ring in one["coordinates"]]
        if any(not one["coordinates"] for one in stated) or any(len(r) < 3 for r in rings):
            return None
        xy = np.array([point for ring in rings for point in ring], dtype=np.float64)
        if xy.ndim != 2 or xy.shape[1] < 2:
            return None
        ring_of = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
        polygon_of = np.repeat(np.arange(len(stated)), [len(one["coordinates"]) for one in stated])
        closed_rings = np.asarray(shapely.linearrings(xy[:, :3], indices=ring_of))
        return np.asarray(shapely.polygons(closed_rings, indices=polygon_of))
    except _NOT_GEOMETRY:
        return None


def _is_open(stated: dict[str, Any]) -> bool:
    """Return whether a ring of an area does not end where it begins."""
    kind = stated["type"]
    if kind not in {"Polygon", "MultiPolygon"}:
        return False
    areas = [stated["coordinates"]] if kind == "Polygon" else stated["coordinates"]
    return any(len(ring) > 2 and ring[0][:2] != ring[-1][:2] for area in areas for ring in area)


def _geometry(stated: dict[str, Any]) -> shapely.Geometry:
    kind = stated["type"]
    if kind == "GeometryCollection":
        return shapely.GeometryCollection([_geometry(part) for part in stated["geometries"]])
    return _BUILDERS[kind](stated["coordinates"])


def _points(stated: list[Any]) -> NDArray[np.float64]:
    """Return ``(n, 2)`` or ``(n, 3)`` coordinates."""
    try:
        coordinates = np.array(stated, dtype=np.float64)
    except ValueError:  # some with height, some without
        coordinates = np.array([[float(p[0]), float(p[1])] for p in stated])
    if len(coordinates) == 0:
        return np.empty((0, 2))
    if coordinates.ndim != 2 or coordinates.shape[1] < 2:
        raise ValueError("a position must have two coordinates")
    return coordinates[:, :3]


def _polygon(stated: list[Any]) -> shapely.Polygon:
    rings = [_points(ring) for ring in stated]
    if not rings or len(rings[0]) == 0:
        return shapely.Polygon()
    return shapely.Polygon(rings[0], [ring for ring in rings[1:] if len(ring)])


def _point(stated: list[Any]) -> shapely.Point:
    return shapely.Point(_points([stated])[0]) if stated else shapely.Point()


_BUILDERS: dict[str, Callable[[Any], shapely.Geometry]] = {
    "Point": _point,
    "MultiPoint": lambda stated: shapely.MultiPoint(_points(stated)),
    "LineString": lambda stated: shapely.LineString(_points(stated)),
    "MultiLineString": lambda stated: shapely.MultiLineString([_points(s) for s in stated]),
    "Polygon": _polygon,
    "MultiPolygon": lambda stated: shapely.MultiPolygon(
        [p for p in map(_polygon, stated) if not p.is_empty]
    ),
}
