"""Lines one after the other, bent or not: places along them, and what lies beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np
import shapely

from fieldmon.compute.arrays import as_compiled, offsets, read_only, runs
from fieldmon.compute.jit import inner_inlined, routine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# who is so much farther from a line than the point before is looked for on all of it: it may turn
_ASTRAY_M = 1.0


class Polylines(NamedTuple):
    """Lines of straight steps; a *place* on one is in metres along it from its first corner.

    Parameters
    ----------
    start
        ``(k + 1,)`` offsets: corners of line i are ``xy_m[start[i]:start[i + 1]]``, two or more.
    xy_m
        ``(v, 2)`` corners.
    at_m
        ``(v,)`` the place of each corner on its line.
    """

    start: Int
    xy_m: Float
    at_m: Float

    def __repr__(self) -> str:
        return f"<Polylines: {len(self.start) - 1} lines>"

    @classmethod
    def of(cls, start: NDArray[np.integer], xy_m: Float) -> Self:
        """Return lines from their corners."""
        step = np.append(0.0, np.hypot(*np.diff(xy_m, axis=0).T))
        step[start[:-1]] = 0.0
        gone = np.cumsum(step)
        at_m = gone - np.repeat(gone[start[:-1]], np.diff(start))
        return cls(np.ascontiguousarray(start, np.int64), np.ascontiguousarray(xy_m), at_m)

    @classmethod
    def each(cls, lines: Sequence[Float]) -> Self:
        """Return lines from the corners of each, ``(k, 2)``."""
        start = offsets(np.array([len(line) for line in lines], np.int64))
        return cls.of(start, np.concatenate(lines) if len(lines) else np.empty((0, 2)))

    def __len__(self) -> int:
        """Return the number of lines."""
        return len(self.start) - 1

    def line(self, i: int) -> Float:
        """Return the corners of a line, ``(k, 2)``."""
        return self.xy_m[self.start[i] : self.start[i + 1]]

    @property
    def length_m(self) -> Float:
        """Return the length of each line."""
        return self.at_m[self.start[1:] - 1]

    def shapes(self) -> NDArray[np.object_]:
        """Return each as a shapely line."""
        owner = np.repeat(np.arange(len(self)), np.diff(self.start))
        return np.asarray(shapely.linestrings(self.xy_m, indices=owner), np.object_)

    def simpler(self, off_m: float) -> Self:
        """Return the lines with as few corners as keep them this near to what they were."""
        thin = shapely.simplify(self.shapes(), off_m, preserve_topology=False)
        xy_m, owner = shapely.get_coordinates(thin, return_index=True)
        return self.of(offsets(np.bincount(owner, minlength=len(self))), xy_m)

    def extended(self, by_m: float) -> Self:
        """Return the lines longer at both ends, straight on. Places on them move by as much."""
        first, last = self.start[:-1], self.start[1:] - 1
        owner = np.repeat(np.arange(len(self)), np.diff(self.start))
        start = self.start + 2 * np.arange(len(self) + 1)
        xy_m = np.empty((start[-1], 2))
        xy_m[np.arange(len(owner)) + 2 * owner + 1] = self.xy_m
        xy_m[start[:-1]] = self.xy_m[first] + by_m * _unit(self.xy_m[first] - self.xy_m[first + 1])
        xy_m[start[1:] - 1] = self.xy_m[last] + by_m * _unit(self.xy_m[last] - self.xy_m[last - 1])
        return self.of(start, xy_m)

    def points(self, line: NDArray[np.integer], place_m: Float) -> Float:
        """Return where places on lines are, ``(m, 2)``; beyond an end, straight on."""
        xy_m = np.empty((len(place_m), 2))
        places = as_compiled(np.asarray(line, np.int64)), as_compiled(np.asarray(place_m, float))
        _points(self._fixed(), *places, xy_m)
        return xy_m

    def ahead(self, line: NDArray[np.integer], place_m: Float) -> Float:
        """Return the directions of lines at places, unit vectors ``(m, 2)``."""
        at = self.corner_before(line, place_m)
        return _unit(self.xy_m[at + 1] - self.xy_m[at])

    def corners_between(self, line: int, from_m: float, to_m: float) -> Float:
        """Return the corners strictly between two places of a line, in the order driven."""
        first, end = int(self.start[line]), int(self.start[line + 1])
        low, high = min(from_m, to_m), max(from_m, to_m)
        a = first + int(np.searchsorted(self.at_m[first:end], low, side="right"))
        b = first + int(np.searchsorted(self.at_m[first:end], high, side="left"))
        inner = self.xy_m[a:b]
        return inner if from_m <= to_m else inner[::-1]

    def stretches(self, line: NDArray[np.integer], from_m: Float, to_m: Float) -> Self:
        """Return stretches of lines, each between two places, with the corners between.

        Backwards where the second place is the lesser one.
        """
        low, high = (self.corner_before(line, f(from_m, to_m)) for f in (np.minimum, np.maximum))
        n = high - low
        corner, of = runs(low + 1, n)
        back = (from_m > to_m)[of]
        corner[back] = (low + 1 + high)[of[back]] - corner[back]
        start = offsets(n + 2)
        xy_m = np.empty((start[-1], 2))
        xy_m[np.arange(len(of)) + 2 * of + 1] = self.xy_m[corner]
        xy_m[start[:-1]] = self.points(line, from_m)
        xy_m[start[1:] - 1] = self.points(line, to_m)
        return self.of(start, xy_m)

    def project(self, xy_m: Float, line: NDArray[np.integer]) -> tuple[Float, Float]:
        """Return the place of each point on a given line, and how far to its left it is.

        Points ``(m, 2)`` of one line come one after the other, in about its order. Beyond an end
        places go on, below 0 or above the length.
        """
        place, left = np.empty(len(xy_m)), np.empty(len(xy_m))
        of = as_compiled(np.asarray(line, np.int64))
        _project(self._fixed(), as_compiled(xy_m), of, place, left)
        return place, left

    def corner_before(self, line: NDArray[np.integer], place_m: Float) -> Int:
        """Return the corner before each place, numbered through all lines."""
        at = np.empty(len(place_m), np.int64)
        places = as_compiled(np.asarray(line, np.int64)), as_compiled(np.asarray(place_m, float))
        _corner_before(self._fixed(), *places, at)
        return at

    def _fixed(self) -> Self:
        """Return the same lines as loops are compiled for them, whoever may change them."""
        start, xy_m, at_m = self.start.view(), self.xy_m.view(), self.at_m.view()
        return type(self)(read_only(start), read_only(xy_m), read_only(at_m))


def sampled(lines: Polylines, step_m: float) -> tuple[Int, Float]:
    """Return places on lines about a step apart, both ends among them: the line and the place."""
    n = np.maximum(np.ceil(lines.length_m / step_m).astype(np.int64), 1)
    place, line = runs(np.zeros(len(lines), np.int64), n + 1)
    return line, place * (lines.length_m / n)[line]


def _unit(way: Float) -> Float:
    length = np.hypot(way[:, 0], way[:, 1])[:, None]
    units: Float = way / np.maximum(length, 1e-12)
    return units


@routine
def _corner_before(lines: Polylines, line: Int, place_m: Float, at: Int) -> None:
    for i in range(at.size):
        at[i] = _before(lines, line[i], place_m[i])


@routine
def _points(lines: Polylines, line: Int, place_m: Float, xy_m: Float) -> None:
    for i in range(place_m.size):
        at = _before(lines, line[i], place_m[i])
        length = max(lines.at_m[at + 1] - lines.at_m[at], 1e-12)
        share = (place_m[i] - lines.at_m[at]) / length
        for k in range(2):
            a, b = lines.xy_m[at, k], lines.xy_m[at + 1, k]
            xy_m[i, k] = a + share * (b - a)


@inner_inlined
def _before(lines: Polylines, line: int, place_m: float) -> int:
    """Return the corner before a place, numbered through all lines."""
    low, high = lines.start[line], lines.start[line + 1] - 1
    while high - low > 1:
        middle = (low + high) // 2
        if lines.at_m[middle] <= place_m:
            low = middle
        else:
            high = middle
    return int(low)


@routine
def _project(lines: Polylines, xy_m: Float, line: Int, place: Float, left: Float) -> None:
    start, corner, at_m = lines
    at, last_line, off_m = 0, -1, 0.0
    for i in range(xy_m.shape[0]):
        first, end = start[line[i]], start[line[i] + 1] - 1
        fresh = line[i] != last_line
        low, high = (first, end) if fresh else (max(at - 1, first), min(at + 3, end))
        last_line = line[i]
        at, best = _nearest_step(corner, (low, high), xy_m[i], (low, np.inf))
        while at >= high - 1 and high < end:  # not at the brink of what was looked at
            here, high = high, min(high + 16, end)
            at, best = _nearest_step(corner, (here, high), xy_m[i], (at, best))
        while at <= low and low > first:
            here, low = low, max(low - 16, first)
            at, best = _nearest_step(corner, (low, here), xy_m[i], (at, best))
        if np.sqrt(best) > off_m + _ASTRAY_M and not fresh:
            at, best = _nearest_step(corner, (first, end), xy_m[i], (at, best))
        off_m = np.sqrt(best)
        wx, wy = corner[at + 1, 0] - corner[at, 0], corner[at + 1, 1] - corner[at, 1]
        x, y = xy_m[i, 0] - corner[at, 0], xy_m[i, 1] - corner[at, 1]
        length = np.hypot(wx, wy)
        share = (x * wx + y * wy) / max(length * length, 1e-12)
        if at > first:
            share = max(share, 0.0)
        if at + 1 < end:
            share = min(share, 1.0)
        place[i] = at_m[at] + share * length
        side = 1.0 if wx * y - wy * x >= 0.0 else -1.0
        left[i] = side * np.hypot(x - share * wx, y - share * wy)


@routine
def _nearest_step(
    corner: Float, among: tuple[int, int], xy_m: Float, known: tuple[int, float]
) -> tuple[int, float]:
    """Return the step nearest to a point among some and the one known, and how near, squared."""
    at, best = known
    for k in range(among[0], among[1]):
        off = _square_to(corner, k, xy_m[0], xy_m[1])
        if off < best:
            at, best = k, off
    return at, best


@routine
def _square_to(corner: Float, k: int, x: float, y: float) -> float:
    wx, wy = corner[k + 1, 0] - corner[k, 0], corner[k + 1, 1] - corner[k, 1]
    px, py = x - corner[k, 0], y - corner[k, 1]
    share = min(max((px * wx + py * wy) / max(wx * wx + wy * wy, 1e-12), 0.0), 1.0)
    square: float = (px - share * wx) ** 2 + (py - share * wy) ** 2
    return square
