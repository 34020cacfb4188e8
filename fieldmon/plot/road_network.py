"""The ways between row ends: through headlands, around holes, never across a row of plants."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

import numba as nb
import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree
from shapely import MultiPolygon, Polygon

from fieldmon.compute.arrays import runs
from fieldmon.compute.jit import kept, routine
from fieldmon.compute.wording import counted, worded
from fieldmon.errors import PlotError
from fieldmon.plot.adjacency import delaunay_sides
from fieldmon.plot.bent_ways import Bends, bends_of, off_steps, row_end_places, row_steps
from fieldmon.plot.row_course import row_courses

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.clearance import Clearance
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]
    Index = NDArray[np.intp]
    Mask = NDArray[np.bool_]

_SAME_M = 1e-6
_SAME_BEARING = 1e-9
# a lane may lie exactly on the boundary
_EDGE_M = 0.01
_CLEARANCE_M = 0.3
_NEAREST = 10
_JUMPS = (2, 3, 4, 6, 8, 12)
_GATE_NEAREST = 64
_BRIDGE_NEAREST = (8, 64, 512)
_MOST_CORNERS = 100


class Where(Enum):
    """Where a way may run, from preferred to last resort; never across a row."""

    INSIDE = "in the drivable area"
    OUTSIDE = "outside the boundary too, but not over holes"
    ANYWHERE = "over holes too, but not over no-go areas"


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


@dataclass(frozen=True, eq=False)
class Obstacles:
    """What a straight way must not touch.

    Parameters
    ----------
    row_box_m
        ``(b, 4)`` low x, low y, high x, high y: boxes about the rows with a little clearance,
        sorted by low y. A straight row has one, a row measured plant by plant one a step.
    row_step_m
        ``(b, 4)`` the steps of rows that bend, from x, y to x, y, beside their boxes; None where
        the boxes say it all.
    clearance_m
        How far ways keep off such steps.
    drivable_m
        Where driving is fine.
    shut_m
        Its holes, and where driving is never fine.
    no_go_m
        Where driving is never fine.
    """

    row_box_m: Float
    row_step_m: Float | None
    clearance_m: float
    drivable_m: shapely.Geometry
    shut_m: shapely.Geometry
    no_go_m: shapely.Geometry

    def __repr__(self) -> str:
        return f"<Obstacles: {counted(len(self.row_box_m), 'row piece')}>"

    @classmethod
    def of(
        cls, grid: PlantGrid, no_go_m: shapely.Geometry, clearance: Clearance | None = None
    ) -> Obstacles:
        """Return the obstacles on a plot, to a robot that needs some clearance."""
        if clearance is None:
            ends_x = grid.along_m[_end_plants(grid)]
            clearance_m = min(_CLEARANCE_M, 0.4 * float(np.abs(grid.lane_x_m - ends_x).min()))
        else:
            clearance_m = clearance.way_m
        whole = shapely.union_all(
            [Polygon(part.exterior) for part in shapely.get_parts(grid.drivable_m)]
        )
        holes_m = shapely.difference(whole, grid.drivable_m)
        areas = (
            shapely.buffer(grid.drivable_m, _EDGE_M, join_style="mitre"),
            shapely.buffer(shapely.union(holes_m, no_go_m), -_EDGE_M, join_style="mitre"),
            shapely.buffer(no_go_m, -_EDGE_M, join_style="mitre"),
        )
        for area in areas:
            shapely.prepare(area)
        if grid.aisles_m is None:
            return cls(_row_boxes(grid, clearance_m), None, clearance_m, *areas)
        return cls(*row_steps(grid, clearance_m), clearance_m, *areas)

    def clear(self, from_m: Float, to_m: Float, where: Where = Where.INSIDE) -> Mask:
        """Tell of k straight ways, ``(k, 2)`` to ``(k, 2)``, whether they can be driven."""
        good = np.ones(len(from_m), np.bool_)
        if self.row_step_m is None:
            _off_boxes(self.row_box_m, from_m, to_m, good)
        else:
            off_steps((self.row_box_m, self.row_step_m), self.clearance_m, from_m, to_m, good)
        kept = np.flatnonzero(good)
        lines = shapely.linestrings(np.stack([from_m[kept], to_m[kept]], axis=1))
        if where is Where.INSIDE:
            good[kept] = shapely.covers(self.drivable_m, lines)
        else:
            good[kept] = ~np.asarray(shapely.intersects(self._shut_to(where), lines))
        return good

    def corners(self, where: Where) -> Float:
        """Return corners that ways may have to go round, ``(k, 2)``; of crowded ones a choice."""
        if where is Where.INSIDE:
            area, sign = self.drivable_m, -1.0
        else:  # on the brink of what must not even be touched
            area, sign = self._shut_to(where), 1.0
            area = shapely.buffer(area, _EDGE_M, join_style="mitre")
        coarse_m, corners = _EDGE_M, _bends(area, _EDGE_M, sign)
        while len(corners) > _MOST_CORNERS:
            coarse_m *= 2
            corners = _bends(area, coarse_m, sign)
        return corners

    def _shut_to(self, where: Where) -> shapely.Geometry:
        return self.shut_m if where is Where.OUTSIDE else self.no_go_m


def _bends(area: shapely.Geometry, coarse_m: float, sign: float) -> Float:
    """Return corners at which an area bulges (sign 1) or something bulges into it (sign -1)."""
    rings = shapely.get_rings(
        shapely.get_parts(shapely.orient_polygons(shapely.simplify(area, coarse_m)))
    )
    found = [np.empty((0, 2))]
    for ring in rings:
        corner = shapely.get_coordinates(ring)[:-1]
        ahead = np.roll(corner, -1, axis=0) - corner
        behind = np.roll(ahead, 1, axis=0)
        turn = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
        found.append(corner[sign * turn > 0])
    return np.concatenate(found)


@routine
def _off_boxes(box_m: Float, from_m: Float, to_m: Float, off: Mask) -> None:
    """Set `off` to False for the straight lines that touch a box; boxes are sorted by low y."""
    low_y = box_m[:, 1]
    tallest = (box_m[:, 3] - low_y).max()
    for k in range(off.size):
        x, y = from_m[k]
        way_x, way_y = to_m[k, 0] - x, to_m[k, 1] - y
        b = np.searchsorted(low_y, min(y, y + way_y) - tallest)
        while off[k] and b < low_y.size and low_y[b] <= max(y, y + way_y):
            # the part of the line within the box's x, then of that within its y
            first, last = _within(x, way_x, box_m[b, 0], box_m[b, 2], (0.0, 1.0))
            first, last = _within(y, way_y, box_m[b, 1], box_m[b, 3], (first, last))
            off[k] = first > last
            b += 1


@kept
@nb.njit(inline="always")
def _within(
    at: float, way: float, low: float, high: float, part: tuple[float, float]
) -> tuple[float, float]:
    """Return the part of a line, as fractions, at which one coordinate is from low to high."""
    if way == 0.0:
        return part if low <= at <= high else (1.0, 0.0)
    enters, leaves = (low - at) / way, (high - at) / way
    return max(part[0], min(enters, leaves)), min(part[1], max(enters, leaves))


def _row_boxes(grid: PlantGrid, clearance_m: float) -> Float:
    ends = _end_plants(grid)
    corner = _corner_plants(grid)
    step = np.flatnonzero(grid.row[corner[1:]] == grid.row[corner[:-1]])
    alone = ends[ends[:, 0] == ends[:, 1], 0]
    start = grid.xy_m[np.append(corner[step], alone)]
    end = grid.xy_m[np.append(corner[step + 1], alone)]
    box_m = np.concatenate(
        [np.minimum(start, end) - clearance_m, np.maximum(start, end) + clearance_m], axis=1
    )
    return box_m[np.argsort(box_m[:, 1])]


def row_lines(grid: PlantGrid) -> NDArray[np.object_]:
    """Return each row as a line through its plants, first to last, ``(r,)``.

    Plants in the middle of a row along x are left out. A row of one plant is a line of no length.
    Where rows bend they bend on between plants that are far apart.
    """
    if grid.aisles_m is not None:
        return row_courses(grid)
    ends = _end_plants(grid)
    plant = np.sort(np.append(_corner_plants(grid), ends[ends[:, 0] == ends[:, 1], 0]))
    lines: NDArray[np.object_] = shapely.linestrings(grid.xy_m[plant], indices=grid.row[plant])
    return lines


def _corner_plants(grid: PlantGrid) -> Index:
    """Return the plants at which rows start, end or leave the direction of x, ascending."""
    y = grid.xy_m[:, 1]
    level = np.abs(np.diff(y)) < _SAME_M
    inner = np.zeros(len(grid), np.bool_)
    inner[1:-1] = level[1:] & level[:-1]
    inner[_end_plants(grid)] = False
    return np.flatnonzero(~inner)


def _end_plants(grid: PlantGrid) -> Index:
    """Return the first and the last plant of each row, ``(r, 2)``."""
    return np.stack([grid.row_start[:-1], grid.row_start[1:] - 1], axis=1)


def find_roads(
    grid: PlantGrid,
    gate_xy_m: tuple[float, float] | None = None,
    no_go_m: MultiPolygon | None = None,
    clearance: Clearance | None = None,
) -> RoadNetwork:
    """Return the network of ways between the lane ends of a plot and its gate.

    Nodes are the lane ends, the points beside them where one may cross the line of a row clear of
    its plants, and their likes on the row's other side. Ways run along aisles and, wherever a
    straight line touches no row and stays in the drivable area, from node to node. Where that
    leaves parts of the plot apart, they are joined by the shortest ways outside, which lead from
    part to part and are no short cuts between places of one; never over `no_go_m`. Without a gate,
    work starts at the low-x lane end of the first row that is not shut.

    With a `clearance`, ways keep so far off plants, rows whose aisles are too narrow are shut:
    nothing leads along them, and nobody need reach them.
    Raise `PlotError` if some row cannot be reached.
    """
    obstacles = Obstacles.of(grid, MultiPolygon() if no_go_m is None else no_go_m, clearance)
    if not grid.in_rows:
        return _find_from_tree_to_tree(grid, gate_xy_m, obstacles)
    narrow = _Narrow.of(grid, clearance)
    if grid.aisles_m is not None:
        return _find_bent(grid, gate_xy_m, obstacles, narrow)
    xy_m, place = _merged(_row_end_places(grid))
    beside = np.where(grid.side[:, None] < 0, place[:, :, 2], place[:, :, 0])
    turns = np.stack([beside.ravel(), place[:, :, 1].ravel()], axis=1)
    trusted = np.concatenate([beside[~narrow.shut], turns[narrow.passed.ravel()]])
    tried = np.concatenate([_along_aisles(grid, xy_m, place), _nearest(xy_m), _jumps(grid, place)])
    tried = _each_once(tried[~np.isin(tried, beside[narrow.tight]).any(axis=1)])
    good = obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]])
    net = _Net(xy_m, np.concatenate([trusted, tried[good]]))
    gate = int(beside[np.argmin(narrow.shut), 0])
    if gate_xy_m is not None:
        gate = len(net.xy_m)
        net = _with_gate(net, np.array([gate_xy_m]), obstacles, grid)
    needed = np.append(beside[~narrow.shut].ravel(), gate)
    net = _joined_outside(_chained(_joined_inside(net, needed, obstacles)), needed, obstacles)
    return _sorted(net, beside, gate)


def _find_from_tree_to_tree(
    grid: PlantGrid, gate_xy_m: tuple[float, float] | None, obstacles: Obstacles
) -> RoadNetwork:
    """Return straight ways from each tree to those about it: no row is in the way."""
    xy_m = grid.stop_m
    nobody = np.full((1, 4), np.inf)
    obstacles = replace(obstacles, row_box_m=nobody)
    n = len(xy_m)
    tried = _each_once(np.concatenate([_nearest(xy_m), delaunay_sides(xy_m)]))
    good = obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]])
    net, gate = _Net(xy_m, tried[good]), 0
    if gate_xy_m is not None:
        gate = n
        net = _with_gate(net, np.array([gate_xy_m]), obstacles, grid)
    needed = np.append(np.repeat(np.arange(n), 2), gate)
    net = _joined_outside(_joined_inside(net, needed, obstacles), needed, obstacles)
    return _sorted(net, np.repeat(np.arange(n), 2).reshape(-1, 2), gate)


class _Narrow(NamedTuple):
    """What a robot's size shuts.

    Rows that cannot be inspected ``(r,)``, lane ends with no room to turn, and row ends that are
    passed clear of their plants, ``(r, 2)``.
    """

    shut: Mask
    tight: Mask
    passed: Mask

    @classmethod
    def of(cls, grid: PlantGrid, clearance: Clearance | None) -> _Narrow:
        none = np.zeros((grid.n_rows, 2), np.bool_)
        if clearance is None:
            return cls(none[:, 0], none, ~none)
        beyond_m = np.abs(grid.lane_x_m - grid.along_m[_end_plants(grid)])
        tight = clearance.tight_ends(grid)
        return cls(clearance.shut(grid), tight, (beyond_m >= clearance.way_m) & ~tight)


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
    gate = int(beside[np.argmin(narrow.shut), 0]) if gate_xy_m is None else len(xy_m)
    if lane is not None:
        xy_m = np.concatenate([xy_m, lane[0]])
    at_gate = None if lane is None else (gate, *lane[1:])
    bends = bends_of(grid, place, at_m, at_gate, narrow.shut)
    bends = bends.where(_driveable(bends, obstacles))
    across = place.reshape(-1, 3)
    turns = np.stack([beside.ravel(), place[:, :, 1].ravel()], axis=1)
    trusted = turns[narrow.passed.ravel()]
    tried = [across[:, :2], across[:, 1:], _nearest(xy_m), _jumps(grid, place)]
    pairs = np.concatenate(tried)
    pairs = _each_once(pairs[~np.isin(pairs, beside[narrow.tight]).any(axis=1)])
    good = obstacles.clear(xy_m[pairs[:, 0]], xy_m[pairs[:, 1]])
    net = _Net(xy_m, np.concatenate([trusted, bends.pair, pairs[good]]))
    if gate_xy_m is not None and lane is None:
        net = _with_gate(net, np.array([gate_xy_m]), obstacles, grid)
    needed = np.append(beside[~narrow.shut].ravel(), gate)
    net = _joined_outside(_joined_inside(net, needed, obstacles), needed, obstacles)
    return _sorted(net, beside, gate, bends)


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


class _Net(NamedTuple):
    """Nodes and the pairs of them between which one can drive."""

    xy_m: Float
    pair: Index

    def plus(self, xy_m: Float, pair: Index) -> _Net:
        """Return the network with more nodes, numbered on, and more ways."""
        return _Net(np.concatenate([self.xy_m, xy_m]), np.concatenate([self.pair, pair]))

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


def _row_end_places(grid: PlantGrid) -> Float:
    """Return ``(r, 2, 3, 2)``: at each row end, below the row, on its line and above it."""
    half = grid.row_spacing_m / 2
    y = grid.xy_m[_end_plants(grid), 1]
    lane = np.broadcast_to(grid.lane_y_m[:, None], y.shape)
    above = np.where(grid.side[:, None] < 0, lane, y + half)
    below = np.where(grid.side[:, None] < 0, y - half, lane)
    x = np.broadcast_to(grid.lane_x_m[:, :, None], (*y.shape, 3))
    return np.stack([x, np.stack([below, y, above], axis=2)], axis=3)


def _merged(places: Float) -> tuple[Float, Index]:
    """Return the different points ``(m, 2)`` and, of each place, which it is."""
    points = places.reshape(-1, 2)
    _, first, which = np.unique(
        np.round(points / _SAME_M).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    return points[first], which.reshape(places.shape[:-1])


def _each_once(pairs: Index) -> Index:
    """Return the pairs without repetitions and without pairs of a node with itself."""
    pairs = np.sort(pairs, axis=1)
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    _, first = np.unique(pairs[:, 0] * (pairs.max(initial=0) + 1) + pairs[:, 1], return_index=True)
    return pairs[first]


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
    on_it = (ends_x[:, 0] - _SAME_M <= x) & (x <= ends_x[:, 1] + _SAME_M)
    owner, near = owner[on_it], near[on_it]
    order = np.lexsort((xy_m[near, 0], owner))
    owner, near = owner[order], near[order]
    same = owner[1:] == owner[:-1]
    chained = np.stack([near[:-1][same], near[1:][same]], axis=1)
    across = place.reshape(-1, 3)
    return np.concatenate([chained, across[:, :2], across[:, 1:]])


def _nearest(xy_m: Float) -> Index:
    """Return the pairs of each node and those nearest to it."""
    k = min(_NEAREST, len(xy_m))
    return _each_to(np.arange(len(xy_m)), cKDTree(xy_m).query(xy_m, k=k)[1])


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


def _chained(net: _Net) -> _Net:
    """Return the network without ways that only repeat shorter ones lying on them end to end."""
    pair = np.concatenate([net.pair, net.pair[:, ::-1]])
    way = net.xy_m[pair[:, 1]] - net.xy_m[pair[:, 0]]
    bearing = np.round(np.arctan2(way[:, 1], way[:, 0]) / _SAME_BEARING)
    order = np.lexsort((np.hypot(way[:, 0], way[:, 1]), bearing, pair[:, 0]))
    pair, bearing = pair[order], bearing[order]
    beyond = (pair[1:, 0] == pair[:-1, 0]) & (bearing[1:] == bearing[:-1])
    # what lies beyond a nearer node is reached from that node: part of the same clear way
    start = np.append(pair[0, 0], np.where(beyond, pair[:-1, 1], pair[1:, 0]))
    return _Net(net.xy_m, _each_once(np.stack([start, pair[:, 1]], axis=1)))


def _with_gate(net: _Net, gate_m: Float, obstacles: Obstacles, grid: PlantGrid) -> _Net:
    """Return the network with the gate as next node, linked to what is visible from it.

    A gate outside the drivable area is first linked to the nearest point of that area; a gate
    among the plants of a row is moved to that row's lane.
    """
    if grid.aisles_m is None and not obstacles.clear(gate_m, gate_m, Where.ANYWHERE)[0]:
        row = grid.row[np.argmin(np.hypot(*(grid.xy_m - gate_m).T))]
        gate_m = np.array([[np.clip(gate_m[0, 0], *grid.lane_x_m[row]), grid.lane_y_m[row]]])
    n, k = len(net.xy_m), min(_GATE_NEAREST, len(net.xy_m))
    entry_m = gate_m
    if not shapely.intersects_xy(obstacles.drivable_m, *gate_m[0]):
        line = shapely.shortest_line(shapely.points(gate_m[0]), grid.drivable_m)
        entry_m = shapely.get_coordinates(line)[1:]
    near = cKDTree(net.xy_m).query(entry_m[0], k=k)[1].reshape(-1)
    seen = near[obstacles.clear(np.repeat(entry_m, k, axis=0), net.xy_m[near])]
    if entry_m is gate_m:
        return net.plus(gate_m, np.stack([np.full(len(seen), n), seen], axis=1))
    pair = np.stack([np.full(len(seen), n + 1), seen], axis=1)
    pair = np.concatenate([np.array([[n, n + 1]]), pair])
    return net.plus(np.concatenate([gate_m, entry_m]), pair)


def _joined_inside(net: _Net, needed: Index, obstacles: Obstacles) -> _Net:
    """Return the network with needed nodes connected as far as that is possible on the plot."""
    if not net.apart(needed):
        return net
    net = _with_corners(net, obstacles)
    return _bridged(net, np.arange(len(net.xy_m)), obstacles, Where.INSIDE)


def _joined_outside(net: _Net, needed: Index, obstacles: Obstacles) -> _Net:
    """Return the network with all needed nodes connected, where it must be by ways off the plot.

    Such a way leads from one part of the network to another and is whole: it may pass over nodes
    of its own part, and to stop there would be a short cut off the plot between two places that
    can be reached on it. Raise `PlotError` if some node cannot be reached at all.
    """
    for where in (Where.OUTSIDE, Where.ANYWHERE):
        if net.apart(needed):
            net = _bridged(net, needed, obstacles, where)
        if net.apart(needed):
            net = _round_corners(net, needed, obstacles, where)
    if net.apart(needed):
        part = net.component()[needed]
        stranded = (part[:-1] != part[-1]).reshape(-1, 2).any(axis=1)
        raise PlotError(
            worded(
                "Every row must be reachable from the gate without crossing "
                "rows or no-go areas, but {shut} of {n} rows are "
                "not. Move the gate, or open the no-go areas that shut them "
                "in.",
                shut=np.count_nonzero(stranded),
                n=len(stranded),
            )
        )
    return net


def _with_corners(net: _Net, obstacles: Obstacles) -> _Net:
    """Return the network with the plot's corners to drive around, linked to what they see."""
    corners = obstacles.corners(Where.INSIDE)
    n, m = len(net.xy_m), len(corners)
    if not m:
        return net
    near = cKDTree(net.xy_m).query(corners, k=min(_NEAREST, n))[1]
    to_near = _each_to(np.arange(n, n + m), near)
    tried = np.concatenate([np.stack(np.triu_indices(m, 1), axis=1) + n, to_near])
    xy_m = np.concatenate([net.xy_m, corners])
    good = obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]])
    return net.plus(corners, tried[good])


