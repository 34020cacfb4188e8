"""Ways that bend along the middle of an aisle, and rows that bend as obstacles to others."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np
import shapely

from fieldmon.compute.arrays import offsets
from fieldmon.compute.jit import routine
from fieldmon.plot.row_course import row_courses

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.polylines import Polylines

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]
    Mask = NDArray[np.bool_]

# rows drawn by plants in line need not be looked at plant by plant
_THIN_M = 0.02


class Bends(NamedTuple):
    """Stretches of aisles between neighbouring nodes on them, b in all.

    Parameters
    ----------
    pair
        ``(b, 2)`` the nodes.
    aisle
        ``(b,)`` the aisle.
    at_m
        ``(b, 2)`` the places of the nodes along it.
    in_lane
        ``(b,)`` whether it is part of a row's own lane.
    aisles
        The middles of all aisles.
    """

    pair: Int
    aisle: Int
    at_m: Float
    in_lane: Mask
    aisles: Polylines

    def __repr__(self) -> str:
        return f"<Bends: {len(self.pair)} ways>"

    def where(self, some: Mask) -> Self:
        """Return some of the stretches."""
        return self._replace(
            pair=self.pair[some],
            aisle=self.aisle[some],
            at_m=self.at_m[some],
            in_lane=self.in_lane[some],
        )

    def numbered(self, number: Int) -> Bends:
        """Return the stretches between nodes numbered anew; those of nodes numbered -1 go."""
        pair = number[self.pair]
        known: Mask = np.asarray((pair >= 0).all(axis=1))
        return self._replace(pair=pair).where(known)

    def steps(self) -> tuple[Float, Float, Int]:
        """Return the straight steps of all stretches, from and to, and of which each is."""
        from_m, to_m, of = [np.empty((0, 2))], [np.empty((0, 2))], [np.empty(0, np.int64)]
        for k in range(len(self.aisle)):
            line = self._line(k)
            from_m.append(line[:-1])
            to_m.append(line[1:])
            of.append(np.full(len(line) - 1, k))
        return np.concatenate(from_m), np.concatenate(to_m), np.concatenate(of)

    def along(self, from_to: Int, length_m: Float) -> tuple[Int, Float]:
        """Set the lengths of ways that are stretches; return CSR corners of every way."""
        wide = int(from_to.max(initial=0)) + 1
        key = from_to[:, 0] * wide + from_to[:, 1]
        count = np.zeros(len(from_to), np.int64)
        corners: dict[int, Float] = {}
        for k, (a, b) in enumerate(self.pair.tolist()):
            inner = self.aisles.corners_between(int(self.aisle[k]), *self.at_m[k].tolist())
            for way, line in ((a * wide + b, inner), (b * wide + a, inner[::-1])):
                e = int(np.searchsorted(key, way))
                if e < len(key) and key[e] == way:
                    length_m[e] = abs(self.at_m[k, 1] - self.at_m[k, 0])
                    count[e], corners[e] = len(line), line
        ordered = [corners[e] for e in sorted(corners)]
        return offsets(count), np.concatenate([np.empty((0, 2)), *ordered])

    def _line(self, k: int) -> Float:
        aisle = np.full(2, self.aisle[k])
        ends = self.aisles.points(aisle, self.at_m[k])
        inner = self.aisles.corners_between(int(self.aisle[k]), *self.at_m[k].tolist())
        return np.concatenate([ends[:1], inner, ends[1:]])


def row_end_places(grid: PlantGrid) -> tuple[Float, Float]:
    """Return ``(r, 2, 3, 2)``: at each row end, right of the row, on its line and left of it.

    And ``(r, 2, 2)``: the places of the outer two along the aisles on either side.
    """
    aisles, own, side = _known(grid)
    ends = grid.end_plants
    plant_at = grid.along_m[ends]
    beyond = grid.lane_x_m - plant_at
    other = own + np.where(side < 0, -1, 1)
    across, _ = aisles.project(grid.xy_m[ends.ravel()], np.repeat(other, 2))
    far = across.reshape(-1, 2) + beyond
    lane = aisles.points(np.repeat(own, 2), grid.lane_x_m.ravel()).reshape(-1, 2, 2)
    beside = aisles.points(np.repeat(other, 2), far.ravel()).reshape(-1, 2, 2)
    ahead = aisles.ahead(np.repeat(own, 2), grid.lane_x_m.ravel()).reshape(-1, 2, 2)
    on_line = grid.xy_m[ends] + ahead * beyond[:, :, None]
    upper = (side < 0)[:, None, None]
    right, left = np.where(upper, beside, lane), np.where(upper, lane, beside)
    at_right = np.where(side[:, None] < 0, far, grid.lane_x_m)
    at_left = np.where(side[:, None] < 0, grid.lane_x_m, far)
    return np.stack([right, on_line, left], axis=2), np.stack([at_right, at_left], axis=2)


def bends_of(
    grid: PlantGrid,
    place: Int,
    at_m: Float,
    gate: tuple[int, int, float] | None,
    too_narrow: Mask | None = None,
) -> Bends:
    """Return the stretches between neighbouring nodes on each aisle; a gate may be one too.

    `place` numbers the nodes of `row_end_places`; `gate` is its node, aisle and place. The lanes
    of rows that are `too_narrow` ``(r,)`` are no lanes.
    """
    aisles, own, side = _known(grid)
    right = np.where(side < 0, own - 1, own)
    aisle = np.repeat(np.stack([right, right + 1], axis=1)[:, None], 2, axis=1).ravel()
    node, at = place[:, :, [0, 2]].ravel(), at_m.ravel()
    if gate is not None:
        node, aisle, at = (np.append(v, g) for v, g in zip((node, aisle, at), gate, strict=True))
    order = np.lexsort((at, aisle))
    node, aisle, at = node[order], aisle[order], at[order]
    next_ = np.flatnonzero((aisle[1:] == aisle[:-1]) & (node[1:] != node[:-1]))
    ends = np.stack([at[next_], at[next_ + 1]], axis=1)
    pair = np.stack([node[next_], node[next_ + 1]], axis=1)
    lanes = np.ones(len(own), np.bool_) if too_narrow is None else ~too_narrow
    in_lane = _in_lanes(grid.lane_x_m[lanes], own[lanes], aisle[next_], ends)
    return Bends(pair, aisle[next_], ends, in_lane, aisles)


def _in_lanes(lane_m: Float, own: Int, aisle: Int, ends: Float) -> Mask:
    """Tell of stretches whether a row is inspected from all of them."""
    far = float(max(np.abs(lane_m).max(), np.abs(ends).max(initial=0.0))) * 4 + 1.0
    low, high = (own * far + lane_m[:, end] for end in range(2))
    order = np.argsort(low)
    low, reached = low[order], np.maximum.accumulate(high[order])
    middle = aisle * far + ends.mean(axis=1)
    before = np.searchsorted(low, middle) - 1
    within: Mask = (before >= 0) & (reached[before.clip(0)] >= middle)
    return within


def _known(grid: PlantGrid) -> tuple[Polylines, Int, NDArray[np.int8]]:
    """Return the aisles of a grid whose rows bend, and which each row is inspected from."""
    if grid.aisles_m is None or grid.aisle is None:
        raise TypeError("rows are straight")  # pragma: no cover - a mistake of ours
    return grid.aisles_m, grid.aisle.astype(np.int64), grid.side


def row_steps(grid: PlantGrid, clearance_m: float) -> tuple[Float, Float]:
    """Return boxes and steps of the rows, ``(b, 4)`` each, sorted by the boxes' low y."""
    thin = shapely.simplify(row_courses(grid), _THIN_M, preserve_topology=False)
    xy_m, of = shapely.get_coordinates(thin, return_index=True)
    inner = np.flatnonzero(of[1:] == of[:-1])
    start, end = xy_m[inner], xy_m[inner + 1]
    by = clearance_m + _THIN_M
    box = np.concatenate([np.minimum(start, end) - by, np.maximum(start, end) + by], axis=1)
    order = np.argsort(box[:, 1])
    return box[order], np.concatenate([start, end], axis=1)[order]


