"""Ways between nodes, joined until all that is needed can be reached: on the plot, else off it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from fieldmon.compute.wording import counted, worded
from fieldmon.errors import PlotError
from fieldmon.plot.obstacles import MOST_CORNERS, ON_PLOT, SAME_M, Obstacles, Where

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]
    Index = NDArray[np.intp]
    Mask = NDArray[np.bool_]

#: ways are tried from each node to so many of those about it
NEAREST = 10
_SAME_BEARING = 1e-9
_GATE_NEAREST = 64
_BRIDGE_NEAREST = (8, 64, 512)


class CutOffError(PlotError):
    """Rows that no way reaches."""


class Net(NamedTuple):
    """Nodes and the pairs of them between which one can drive."""

    xy_m: Float
    pair: Index

    def __repr__(self) -> str:
        return f"<Net: {counted(len(self.xy_m), 'node')}, {counted(len(self.pair), 'way')}>"

    def plus(self, xy_m: Float, pair: Index) -> Net:
        """Return the network with more nodes, numbered on, and more ways."""
        return Net(np.concatenate([self.xy_m, xy_m]), np.concatenate([self.pair, pair]))

    def length_m(self) -> Float:
        """Return the length of each way."""
        way = self.xy_m[self.pair[:, 0]] - self.xy_m[self.pair[:, 1]]
        return np.hypot(way[:, 0], way[:, 1])

    def component(self) -> Index:
        """Return a number for each node: the same where one can drive from one to the other."""
        n = len(self.xy_m)
        links = coo_array((np.ones(len(self.pair), np.int8), self.pair.T), shape=(n, n))
        parts: Index = connected_components(links, directed=False)[1]
        return parts

    def apart(self, nodes: Index) -> bool:
        """Tell whether some of the nodes cannot be reached from others."""
        return bool(np.ptp(self.component()[nodes]))


def each_once(pairs: Index) -> Index:
    """Return the pairs without repetitions and without pairs of a node with itself."""
    pairs = np.sort(pairs, axis=1)
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    _, first = np.unique(pairs[:, 0] * (pairs.max(initial=0) + 1) + pairs[:, 1], return_index=True)
    return pairs[first]


def without_repeats(net: Net) -> Net:
    """Return the network without ways that only repeat shorter ones lying on them end to end."""
    pair = np.concatenate([net.pair, net.pair[:, ::-1]])
    way = net.xy_m[pair[:, 1]] - net.xy_m[pair[:, 0]]
    bearing = np.round(np.arctan2(way[:, 1], way[:, 0]) / _SAME_BEARING)
    order = np.lexsort((np.hypot(way[:, 0], way[:, 1]), bearing, pair[:, 0]))
    pair, bearing = pair[order], bearing[order]
    beyond = (pair[1:, 0] == pair[:-1, 0]) & (bearing[1:] == bearing[:-1])
    # what lies beyond a nearer node is reached from that node: part of the same clear way
    start = np.append(pair[0, 0], np.where(beyond, pair[:-1, 1], pair[1:, 0]))
    return Net(net.xy_m, each_once(np.stack([start, pair[:, 1]], axis=1)))


def with_gate(net: Net, gate_m: Float, obstacles: Obstacles, grid: PlantGrid) -> Net:
    """Return the network with the gate as next node, linked to what is visible from it.

    A gate outside the drivable area is first linked to the nearest point of that area; a gate
    among the plants of a row is moved to that row's lane.
    """
    if grid.aisles_m is None and obstacles.among_plants(gate_m):
        row = grid.row[np.argmin(np.hypot(*(grid.xy_m - gate_m).T))]
        gate_m = np.array([[np.clip(gate_m[0, 0], *grid.lane_x_m[row]), grid.lane_y_m[row]]])
    n, k = len(net.xy_m), min(_GATE_NEAREST, len(net.xy_m))
    entry_m = gate_m
    if not shapely.intersects_xy(obstacles.drivable_m, *gate_m[0]):
        ground = obstacles.drivable_m if obstacles.half_m else grid.ground_m
        line = shapely.shortest_line(shapely.points(gate_m[0]), ground)
        entry_m = shapely.get_coordinates(line)[1:]
    near = cKDTree(net.xy_m).query(entry_m[0], k=k)[1].reshape(-1)
    seen = near[obstacles.clear(np.repeat(entry_m, k, axis=0), net.xy_m[near])]
    if entry_m is gate_m:
        return net.plus(gate_m, np.stack([np.full(len(seen), n), seen], axis=1))
    pair = np.stack([np.full(len(seen), n + 1), seen], axis=1)
    pair = np.concatenate([np.array([[n, n + 1]]), pair])
    return net.plus(np.concatenate([gate_m, entry_m]), pair)


def joined_inside(net: Net, needed: Index, obstacles: Obstacles) -> Net:
    """Return the network with needed nodes connected as far as that is possible on the plot."""
    for where in ON_PLOT if obstacles.half_m else (Where.INSIDE,):
        if net.apart(needed):
            net = _with_corners(net, obstacles, where)
            net = _bridged(net, np.arange(len(net.xy_m)), obstacles, where)
    return net


def joined_outside(
    net: Net, needed: Index, obstacles: Obstacles, called: Callable[[Index], str]
) -> Net:
    """Return the network with all needed nodes connected, where it must be by ways off the plot.

    Such a way leads from one part of the network to another and is whole: it may pass over nodes
    of its own part, and to stop there would be a short cut off the plot between two places that
    can be reached on it. Raise `PlotError` if some node cannot be reached at all: of the `needed`,
    the two ends of each row and last the gate, `called` names the rows of these numbers.
    """
    for where in (Where.OUTSIDE, Where.ANYWHERE):
        if net.apart(needed):
            net = _bridged(net, needed, obstacles, where)
        if net.apart(needed):
            net = _round_corners(net, needed, obstacles, where)
    if net.apart(needed):
        part = net.component()[needed]
        stranded = (part[:-1] != part[-1]).reshape(-1, 2).any(axis=1)
        raise CutOffError(
            worded(
                "Every row must be reachable from the gate without crossing "
                "rows or no-go areas, but {shut} of {n} rows are not: {rows}. Move the gate, or "
                "open the no-go areas that shut them in.",
                shut=np.count_nonzero(stranded),
                n=len(stranded),
                rows=called(np.flatnonzero(stranded)),
            )
        )
    return net


def _with_corners(net: Net, obstacles: Obstacles, where: Where) -> Net:
    """Return the network with the plot's corners to drive around, linked to what they see."""
    corners = obstacles.corners(where)
    n, m = len(net.xy_m), len(corners)
    if not m:
        return net
    near = cKDTree(net.xy_m).query(corners, k=min(NEAREST, n))[1]
    to_near = each_to(np.arange(n, n + m), near)
    tried = np.concatenate([np.stack(np.triu_indices(m, 1), axis=1) + n, to_near])
    xy_m = np.concatenate([net.xy_m, corners])
    good = obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]], where)
    return net.plus(corners, tried[good])


