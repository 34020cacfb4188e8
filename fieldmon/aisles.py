"""Metres from any plant to any plant without crossing a row, and the line that is driven."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numba as nb
import numpy as np
import shapely

from fieldmon.headland import Ways, row_lines, ways

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from shapely import MultiPolygon

    from fieldmon.grid import PlantGrid

    Float = NDArray[np.float64]

_TOUCH_M = 0.01
_BLOCK = 32
_STRAIGHT = 1e-9


class Ground(NamedTuple):
    """What compiled loops need to know of a plot: plants, rows, and the ways between rows.

    Parameters
    ----------
    x_m
        ``(n,)`` position of each plant along its row.
    row
        ``(n,)`` int32 row of each plant.
    row_start
        ``(r + 1,)`` offsets: plants of row k are ``row_start[k]:row_start[k + 1]``.
    end_x_m
        ``(r, 2)`` x of the ends of each row's lane, low and high.
    between_m
        ``(2r + 1, 2r + 1)`` shortest ways between lane ends: 2k is the low-x end of lane k,
        2k + 1 its high-x end, 2r the gate.
    corridor
        ``(r,)`` rows with the same number are inspected from the same stretch of aisle.
    side
        ``(r,)`` on which side of its lane the row is: -1 lower y, +1 higher y.
    """

    x_m: Float
    row: NDArray[np.int32]
    row_start: NDArray[np.int64]
    end_x_m: Float
    between_m: Float
    corridor: NDArray[np.int32]
    side: NDArray[np.int8]


@dataclass(frozen=True, eq=False)
class Aisles:
    """The ways between the plants of a plot.

    A robot drives along the aisles and changes rows in the headlands; it crosses no row. Plants
    are given by number; -1 is the gate, where a working day starts and ends.

    Parameters
    ----------
    grid
        The plants.
    ways
        The network of ways between lane ends.
    ground
        The same for compiled loops, see `drive_m`.
    """

    grid: PlantGrid
    ways: Ways
    ground: Ground

    @classmethod
    def of(
        cls,
        grid: PlantGrid,
        gate_xy_m: tuple[float, float] | None = None,
        no_go_m: MultiPolygon | None = None,
    ) -> Aisles:
        """Find the ways on a plot; raise `PlotError` where a row cannot be reached.

        Without a gate, work starts at the low-x lane end of the first row. `no_go_m` is what must
        not be crossed either where parts of a plot can only be joined outside the boundary.
        """
        net = ways(grid, gate_xy_m, no_go_m)
        stops, which = np.unique(np.append(net.end.ravel(), net.gate), return_inverse=True)
        reach_m = np.empty((len(stops), len(stops)))
        _reach(net, stops, reach_m)
        between_m = np.minimum(reach_m, reach_m.T)[np.ix_(which, which)]
        ground = Ground(
            np.ascontiguousarray(grid.xy_m[:, 0]),
            grid.row,
            grid.row_start,
            grid.lane_x_m,
            between_m,
            grid.corridor,
            grid.side,
        )
        for values in (*net[:-1], *ground):
            values.setflags(write=False)
        return cls(grid, net, ground)

    @property
    def gate_m(self) -> Float:
        """Where a working day starts and ends, ``(2,)``."""
        here: Float = self.ways.xy_m[self.ways.gate]
        return here

    @cached_property
    def stop_m(self) -> Float:
        """Where the robot stands to inspect each plant, ``(n, 2)``."""
        stop_m = np.stack([self.grid.xy_m[:, 0], self.grid.lane_y_m[self.grid.row]], axis=1)
        stop_m.setflags(write=False)
        return stop_m

    def distance_m(self, i: ArrayLike, j: ArrayLike) -> Float:
        """Return the metres from plants i to plants j, -1 for the gate; shapes broadcast."""
        a, b = np.broadcast_arrays(np.asarray(i, np.int64), np.asarray(j, np.int64))
        metres = np.empty(a.size)
        _drive_all(self.ground, a.ravel(), b.ravel(), metres)
        return metres.reshape(a.shape)

    def path(self, i: int, j: int) -> Float:
        """Return the line ``(k, 2)`` driven from plant i to plant j, -1 for the gate.

        It is as long as `distance_m` says, and has two points or more.
        """
        a, b = self._at(i), self._at(j)
        if (
            i >= 0
            and j >= 0
            and self.grid.corridor[self.grid.row[i]] == (self.grid.corridor[self.grid.row[j]])
        ):
            return np.stack([a, b])
        out, back = _exits(self.ground, i, j)
        node = np.append(self.ways.end.ravel(), self.ways.gate)
        nodes = _trace(self.ways, node[out], node[back])
        return _plain(np.concatenate([[a], self.ways.xy_m[nodes], [b]]))

    def _at(self, i: int) -> Float:
        here: Float = self.gate_m if i < 0 else self.stop_m[i]
        return here


def crosses_rows(grid: PlantGrid, line_xy_m: Float) -> bool:
    """Tell whether a line ``(k, 2)`` comes within a centimetre of a row.

    A row is the line through its plants, from the first to the last.
    """
    rows = shapely.STRtree(row_lines(grid))
    steps = shapely.linestrings(np.stack([line_xy_m[:-1], line_xy_m[1:]], axis=1))
    return bool(rows.query(steps, predicate="dwithin", distance=_TOUCH_M).size)


@nb.njit(cache=True, inline="always")
def drive_m(ground: Ground, i: int, j: int) -> float:
    """Return the metres from plant i to plant j; -1 is the gate."""
    if i >= 0 and j >= 0 and ground.corridor[ground.row[i]] == ground.corridor[ground.row[j]]:
        return abs(float(ground.x_m[i] - ground.x_m[j]))
    best_m = np.inf
    for out in range(2):
        a, out_m = _exit(ground, i, out)
        for back in range(2):
            b, back_m = _exit(ground, j, back)
            best_m = min(best_m, out_m + ground.between_m[a, b] + back_m)
    return best_m


@nb.njit(cache=True, inline="always")
def _exit(ground: Ground, i: int, end: int) -> tuple[int, float]:
    """Return one of the two lane ends of plant i, as a node, and the metres to it."""
    if i < 0:
        return ground.between_m.shape[0] - 1, 0.0
    row = ground.row[i]
    return 2 * row + end, abs(ground.x_m[i] - ground.end_x_m[row, end])


@nb.njit(cache=True)
def _exits(ground: Ground, i: int, j: int) -> tuple[int, int]:
    """Return the lane ends by which one drives from plant i to plant j."""
    best_m, exits = np.inf, (-1, -1)
    for out in range(2):
        a, out_m = _exit(ground, i, out)
        for back in range(2):
            b, back_m = _exit(ground, j, back)
            if out_m + ground.between_m[a, b] + back_m < best_m:
                best_m, exits = out_m + ground.between_m[a, b] + back_m, (a, b)
    return exits


@nb.njit(cache=True)
def _drive_all(ground: Ground, i: NDArray[np.int64], j: NDArray[np.int64], metres: Float) -> None:
    for k in range(i.size):
        metres[k] = drive_m(ground, i[k], j[k])


@nb.njit(cache=True)
def _reach(ways: Ways, stops: NDArray[np.int64], reach_m: Float) -> None:
    """Fill in the shortest ways ``(s, s)`` between the given nodes.

    Nodes are relaxed up and down the plot in turn, for some dozen sources side by side, until
    nothing gets shorter. As nodes are sorted by y, a way that turns back in y k times takes k + 2
    sweeps or fewer: on most plots that is far less work than a queue of nodes for each source.
    """
    n = ways.xy_m.shape[0]
    near = np.empty((n, _BLOCK))
    for first in range(0, stops.size, _BLOCK):
        width = min(_BLOCK, stops.size - first)
        near[:] = np.inf
        for s in range(width):
            near[stops[first + s], s] = 0.0
        shorter = True
        while shorter:
            shorter = _sweep(ways, near, 0, n, 1) | _sweep(ways, near, n - 1, -1, -1)
        for s in range(width):
            for t in range(stops.size):
                reach_m[first + s, t] = near[stops[t], s]


@nb.njit(cache=True)
def _sweep(ways: Ways, near: Float, first: int, end: int, step: int) -> bool:
    """Relax the nodes in order; tell whether any came nearer."""
    shorter = False
    for node in range(first, end, step):
        for e in range(ways.start[node], ways.start[node + 1]):
            other, length_m = ways.to[e], ways.length_m[e]
            for s in range(near.shape[1]):
                way_m = near[other, s] + length_m
                shorter |= way_m < near[node, s]
                near[node, s] = min(way_m, near[node, s])
    return shorter


@nb.njit(cache=True)
def _trace(ways: Ways, a: int, b: int) -> NDArray[np.int64]:
    """Return the nodes on the shortest way from node a to node b."""
    n = ways.xy_m.shape[0]
    near, onward = np.full(n, np.inf), np.full(n, -1)
    near[b] = 0.0
    shorter = True
    while shorter:
        shorter = False
        for step in (1, -1):
            for place in range(n):
                node = place if step == 1 else n - 1 - place
                for e in range(ways.start[node], ways.start[node + 1]):
                    way_m = near[ways.to[e]] + ways.length_m[e]
                    if way_m < near[node]:
                        near[node], onward[node] = way_m, ways.to[e]
                        shorter = True
    nodes = [a]
    while nodes[-1] != b:
        nodes.append(onward[nodes[-1]])
    return np.array(nodes)


def _plain(line: Float) -> Float:
    """Return a line without points that are passed straight on; its ends stay."""
    step = np.diff(line, axis=0)
    moved = np.append(True, np.hypot(step[:, 0], step[:, 1]) > 0)
    line = line[moved] if moved.sum() > 1 else line[[0, -1]]
    step = np.diff(line, axis=0)
    ahead = step / np.maximum(np.hypot(step[:, 0], step[:, 1]), np.finfo(float).tiny)[:, None]
    turn = np.hypot(*(ahead[1:] - ahead[:-1]).T)
    turns: Float = line[np.concatenate([[True], turn > _STRAIGHT, [True]])]
    return turns
