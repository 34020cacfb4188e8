"""Where lanes of measured rows end, so that a robot turns within the boundary."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.plot.end_turns import lane_ends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]
    Mask = NDArray[np.bool_]

#: with less between the last plant and the boundary a lane end is no place to turn
ROOM_M = 0.8
# a lane ends midway between them, but so far from the last plant if there is room
_ROOMY_M = 1.0
_BESIDE_M = 0.05
# rows that are passed outside are passed within so much of the row spacing of a lane's end
_ABOUT = 0.8
# a lane may end on the boundary
_SLACK_M = 1e-4


def lanes_within(
    beyond_m: Float, sides: list[NDArray[np.object_]], area: shapely.Geometry
) -> tuple[Float, Mask]:
    """Return how far lanes reach beyond their last plants, and rows without an end in an area.

    Parameters
    ----------
    beyond_m
        ``(r, 2)`` how far they would at either end.
    sides
        Of each lane of a row the last parts, ``(2 r,)``: lines from beside the last plant
        outwards, as long as that.
    area
        Where one may drive.

    Returns
    -------
    beyond_m
        ``(r, 2)`` within the area; 0 where that leaves no place to turn but the other end does.
    shut
        ``(r,)`` whether neither end does. Its lanes reach as far as they would.
    """
    each = [_within(beyond_m.ravel(), ends, area).reshape(-1, 2) for ends in sides]
    within_m = np.min(each, axis=0)
    shut: Mask = np.isnan(within_m).all(axis=1)
    return np.where(shut[:, None], beyond_m, np.nan_to_num(within_m)), shut


def opened(grid: PlantGrid, needs_m: float, off: shapely.Geometry) -> PlantGrid:
    """Return measured rows that can be passed at all ends, outside the boundary where they must.

    Parameters
    ----------
    grid
        The rows.
    needs_m
        So far from its last plant a row is passed.
    off
        What nobody may drive over.
    """
    plant_m = grid.along_m[grid.end_plants]
    short = (grid.beyond_plants_m < needs_m) & ~grid.cut_ends
    far_m = plant_m + (needs_m + _BESIDE_M) * np.array([-1.0, 1.0])
    wider = replace(grid, lane_x_m=np.where(short, far_m, grid.lane_x_m))
    ends_m = np.asarray(shapely.points(lane_ends(wider)[0]))
    short &= ~shapely.intersects(shapely.linestrings(_outwards(wider, plant_m)), off)
    if not short.any():
        return grid
    about = shapely.union_all(shapely.buffer(ends_m[short], _ABOUT * grid.row_spacing_m))
    about = shapely.difference(shapely.difference(about, off), grid.drivable_m)
    if grid.beyond_m is not None:
        about = shapely.union(about, grid.beyond_m)
    return replace(
        grid,
        lane_x_m=np.where(short, far_m, grid.lane_x_m),
        beyond_m=MultiPolygon([part for part in shapely.get_parts(about) if part.area > 0]),
    )


def _outwards(grid: PlantGrid, plant_m: Float) -> Float:
    """Return the last part of each lane, from beside its last plant, ``(r, 2, 2, 2)``."""
    at_plants = replace(grid, lane_x_m=plant_m)
    return np.stack([lane_ends(at_plants)[0], lane_ends(grid)[0]], axis=2)


def _within(beyond_m: Float, lanes: NDArray[np.object_], area: shapely.Geometry) -> Float:
    """Return how far lanes ``(k,)`` reach within an area; NaN: there is no place to turn."""
    grown = shapely.buffer(area, _SLACK_M)
    shapely.prepare(grown)
    room_m = np.full(len(lanes), np.inf)
    leave = np.flatnonzero(~shapely.covers(grown, lanes))
    outside = shapely.difference(lanes[leave], grown)
    room_m[leave] = shapely.distance(shapely.get_point(lanes[leave], 0), outside)
    near_m = np.maximum(room_m / 2, np.minimum(room_m - _BESIDE_M, _ROOMY_M))
    within = np.where(room_m >= ROOM_M, np.minimum(near_m, beyond_m), np.nan)
    return np.where(room_m >= beyond_m, beyond_m, within)