def _bridged(net: Net, joined: Index, obstacles: Obstacles, where: Where) -> Net:
    """Return the network with bridges between components that hold some of the nodes to be joined.

    From each of them to those nearest to it.
    """
    zone = np.zeros(len(net.xy_m), np.intp)
    if where in ON_PLOT:  # from one part of the drivable area to another there are none
        drivable = shapely.STRtree(shapely.get_parts(obstacles.drivable_m))
        zone = np.asarray(drivable.nearest(shapely.points(net.xy_m)))
    part = net.component()
    zone[~np.isin(part, part[joined])] = -1
    for k in _BRIDGE_NEAREST:
        while True:
            tried = _foreign(net, zone, k)
            good = obstacles.clear(net.xy_m[tried[:, 0]], net.xy_m[tried[:, 1]], where)
            if not good.any():
                break
            net = net.plus(net.xy_m[:0], _short_ones(net, tried[good]))
    return net


def _round_corners(net: Net, needed: Index, obstacles: Obstacles, where: Where) -> Net:
    """Return the network with parts joined by the shortest ways round corners.

    Each way has corners of its own: if two shared one, they would be a way off the plot between
    places of one part.
    """
    corners_m = np.concatenate([obstacles.corners(where), _near_stranded(net, needed)])
    while len(corners_m) and net.apart(needed):
        part = net.component()
        for own in np.unique(part[needed]):
            others = np.isin(part, part[needed]) & (part != own)
            ends = np.flatnonzero(part == own), np.flatnonzero(others)
            round_ = _shortest_round(net.xy_m, ends, corners_m, obstacles, where)
            if len(round_):
                break
        else:
            return net
        first, last, between = round_[0], round_[-1], round_[1:-1] - len(net.xy_m)
        new = len(net.xy_m) + np.arange(len(between))
        chain = np.concatenate([[first], new, [last]])
        net = net.plus(corners_m[between], np.stack([chain[:-1], chain[1:]], axis=1))
    return net


