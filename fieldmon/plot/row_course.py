"""Rows that bend: from plant to plant, and on along their aisle where some are missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.arrays import runs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.polylines import Polylines

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# plants further apart than this, in plant spacings, have others missing between them
_GAP = 1.5


def row_courses(grid: PlantGrid) -> NDArray[np.object_]:
    """Return each unbroken row that bends as a line, ``(w,)``; one of a plant has no length.

    Straight from plant to plant; where plants are missing between, as the aisle bends.
    """
    aisles = grid.aisles_m
    if aisles is None or grid.aisle is None:
        raise TypeError("rows are straight")  # pragma: no cover - a mistake of ours
    after, corner_m = _in_gaps(grid, aisles, grid.aisle.astype(np.int64))
    start = grid.unbroken_start
    alone = start[:-1][np.diff(start) == 1]
    at = np.concatenate([after + 1, alone + 1])
    xy_m = np.insert(grid.xy_m, at, np.concatenate([corner_m, grid.xy_m[alone]]), axis=0)
    row = grid.unbroken_row
    owner = np.insert(row, at, row[at - 1])
    return np.asarray(shapely.linestrings(xy_m, indices=owner), np.object_)


def row_corners(grid: PlantGrid) -> list[NDArray[np.float64]]:
    """Return each unbroken row as a line to draw, ``(k, 2)`` metres: ends, and where it bends."""
    start = grid.unbroken_start
    ends = zip(start[:-1].tolist(), (start[1:] - 1).tolist(), strict=True)
    if grid.aisles_m is None:
        return [grid.xy_m[[a, b]] for a, b in ends]
    thin = shapely.simplify(row_courses(grid), 0.05, preserve_topology=False)
    return [shapely.get_coordinates(line) for line in thin]


def _in_gaps(grid: PlantGrid, aisles: Polylines, aisle: Int) -> tuple[Int, Float]:
    """Return where rows bend between plants ``(k, 2)``, and the plant before each."""
    row, place_m = grid.row, grid.along_m
    wide = np.diff(place_m) > _GAP * grid.plant_spacing_m
    before = np.flatnonzero(wide & (np.diff(grid.unbroken_row) == 0))
    lane, from_m, to_m = aisle[row[before]], place_m[before], place_m[before + 1]
    first = aisles.corner_before(lane, from_m) + 1
    count = np.maximum(aisles.corner_before(lane, to_m) + 1 - first, 0)
    corner, gap = runs(first, count)
    share = (aisles.at_m[corner] - from_m[gap]) / (to_m - from_m)[gap]
    left_m = _left_of_lane(grid, aisles, aisle)
    off_m = left_m[before][gap] * (1 - share) + left_m[before + 1][gap] * share
    ahead = aisles.xy_m[corner + 1] - aisles.xy_m[corner - 1]
    ahead /= np.maximum(np.hypot(ahead[:, 0], ahead[:, 1]), 1e-12)[:, None]
    aside = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    return before[gap], aisles.xy_m[corner] + off_m[:, None] * aside


def _left_of_lane(grid: PlantGrid, aisles: Polylines, aisle: Int) -> Float:
    """Return how far to the left of its lane each plant stands, ``(n,)``; below 0: right."""
    ahead = aisles.ahead(aisle[grid.row], grid.along_m)
    way = grid.xy_m - grid.stop_m
    left = ahead[:, 0] * way[:, 1] - ahead[:, 1] * way[:, 0] >= 0.0
    far: Float = np.hypot(way[:, 0], way[:, 1])
    return np.where(left, far, -far)
