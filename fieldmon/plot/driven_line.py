"""The line that is driven from place to place: along aisles, through headlands, round corners."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_inlined, routine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.road_network import RoadNetwork
    from fieldmon.plot.travel_table import TravelTable

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_STRAIGHT = 1e-9


class Lanes(NamedTuple):
    """Where lanes are on the ground, for compiled loops.

    Parameters
    ----------
    stop_m
        ``(n, 2)`` where each plant is inspected.
    end_node
        ``(2r + 1,)`` the node of each lane end and of the gate, as in `TravelTable.between_m`.
    aisle
        ``(r,)`` the aisle of each row where rows bend, else -1.
    start, corner_m, at_m
        The middles of the aisles, as in `Polylines`; empty where all is straight.
    """

    stop_m: Float
    end_node: Int
    aisle: Int
    start: Int
    corner_m: Float
    at_m: Float

    def __repr__(self) -> str:
        return f"<Lanes: {len(self.aisle)} rows>"


@routine
def driven_line(
    travel: TravelTable, roads: RoadNetwork, lanes: Lanes, places: Int
) -> tuple[Float, Int]:
    """Return the line ``(m, 2)`` driven from place to place, and where each leg ends on it.

    Places ``(k,)`` are plants, or -1 for the gate; there are ``k - 1`` legs. Between plants that
    are inspected from one straight stretch of aisle one drives straight ahead.
    """
    line, size = _with(np.empty((64, 2)), 0, _at(roads, lanes, places[0]))
    leg_end = np.empty(places.size - 1, np.int64)
    for leg in range(places.size - 1):
        i, j = places[leg], places[leg + 1]
        if i >= 0 and j >= 0 and travel.corridor[travel.row[i]] == travel.corridor[travel.row[j]]:
            along = (travel.x_m[i], travel.x_m[j])
            line, size = _with_lane(lanes, int(travel.row[i]), along, line, size)
            line, size = _with(line, size, _at(roads, lanes, j))
        else:
            begin = size - 1
            line, size = _through_headlands(travel, roads, lanes, (i, j), line, size)
            size = _plain(line, begin, size)
        leg_end[leg] = size - 1
    return line[:size].copy(), leg_end


@routine
def _at(roads: RoadNetwork, lanes: Lanes, place: int) -> tuple[float, float]:
    if place < 0:
        return roads.xy_m[roads.gate, 0], roads.xy_m[roads.gate, 1]
    return lanes.stop_m[place, 0], lanes.stop_m[place, 1]


@routine
def _with(line: Float, size: int, point: tuple[float, float]) -> tuple[Float, int]:
    """Return a line with one point more; it grows by doubling."""
    if size == line.shape[0]:
        longer = np.empty((2 * size, 2))
        for k in range(size):
            longer[k, 0], longer[k, 1] = line[k, 0], line[k, 1]
        line = longer
    line[size, 0], line[size, 1] = point
    return line, size + 1


@routine
def _with_lane(
    lanes: Lanes, row: int, along: tuple[float, float], line: Float, size: int
) -> tuple[Float, int]:
    """Return a line with the corners strictly between two places of a row's lane."""
    aisle = lanes.aisle[row]
    if aisle < 0:
        return line, size
    first, end = lanes.start[aisle], lanes.start[aisle + 1]
    low, high = min(along[0], along[1]), max(along[0], along[1])
    a = first + np.searchsorted(lanes.at_m[first:end], low, side="right")
    b = first + np.searchsorted(lanes.at_m[first:end], high, side="left")
    for k in range(b - a):
        at = a + k if along[0] <= along[1] else b - 1 - k
        line, size = _with(line, size, (lanes.corner_m[at, 0], lanes.corner_m[at, 1]))
    return line, size