def _near_stranded(net: Net, needed: Index) -> Float:
    """Return the places at row ends that are off the plot, near those that cannot be reached.

    A row along the boundary may be passed at its end only off the plot.
    """
    part = net.component()
    idle = np.flatnonzero(~np.isin(part, part[needed]))
    if not len(idle):
        return np.empty((0, 2))
    most = np.argmax(np.bincount(part[needed]))
    stranded = needed[part[needed] != most]
    far_m = cKDTree(net.xy_m[stranded]).query(net.xy_m[idle])[0]
    near = idle[np.argsort(far_m, kind="stable")[:MOST_CORNERS]]
    places: Float = net.xy_m[near]
    return places


def _shortest_round(
    node_m: Float, ends: tuple[Index, Index], corners_m: Float, obstacles: Obstacles, where: Where
) -> Index:
    """Return the shortest way by corners, numbered on after the nodes, from some nodes to others.

    It is empty if there is none.
    """
    n, m = len(node_m), len(corners_m)
    corner = np.arange(n, n + m)
    out, back = (
        nodes[cKDTree(node_m[nodes]).query(corners_m, k=min(_GATE_NEAREST, len(nodes)))[1]]
        for nodes in ends
    )
    pairs = [each_to(corner, out)[:, ::-1], each_to(corner, back)]
    between = np.stack(np.triu_indices(m, 1), axis=1) + n
    tried = np.concatenate([*pairs, between, between[:, ::-1]])
    xy_m = np.concatenate([node_m, corners_m])
    good = tried[obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]], where)]
    length_m = Net(xy_m, good).length_m()
    graph = coo_array((np.maximum(length_m, SAME_M), good.T), shape=(n + m, n + m))
    far, before, _ = dijkstra(graph, indices=ends[0], min_only=True, return_predecessors=True)
    way = [int(ends[1][np.argmin(far[ends[1]])])]
    if not np.isfinite(far[way[0]]):
        return np.empty(0, np.intp)
    while before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    return np.array(way[::-1])


def each_to(nodes: Index, near: Index) -> Index:
    """Return each of k nodes ``(k,)`` paired with those near it, ``(k, j)``."""
    near = near.reshape(len(nodes), -1)
    return np.stack([np.repeat(nodes, near.shape[1]), near.ravel()], axis=1)


def _foreign(net: Net, zone: Index, k: int) -> Index:
    """Return each node with the k nearest nodes of other components of its zone, nearest first.

    Nodes in zone -1 are left alone.
    """
    part = net.component()
    found = [np.empty((0, 2), np.intp)]
    for own in range(part.max() + 1):
        ours = np.flatnonzero(part == own)
        others = np.flatnonzero((part != own) & (zone == zone[ours[0]]))
        if zone[ours[0]] < 0 or not len(others):
            continue
        near = cKDTree(net.xy_m[others]).query(net.xy_m[ours], k=min(k, len(others)))[1]
        found.append(each_to(ours, others[near]))
    return np.concatenate(found)


def _short_ones(net: Net, bridges: Index) -> Index:
    """Return of each node the first bridge, unless its component has one of half the length."""
    bridges = bridges[np.unique(bridges[:, 0], return_index=True)[1]]
    length_m = Net(net.xy_m, bridges).length_m()
    part = net.component()[bridges[:, 0]]
    shortest = np.full(part.max() + 1, np.inf)
    np.minimum.at(shortest, part, length_m)
    return bridges[length_m <= 2 * shortest[part]]
