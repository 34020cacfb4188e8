"""The ways between row ends: through headlands, around holes, never across a row of plants."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree
from shapely import MultiPolygon

from fieldmon.compute.arrays import runs
from fieldmon.compute.wording import counted
from fieldmon.compute.wording import runs as numbers_listed
from fieldmon.plot.adjacency import delaunay_sides
from fieldmon.plot.bent_ways import Bends, bends_of, row_end_places
from fieldmon.plot.end_turns import lane_ends
from fieldmon.plot.grid import plant_numbers, rows_listed
from fieldmon.plot.obstacles import SAME_M, Obstacles
from fieldmon.plot.way_joining import (
    NEAREST,
    Net,
    each_once,
    each_to,
    joined_inside,
    joined_outside,
    with_gate,
    without_repeats,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.clearance import Clearance
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]
    Index = NDArray[np.intp]
    Mask = NDArray[np.bool_]

_JUMPS = (2, 3, 4, 6, 8, 12)


class RoadNetwork(NamedTuple):
    """A network of straight ways: m nodes, sorted by y, then x.

    Parameters
    ----------
    xy_m
        ``(m, 2)`` where the nodes are.
    start, to, length_m
        CSR lists: from node v one can drive to ``to[start[v]:start[v + 1]]``. Both directions.
    end
        ``(r, 2)`` nodes of the low-x and the high-x end of each row's lane.
    gate
        Node at which a working day starts and ends.
    via_start, via_m
        Corners of ways that bend: of way e ``via_m[via_start[e]:via_start[e + 1]]``; of straight
        ways there are none.
    """

    xy_m: Float
    start: NDArray[np.int64]
    to: NDArray[np.int64]
    length_m: Float
    end: NDArray[np.int64]
    gate: int
    via_start: NDArray[np.int64]
    via_m: Float

    def __repr__(self) -> str:
        nodes, roads = counted(len(self.xy_m), "node"), counted(len(self.to) // 2, "way")
        return f"<RoadNetwork: {nodes}, {roads}>"


def find_roads(
    grid: PlantGrid,
    gate_xy_m: tuple[float, float] | None = None,
    no_go_m: MultiPolygon | None = None,
    clearance: Clearance | None = None,
    shut: Mask | None = None,
) -> RoadNetwork:
    """Return the network of ways between the lane ends of a plot and its gate.

    Nodes are the lane ends, the points beside them where one may cross the line of a row clear of
    its plants, and their likes on the row's other side. Ways run along aisles and, wherever a
    straight line touches no row and stays in the drivable area, from node to node. Where that
    leaves parts of the plot apart, they are joined by the shortest ways outside, which lead from
    part to part and are no short cuts between places of one; never over `no_go_m`. Without a gate,
    work starts at the low-x lane end of the first row that is not too narrow, if it is on the plot.

    With a `clearance`, ways keep so far off plants, holes and no-go areas, and off the boundary
    where there is room; nothing leads along aisles that are too narrow, or of rows ``(r,)`` that
    are `shut`, and nobody need reach these. Raise `PlotError` if some row cannot be reached.
    """
    obstacles = Obstacles.of(grid, MultiPolygon() if no_go_m is None else no_go_m, clearance)
    if not grid.in_rows:
        return _find_from_tree_to_tree(grid, gate_xy_m, obstacles)
    narrow = _Narrow.of(grid, clearance)
    if shut is not None and shut.any() and not (narrow.rows | shut).all():
        narrow = narrow._replace(rows=narrow.rows | shut)
    if grid.aisles_m is not None:
        return _find_bent(grid, gate_xy_m, obstacles, narrow)
    xy_m, place = _merged(_row_end_places(grid))
    beside = np.where(grid.side[:, None] < 0, place[:, :, 2], place[:, :, 0])
    turns = np.stack([beside.ravel(), place[:, :, 1].ravel()], axis=1)
    turns = turns[narrow.passed.ravel() & obstacles.within(xy_m[turns[:, 0]], xy_m[turns[:, 1]])]
    trusted = np.concatenate([beside[~narrow.rows], turns])
    tried = np.concatenate([_along_aisles(grid, xy_m, place), _nearest(xy_m), _jumps(grid, place)])
    tried = each_once(tried[narrow.can_turn(grid, xy_m, tried, beside)])
    good = obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]])
    net = Net(xy_m, np.concatenate([trusted, tried[good]]))
    gate = _first_end(xy_m, beside, narrow, obstacles)
    if gate_xy_m is not None:
        gate = len(net.xy_m)
        net = with_gate(net, np.array([gate_xy_m]), obstacles, grid)
    needed = np.append(beside[~narrow.rows].ravel(), gate)
    net = joined_inside(net, needed, obstacles)
    if not narrow.one_sided:
        # where one may turn to one side only, what passes straight by must stay a way of its own
        net = without_repeats(net)
    net = joined_outside(net, needed, obstacles, _called(grid, narrow))
    return _sorted(net, beside, gate)


def _find_from_tree_to_tree(
    grid: PlantGrid, gate_xy_m: tuple[float, float] | None, obstacles: Obstacles
) -> RoadNetwork:
    """Return straight ways from each tree to those about it: no row is in the way."""
    xy_m = grid.stop_m
    nobody = np.full((1, 4), np.inf)
    obstacles = replace(obstacles, row_box_m=nobody)
    n = len(xy_m)
    tried = each_once(np.concatenate([_nearest(xy_m), delaunay_sides(xy_m)]))
    good = obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]])
    net, gate = Net(xy_m, tried[good]), 0
    if gate_xy_m is not None:
        gate = n
        net = with_gate(net, np.array([gate_xy_m]), obstacles, grid)
    needed = np.append(np.repeat(np.arange(n), 2), gate)
    net = joined_inside(net, needed, obstacles)
    net = joined_outside(net, needed, obstacles, _called(grid))
    return _sorted(net, np.repeat(np.arange(n), 2).reshape(-1, 2), gate)


class _Narrow(NamedTuple):
    """What is too narrow for a robot's size.

    Rows that cannot be inspected ``(r,)``, lane ends with no room to turn, and row ends that are
    passed clear of their plants, ``(r, 2)``; where there is room to turn right and left,
    ``(r, 2, 2)``, as the lane runs; and ends at which a lane is cut ``(r, 2)``: one comes back
    from there.
    """

    rows: Mask
    tight: Mask
    passed: Mask
    room: Mask
    cut: Mask

    @classmethod
    def of(cls, grid: PlantGrid, clearance: Clearance | None) -> _Narrow:
        none, cut = np.zeros((grid.n_rows, 2), np.bool_), grid.cut_ends
        if clearance is None:
            passed = (grid.beyond_plants_m > 0.0) & ~cut
            room = np.repeat(~cut[..., None], 2, axis=2)
            return cls(none[:, 0], none, passed, room, cut)
        room = clearance.turn_room(grid)
        to_row = room[np.arange(grid.n_rows), :, (grid.side > 0).astype(np.intp)]
        passed = (grid.beyond_plants_m >= clearance.way_m) & to_row
        tight = clearance.tight_ends(grid) & ~cut
        return cls(clearance.too_narrow(grid), tight, passed, room, cut)

    @property
    def one_sided(self) -> bool:
        """Whether there is room to turn to one side only at a lane end."""
        return bool((self.room[..., 0] != self.room[..., 1]).any())

    def can_turn(self, grid: PlantGrid, xy_m: Float, pairs: Index, beside: Index) -> Mask:
        """Tell of pairs of nodes ``(k, 2)`` whether a robot can turn at them where lanes end."""
        good: Mask = ~np.asarray(np.isin(pairs, beside[self.tight]).any(axis=1))
        if self.room.all():
            return good
        _, ahead = lane_ends(grid)
        lane = np.full((len(xy_m), 2), 0.0)
        blocked = np.zeros((len(xy_m), 2), np.bool_)
        lane[beside.ravel()] = ahead.reshape(-1, 2)
        # where another row's lane ends there too, it is what counts
        blocked[beside[self.cut]] = True
        blocked[beside[~self.cut]] = ~self.room[~self.cut]
        for here, there in (pairs.T, pairs.T[::-1]):
            way, along = xy_m[there] - xy_m[here], lane[here]
            to_left = along[:, 0] * way[:, 1] - along[:, 1] * way[:, 0]
            good &= ~(blocked[here, 0] & (to_left < -SAME_M))
            good &= ~(blocked[here, 1] & (to_left > SAME_M))
        return good


def _find_bent(
    grid: PlantGrid,
    gate_xy_m: tuple[float, float] | None,
    obstacles: Obstacles,
    narrow: _Narrow,
) -> RoadNetwork:
    """Return the network of rows that bend: along the middle of their aisles ways bend too."""
    places, at_m = row_end_places(grid)
    xy_m, place = _merged(places)
    beside = np.where(grid.side[:, None] < 0, place[:, :, 2], place[:, :, 0])
    lane = None if gate_xy_m is None else _lane_at(grid, np.array([gate_xy_m]))
    gate = len(xy_m)
    if gate_xy_m is None:
        gate = _first_end(xy_m, beside, narrow, obstacles)
    if lane is not None:
        xy_m = np.concatenate([xy_m, lane[0]])
    at_gate = None if lane is None else (gate, *lane[1:])
    bends = bends_of(grid, place, at_m, at_gate, narrow.rows)
    bends = bends.where(_driveable(bends, obstacles))
    across = place.reshape(-1, 3)
    turns = np.stack([beside.ravel(), place[:, :, 1].ravel()], axis=1)
    turns = turns[narrow.passed.ravel() & obstacles.within(xy_m[turns[:, 0]], xy_m[turns[:, 1]])]
    tried = [across[:, :2], across[:, 1:], _nearest(xy_m), _jumps(grid, place)]
    pairs = np.concatenate(tried)
    pairs = each_once(pairs[narrow.can_turn(grid, xy_m, pairs, beside)])
    good = obstacles.clear(xy_m[pairs[:, 0]], xy_m[pairs[:, 1]])
    net = Net(xy_m, np.concatenate([turns, bends.pair, pairs[good]]))
    if gate_xy_m is not None and lane is None:
        net = with_gate(net, np.array([gate_xy_m]), obstacles, grid)
    needed = np.append(beside[~narrow.rows].ravel(), gate)
    net = joined_inside(net, needed, obstacles)
    net = joined_outside(net, needed, obstacles, _called(grid, narrow))
    return _sorted(net, beside, gate, bends)


def _called(grid: PlantGrid, narrow: _Narrow | None = None) -> Callable[[Index], str]:
    """Return what names rows by their places among those that must be reached."""
    if not grid.in_rows:
        return lambda trees: numbers_listed(plant_numbers(grid, trees).number.tolist())
    number = grid.row_line_number if narrow is None else grid.row_line_number[~narrow.rows]
    return lambda rows: rows_listed(grid, number[rows])


def _first_end(xy_m: Float, beside: Index, narrow: _Narrow, obstacles: Obstacles) -> int:
    """Return the lane end at which days begin where nobody said: of the first row one can enter.

    Its low end, or the first end in the rows' order that is on the plot.
    """
    ends = beside[~narrow.rows[:, None] & ~narrow.cut]
    ends = ends if len(ends) else beside.ravel()
    on_plot = obstacles.within(xy_m[ends], xy_m[ends])
    return int(ends[np.argmax(on_plot)])


def _lane_at(grid: PlantGrid, gate_m: Float) -> tuple[Float, int, float] | None:
    """Return where in an aisle a gate among the rows is, ``(1, 2)``, the aisle and the place."""
    far_m, plant = grid.tree.query(gate_m[0])
    row = int(grid.row[plant])
    if grid.aisles_m is None or grid.aisle is None or far_m > 0.75 * grid.row_spacing_m:
        return None
    both = grid.aisle[row] + np.array([0, -1 if grid.side[row] < 0 else 1])
    at_m, left_m = grid.aisles_m.project(np.repeat(gate_m, 2, axis=0), both)
    near = np.argmin(np.abs(left_m))
    aisle = both[near : near + 1]
    place_m = np.clip(at_m[near], 0.0, grid.aisles_m.length_m[aisle])
    return grid.aisles_m.points(aisle, place_m), int(aisle[0]), float(place_m[0])


def _driveable(bends: Bends, obstacles: Obstacles) -> Mask:
    """Tell of stretches of aisles whether they can be driven; those of a lane always can."""
    good = bends.in_lane.copy()
    asked = np.flatnonzero(~good)
    from_m, to_m, of = bends.where(~good).steps()
    bad = ~obstacles.clear(from_m, to_m)
    good[asked] = np.bincount(of[bad], minlength=len(asked)) == 0
    return good


def _row_end_places(grid: PlantGrid) -> Float:
    """Return ``(r, 2, 3, 2)``: at each row end, below the row, on its line and above it."""
    half = grid.row_spacing_m / 2
    y = grid.xy_m[grid.end_plants, 1]
    lane = np.broadcast_to(grid.lane_y_m[:, None], y.shape)
    above = np.where(grid.side[:, None] < 0, lane, y + half)
    below = np.where(grid.side[:, None] < 0, y - half, lane)
    x = np.broadcast_to(grid.lane_x_m[:, :, None], (*y.shape, 3))
    return np.stack([x, np.stack([below, y, above], axis=2)], axis=3)


def _merged(places: Float) -> tuple[Float, Index]:
    """Return the different points ``(m, 2)`` and, of each place, which it is."""
    points = places.reshape(-1, 2)
    _, first, which = np.unique(
        np.round(points / SAME_M).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    return points[first], which.reshape(places.shape[:-1])


def _along_aisles(grid: PlantGrid, xy_m: Float, place: Index) -> Index:
    """Return pairs of nodes next to each other on one aisle, and those across half an aisle.

    Aisles of neighbouring rows that were measured, not laid, lie at slightly different y: nodes
    within a quarter of the row spacing count as on the aisle.
    """
    aisle = place[:, :, [0, 2]].transpose(0, 2, 1).reshape(-1, 2)
    node = np.unique(aisle)
    node = node[np.argsort(xy_m[node, 1], kind="stable")]
    y = xy_m[node, 1]
    reach = grid.row_spacing_m / 4
    aisle_y = xy_m[aisle, 1]
    low = np.searchsorted(y, aisle_y.min(axis=1) - reach)
    n_near = np.searchsorted(y, aisle_y.max(axis=1) + reach, side="right") - low
    place_in_y, owner = runs(low, n_near)
    near = node[place_in_y]
    x, ends_x = xy_m[near, 0], xy_m[aisle, 0][owner]
    on_it = (ends_x[:, 0] - SAME_M <= x) & (x <= ends_x[:, 1] + SAME_M)
    owner, near = owner[on_it], near[on_it]
    order = np.lexsort((xy_m[near, 0], owner))
    owner, near = owner[order], near[order]
    same = owner[1:] == owner[:-1]
    chained = np.stack([near[:-1][same], near[1:][same]], axis=1)
    across = place.reshape(-1, 3)
    return np.concatenate([chained, across[:, :2], across[:, 1:]])


def _nearest(xy_m: Float) -> Index:
    """Return the pairs of each node and those nearest to it."""
    k = min(NEAREST, len(xy_m))
    return each_to(np.arange(len(xy_m)), cKDTree(xy_m).query(xy_m, k=k)[1])


def _jumps(grid: PlantGrid, place: Index) -> Index:
    """Return pairs of row ends on the same headland several lines apart.

    From line to line one goes to the row whose end is nearest in x.
    """
    r, wide = grid.n_rows, 2 * float(np.ptp(grid.lane_x_m)) + 1.0
    pairs = []
    for end in range(2):
        x = grid.lane_x_m[:, end] - grid.lane_x_m[:, end].min()
        key = grid.row_line * wide + x
        order = np.argsort(key)
        after = np.searchsorted(key[order], key + wide)
        near = order[np.clip(np.stack([after - 1, after]), 0, r - 1)]
        off_m = np.where(grid.row_line[near] == grid.row_line + 1, np.abs(x[near] - x), np.inf)
        best = near[np.argmin(off_m, axis=0), np.arange(r)]
        onward = np.append(np.where(np.isfinite(off_m.min(axis=0)), best, r), r)
        row = np.arange(r)
        for jump in range(1, max(_JUMPS) + 1):
            row = onward[row]
            if jump in _JUMPS:
                there = row < r
                pairs.append(np.stack([place[there, end, 1], place[row[there], end, 1]], axis=1))
    return np.concatenate(pairs)


def _sorted(net: Net, end: Index, gate: int, bends: Bends | None = None) -> RoadNetwork:
    """Return the network as sorted lists, without what cannot be reached from the gate."""
    part = net.component()
    kept = np.flatnonzero(part == part[gate])
    kept = kept[np.lexsort(net.xy_m[kept].T)]
    place = np.full(len(net.xy_m), -1)
    place[kept] = np.arange(len(kept))
    pair = each_once(place[net.pair[part[net.pair[:, 0]] == part[gate]]])
    from_to = np.concatenate([pair, pair[:, ::-1]])
    from_to = from_to[np.lexsort(from_to.T[::-1])]
    xy_m = net.xy_m[kept]
    start = np.searchsorted(from_to[:, 0], np.arange(len(kept) + 1))
    length_m = Net(xy_m, from_to).length_m()
    # ends of a row that is too narrow may be out of reach: nobody goes there
    ends = np.where(place[end] < 0, place[gate], place[end])
    via_start, via_m = np.zeros(len(from_to) + 1, np.int64), np.empty((0, 2))
    if bends is not None:
        via_start, via_m = bends.numbered(place).along(from_to, length_m)
    return RoadNetwork(
        xy_m,
        start,
        from_to[:, 1].astype(np.int64),
        length_m,
        ends.astype(np.int64),
        int(place[gate]),
        via_start,
        via_m,
    )
