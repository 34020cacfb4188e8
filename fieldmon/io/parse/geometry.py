"""Areas as they come from a file, made fit for a plot, and every change said."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon
from shapely.errors import GEOSException

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, doubtful, dropped, repaired
from fieldmon.io.parse.crossed_outline import crossed_at, in_order
from fieldmon.plot.projection import GEOD

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: a plot smaller or larger than this is questioned
SMALLEST_M2, LARGEST_M2 = 10.0, 100_000_000.0
#: nobody reads a smaller area as a number
_NO_AREA_M2 = 0.01
#: a part smaller or narrower than this carries no plant
_SLIVER_M2, _SLIVER_WIDTH_M = 1.0, 0.1
_MANY_CROSSED = "the outlines of {n} plots cross themselves"
_REASONS = {
    "Self-intersection": "its outline crosses itself",
    "Ring Self-intersection": "its outline touches itself",
    "Hole lies outside shell": "a hole lies outside it",
    "Holes are nested": "a hole lies in a hole",
    "Nested holes": "a hole lies in a hole",
    "Nested shells": "a part lies inside another",
    "Duplicate Rings": "a ring is there twice",
    "Interior is disconnected": "holes cut it into pieces",
    "Too few points in geometry component": "a ring has too few corners",
}


def areas_m2(geometry: NDArray[np.object_]) -> Floats:
    """Return the areas of lon/lat polygons and multipolygons ``(n,)`` on the ellipsoid."""
    parts, feature = shapely.get_parts(geometry, return_index=True)
    return np.bincount(feature, _measured_parts(parts).area_m2, len(geometry)).astype(np.float64)


def area_m2(geometry: shapely.Geometry) -> float:
    """Return the area of a lon/lat geometry on the ellipsoid."""
    return float(_measured(geometry).area_m2.sum())


def steps_m(lonlat: Floats) -> Floats:
    """Return how far each lon/lat position ``(n, 2)`` is from the next ``(n - 1,)``."""
    return np.array(GEOD.line_lengths(lonlat[:, 0], lonlat[:, 1]), dtype=np.float64)


class _PolygonSizes(NamedTuple):
    """Area without holes, and length of the outlines, of each polygon ``(n,)``."""

    area_m2: Floats
    perimeter_m: Floats


def _measured(geometry: shapely.Geometry) -> _PolygonSizes:
    """Return the measures of a lon/lat geometry's polygons."""
    return _measured_parts(shapely.get_parts(_polygons(geometry)))


def _measured_parts(polygons: NDArray[np.object_]) -> _PolygonSizes:
    """Return the measures of lon/lat polygons ``(n,)``.

    The area between a parallel and the equator has a closed form on the ellipsoid (Snyder 1987,
    Map Projections, eq. 3-12), so that of a ring is one sum; sides count as straight in a map that
    keeps areas, which for a side of 1 km is geodesic to some centimetres.
    """
    rings, polygon = shapely.get_rings(polygons, return_index=True)
    lonlat, ring = shapely.get_coordinates(rings, return_index=True)
    lon, lat = np.deg2rad(lonlat).T
    sin = np.sin(lat)
    eccentricity = np.sqrt(GEOD.es)
    whole = (1 - GEOD.es) * (
        sin / (1 - GEOD.es * sin**2) + np.arctanh(eccentricity * sin) / eccentricity
    )
    first = np.searchsorted(ring, np.arange(len(rings)))
    band = whole - whole[first][ring]  # from the ring's first corner, so that no digits are lost
    inside = ring[1:] == ring[:-1]
    east = np.where(inside, (np.diff(lon) + np.pi) % (2 * np.pi) - np.pi, 0.0)
    swept = GEOD.a**2 / 2 * east * (band[1:] + band[:-1]) / 2
    area = np.abs(np.bincount(ring[1:], swept, len(rings)))
    area[np.diff(polygon, prepend=-1) == 0] *= -1  # all but the first ring of a polygon are holes
    curve = np.sqrt(1 - GEOD.es * ((sin[1:] + sin[:-1]) / 2) ** 2)
    x = east * GEOD.a / curve * np.cos((lat[1:] + lat[:-1]) / 2)
    y = np.where(inside, np.diff(lat), 0.0) * GEOD.a * (1 - GEOD.es) / curve**3
    length = np.bincount(ring[1:], np.hypot(x, y), len(rings))
    n = len(polygons)
    of_polygon = (np.bincount(polygon, values, n).astype(np.float64) for values in (area, length))
    return _PolygonSizes(*of_polygon)


