"""Strands: plants along a line, sorted, with the line through them smoothed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import offsets
from fieldmon.compute.jit import routine
from fieldmon.plot.polylines import Polylines

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# a line is smoothed over so many plants: 13 follow a bend of 30 m and halve errors of position
_SMOOTHED = 13


class Strands(NamedTuple):
    """Plants along lines: ``plant (n,)`` in order, lines from ``start``, smoothed ``line_m``."""

    plant: Int
    start: Int
    line_m: Float
    ahead: Float  # (n, 2) unit vectors along

    def __repr__(self) -> str:
        return f"<Strands: {len(self.plant)} plants on {len(self.start) - 1} lines>"

    @property
    def owner(self) -> Int:
        """Return the strand of each plant, ``(n,)``."""
        return np.repeat(np.arange(len(self.start) - 1), np.diff(self.start))


def ordered(xy_m: Float, strand: Int, along: Float, angle: Float | None = None) -> Strands:
    """Return plants sorted along their strands, with the lines through them."""
    plant = np.lexsort((along, strand))
    start = offsets(np.bincount(strand))
    line_m, ahead = np.empty((len(plant), 2)), np.empty((len(plant), 2))
    _smooth(xy_m[plant], start, along[plant], (line_m, ahead, np.empty(len(plant))))
    if angle is not None:
        few = np.repeat(np.diff(start) < 3, np.diff(start))
        turn = angle[plant[few]]
        ahead[few] = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return Strands(plant, start, line_m, ahead)


@routine
def _smooth(xy_m: Float, start: Int, along: Float, made: tuple[Float, Float, Float]) -> None:
    """Fit a parabola about each plant: its point and direction there, and the plant's own part."""
    line_m, ahead, own = made
    for row in range(start.size - 1):
        first, end = start[row], start[row + 1]
        for i in range(first, end):
            low = max(min(i - _SMOOTHED // 2, end - _SMOOTHED), first)
            high = min(low + _SMOOTHED, end)
            reach = max(along[i] - along[low], along[high - 1] - along[i]) * 1.2 + 1e-9
            s0, s1, s2, s3, s4 = 0.0, 0.0, 0.0, 0.0, 0.0
            x0, x1, x2, y0, y1, y2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for k in range(low, high):
                t = (along[k] - along[i]) / reach
                weight = (1.0 - abs(t) ** 3) ** 3
                x, y = xy_m[k, 0] - xy_m[i, 0], xy_m[k, 1] - xy_m[i, 1]
                s0 += weight
                s1 += weight * t
                s2 += weight * t * t
                s3 += weight * t**3
                s4 += weight * t**4
                x0, x1, x2 = x0 + weight * x, x1 + weight * x * t, x2 + weight * x * t * t
                y0, y1, y2 = y0 + weight * y, y1 + weight * y * t, y2 + weight * y * t * t
            n = high - low
            px, dx, own[i] = _fit(n, (s0, s1, s2, s3, s4), (x0, x1, x2))
            py, dy, own[i] = _fit(n, (s0, s1, s2, s3, s4), (y0, y1, y2))
            line_m[i, 0], line_m[i, 1] = xy_m[i, 0] + px, xy_m[i, 1] + py
            length = np.hypot(dx, dy)
            ahead[i, 0] = dx / length if length > 0 else 1.0
            ahead[i, 1] = dy / length if length > 0 else 0.0


@routine
def _fit(
    n: int, s: tuple[float, float, float, float, float], v: tuple[float, float, float]
) -> tuple[float, float, float]:
    """Return value and slope at 0 of the weighted parabola, or line where plants are few.

    And the part of the value that is the plant's own at 0.
    """
    if n < 2:
        return 0.0, 0.0, 0.0
    if n < 6:
        det = s[0] * s[2] - s[1] * s[1]
        if det <= 1e-12:
            return 0.0, 0.0, 0.0
        value = (s[2] * v[0] - s[1] * v[1]) / det
        return value, (s[0] * v[1] - s[1] * v[0]) / det, s[2] / det
    c0, c1, c2 = s[2] * s[4] - s[3] * s[3], s[2] * s[3] - s[1] * s[4], s[1] * s[3] - s[2] * s[2]
    det = s[0] * c0 + s[1] * c1 + s[2] * c2
    if abs(det) <= 1e-12:
        return 0.0, 0.0, 0.0
    d1, d2 = s[0] * s[4] - s[2] * s[2], s[1] * s[2] - s[0] * s[3]
    value = (c0 * v[0] + c1 * v[1] + c2 * v[2]) / det
    return value, (c1 * v[0] + d1 * v[1] + d2 * v[2]) / det, c0 / det


def lines_of(strands: Strands) -> Polylines:
    """Return the lines of strands; that of a single plant is short."""
    alone = np.flatnonzero(np.diff(strands.start) == 1)
    at = strands.start[alone]
    xy_m = np.insert(strands.line_m, at + 1, strands.line_m[at] + 0.01 * strands.ahead[at], axis=0)
    return Polylines.of(strands.start + np.searchsorted(alone, np.arange(len(strands.start))), xy_m)


class RowDeviations(NamedTuple):
    """How far plants stand beside the lines of their rows.

    ``left_m (n,)`` to the left of the line through all of them, below 0 to its right;
    ``alone_m (n,)`` from that of the others; and how many are ``free`` to say so: a line that
    bends follows few plants of itself, about a fourth of them and two a row.
    """

    left_m: Float
    alone_m: Float
    free: float

    def __repr__(self) -> str:
        return f"<RowDeviations: {len(self.left_m)} plants>"


def row_deviations(xy_m: Float, row: NDArray[np.integer]) -> RowDeviations:
    """Return how far plants stand beside their rows; they come row by row, along each."""
    n_plants = np.bincount(row)
    n_plants = n_plants[n_plants > 0]
    start = offsets(n_plants)
    line_m, ahead, own = np.empty_like(xy_m), np.empty_like(xy_m), np.empty(len(xy_m))
    step = np.append(0.0, np.hypot(*np.diff(xy_m, axis=0).T))
    xy_m = np.ascontiguousarray(xy_m)
    _smooth(xy_m, start, np.cumsum(step), (line_m, ahead, own))
    off = xy_m - line_m
    left_m: Float = ahead[:, 0] * off[:, 1] - ahead[:, 1] * off[:, 0]
    alone_m: Float = np.abs(left_m) / np.maximum(1.0 - own, 0.2)
    return RowDeviations(left_m, alone_m, float(np.maximum(0.75 * n_plants - 2.0, 0.0).sum()))