@routine
def tallest_of(box_m: Float) -> float:
    """Return how far the tallest of boxes reaches from its low y to its high y."""
    tallest = 0.0
    for b in range(len(box_m)):  # numba's `max` of an array compiles for half a second
        tallest = max(tallest, box_m[b, 3] - box_m[b, 1])
    return tallest


@routine
def off_steps(
    rows: tuple[Float, Float], clearance_m: float, from_m: Float, to_m: Float, off: Mask
) -> None:
    """Set `off` to False for the straight lines that come as near as this to a step."""
    box_m, step_m = rows
    low_y = box_m[:, 1]
    tallest = tallest_of(box_m)
    near = clearance_m + _THIN_M
    for k in range(off.size):
        x0, x1 = min(from_m[k, 0], to_m[k, 0]), max(from_m[k, 0], to_m[k, 0])
        y0, y1 = min(from_m[k, 1], to_m[k, 1]), max(from_m[k, 1], to_m[k, 1])
        b = np.searchsorted(low_y, y0 - tallest)
        while off[k] and b < low_y.size and low_y[b] <= y1:
            if box_m[b, 0] <= x1 and box_m[b, 2] >= x0 and box_m[b, 3] >= y0:
                off[k] = _square_between(step_m[b], from_m[k], to_m[k]) > near * near
            b += 1


@routine
def _square_between(step: Float, a: Float, b: Float) -> float:
    """Return the square of the distance between two straight pieces."""
    cx, cy, dx, dy = step
    one = (b[0] - a[0]) * (cy - a[1]) - (b[1] - a[1]) * (cx - a[0])
    two = (b[0] - a[0]) * (dy - a[1]) - (b[1] - a[1]) * (dx - a[0])
    three = (dx - cx) * (a[1] - cy) - (dy - cy) * (a[0] - cx)
    four = (dx - cx) * (b[1] - cy) - (dy - cy) * (b[0] - cx)
    if one * two < 0.0 and three * four < 0.0:
        return 0.0
    of_ends = min(_square_off(cx, cy, a, b), _square_off(dx, dy, a, b))
    return min(of_ends, _square_to_step(a, step), _square_to_step(b, step))


@routine
def _square_off(x: float, y: float, a: Float, b: Float) -> float:
    wx, wy = b[0] - a[0], b[1] - a[1]
    share = ((x - a[0]) * wx + (y - a[1]) * wy) / max(wx * wx + wy * wy, 1e-18)
    share = min(max(share, 0.0), 1.0)
    square: float = (x - a[0] - share * wx) ** 2 + (y - a[1] - share * wy) ** 2
    return square


@routine
def _square_to_step(p: Float, step: Float) -> float:
    wx, wy = step[2] - step[0], step[3] - step[1]
    share = ((p[0] - step[0]) * wx + (p[1] - step[1]) * wy) / max(wx * wx + wy * wy, 1e-18)
    share = min(max(share, 0.0), 1.0)
    square: float = (p[0] - step[0] - share * wx) ** 2 + (p[1] - step[1] - share * wy) ** 2
    return square
