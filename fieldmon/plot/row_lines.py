"""Rows as lines, the ground about them, and the stretches of it on which nothing can stand."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arrays import runs
from fieldmon.plot.aisle_lines import aisles_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.plot.aisle_lines import RowAisles
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.polylines import Polylines

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

#: the sides of a row, in the order of its aisles
RIGHT, LEFT = 0, 1
# a strip beside a row reaches to one aisle, or to both
_ONE, _BOTH = 1, 2
# strips along rows are looked at so finely beside obstacles, in plant spacings
_FINE = 0.25


class RowLines(NamedTuple):
    """Rows as lines in metres of a plot's frame.

    Parameters
    ----------
    lines
        The rows, block by block, in each from right to left of their direction.
    block
        ``(r,)`` the block of each row, ascending from 0 without gaps.
    spacing_m
        ``(r, 2)`` from each row to the next and from plant to plant in it, where blocks are
        planted differently; None: as the planting says.
    called
        ``(r,)`` the block that people mean, ascending, where it has several of these; None: each
        is one.
    """

    lines: Polylines
    block: Int
    spacing_m: Float | None = None
    called: Int | None = None

    def __repr__(self) -> str:
        return f"<RowLines: {len(self.block)} rows>"

    def spacings(self, planting: Planting) -> Float:
        """Return ``(r, 2)`` from each row to the next and from plant to plant in it."""
        if self.spacing_m is not None:
            return self.spacing_m
        each = [planting.row_spacing_m, planting.plant_spacing_m]
        return np.tile(each, (len(self.block), 1))


class Blocked(NamedTuple):
    """Where rows cannot go on: row, from which place on its line, and to which; ascending."""

    row: Int
    from_m: Float
    to_m: Float

    def __repr__(self) -> str:
        return f"<Blocked: {len(self.row)} stretches>"

    @classmethod
    def nowhere(cls) -> Blocked:
        """Return no such stretch."""
        return cls(np.empty(0, np.int64), np.empty(0), np.empty(0))


class Ground(NamedTuple):
    """Where rows and lanes may be, metres of the frame.

    Parameters
    ----------
    area
        Where one may drive; None: wherever rows with their aisles and headlands reach.
    obstacles
        What stands in the way of rows and lanes.
    blocked
        Where rows cannot go on if that is known already, else None.
    aisles
        The aisles of the rows if they are known already, else None.
    """

    area: MultiPolygon | None
    obstacles: shapely.Geometry
    blocked: Blocked | None = None
    aisles: RowAisles | None = None


def row_aisles(rows: RowLines, planting: Planting) -> RowAisles:
    """Return the aisles of rows, out into their headlands."""
    beyond_m = 2 * planting.headland_m
    return aisles_of(rows.lines, rows.block, rows.spacings(planting)[:, 0], beyond_m)


def blocked_by(
    obstacles: shapely.Geometry, rows: RowLines, aisles: RowAisles, planting: Planting
) -> Blocked:
    """Return where something stands between rows and the aisle they are inspected from."""
    if shapely.is_empty(obstacles):
        return Blocked.nowhere()

    def is_blocked(shapes: NDArray[np.object_]) -> NDArray[np.bool_]:
        met: NDArray[np.bool_] = shapely.intersects(obstacles, shapes)
        return met

    return blocked_stretches(rows, aisles, planting, is_blocked)


def blocked_stretches(
    rows: RowLines,
    aisles: RowAisles,
    planting: Planting,
    is_blocked: Callable[[NDArray[np.object_]], NDArray[np.bool_]],
    *,
    whole: bool = False,
) -> Blocked:
    """Return the stretches of rows whose strip to the aisle is blocked, headlands included.

    `is_blocked` tells of shapes ``(k,)`` whether they are; it is asked of long strips first, and of
    fine ones where these are. The `whole` strip reaches to both aisles, whichever is needed.
    """
    sides = _BOTH if whole or planting.faces == 2 else _ONE
    far_m = planting.headland_m + 1.0
    plant_m = float(rows.spacings(planting)[:, 1].min())
    coarse_m = 16 * plant_m
    n = np.ceil((rows.lines.length_m + 2 * far_m) / coarse_m).astype(np.int64)
    k, row = runs(np.zeros(len(n), np.int64), n)
    from_m = np.asarray(k * coarse_m - far_m, np.float64)
    to_m: Float = np.minimum(from_m + coarse_m, rows.lines.length_m[row] + far_m)
    hit = np.flatnonzero(is_blocked(_strips(rows, aisles, sides, (row, from_m, to_m))))
    m = int(np.ceil(coarse_m / (_FINE * plant_m)))
    j, of = runs(np.zeros(len(hit), np.int64), np.full(len(hit), m))
    row, step = row[hit][of], ((to_m - from_m)[hit] / m)[of]
    from_m = from_m[hit][of] + j * step
    to_m = from_m + step
    blocked = np.flatnonzero(is_blocked(_strips(rows, aisles, sides, (row, from_m, to_m))))
    row, from_m, to_m = row[blocked], from_m[blocked], to_m[blocked]
    if not len(row):
        return Blocked.nowhere()
    new = np.append(True, (np.diff(row) > 0) | (from_m[1:] > to_m[:-1] + 1e-6))
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(row)) - 1
    return Blocked(row[first], from_m[first], to_m[last])


def _strips(
    rows: RowLines, aisles: RowAisles, sides: int, stretches: tuple[Int, Float, Float]
) -> NDArray[np.object_]:
    """Return the ground between rows and the middle of their aisle, or both, as polygons.

    With every corner of either side: a lane lies on the edge.
    """
    row, from_m, to_m = stretches

    def aisle_middle(side: int) -> Polylines:
        aisle = (aisles.left if side == LEFT else aisles.right)[row]
        ends = (rows.lines.points(row, place_m) for place_m in (from_m, to_m))
        low, high = (aisles.lines.project(end, aisle)[0] for end in ends)
        return aisles.lines.stretches(aisle, low, high)

    left = aisle_middle(LEFT)
    right = aisle_middle(RIGHT) if sides == _BOTH else rows.lines.stretches(row, from_m, to_m)
    owner = np.concatenate([np.repeat(np.arange(len(row)), np.diff(right.start)),
                            np.repeat(np.arange(len(row)), np.diff(left.start))[::-1]])  # fmt: skip
    corners = np.concatenate([right.xy_m, left.xy_m[::-1]])
    order = np.argsort(owner, kind="stable")
    rings = shapely.linearrings(corners[order], indices=owner[order])
    return np.asarray(shapely.polygons(rings), np.object_)
