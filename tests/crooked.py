"""Random crooked plots for properties: concave, with holes and no-go areas, in parts, tiny ones.

Everything is drawn in metres about a random place on Earth and handed out in degrees.
"""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import assume
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame

_part = st.floats(0.0, 1.0)


@st.composite
def stars(draw, radius_m: float) -> Polygon:
    """Draw a polygon about (0, 0), concave more often than not."""
    n = draw(st.integers(3, 9))
    turns = (np.arange(n) + [0.8 * draw(_part) for _ in range(n)]) * (2 * np.pi / n)
    radii = radius_m * np.array([0.25 + 0.75 * draw(_part) for _ in range(n)])
    return Polygon(np.stack([radii * np.cos(turns), radii * np.sin(turns)], axis=1))


@st.composite
def blocks(draw, radius_m: float) -> Polygon:
    """Draw a rectangle, an L or a U about (0, 0), square to the axes."""
    wide, high = (radius_m * (0.2 + 0.8 * draw(_part)) for _ in range(2))
    block = shapely.box(-wide, -high, wide, high)
    bite = (0.2 + 0.6 * draw(_part)) * wide
    kind = draw(st.sampled_from(("rectangle", "L", "U")))
    if kind == "L":
        return shapely.difference(block, shapely.box(wide - bite, 0.0, wide + 1, high + 1))
    if kind == "U":
        return shapely.difference(block, shapely.box(-bite / 2, 0.0, bite / 2, high + 1))
    return block


@st.composite
def areas(draw, radius_m: float) -> MultiPolygon:
    """Draw an area in metres: one to three parts, holes or none, turned anyhow."""
    area = draw(st.one_of(stars(radius_m), blocks(radius_m)))
    for _ in range(draw(st.integers(0, 2))):
        hole = _moved(draw, draw(stars(radius_m / 4)), 0.6 * radius_m)
        area = shapely.difference(area, hole)
    for number in range(draw(st.sampled_from((0, 0, 0, 1, 2)))):
        other = draw(stars(radius_m / 2))
        area = shapely.union(
            area,
            shapely.transform(
                other, lambda xy, by=2.0 * radius_m * (number + 1): xy + np.array([by, 0.0])
            ),
        )
    turn = draw(st.floats(0.0, 2 * np.pi))
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return _polygons(shapely.transform(area, lambda xy: xy @ rotation))


@st.composite
def crooked_fields(
    draw, max_radius_m: float = 80.0, min_radius_m: float = 15.0, *, awkward: bool = True
) -> Field:
    """Draw a plot of about twice the given radius.

    Sizes of 15 m hold a handful of plants, of 80 m about a thousand. Not every plot has room
    for a plant with every planting (see `crooked_grids`). With ``awkward=False``: one part,
    no gate, no no-go area.
    """
    radius_m = draw(st.floats(min_radius_m, max_radius_m))
    frame = Frame(draw(st.floats(-179.0, 179.0)), draw(st.floats(-65.0, 65.0)))
    if not awkward:
        area = _polygons(draw(st.one_of(stars(radius_m), blocks(radius_m))))
        return Field("crooked", frame.geometry_lonlat(area))
    area = draw(areas(radius_m))
    no_go, gate = MultiPolygon(), None
    if draw(st.booleans()):
        patch = _moved(draw, draw(stars(radius_m / 4)), 0.8 * radius_m)
        assume(shapely.difference(area, patch).area > 1.0)
        no_go = frame.geometry_lonlat(_polygons(patch))
    if draw(st.booleans()):
        edge = shapely.get_parts(area)[0].exterior
        at = shapely.line_interpolate_point(edge, draw(_part), normalized=True)
        lon, lat = frame.lonlat([[at.x, at.y]])[0]
        gate = (float(lon), float(lat))
    boundary = frame.geometry_lonlat(area)
    assume(boundary.is_valid)
    return Field("crooked", boundary, no_go=no_go, gate=gate)


@st.composite
def plantings(draw, *, faces: tuple[int, ...] = (1, 2)) -> Planting:
    """Draw how a plot is planted: bearing given or to be found, usual spacings."""
    return Planting(
        row_bearing_deg=draw(st.none() | st.floats(0.0, 360.0)),
        row_spacing_m=draw(st.floats(1.5, 7.0)),
        plant_spacing_m=draw(st.floats(0.8, 6.0)),
        headland_m=draw(st.floats(1.0, 6.0)),
        faces=draw(st.sampled_from(faces)),
    )


@st.composite
def crooked_grids(
    draw,
    max_radius_m: float = 80.0,
    *,
    faces: tuple[int, ...] = (1, 2),
    max_plants: int = 20_000,
):
    """Draw the plants of a random crooked plot; plots without room for one are left out."""
    field = draw(crooked_fields(max_radius_m))
    try:
        grid = lay(field, draw(plantings(faces=faces)))
    except PlotError:
        assume(False)
    assume(len(grid) <= max_plants)
    return grid


def _moved(draw, shape: Polygon, reach_m: float) -> Polygon:
    by = np.array([reach_m * (2 * draw(_part) - 1) for _ in range(2)])
    return shapely.transform(shape, lambda xy: xy + by)


def _polygons(area: shapely.Geometry) -> MultiPolygon:
    parts = [
        part
        for part in shapely.get_parts(shapely.make_valid(area))
        if part.geom_type == "Polygon" and part.area > 1.0
    ]
    assume(bool(parts))
    return MultiPolygon(parts)
