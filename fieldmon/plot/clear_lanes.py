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
    Rows = NDArray[np.intp]

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
        The same plants; rows whose lanes are cut are in pieces, one for each stretch of lane.
    hidden
        ``(n,)`` which plants can be inspected from no part of their lane that can be entered.
    of
        ``(r,)`` of which row each of its rows is a piece.
    """

    grid: PlantGrid
    hidden: Mask
    of: Rows

    def __repr__(self) -> str:
        return f"<ClearLanes: {int(self.hidden.sum())} of {len(self.grid)} plants hidden>"


def clear_lanes(grid: PlantGrid, off: shapely.Geometry) -> ClearLanes:
    """Return a grid whose lanes keep off an area.

    Each stretch of a lane that is cut is driven from its own end. Plants beside the area are
    inspected from before it, or are hidden if that is too far; and so are those of a stretch that
    is closed at both ends.
    """
    whole = ClearLanes(grid, np.zeros(len(grid), np.bool_), np.arange(grid.n_rows))
    off = shapely.buffer(off, -_EDGE_M, join_style="mitre")
    if shapely.is_empty(off):
        return whole
    shapely.prepare(off)
    lanes = lane_lines(grid)
    met = np.unique(grid.stretches[np.flatnonzero(shapely.intersects(off, lanes))])
    if not len(met):
        return whole
    pieces = _Pieces(grid)
    for stretch in met.tolist():
        rows = np.flatnonzero(grid.stretches == stretch)
        pieces.cut(rows, _free(grid, rows, (off, lanes)))
    return pieces.laid()


def measured_clear(grid: PlantGrid, off: shapely.Geometry) -> PlantGrid:
    """Return measured rows whose lanes keep off an area, whoever inspects them.

    Lanes that are cut to little more than their last plants end at them: nobody turns there.
    """
    clear = clear_lanes(grid, off)
    before, grid = grid, clear.grid
    if grid is before:
        return grid
    moved = (grid.lane_x_m != before.lane_x_m[clear.of]) & ~grid.cut_ends
    short = (grid.beyond_plants_m < _LEAST_M) & moved
    return replace(grid, lane_x_m=np.where(short, grid.along_m[grid.end_plants], grid.lane_x_m))


class _Piece(NamedTuple):
    """A piece of a row: where its plants end, its lane, its stretch of that, which ends are cut."""

    end: int
    lane_m: Float
    stretch: int
    cut: Mask


class _Pieces:
    """The rows of a grid, of which some are cut into pieces."""

    def __init__(self, grid: PlantGrid) -> None:
        self._grid = grid
        self._place_m, self._hidden = grid.along_m.copy(), np.zeros(len(grid), np.bool_)
        self._cut: dict[int, list[_Piece]] = {}
        self._n_stretches = int(grid.stretches.max()) + 1

    def cut(self, rows: Rows, free: list[tuple[float, float]]) -> None:
        """Cut the rows of one stretch of lane: of that only some is free, ``(low, high)`` each."""
        start = self._grid.row_start
        plants = [np.arange(start[row], start[row + 1]) for row in rows]
        low_m, high_m = np.array(free).reshape(-1, 2).T
        away_m = [self._away_m(own, low_m, high_m) for own in plants]
        seen = np.array([(own_m <= REACH_M).any(axis=0) for own_m in away_m])
        used = seen.any(axis=0)
        if not used.any():
            self._hidden[np.concatenate(plants)] = True
            return
        ends = [self._ends(row, low_m, high_m) for row in rows]
        # nobody gets into what is cut at both ends
        shut = np.array(
            [cut.all(axis=1) | ~near for (_, cut), near in zip(ends, seen, strict=True)]
        )
        for k, row in enumerate(rows.tolist()):
            free_m, cut = ends[k]
            nearest = away_m[k] + REACH_M * (shut.all(axis=0) & (away_m[k] <= REACH_M))
            own = np.maximum.accumulate(np.argmin(np.where(used, nearest, np.inf), axis=1))
            self._hidden[plants[k]] = away_m[k][np.arange(len(own)), own] > REACH_M
            self._place_m[plants[k]] = np.clip(self._place_m[plants[k]], low_m[own], high_m[own])
            begins = np.flatnonzero(np.diff(own, prepend=-1) != 0)
            self._cut[row] = [
                _Piece(int(plants[k][last]) + 1, free_m[j], self._n_stretches + int(j), cut[j])
                for j, last in zip(own[begins], [*(begins[1:] - 1), -1], strict=True)
            ]
        self._n_stretches += len(free)

    def _away_m(self, plants: Rows, low_m: Float, high_m: Float) -> Float:
        """Return how far plants are ahead of stretches ``(k,)`` or behind them, ``(p, k)``."""
        at_m = self._grid.along_m[plants, None]
        away_m: Float = np.maximum(np.maximum(low_m - at_m, at_m - high_m), 0.0)
        return away_m

    def _ends(self, row: int, low_m: Float, high_m: Float) -> tuple[Float, Mask]:
        """Return where the lane of a row ends in stretches, and where it is cut, ``(k, 2)``.

        That is where the row goes on.
        """
        grid = self._grid
        free_m = np.clip(grid.lane_x_m[row], low_m[:, None], high_m[:, None])
        first_m, last_m = grid.along_m[grid.end_plants[row]]
        goes_on = np.stack([first_m < free_m[:, 0], last_m > free_m[:, 1]], axis=1)
        return free_m, np.where(free_m == grid.lane_x_m[row], grid.cut_ends[row], goes_on)

    def laid(self) -> ClearLanes:
        """Return the grid of all pieces."""
        grid, pieces, of = self._grid, [], []
        for row in range(grid.n_rows):
            own = self._cut.get(row) or [
                _Piece(
                    grid.row_start[row + 1],
                    grid.lane_x_m[row],
                    grid.stretches[row],
                    grid.cut_ends[row],
                )
            ]
            pieces += own
            of += [row] * len(own)
        rows = np.array(of)
        cut = np.array([piece.cut for piece in pieces])
        lane_m = np.array([piece.lane_m for piece in pieces])
        if len(pieces) == grid.n_rows and not cut.any():
            laid = replace(grid, lane_x_m=lane_m, place_m=self._place_m)
            return ClearLanes(laid, self._hidden, rows)
        stretch = np.unique([piece.stretch for piece in pieces], return_inverse=True)[1]
        laid = replace(
            grid,
            row_start=np.array([0, *(piece.end for piece in pieces)], np.int64),
            row_line=grid.row_line[rows],
            lane_y_m=grid.lane_y_m[rows],
            lane_x_m=lane_m,
            corridor=grid.corridor[rows],
            side=grid.side[rows],
            block=None if grid.block is None else grid.block[rows],
            aisle=None if grid.aisle is None else grid.aisle[rows],
            place_m=self._place_m,
            stretch=stretch.astype(np.int32),
            whole=(rows if grid.whole is None else grid.whole[rows]).astype(np.int32),
            cut=cut,
        )
        return ClearLanes(laid, self._hidden | laid.closed_rows[laid.row], rows)


def hidden_plants(grid: PlantGrid) -> Mask:
    """Tell of each plant ``(n,)`` whether its place along its lane is too far ahead of it.

    Or whether nobody gets to it, its stretch of lane being closed at both ends.
    """
    if grid.aisles_m is None or grid.aisle is None:
        beside_m = grid.xy_m[:, 0]
    else:
        beside_m, _ = grid.aisles_m.project(grid.xy_m, grid.aisle[grid.row])
    hidden: Mask = np.abs(grid.along_m - beside_m) > REACH_M + _EDGE_M
    return hidden | grid.closed_rows[grid.row]


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


def _free(
    grid: PlantGrid, rows: Rows, there: tuple[shapely.Geometry, Shapes]
) -> list[tuple[float, float]]:
    """Return what is free of the lanes of one stretch, from low to high."""
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
    return free
