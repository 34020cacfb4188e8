"""Areas as they come from a file, made fit for a plot, and every change said."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyproj
import shapely
from shapely import MultiPolygon

from fieldmon.geodata.findings import Finding, doubtful, dropped, repaired

if TYPE_CHECKING:
    from numpy.typing import NDArray

_GEOD = pyproj.Geod(ellps="WGS84")
_AREAL = frozenset({"Polygon", "MultiPolygon", "GeometryCollection"})
#: a plot smaller or larger than this is questioned
SMALLEST_M2, LARGEST_M2 = 10.0, 100_000_000.0
#: a part smaller or narrower than this carries no plant
_SLIVER_M2, _SLIVER_WIDTH_M = 1.0, 0.1


def area_m2(geometry: shapely.Geometry) -> float:
    """Return the area of a lon/lat geometry on the ellipsoid."""
    return abs(float(_GEOD.geometry_area_perimeter(shapely.orient_polygons(geometry))[0]))


def boundary(area: shapely.Geometry, name: str) -> tuple[MultiPolygon, list[Finding]]:
    """Return one feature's lon/lat area as a valid MultiPolygon (empty where nothing is left)."""
    findings: list[Finding] = []
    before = area_m2(_areas(area))
    if not shapely.is_valid(area):
        why = shapely.is_valid_reason(area)
        area = shapely.make_valid(area, method="structure", keep_collapsed=False)
        after = area_m2(_areas(area))
        findings.append(
            repaired(
                f"The shape was not valid ({_plain(why)}) and was repaired: "
                f"{_amount(before)} before, {_amount(after)} now.",
                name,
            )
        )
    kept, slivers = _without_slivers(_areas(area))
    if slivers:
        findings.append(
            dropped(
                f"{slivers} part(s) too small or narrow for a plant were left out "
                f"(under {_SLIVER_M2:g} m2 or {_SLIVER_WIDTH_M:g} m wide).",
                name,
            )
        )
    if not kept.is_empty:
        findings += _questions(kept, name)
    return kept, findings


def _areas(geometry: shapely.Geometry) -> MultiPolygon:
    """Return the polygons of any geometry."""
    parts = shapely.get_parts(geometry)
    while any(shapely.get_type_id(parts) >= 4):
        parts = shapely.get_parts(parts)
    return MultiPolygon([p for p in parts if p.geom_type == "Polygon" and not p.is_empty])


def _without_slivers(areas: MultiPolygon) -> tuple[MultiPolygon, int]:
    kept = []
    for part in areas.geoms:
        area, perimeter = _GEOD.geometry_area_perimeter(part)
        if abs(area) >= _SLIVER_M2 and 2 * abs(area) / max(perimeter, 1e-9) >= _SLIVER_WIDTH_M:
            kept.append(part)
    return MultiPolygon(kept), len(areas.geoms) - len(kept)


def _questions(areas: MultiPolygon, name: str) -> list[Finding]:
    area = area_m2(areas)
    if SMALLEST_M2 <= area <= LARGEST_M2:
        return []
    return [
        doubtful(
            f"A plot has {SMALLEST_M2:g} m2 to {_amount(LARGEST_M2)} as a rule, but this one has "
            f"{_amount(area)}. Check the coordinate system and the choice of feature.",
            name,
        )
    ]


def _amount(area: float) -> str:
    return f"{area:.4g} m2" if area < 1000 else f"{area / 10_000:.5g} ha"


def _plain(reason: str) -> str:
    """Return GEOS's reason with its coordinates as people write them."""
    what, _, where = reason.partition("[")
    words = {
        "Self-intersection": "its outline crosses itself",
        "Ring Self-intersection": "its outline touches itself",
        "Hole lies outside shell": "a hole lies outside it",
        "Holes are nested": "a hole lies in a hole",
        "Nested shells": "a part lies inside another",
        "Duplicate Rings": "a ring is there twice",
        "Interior is disconnected": "holes cut it into pieces",
        "Too few points in geometry component": "a ring has too few corners",
        "Invalid Coordinate": "a coordinate is not a number",
    }
    text = words.get(what.strip(), what.strip())
    if not where:
        return text
    try:
        lon, lat = (float(v) for v in where.rstrip("]").split()[:2])
    except ValueError:
        return text
    return f"{text} at {lon:.6f}, {lat:.6f}"


def sort_out(
    geometry: NDArray[np.object_],
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """Return masks ``(n,)`` of areas, of lines and of points; none of them for missing ones."""
    types = shapely.get_type_id(geometry)
    there = (types >= 0) & ~shapely.is_empty(geometry)
    collections = there & (types == 7)
    has_area = there & np.isin(types, (3, 6))
    has_area[collections] = shapely.get_dimensions(geometry[collections]) == 2
    has_line = there & np.isin(types, (1, 2, 5))
    has_line[collections] = shapely.get_dimensions(geometry[collections]) == 1
    return has_area, has_line, there & ~has_area & ~has_line