class GeometryKinds(NamedTuple):
    """Masks ``(n,)`` of features by what they are; none of them for a missing geometry."""

    areas: NDArray[np.bool_]
    lines: NDArray[np.bool_]
    points: NDArray[np.bool_]


def geometry_kinds(geometry: NDArray[np.object_]) -> GeometryKinds:
    """Return which features are areas, lines or points; a collection is the most it holds."""
    there = ~shapely.is_missing(geometry) & ~shapely.is_empty(geometry)
    dimensions = np.where(there, shapely.get_dimensions(geometry), -1)
    return GeometryKinds(dimensions == 2, dimensions == 1, dimensions == 0)


def closed_lines(geometry: NDArray[np.object_]) -> NDArray[np.bool_]:
    """Return which features are lines that end where they begin: outlines drawn as lines."""
    parts_closed = [
        g is not None
        and g.geom_type in {"LineString", "MultiLineString"}
        and not g.is_empty
        and all(p.is_closed and len(p.coords) >= 4 for p in shapely.get_parts(g))
        for g in geometry
    ]
    return np.array(parts_closed, dtype=bool)


def filled(line: shapely.Geometry) -> MultiPolygon:
    """Return the area inside lines that end where they begin."""
    return MultiPolygon([Polygon(part.coords) for part in shapely.get_parts(line)])


def boundaries(
    areas: NDArray[np.object_], names: list[str]
) -> tuple[NDArray[np.object_], list[ImportMessage]]:
    """Return lon/lat areas ``(n,)`` as valid MultiPolygons (empty where nothing is left).

    Valid areas go together, which is thirty times faster than one by one.
    """
    whole = np.empty(len(areas), dtype=object)
    messages: list[ImportMessage] = []
    is_plain = np.isin(shapely.get_type_id(areas), (3, 6)) & ~shapely.is_empty(areas)
    is_plain &= shapely.is_valid(areas)
    plain = np.flatnonzero(is_plain)
    parts, feature = shapely.get_parts(areas[plain], return_index=True)
    if len(plain):
        whole[plain] = shapely.multipolygons(parts, indices=feature)
        measured = _measured_parts(parts)
        is_wide = _is_wide(measured)
        area = np.bincount(feature, measured.area_m2, len(plain))
        odd = np.bincount(feature, ~is_wide, len(plain)) > 0
        odd |= (area < SMALLEST_M2) | (area > LARGEST_M2)
        is_plain[plain[odd]] = False
    for i in np.flatnonzero(~is_plain).tolist():
        whole[i], more = boundary(areas[i], names[i])
        messages += more
    return whole, messages


def boundary(area: shapely.Geometry, name: str) -> tuple[MultiPolygon, list[ImportMessage]]:
    """Return one feature's lon/lat area as a valid MultiPolygon (empty where nothing is left)."""
    drawn = _polygons(area)
    whole, messages = drawn, []
    if not shapely.is_valid(drawn):
        why = _plain(shapely.is_valid_reason(drawn))
        try:
            whole = _polygons(shapely.make_valid(drawn, method="structure", keep_collapsed=False))
        except GEOSException as bad:
            said = worded("The shape is broken ({why}) beyond repair: {bad}.", why=why, bad=bad)
            many = "{n} shapes are broken beyond repair"
            return MultiPolygon(), [dropped(said, name, many=many)]
    measured = _measured(whole)
    if whole is not drawn:
        crossed = crossed_at(drawn)
        messages.append(
            _repaired(drawn, whole, measured, name, why)
            if crossed is None
            else doubtful(_crossed(drawn, whole, measured, crossed), name, many=_MANY_CROSSED)
        )
    is_wide = _is_wide(measured)
    if not is_wide.all():
        whole = MultiPolygon([p for p, wide in zip(whole.geoms, is_wide, strict=True) if wide])
        messages.append(
            dropped(
                worded(
                    "{n} {n:part|parts} too small or narrow for a plant {n:was|were} left out "
                    "(under "
                    "{sliver_m2:g} m2 or {sliver_width_m:g} m wide).",
                    n=int((~is_wide).sum()),
                    sliver_m2=_SLIVER_M2,
                    sliver_width_m=_SLIVER_WIDTH_M,
                ),
                name,
                many="{n} plots have parts too small or narrow for a plant, which were left out",
            )
        )
    if not whole.is_empty:
        messages += _questions(float(measured.area_m2[is_wide].sum()), name)
    return whole, messages


