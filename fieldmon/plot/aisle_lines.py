"""The middle of each aisle between rows that bend."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import offsets
from fieldmon.plot.polylines import Polylines, sampled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# a middle has as few corners as keep it this near to where it would be with all
_THIN_M = 0.02
# rows are looked at as finely as keeps the middle this near to where it would be, and no coarser
# than so far
_NEAR_M, _STEP_M = 0.03, 4.0
_RIGHT, _LEFT = -1.0, 1.0


class RowAisles(NamedTuple):
    """The aisles of rows, block by block from the right of the first row to the left of the last.

    Parameters
    ----------
    lines
        The middle of each aisle, ``a = r + blocks`` of them, as long as the rows on both sides.
    right, left
        ``(r,)`` the aisle on either side of each row.
    """

    lines: Polylines
    right: Int
    left: Int

    def __repr__(self) -> str:
        return f"<RowAisles: {len(self.lines.start) - 1} aisles>"


def aisles_of(rows: Polylines, block: Int, row_spacing_m: Float, beyond_m: float) -> RowAisles:
    """Return the aisles of rows, longer than these at both ends.

    Midway between neighbouring rows of a block; beside its outermost rows half their distance to
    the next one off, or half the usual spacing.

    Parameters
    ----------
    rows
        By block, in each from right to left of their direction.
    block
        ``(r,)`` the block of each row, ascending without gaps.
    row_spacing_m
        ``(r,)`` the usual distance from each row to the next.
    beyond_m
        How much longer than the rows.
    """
    right = np.arange(len(rows)) + block
    line, place = sampled(rows, _step_m(rows, float(row_spacing_m.min())))
    start = offsets(np.bincount(line, minlength=len(rows)))
    thin = Polylines.of(start, rows.points(line, place))
    middles: list[Float] = []
    for row in range(len(rows)):
        first = row == 0 or block[row] != block[row - 1]
        last = row + 1 == len(rows) or block[row] != block[row + 1]
        usual_m = float(row_spacing_m[row])
        if first:
            gap_m = usual_m if last else _apart(rows, thin, row, row + 1, usual_m)
            middles.append(_shifted(thin.line(row), _RIGHT * gap_m / 2))
        if last:
            gap_m = usual_m if first else _apart(rows, thin, row, row - 1, usual_m)
            middles.append(_shifted(thin.line(row), _LEFT * gap_m / 2))
        else:
            middles.append(_between(rows, thin, row, (usual_m, beyond_m / 2)))
    lines = Polylines.each(middles).extended(beyond_m).simpler(_THIN_M)
    return RowAisles(lines, right, right + 1)


def _step_m(rows: Polylines, row_spacing_m: float) -> float:
    """Return how finely rows must be looked at where they bend most."""
    line, place = sampled(rows, _STEP_M)
    way = np.diff(rows.points(line, place), axis=0)[np.diff(line) == 0]
    angle = np.arctan2(way[:, 1], way[:, 0])
    length = np.hypot(way[:, 0], way[:, 1])
    turn = np.abs((np.diff(angle) + np.pi) % (2 * np.pi) - np.pi)
    # steps of different rows meet nowhere
    of = line[1:][np.diff(line) == 0]
    bends = (turn / np.maximum(length[1:], 0.1))[np.diff(of) == 0]
    tightest_m = 1.0 / max(float(np.quantile(bends, 0.99)), 1e-3) if len(bends) else 1e3
    return float(min(1.5 * row_spacing_m, _STEP_M, np.sqrt(8 * _NEAR_M * tightest_m)))


def _apart(rows: Polylines, thin: Polylines, row: int, other: int, usual_m: float) -> float:
    """Return the distance from one row to another where both are, at most the usual one."""
    line = thin.line(row)
    place, left = rows.project(line, np.full(len(line), other))
    beside = (place >= 0) & (place <= rows.length_m[other])
    return min(float(np.median(np.abs(left[beside]))), usual_m) if beside.any() else usual_m


def _between(rows: Polylines, thin: Polylines, row: int, reach_m: tuple[float, float]) -> Float:
    """Return the middle between a row and the next one, as long as the longer one at each end.

    `reach_m` is the usual distance between them, and how far lanes reach beyond either.
    """
    row_spacing_m, lane_m = reach_m
    here, there = thin.line(row), thin.line(row + 1)
    place, left = rows.project(here, np.full(len(here), row + 1))
    beside = (place >= 0) & (place <= rows.length_m[row + 1])
    half = np.full(len(here), row_spacing_m / 2)
    if beside.any():
        index = np.arange(len(here))
        # to the next row's left or right as it is measured: half the way there
        half = np.interp(index, index[beside], np.abs(left[beside]) / 2)
        foot = rows.points(np.full(int(beside.sum()), row + 1), place[beside])
    middle = _shifted(here, half)
    if beside.any():
        middle[beside] = (here[beside] + foot) / 2
    beyond, _ = rows.project(there, np.full(len(there), row))
    clear = 0.25 * row_spacing_m
    before = _shifted(there, -np.full(len(there), half[0]))[beyond < -clear]
    after = _shifted(there, -np.full(len(there), half[-1]))[beyond > rows.length_m[row] + clear]
    return _joined(_joined(before, middle, lane_m), after, lane_m)


def _joined(first: Float, last: Float, reach_m: float) -> Float:
    """Return two lines in one: each goes straight on before it turns to the other.

    So far that a lane that ends there does not turn, if there is room.
    """
    if not len(first) or not len(last):
        return np.concatenate([first, last])
    on_m = min(reach_m, float(np.hypot(*(last[0] - first[-1]))) / 3)
    onward, back = (_straight_on(line, on_m) for line in (first, last[::-1]))
    return np.concatenate([first, onward, back, last])


def _straight_on(line: Float, by_m: float) -> Float:
    """Return the place straight on from the end of a line, ``(1, 2)``; none if it is a point."""
    if len(line) < 2:
        return np.empty((0, 2))
    way = line[-1] - line[-2]
    onward: Float = line[-1:] + by_m * way / max(float(np.hypot(*way)), 1e-12)
    return onward


def _shifted(line: Float, left_m: Float | float) -> Float:
    """Return the corners of a line moved to its left, each at right angles to the line there."""
    step = np.diff(line, axis=0)
    step /= np.maximum(np.hypot(step[:, 0], step[:, 1]), 1e-12)[:, None]
    ahead = np.concatenate([step[:1], step[:-1] + step[1:], step[-1:]])
    ahead /= np.maximum(np.hypot(ahead[:, 0], ahead[:, 1]), 1e-12)[:, None]
    moved: Float = line + np.stack([-ahead[:, 1], ahead[:, 0]], axis=1) * np.reshape(
        left_m, (-1, 1)
    )
    return moved
