"""Lanes cut where something stands in them, and plants beside it inspected from before it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]
    Mask = NDArray[np.bool_]
    Shapes = NDArray[np.object_]

#: plants beside what stands in a lane are inspected from so far ahead of them, or not at all
REACH_M = 1.5
# a lane may lie exactly beside it
_EDGE_M = 0.01
# lanes that end this near to their last plant leave nobody room to turn
_LEAST_M = 0.75


class ClearLanes(NamedTuple):
    """A grid whose lanes touch nothing.

    Parameters
    ----------
    grid
        The same plants and rows.
    hidden
        ``(n,)`` which plants can be inspected from no part of their lane.
    """

    grid: PlantGrid
    hidden: Mask

    def __repr__(self) -> str:
        return f"<ClearLanes: {int(self.hidden.sum())} of {len(self.grid)} plants hidden>"


def clear_lanes(grid: PlantGrid, off: shapely.Geometry) -> ClearLanes:
    """Return a grid whose lanes keep off an area.

    Of a lane that is cut there stays the stretch with most of its plants. Those beside the area
    are inspected from before it; those farther on are hidden.
    """
    hidden = np.zeros(len(grid), np.bool_)
    off = shapely.buffer(off, -_EDGE_M, join_style="mitre")
    if shapely.is_empty(off):
        return ClearLanes(grid, hidden)
    shapely.prepare(off)
    lanes = lane_lines(grid)
    met = np.unique(grid.corridor[np.flatnonzero(shapely.intersects(off, lanes))])
    if not len(met):
        return ClearLanes(grid, hidden)
    lane_m, place_m = grid.lane_x_m.copy(), grid.along_m.copy()
    for corridor in met.tolist():
        rows = np.flatnonzero(grid.corridor == corridor)
        plants = np.concatenate(
            [np.arange(grid.row_start[row], grid.row_start[row + 1]) for row in rows]
        )
        low, high = _stretch(grid, rows, (off, lanes), place_m[plants])
        there = np.clip(place_m[plants], low, high)
        far_m = np.abs(there - place_m[plants])
        hidden[plants] = far_m > REACH_M
        if not hidden[plants].all():
            place_m[plants] = there
            lane_m[rows] = np.clip(lane_m[rows], low, high)
    return ClearLanes(replace(grid, lane_x_m=lane_m, place_m=place_m), hidden)


def measured_clear(grid: PlantGrid, off: shapely.Geometry) -> PlantGrid:
    """Return measured rows whose lanes keep off an area, whoever inspects them.

    Lanes that are cut to little more than their last plants end at them: nobody turns there.
    """
    before, grid = grid, clear_lanes(grid, off).grid
    if grid is before:
        return grid
    short = (grid.beyond_plants_m < _LEAST_M) & (grid.lane_x_m != before.lane_x_m)
    return replace(grid, lane_x_m=np.where(short, grid.along_m[grid.end_plants], grid.lane_x_m))


def hidden_plants(grid: PlantGrid) -> Mask:
    """Tell of each plant ``(n,)`` whether its place along its lane is too far ahead of it."""
    if grid.aisles_m is None or grid.aisle is None:
        beside_m = grid.xy_m[:, 0]
    else:
        beside_m, _ = grid.aisles_m.project(grid.xy_m, grid.aisle[grid.row])
    hidden: Mask = np.abs(grid.along_m - beside_m) > REACH_M + _EDGE_M
    return hidden


def lane_lines(grid: PlantGrid) -> Shapes:
    """Return the lane of each row as a line, ``(r,)``."""
    if grid.aisles_m is None or grid.aisle is None:
        y = np.repeat(grid.lane_y_m, 2).reshape(-1, 2)
        straight: Any = shapely.linestrings(np.stack([grid.lane_x_m, y], axis=2))
        return np.asarray(straight, object)
    aisles, lanes = grid.aisles_m, []
    for aisle, (low, high) in zip(grid.aisle.tolist(), grid.lane_x_m.tolist(), strict=True):
        ends = aisles.points(np.full(2, aisle), np.array([low, high]))
        inner = aisles.corners_between(aisle, low, high)
        lanes.append(shapely.linestrings(np.concatenate([ends[:1], inner, ends[1:]])))
    bent: Shapes = np.array(lanes, object)
    return bent


def _stretch(
    grid: PlantGrid, rows: NDArray[np.intp], there: tuple[shapely.Geometry, Shapes], at_m: Float
) -> tuple[float, float]:
    """Return the free stretch of the lanes of one corridor from which most plants are seen."""
    off, lanes = there
    taken = []
    for row in rows.tolist():
        for part in shapely.get_parts(shapely.intersection(lanes[row], off)):
            if part.is_empty:
                continue  # it is only touched
            corners = shapely.points(shapely.get_coordinates(part))
            along = shapely.line_locate_point(lanes[row], corners) + grid.lane_x_m[row, 0]
            taken.append((float(along.min()) - 2 * _EDGE_M, float(along.max()) + 2 * _EDGE_M))
    low, high = float(grid.lane_x_m[rows, 0].min()), float(grid.lane_x_m[rows, 1].max())
    free, at = [], low
    for from_m, to_m in [*sorted(taken), (high, high)]:
        if from_m > at:
            free.append((at, from_m))
        at = max(at, to_m)
    if not free:
        return np.inf, np.inf

    def seen(stretch: tuple[float, float]) -> tuple[int, float]:
        within = (at_m >= stretch[0] - REACH_M) & (at_m <= stretch[1] + REACH_M)
        return int(within.sum()), stretch[1] - stretch[0]

    return max(free, key=seen)