def _bridged(net: _Net, joined: Index, obstacles: Obstacles, where: Where) -> _Net:
    """Return the network with bridges between components that hold some of the nodes to be joined.

    From each of them to those nearest to it.
    """
    zone = np.zeros(len(net.xy_m), np.intp)
    if where is Where.INSIDE:  # from one part of the drivable area to another there are none
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


def _round_corners(net: _Net, needed: Index, obstacles: Obstacles, where: Where) -> _Net:
    """Return the network with parts joined by the shortest ways round corners.

    Each way has corners of its own: if two shared one, they would be a way off the plot between
    places of one part.
    """
    corners_m = np.concatenate([obstacles.corners(where), _beside_stranded(net, needed)])
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


def _beside_stranded(net: _Net, needed: Index) -> Float:
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
    near = idle[np.argsort(far_m, kind="stable")[:_MOST_CORNERS]]
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
    pairs = [_each_to(corner, out)[:, ::-1], _each_to(corner, back)]
    between = np.stack(np.triu_indices(m, 1), axis=1) + n
    tried = np.concatenate([*pairs, between, between[:, ::-1]])
    xy_m = np.concatenate([node_m, corners_m])
    good = tried[obstacles.clear(xy_m[tried[:, 0]], xy_m[tried[:, 1]], where)]
    length_m = _Net(xy_m, good).length_m()
    graph = coo_array((np.maximum(length_m, _SAME_M), good.T), shape=(n + m, n + m))
    far, before, _ = dijkstra(graph, indices=ends[0], min_only=True, return_predecessors=True)
    way = [int(ends[1][np.argmin(far[ends[1]])])]
    if not np.isfinite(far[way[0]]):
        return np.empty(0, np.intp)
    while before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    return np.array(way[::-1])


