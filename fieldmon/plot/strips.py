"""Straight rows in strips: where whole ones fit into an area, and the plants on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arrays import offsets, runs
from fieldmon.compute.wording import counted, worded
from fieldmon.errors import PlotError

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.plot.planting import Planting

    Float = NDArray[np.float64]

# rounding of coordinates must not cost a row or a plant where the plot fits exactly
SLACK_M = 1e-6
_MOST_PLANTS = 20_000_000
_PHASES = 8


class Pieces(NamedTuple):
    """Unbroken pieces of rows, by line, then along it: r pieces of n plants together."""

    xy_m: Float
    row_start: NDArray[np.int64]
    row_line: NDArray[np.int32]
    aisle_y_m: Float  # (r, 2): middle of the aisle below and of the aisle above
    lane_x_m: Float  # (r, 2)

    def __repr__(self) -> str:
        plants = counted(len(self.xy_m), "plant")
        return f"<Pieces: {plants} in {counted(len(self.row_line), 'row')}>"


class Intervals(NamedTuple):
    """Stretches of x, k in all, each on one of several horizontal strips."""

    strip: NDArray[np.intp]
    low_x: Float
    high_x: Float

    def __repr__(self) -> str:
        return f"<Intervals: {counted(len(self.strip), 'piece')}>"


def free_intervals(area: shapely.Geometry, low_y: Float, high_y: Float) -> Intervals:
    """Return where whole horizontal strips are inside an area: ascending by strip, then x.

    Strip k is ``low_y[k] < y < high_y[k]``; both ascend with k. An x is free if every point of
    the strip there is in the area: the x where an edge runs through the strip are taken out, and
    what is left between them is inside or outside as a whole.
    """
    x1, y1, x2, y2 = _edges(area)
    first = np.searchsorted(high_y, y1, side="right")
    n_met = np.maximum(np.searchsorted(low_y, y2, side="left") - first, 0)
    strip, edge = runs(first, n_met)
    x1, y1, x2, y2 = x1[edge], y1[edge], x2[edge], y2[edge]
    low, high = low_y[strip], high_y[strip]
    # parts of the edge's height, so that the flattest edge cannot overflow
    height = np.where(y2 > y1, y2 - y1, 1.0)
    enters = x1 + (np.maximum(low, y1) - y1) / height * (x2 - x1)
    leaves = np.where(y2 <= high, x2, x1 + (np.minimum(high, y2) - y1) / height * (x2 - x1))
    middle = (low + high) / 2
    crosses = (y1 <= middle) & (middle < y2)
    # sweep each strip from low to high x: an edge opens where it begins and closes where it
    # ends; between edges, an odd number of crossings so far means inside
    x = np.concatenate([np.minimum(enters, leaves), np.maximum(enters, leaves)])
    opens = np.repeat([1, -1], len(edge))
    order = np.lexsort((-opens, x, np.tile(strip, 2)))
    inside = np.cumsum(np.concatenate([np.zeros(len(edge), int), crosses])[order]) % 2 == 1
    before = np.flatnonzero((np.cumsum(opens[order]) == 0) & inside)
    x = x[order]
    return Intervals(np.tile(strip, 2)[order][before], x[before], x[before + 1])


def best_strips(area: MultiPolygon, planting: Planting) -> tuple[Float, Intervals]:
    """Return the rows' y and their free intervals for the placement that holds most plants."""
    _, low, _, high = area.bounds
    step = planting.row_spacing_m
    left_over = (high - low + SLACK_M) % step - SLACK_M
    best = (np.empty(0), Intervals(np.empty(0, np.intp), np.empty(0), np.empty(0)))
    most = 0
    # first the strips centred in the plot, which is best for a rectangle
    for phase in range(_PHASES):
        first = low + left_over / 2 + step / 2 - phase * step / _PHASES
        y = np.arange(first, high, step)
        free = free_intervals(area, y - step / 2 + SLACK_M, y + step / 2 - SLACK_M)
        room = free.high_x - free.low_x - 2 * planting.headland_m + SLACK_M
        fits = room >= 0
        n = int((room[fits] // planting.plant_spacing_m + 1).sum())
        if n > most:
            best = (y, Intervals(free.strip[fits], free.low_x[fits], free.high_x[fits]))
            most = n
    return best


def fill(y: Float, free: Intervals, planting: Planting) -> Pieces:
    """Return pieces of rows with plants on one lattice along x, as many as fit the longest."""
    step, half = planting.plant_spacing_m, planting.headland_m / 2
    low, high = free.low_x + 2 * half, free.high_x - 2 * half
    longest = np.argmax(high - low)
    origin = low[longest] + ((high - low)[longest] + SLACK_M) % step / 2
    first = np.ceil((low - origin - SLACK_M) / step).astype(np.int64)
    n_plants = np.floor((high - origin + SLACK_M) / step).astype(np.int64) - first + 1
    planted = n_plants > 0
    first, n_plants, strip = first[planted], n_plants[planted], free.strip[planted]
    place, _ = runs(first, n_plants)
    row_y = y[strip]
    aisle = planting.row_spacing_m / 2
    return Pieces(
        np.stack([origin + place * step, np.repeat(row_y, n_plants)], axis=1),
        offsets(n_plants),
        np.unique(strip, return_inverse=True)[1].astype(np.int32),
        np.stack([row_y - aisle, row_y + aisle], axis=1),
        np.stack([free.low_x[planted] + half, free.high_x[planted] - half], axis=1),
    )


def check_size(name: str, area: MultiPolygon, planting: Planting) -> None:
    """Raise `PlotError` where more plants would be laid than memory holds."""
    about = area.area / (planting.row_spacing_m * planting.plant_spacing_m)
    if about > _MOST_PLANTS:
        raise PlotError(
            worded(
                "A plot may have {most} plants, but {name!r} ({area_ha:.0f} ha) would have "
                "about {about:.0f} with rows {row_spacing_m} m and plants {plant_spacing_m} m "
                "apart. Check the spacings and the boundary's units.",
                most=_MOST_PLANTS,
                name=name,
                area_ha=area.area / 10000.0,
                about=about,
                row_spacing_m=planting.row_spacing_m,
                plant_spacing_m=planting.plant_spacing_m,
            )
        )


def no_room(name: str, area: MultiPolygon, planting: Planting) -> PlotError:
    """Return the problem that an area has no room for a plant."""
    low_x, low_y, high_x, high_y = area.bounds
    return PlotError(
        worded(
            "A plot must have room for one plant: a strip {row_spacing_m:g} m wide (the "
            "row spacing) and {headlands_m:g} m long (two headlands) along the rows. Plot "
            "{name!r} ({area_m2:.0f} m2; {along_m:.1f} m along the rows, {across_m:.1f} m "
            "across) has none. Choose a smaller headland or row spacing, another row "
            "bearing, or check the boundary.",
            row_spacing_m=planting.row_spacing_m,
            headlands_m=2 * planting.headland_m,
            name=name,
            area_m2=area.area,
            along_m=high_x - low_x,
            across_m=high_y - low_y,
        )
    )


def _edges(area: shapely.Geometry) -> tuple[Float, Float, Float, Float]:
    """Return all edges as ``x1, y1, x2, y2`` with y1 <= y2."""
    rings = shapely.get_rings(shapely.get_parts(area))
    corners, ring = shapely.get_coordinates(rings, return_index=True)
    same = ring[1:] == ring[:-1]
    start, end = corners[:-1][same], corners[1:][same]
    falls = (start[:, 1] > end[:, 1])[:, None]
    low, high = np.where(falls, end, start), np.where(falls, start, end)
    return low[:, 0], low[:, 1], high[:, 0], high[:, 1]
