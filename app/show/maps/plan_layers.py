"""The plot as a plan: headlands, rows, aisles between them, and what is not driven through."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import shapely
from pydeck import Layer

from fieldmon.plot.row_course import row_courses

from ...words import texts
from . import colours, deck

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]

#: layers of the plan, from below to above
IDS = ("headland", "rows-ground", "aisles", "no-go", "hatch")
# of the distance from row to row, this much is aisle
_AISLE = 0.4
# bent rows are drawn to the decimetre
_SMOOTH_M = 0.1
# lines of a hatch are so far apart, of the area's longer side, but not less than metres
_HATCH, _HATCH_M = 1 / 14, 1.0


def plan(grid: PlantGrid, field: Field, *, dark: bool = False) -> list[Layer]:
    """Return what is drawn of a plot before any of its plants."""
    tone = colours.PLAN_IN_DARK if dark else colours.PLAN
    ground = [{"a": _rings(part)} for part in shapely.get_parts(field.boundary)]
    layers = [
        Layer("PolygonLayer", ground, id="headland", get_polygon="a", stroked=False,
              get_fill_color=list(tone.headland)),
        _strips("rows-ground", rows_m(grid), grid, 1.0, tone.rows),
        _strips("aisles", aisles_m(grid), grid, _AISLE, tone.aisle),
    ]  # fmt: skip
    if not field.no_go.is_empty:
        areas = [
            {"a": _rings(part), "p": _corners(part.exterior), "t": texts.TIP_NO_GO}
            for part in shapely.get_parts(field.no_go)
        ]
        lines = [{"path": _corners(line)} for line in hatch(grid, field)]
        layers += [
            Layer("PolygonLayer", areas, id="no-go", get_polygon="a", stroked=False,
                  get_fill_color=list(tone.no_go)),
            Layer("PathLayer", lines, id="hatch", get_path="path", get_color=list(tone.hatch),
                  get_width=0.15, width_min_pixels=1.2),
        ]  # fmt: skip
    return [*layers, deck.boundary(field, dark=dark)]


def rows_m(grid: PlantGrid) -> Iterator[Float]:
    """Yield the middle of each row in metres, half a plant longer on both ends."""
    if grid.aisles_m is not None:
        long = shapely.simplify(row_courses(grid)[np.diff(grid.unbroken_start) > 1], _SMOOTH_M)
        yield from (shapely.get_coordinates(line) for line in long)
        return
    half = grid.plant_spacing_m / 2
    for first, after in pairwise(grid.unbroken_start):
        own = grid.xy_m[first:after]
        y = own[:, 1].mean()
        yield np.array([[own[0, 0] - half, y], [own[-1, 0] + half, y]])


def aisles_m(grid: PlantGrid) -> Iterator[Float]:
    """Yield the middle of each aisle in metres, once, however many rows are inspected from it.

    As far as its lane: where rows bend, the line itself goes on beyond the headland.
    """
    if grid.aisles_m is not None and grid.aisle is not None:
        stretch = grid.stretches
        low, first = np.full((2, int(stretch.max()) + 1), np.inf)
        high = -low
        np.minimum.at(low, stretch, grid.lane_x_m[:, 0])
        np.maximum.at(high, stretch, grid.lane_x_m[:, 1])
        first[stretch] = grid.aisle
        for aisle, ends in zip(first.astype(int), np.stack([low, high], axis=1), strict=True):
            one, other = grid.aisles_m.points(np.full(2, aisle), ends)[:, None]
            inner = grid.aisles_m.corners_between(aisle, *ends)
            yield np.concatenate([one, inner, other])
        return
    lanes = np.column_stack([grid.lane_x_m, grid.lane_y_m]).round(2)
    for low, high, y in np.unique(lanes, axis=0):
        yield np.array([[low, y], [high, y]])


def hatch(grid: PlantGrid, field: Field) -> list[shapely.LineString]:
    """Return lines across the areas that are not driven through, lon/lat, aslant to the rows."""
    found: list[shapely.LineString] = []
    for part in shapely.get_parts(field.no_go):
        area = shapely.transform(part, grid.frame.xy_m)
        x0, y0, x1, y1 = area.bounds
        long = max(x1 - x0, y1 - y0)
        apart = max(_HATCH * long, _HATCH_M)
        starts = np.arange(x0 - (y1 - y0) + apart / 2, x1, apart)
        ends = np.stack([starts, np.full_like(starts, y0)], axis=1)
        across = np.stack([ends, ends + (y1 - y0)], axis=1)
        cut = shapely.intersection(shapely.linestrings(across), area)
        lines = [one for one in shapely.get_parts(cut) if one.length > 0]
        lines = [one for one in lines if one.geom_type == "LineString"]
        found += [shapely.transform(one, grid.frame.lonlat) for one in lines]
    return found


def _strips(
    name: str, lines_m: Iterator[Float], grid: PlantGrid, share: float, colour: colours.Colour
) -> Layer:
    lines = [np.zeros((0, 2)), *lines_m]
    corners = np.round(grid.frame.lonlat(np.concatenate(lines)), 7)
    ends = np.cumsum([len(line) for line in lines])
    rows = [{"path": corners[a:b].tolist()} for a, b in pairwise(ends)]
    return Layer(
        "PathLayer", rows, id=name, get_path="path", get_color=list(colour),
        get_width=share * grid.row_spacing_m, width_min_pixels=0, joint_rounded=True,
    )  # fmt: skip


def _rings(part: shapely.Polygon) -> list[list[list[float]]]:
    return [_corners(ring) for ring in shapely.get_rings(part)]


def _corners(line: shapely.Geometry) -> list[list[float]]:
    corners: list[list[float]] = np.round(shapely.get_coordinates(line), 7).tolist()
    return corners