def _repaired(
    drawn: MultiPolygon, whole: MultiPolygon, now: _PolygonSizes, name: str, why: str
) -> ImportMessage:
    """Return what to say of an area made valid: parts that overlap are one, holes stay holes."""
    n = len(whole.geoms)
    parts = "" if n == len(drawn.geoms) else f" in {n} part{'' if n == 1 else 's'}"
    change = f"{_amount(area_m2(drawn))} as drawn, {_amount(now.area_m2.sum())}{parts} now"
    said = worded(
        "The shape was not valid ({why}) and was repaired: {change}.", why=why, change=change
    )
    return repaired(said, name, many="{n} shapes were not valid and were repaired")


def _crossed(
    drawn: MultiPolygon, whole: MultiPolygon, now: _PolygonSizes, at: tuple[float, float]
) -> str:
    """Return what to say of an outline that crosses itself: the plot may be another."""
    n, kept, (lon, lat) = len(whole.geoms), _amount(now.area_m2.sum()), at
    if (ordered := in_order(drawn, whole.area)) is not None:
        return worded(
            "The corners seem to be in the wrong order: the outline crosses itself at {lon:.6f}, "
            "{lat:.6f}, and {kept} in {n} {n:part|parts} was kept. Around the same corners, "
            "without a crossing, it has {ordered}. Put the corners in order, or draw the plot.",
            lon=lon, lat=lat, kept=kept, n=n, ordered=_amount(area_m2(ordered)),
        )  # fmt: skip
    return worded(
        "The outline crosses itself at {lon:.6f}, {lat:.6f}, and {kept} in {n} {n:part|parts} was "
        "kept. If that is not the plot, mend the outline, or draw the plot.",
        lon=lon, lat=lat, kept=kept, n=n,
    )  # fmt: skip


def _polygons(geometry: shapely.Geometry) -> MultiPolygon:
    """Return the polygons of any geometry."""
    parts = shapely.get_parts(geometry)
    while (shapely.get_type_id(parts) >= 4).any():
        parts = shapely.get_parts(parts)
    kept = parts[(shapely.get_type_id(parts) == 3) & ~shapely.is_empty(parts)]
    return MultiPolygon(list(kept))


def _is_wide(measured: _PolygonSizes) -> NDArray[np.bool_]:
    """Return which parts ``(n,)`` have room for a plant."""
    width_m = 2 * measured.area_m2 / np.maximum(measured.perimeter_m, 1e-9)
    return (measured.area_m2 >= _SLIVER_M2) & (width_m >= _SLIVER_WIDTH_M)


def _questions(area: float, name: str) -> list[ImportMessage]:
    if SMALLEST_M2 <= area <= LARGEST_M2:
        return []
    return [
        doubtful(
            worded(
                "A plot has {least} to {most} as a rule, but this one has {has}. Check the "
                "coordinate system and the choice of feature.",
                least=_amount(SMALLEST_M2),
                most=_amount(LARGEST_M2),
                has=_amount(area),
            ),
            name,
            many="{n} plots are smaller or larger than is usual",
        )
    ]


def _amount(area: float) -> str:
    if area < _NO_AREA_M2:
        return f"less than {_NO_AREA_M2:g} m2"
    return f"{area:.4g} m2" if area < 1000 else f"{area / 10_000:.5g} ha"


def _plain(reason: str) -> str:
    """Return GEOS's reason in words, with its place as people write it."""
    what, _, where = reason.partition("[")
    words = _REASONS.get(what.strip(), what.strip())
    numbers = where.rstrip("]").split()
    if len(numbers) < 2:
        return words
    return f"{words} at {float(numbers[0]):.6f}, {float(numbers[1]):.6f}"