@routine
def _through_headlands(
    travel: TravelTable,
    roads: RoadNetwork,
    lanes: Lanes,
    way: tuple[int, int],
    line: Float,
    size: int,
) -> tuple[Float, int]:
    """Return a line with the shortest way from one place to another by the ends of their lanes."""
    i, j = way
    first, last = _ends(travel, i, j)
    if i >= 0:
        along = (travel.x_m[i], travel.end_x_m[first // 2, first % 2])
        line, size = _with_lane(lanes, first // 2, along, line, size)
    nodes = shortest_nodes(roads, lanes.end_node[first], lanes.end_node[last])
    for k in range(nodes.size):
        if k > 0:
            a, b = nodes[k - 1], nodes[k]
            e = roads.start[a] + np.searchsorted(roads.to[roads.start[a] : roads.start[a + 1]], b)
            for corner in range(roads.via_start[e], roads.via_start[e + 1]):
                point = roads.via_m[corner, 0], roads.via_m[corner, 1]
                line, size = _with(line, size, point)
        node = nodes[k]
        line, size = _with(line, size, (roads.xy_m[node, 0], roads.xy_m[node, 1]))
    if j >= 0:
        along = (travel.end_x_m[last // 2, last % 2], travel.x_m[j])
        line, size = _with_lane(lanes, last // 2, along, line, size)
    return _with(line, size, _at(roads, lanes, j))


@routine
def _ends(travel: TravelTable, i: int, j: int) -> tuple[int, int]:
    """Return the lane ends by which the way between two places is shortest."""
    gate = travel.between_m.shape[0] - 1
    best, first, last = np.inf, gate, gate
    for a in range(2 if i >= 0 else 1):
        out = gate if i < 0 else 2 * travel.row[i] + a
        out_m = 0.0 if i < 0 else abs(travel.x_m[i] - travel.end_x_m[travel.row[i], a])
        for b in range(2 if j >= 0 else 1):
            back = gate if j < 0 else 2 * travel.row[j] + b
            back_m = 0.0 if j < 0 else abs(travel.x_m[j] - travel.end_x_m[travel.row[j], b])
            way_m = out_m + travel.between_m[out, back] + back_m
            if way_m < best:
                best, first, last = way_m, out, back
    return first, last


@routine
def shortest_nodes(roads: RoadNetwork, a: int, b: int) -> Int:
    """Return the nodes on the shortest way from node a to node b.

    Looked for from b, first where the way so far and the straight line on to a are shortest (A*).
    """
    near = np.full(roads.xy_m.shape[0], np.inf)
    onward = np.full(near.size, -1)
    near[b] = 0.0
    queue = [(_straight_m(roads, b, a), b)]
    while queue[0][1] != a:
        least_m, node = heapq.heappop(queue)
        if least_m > near[node] + _straight_m(roads, node, a):
            continue
        for e in range(roads.start[node], roads.start[node + 1]):
            other, way_m = int(roads.to[e]), near[node] + float(roads.length_m[e])
            if way_m < near[other]:
                near[other], onward[other] = way_m, node
                heapq.heappush(queue, (way_m + _straight_m(roads, other, a), other))
    nodes = [a]
    while nodes[-1] != b:
        nodes.append(onward[nodes[-1]])
    return np.array(nodes)


@inner_inlined
def _straight_m(roads: RoadNetwork, one: int, other: int) -> float:
    """Return the metres from node to node as the crow flies."""
    x = roads.xy_m[one, 0] - roads.xy_m[other, 0]
    y = roads.xy_m[one, 1] - roads.xy_m[other, 1]
    return float(np.sqrt(x * x + y * y))


@routine
def _plain(line: Float, begin: int, size: int) -> int:
    """Leave points out of the end of a line that are passed straight on; return its new size.

    The points at `begin` and at the end stay.
    """
    k = begin + 1
    for point in range(begin + 1, size - 1):
        x, y = line[point]
        back_x, back_y = x - line[k - 1, 0], y - line[k - 1, 1]
        on_x, on_y = line[point + 1, 0] - x, line[point + 1, 1] - y
        turn = abs(back_x * on_y - back_y * on_x)
        reach = np.hypot(back_x, back_y) * np.hypot(on_x, on_y)
        if turn > _STRAIGHT * reach or back_x * on_x + back_y * on_y < 0:
            line[k, 0], line[k, 1] = x, y
            k += 1
    line[k, 0], line[k, 1] = line[size - 1]
    return k + 1
