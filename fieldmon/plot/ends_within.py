"""Where lanes of measured rows end, so that a robot turns within the boundary."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Mask = NDArray[np.bool_]

# with less between the last plant and the boundary a lane end is no place to turn
_LEAST_M = 0.8
# a lane ends midway between them, but so far from the last plant if there is room
_ROOMY_M = 1.0
_BESIDE_M = 0.05
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


def _within(beyond_m: Float, lanes: NDArray[np.object_], area: shapely.Geometry) -> Float:
    """Return how far lanes ``(k,)`` reach within an area; NaN: there is no place to turn."""
    grown = shapely.buffer(area, _SLACK_M)
    shapely.prepare(grown)
    room_m = np.full(len(lanes), np.inf)
    leave = np.flatnonzero(~shapely.covers(grown, lanes))
    outside = shapely.difference(lanes[leave], grown)
    room_m[leave] = shapely.distance(shapely.get_point(lanes[leave], 0), outside)
    near_m = np.maximum(room_m / 2, np.minimum(room_m - _BESIDE_M, _ROOMY_M))
    within = np.where(room_m >= _LEAST_M, np.minimum(near_m, beyond_m), np.nan)
    return np.where(room_m >= beyond_m, beyond_m, within)