def _each_to(nodes: Index, near: Index) -> Index:
    """Return each of k nodes ``(k,)`` paired with those near it, ``(k, j)``."""
    near = near.reshape(len(nodes), -1)
    return np.stack([np.repeat(nodes, near.shape[1]), near.ravel()], axis=1)


def _foreign(net: _Net, zone: Index, k: int) -> Index:
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
        found.append(_each_to(ours, others[near]))
    return np.concatenate(found)


def _short_ones(net: _Net, bridges: Index) -> Index:
    """Return of each node the first bridge, unless its component has one of half the length."""
    bridges = bridges[np.unique(bridges[:, 0], return_index=True)[1]]
    length_m = _Net(net.xy_m, bridges).length_m()
    part = net.component()[bridges[:, 0]]
    shortest = np.full(part.max() + 1, np.inf)
    np.minimum.at(shortest, part, length_m)
    return bridges[length_m <= 2 * shortest[part]]


def _sorted(net: _Net, end: Index, gate: int, bends: Bends | None = None) -> RoadNetwork:
    """Return the network as sorted lists, without what cannot be reached from the gate."""
    part = net.component()
    kept = np.flatnonzero(part == part[gate])
    kept = kept[np.lexsort(net.xy_m[kept].T)]
    place = np.full(len(net.xy_m), -1)
    place[kept] = np.arange(len(kept))
    pair = _each_once(place[net.pair[part[net.pair[:, 0]] == part[gate]]])
    from_to = np.concatenate([pair, pair[:, ::-1]])
    from_to = from_to[np.lexsort(from_to.T[::-1])]
    xy_m = net.xy_m[kept]
    start = np.searchsorted(from_to[:, 0], np.arange(len(kept) + 1))
    length_m = _Net(xy_m, from_to).length_m()
    # ends of a row that is shut may be out of reach: nobody goes there
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
