"""Plants traced into the rows in which they stand: bent, in blocks of several directions."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from fieldmon.compute.arrays import offsets
from fieldmon.compute.jit import routine
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_pieces import Windows, pieces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_NEIGHBOURS = 20
# plants farther apart along a row than this many spacings are of different pieces: a headland may
# lie between them; pieces of one block that are level with each other are one row again
_GAP = 3.3
# a line is smoothed over so many plants: 13 follow a bend of 30 m and halve errors of position
_SMOOTHED = 13
# gaps so many plants wide are gone over as the row bends before and behind, as so many plants tell
_MANY_MISSING, _TELLING, _FEWEST = 4.0, 9, 5
# rows beside each other run the same way within this, and are this many usual spacings apart
_ASTRAY_DEG, _BESIDE = 30.0, 1.7
_REFITS = 2
# the lines of so many of the nearest plants may be a plant's own
_ASKED = 8
# blocks of fewer plants, or of fewer a row, may be scraps of others
_SCRAP, _SHORT = 12, 6
# lines are looked about from so many places of each
_LOOKS = 8


class TracedRows(NamedTuple):
    """Plants in rows as they run, block by block, row by row, along each.

    Parameters
    ----------
    plant
        ``(n,)`` which plant stands at each place.
    row_start
        ``(r + 1,)`` offsets: plants of row k are ``plant[row_start[k]:row_start[k + 1]]``.
    block
        ``(r,)`` the block of each row, 0 first; rows ascend within their block to the left of
        their direction.
    line_m
        ``(n, 2)`` the row's line where each plant stands: its place without what it is off.
    off_m
        ``(n,)`` how far each plant stands beside its line.
    row_spacing_m, plant_spacing_m
        Typical distances; the first is NaN where no two rows are beside each other.
    """

    plant: Int
    row_start: Int
    block: Int
    line_m: Float
    off_m: Float
    row_spacing_m: float
    plant_spacing_m: float

    def __repr__(self) -> str:
        return f"<TracedRows: {len(self.plant)} plants>"


class _Strands(NamedTuple):
    """Plants along lines: ``plant (n,)`` in order, lines from ``start``, smoothed ``line_m``."""

    plant: Int
    start: Int
    line_m: Float
    ahead: Float  # (n, 2) unit vectors along

    @property
    def owner(self) -> Int:
        return np.repeat(np.arange(len(self.start) - 1), np.diff(self.start))


def trace(xy_m: Float, label: Int | None = None) -> TracedRows | None:
    """Return the rows in which plants stand; None where there are too few to tell.

    Parameters
    ----------
    xy_m
        ``(n, 2)`` plants, no two in one place.
    label
        ``(n,)`` the row of each, from 0, where that is known: plants of one label and block are
        a row. None: rows are found.
    """
    n = len(xy_m)
    if n < 3:
        return None
    k = min(_NEIGHBOURS, n - 1)
    far_m, near = cKDTree(xy_m).query(xy_m, k=k + 1)
    near_m = float(np.median(far_m[:, 1]))
    area_m2 = float(np.pi * np.median(far_m[:, k]) ** 2 / k)
    windows = Windows.of(xy_m, near_m, area_m2)
    piece, directions = pieces(xy_m, windows)
    angle = np.empty(n)
    angle[windows.plant] = np.repeat(directions.angle, np.diff(windows.start))
    if label is not None:
        piece = label
    spacing_m = _next_in(piece, far_m, near)
    strands = _strands(xy_m, piece, (far_m, near), _GAP * spacing_m, angle)
    rows = _Rows.of(strands, _beside(strands, float(np.sqrt(area_m2))))
    if label is not None:
        rows = _by_label(strands, rows, label)
    strands = _joined(xy_m, strands, rows)
    if label is None:
        strands, rows = _absorbed(xy_m, strands, rows, _GAP * spacing_m)
    for _ in range(_REFITS if label is None else 0):
        strands = _nearest_lines(xy_m, strands)
    return _traced(xy_m, strands, rows.block, rows.spacing_m)


def _by_label(strands: _Strands, rows: _Rows, label: Int) -> _Rows:
    """Return rows by their label: strands of one in one block are a row, where most of it is."""
    of_strand = label[strands.plant[strands.start[:-1]]]
    block = rows.block[rows.row]
    key = block * (int(label.max()) + 1) + of_strand
    group = np.unique(key, return_inverse=True)[1]
    size = np.diff(strands.start)
    level = np.empty(int(group.max()) + 1)
    for k in range(len(level)):
        mine = np.flatnonzero(group == k)
        level[k] = rows.row[mine[np.argmax(size[mine])]]
    rank = np.argsort(np.argsort(level, kind="stable"))
    row = rank[group]
    of_row = np.zeros(len(level), np.int64)
    of_row[row] = block
    return rows._replace(row=row, block=of_row)


def _next_in(piece: Int, far_m: Float, near: Int) -> float:
    """Return the usual distance to the nearest plant of the same piece."""
    same = piece[near[:, 1:]] == piece[:, None]
    first = same.argmax(axis=1)
    has = same.any(axis=1)
    return float(np.median(far_m[np.flatnonzero(has), 1 + first[has]])) if has.any() else np.inf


def _strands(
    xy_m: Float, piece: Int, nearest: tuple[Float, Int], gap_m: float, angle: Float
) -> _Strands:
    """Return the plants of pieces in order along them; gaps part strands."""
    far_m, near = nearest
    n = len(xy_m)
    one = np.repeat(np.arange(n), near.shape[1] - 1)
    other, length_m = near[:, 1:].ravel(), far_m[:, 1:].ravel()
    linked = (piece[one] == piece[other]) & (length_m <= gap_m)
    graph = coo_array(
        (np.maximum(length_m[linked], 1e-9), (one[linked], other[linked])), shape=(n, n)
    ).tocsr()
    strand = connected_components(graph, directed=False)[1]
    return _ordered(xy_m, strand, _from_one_end(graph, strand), angle)


def _from_one_end(graph: coo_array, strand: Int) -> Float:
    """Return how far each plant is from one end of its strand, along the strand."""
    anyone = np.unique(strand, return_index=True)[1]
    far = dijkstra(graph, directed=False, indices=anyone, min_only=True)
    order = np.lexsort((far, strand))
    last = order[np.append(np.flatnonzero(np.diff(strand[order])), len(strand) - 1)]
    along: Float = dijkstra(graph, directed=False, indices=last, min_only=True)
    return along


def _ordered(xy_m: Float, strand: Int, along: Float, angle: Float | None = None) -> _Strands:
    """Return plants sorted along their strands, with the lines through them."""
    plant = np.lexsort((along, strand))
    start = offsets(np.bincount(strand))
    line_m, ahead = np.empty((len(plant), 2)), np.empty((len(plant), 2))
    _smooth(xy_m[plant], start, along[plant], (line_m, ahead, np.empty(len(plant))))
    if angle is not None:
        few = np.repeat(np.diff(start) < 3, np.diff(start))
        turn = angle[plant[few]]
        ahead[few] = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return _Strands(plant, start, line_m, ahead)


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


class DrawnRows(NamedTuple):
    """Lines sorted into rows: block by block, in each from right to left of their direction.

    ``lines`` of the rows, pieces of one joined; the ``block (r,)`` of each; and the usual distance
    between rows, NaN where none are beside each other.
    """

    lines: Polylines
    block: Int
    spacing_m: float

    def __repr__(self) -> str:
        return f"<DrawnRows: {len(self.block)} rows>"


def sorted_rows(lines: Polylines, reach_m: float) -> DrawnRows:
    """Return lines drawn in any order and either way as rows; neighbours are within a reach."""
    f = len(lines)
    line, share = np.repeat(np.arange(f), _LOOKS), np.tile((np.arange(_LOOKS) + 0.5) / _LOOKS, f)
    place = share * lines.length_m[line]
    at, ahead = lines.points(line, place), lines.ahead(line, place)
    strands = _Strands(np.arange(len(at)), np.arange(f + 1) * _LOOKS, at, ahead)
    rows = _Rows.of(strands, _beside_lines(lines, strands, reach_m))
    joined = []
    for row in range(len(rows.block)):
        parts = _in_line(strands, rows, np.flatnonzero(rows.row == row).tolist())
        turned = [lines.line(k)[:: -1 if rows.turned[k] else 1] for k in parts]
        joined.append(np.concatenate(turned))
    return DrawnRows(Polylines.each(joined), rows.block, rows.spacing_m)


def _beside_lines(lines: Polylines, strands: _Strands, reach_m: float) -> _Beside:
    """Return which lines run beside which: what is met at right angles to them."""
    shapes, owner = lines.shapes(), strands.owner
    tree = shapely.STRtree(shapes)
    left = np.stack([-strands.ahead[:, 1], strands.ahead[:, 0]], axis=1)
    found = []
    for sign in (1, -1):
        ends = strands.line_m + sign * reach_m * left
        ways = np.stack([strands.line_m, ends], axis=1)
        rays = np.asarray(shapely.linestrings(ways), np.object_)
        ray, hit = tree.query(rays, predicate="intersects")
        ray, hit = ray[owner[ray] != hit], hit[owner[ray] != hit]
        met = shapely.intersection(rays[ray], shapes[hit])
        off = shapely.distance(shapely.points(strands.line_m[ray]), met)
        order = np.lexsort((off, ray))
        first = order[np.unique(ray[order], return_index=True)[1]]
        ray, hit, off = ray[first], hit[first], off[first]
        place = shapely.line_locate_point(shapes[hit], shapely.points(strands.line_m[ray]))
        turn = np.einsum("ij,ij->i", lines.ahead(hit, place), strands.ahead[ray])
        ok = np.abs(turn) >= np.cos(np.deg2rad(_ASTRAY_DEG))
        way = np.full(int(ok.sum()), sign)
        found.append((owner[ray][ok], hit[ok], way, np.sign(turn[ok]), off[ok]))
    columns = [np.concatenate(part) for part in zip(*found, strict=True)]
    return _counted_pairs(len(lines), *columns)


class _Rows(NamedTuple):
    """Which strands are level with each other, block by block.

    ``row (f,)`` of each strand, rows by block and level; ``turned (f,)`` whether it runs against
    its row; ``block (r,)`` of each row; the usual spacing, NaN if no rows are beside each other.
    """

    row: Int
    turned: NDArray[np.bool_]
    block: Int
    spacing_m: float

    @classmethod
    def of(cls, strands: _Strands, beside: _Beside) -> _Rows:
        """Sort strands into rows and blocks by who is beside whom."""
        f = len(strands.start) - 1
        level, sign, block = _levels(f, beside)
        _left_of_north(strands, level, sign, block)
        spacing_m = float(np.median(beside.apart_m)) if len(beside.apart_m) else np.nan
        _part_doubled(level, block, beside)
        place = _block_order(strands, block)
        keys = np.stack([place, level], axis=1)
        rows, row = np.unique(keys, axis=0, return_inverse=True)
        return cls(
            row.reshape(-1), sign < 0, np.unique(rows[:, 0], return_inverse=True)[1], spacing_m
        )


class _Beside(NamedTuple):
    """Pairs of strands beside each other ``(e,)``: the other is left (+1) or right of one."""

    one: Int
    other: Int
    side: Int
    same_way: Int
    votes: Int
    apart_m: Float


def _beside(strands: _Strands, step_m: float) -> _Beside:
    """Return which strands run beside which."""
    m = len(strands.plant)
    owner = strands.owner
    usual = np.hypot(*np.diff(strands.line_m, axis=0).T)[np.diff(owner) == 0]
    every = max(int(step_m / np.median(usual)), 1) if len(usual) else 1
    place = np.arange(m) - strands.start[owner]
    thin = np.flatnonzero((place % every == 0) | (np.arange(m) == strands.start[owner + 1] - 1))
    at, ahead, owner = strands.line_m[thin], strands.ahead[thin], owner[thin]
    k = min(24, len(thin))
    near = cKDTree(at).query(at, k=np.arange(1, k + 1))[1]
    way = at[near] - at[:, None]
    along = np.einsum("ijk,ik->ij", way, ahead)
    left = ahead[:, None, 0] * way[:, :, 1] - ahead[:, None, 1] * way[:, :, 0]
    turn = np.einsum("ijk,ik->ij", ahead[near], ahead)
    fits = (owner[near] != owner[:, None]) & (np.abs(along) <= 0.7 * np.abs(left))
    one, other, side, same, apart = [], [], [], [], []
    for sign in (1, -1):
        off = np.where(fits & (sign * left > 0), np.abs(left), np.inf)
        best = off.argmin(axis=1)
        rows = np.arange(len(thin))
        ok = np.isfinite(off[rows, best])
        ok &= np.abs(turn[rows, best]) >= np.cos(np.deg2rad(_ASTRAY_DEG))
        one.append(owner[ok])
        other.append(owner[near[rows, best]][ok])
        side.append(np.full(int(ok.sum()), sign))
        same.append(np.sign(turn[rows, best][ok]))
        apart.append(off[rows, best][ok])
    columns = [np.concatenate(part) for part in (one, other, side, same, apart)]
    return _counted_pairs(len(strands.start) - 1, *columns)


def _counted_pairs(f: int, one: Int, other: Int, side: Int, same: Float, apart: Float) -> _Beside:
    """Return each pair once, with its votes; pairs too far apart for rows are left out."""
    usual = np.full(f, np.inf)
    order = np.argsort(one, kind="stable")
    for part in np.split(order, np.flatnonzero(np.diff(one[order])) + 1):
        if len(part):
            usual[one[part[0]]] = np.median(apart[part])
    # at the edge of a block the nearest row on the far side is another block's
    limit = _BESIDE * np.minimum(usual[one], usual[other])
    kept = apart <= limit * 1.0000001
    one, other, side, same, apart = (v[kept] for v in (one, other, side, same, apart))
    key = (one * f + other) * 2 + (side > 0)
    _, first, group, votes = np.unique(
        key, return_index=True, return_inverse=True, return_counts=True
    )
    way = np.sign(np.bincount(group, same, len(first)) + 0.5).astype(np.int64)
    mean = np.bincount(group, apart, len(first)) / np.maximum(votes, 1)
    return _Beside(one[first], other[first], side[first], way, votes, mean)


def _levels(f: int, beside: _Beside) -> tuple[Int, Int, Int]:
    """Return of each strand its level in its block, its direction in it (1, -1), and the block.

    Strands are placed from the best known on: by the pairs with most votes.
    """
    from heapq import heappop, heappush  # noqa: PLC0415

    edges: list[list[tuple[int, int, int, int]]] = [[] for _ in range(f)]
    columns = (beside.one, beside.other, beside.side, beside.same_way, beside.votes)
    for one, other, side, same, votes in zip(*(c.tolist() for c in columns), strict=True):
        edges[one].append((votes, other, side, same))
        edges[other].append((votes, one, -side * same, same))
    level, sign, block = np.zeros(f, np.int64), np.ones(f, np.int64), np.full(f, -1)
    n_blocks = 0
    for seed in range(f):
        if block[seed] >= 0:
            continue
        queue = [(0, seed, 0, 1)]
        while queue:
            _, strand, at, way = heappop(queue)
            if block[strand] >= 0:
                continue
            block[strand], level[strand], sign[strand] = n_blocks, at, way
            for votes, other, side, same in edges[strand]:
                if block[other] < 0:
                    heappush(queue, (-votes, other, at + way * side, way * same))
        n_blocks += 1
    return level, sign, block


def _left_of_north(strands: _Strands, level: Int, sign: Int, block: Int) -> None:
    """Turn blocks so that rows point to the east of north-south, and levels rise to their left."""
    owner = strands.owner
    ahead = strands.ahead * sign[owner, None]
    of = block[owner]
    east, north = (np.bincount(of, ahead[:, k], block.max() + 1) for k in range(2))
    back = (east < -1e-9) | ((np.abs(east) <= 1e-9) & (north < 0))
    sign[back[block]] *= -1
    level[back[block]] *= -1


def _part_doubled(level: Int, block: Int, beside: _Beside) -> None:
    """Give strands that are level with one beside them a block of their own."""
    same = (block[beside.one] == block[beside.other]) & (level[beside.one] == level[beside.other])
    for k in np.flatnonzero(same & (beside.votes >= 2)):
        one, other = int(beside.one[k]), int(beside.other[k])
        if block[one] == block[other]:
            block[max(one, other)] = block.max() + 1


def _block_order(strands: _Strands, block: Int) -> Int:
    """Return the number of each strand's block: those with more plants first."""
    size = np.bincount(block[strands.owner], minlength=block.max() + 1)
    rank = np.empty(len(size), np.int64)
    rank[np.argsort(-size, kind="stable")] = np.arange(len(size))
    return rank[block]


def _joined(xy_m: Float, strands: _Strands, rows: _Rows) -> _Strands:
    """Return the strands that are level with each other as one, end to end."""
    along = np.zeros(len(xy_m))
    row = np.empty(len(xy_m), np.int64)
    members: dict[int, list[int]] = {}
    for strand, of in enumerate(rows.row.tolist()):
        members.setdefault(of, []).append(strand)
    for of, parts in members.items():
        gone = 0.0
        last: Float | None = None
        for strand in _in_line(strands, rows, parts):
            a, b = strands.start[strand], strands.start[strand + 1]
            order = np.arange(a, b)[:: -1 if rows.turned[strand] else 1]
            line = strands.line_m[order]
            if last is not None:
                gone += max(float(np.hypot(*(line[0] - last))), 0.01)
            step = np.hypot(*np.diff(line, axis=0).T) if len(order) > 1 else np.empty(0)
            plants = strands.plant[order]
            along[plants] = gone + np.append(0.0, np.cumsum(np.maximum(step, 1e-6)))
            row[plants] = of
            gone, last = float(along[plants[-1]]), line[-1]
    return _ordered(xy_m, row, along)


def _absorbed(
    xy_m: Float, strands: _Strands, rows: _Rows, reach_m: float
) -> tuple[_Strands, _Rows]:
    """Return the rows with scraps of a few plants as parts of those that they continue.

    At corners of a plot some plants may be seen in line another way.
    """
    for _ in range(2 * _REFITS):
        owner, n_plants = strands.owner, np.diff(strands.start)
        size = np.bincount(rows.block, n_plants)
        scrap = ((size < _SCRAP) | (size < _SHORT * np.bincount(rows.block)))[rows.block]
        whole = np.flatnonzero(~scrap & (n_plants >= 3))
        if not scrap.any() or not len(whole):
            return strands, rows
        loose = np.flatnonzero(scrap[owner])
        kept = np.flatnonzero(np.isin(owner, whole))
        lines = Polylines.of(offsets(n_plants[whole]), strands.line_m[kept])
        line, at, off_m = _continued(xy_m[strands.plant[loose]], lines, reach_m)
        # one alone stands far beside its row rather than in one of its own
        alone = size[rows.block[owner[loose]]] < 3
        fits = off_m <= np.where(alone, 0.6, 0.35) * rows.spacing_m
        row, along = np.empty(len(xy_m), np.int64), np.empty(len(xy_m))
        row[strands.plant] = owner
        gone = np.append(0.0, np.cumsum(np.hypot(*np.diff(strands.line_m, axis=0).T)))
        along[strands.plant] = gone - gone[strands.start[owner]]
        plants = strands.plant[loose][fits]
        row[plants], along[plants] = whole[line[fits]], at[fits]
        left_over, row = np.unique(row, return_inverse=True)
        block = np.unique(rows.block[left_over], return_inverse=True)[1]
        strands, rows = _ordered(xy_m, row, along), rows._replace(block=block)
    return strands, rows


def _continued(xy_m: Float, lines: Polylines, beyond_m: float | None) -> tuple[Int, Float, Float]:
    """Return the line that each plant continues best, its place on it, and how far off it stands.

    Of lines that end no farther from it that beside which it stands nearest; without such a limit
    the nearest line.
    """
    owner = np.repeat(np.arange(len(lines)), np.diff(lines.start))
    k = min(_ASKED, len(owner))
    near = cKDTree(lines.xy_m).query(xy_m, k=np.arange(1, k + 1))[1]
    best, line, place = np.full(len(xy_m), np.inf), owner[near[:, 0]], np.zeros(len(xy_m))
    for column in range(k):
        asked = owner[near[:, column]]
        order = np.argsort(asked, kind="stable")
        at, left = (np.empty(len(xy_m)) for _ in range(2))
        at[order], left[order] = lines.project(xy_m[order], asked[order])
        beyond = np.maximum(-at, at - lines.length_m[asked])
        if beyond_m is None:
            off = np.hypot(left, np.maximum(beyond, 0.0))
        else:
            off = np.where(beyond <= beyond_m, np.abs(left), np.inf)
        better = off < best
        best[better], line[better], place[better] = off[better], asked[better], at[better]
    return line, place, best


def _in_line(strands: _Strands, rows: _Rows, parts: list[int]) -> list[int]:
    """Return strands of one row in their order along it."""
    if len(parts) == 1:
        return parts
    ahead, middle = [], []
    for strand in parts:
        a, b = strands.start[strand], strands.start[strand + 1]
        sign = -1.0 if rows.turned[strand] else 1.0
        ahead.append(sign * strands.ahead[a:b].sum(axis=0))
        middle.append(strands.line_m[a:b].mean(axis=0))
    along = np.array(middle) @ np.sum(ahead, axis=0)
    return [parts[k] for k in np.argsort(along)]


def _nearest_lines(xy_m: Float, strands: _Strands) -> _Strands:
    """Return the rows with each plant in that whose line is nearest, and in its order there."""
    row, along, _ = _continued(xy_m, _lines(strands), None)
    if len(np.unique(row)) < len(strands.start) - 1:
        return strands
    return _ordered(xy_m, row, along)


def row_lines_of(traced: TracedRows) -> Polylines:
    """Return the lines of traced rows; that of a single plant is short, and along x.

    Over gaps of many plants they go on bending as they do on either side.
    """
    ahead = np.tile([1.0, 0.0], (len(traced.plant), 1))
    lines = _lines(_Strands(traced.plant, traced.row_start, traced.line_m, ahead))
    return _bent_over_gaps(lines, _MANY_MISSING * traced.plant_spacing_m)


def _bent_over_gaps(lines: Polylines, wide_m: float) -> Polylines:
    """Return lines whose steps wider than this are curves, smooth at both ends."""
    step_m = np.diff(lines.at_m)
    step_m[lines.start[1:-1] - 1] = 0.0
    at, made = [np.empty(0, np.int64)], [np.empty((0, 2))]
    for k in np.flatnonzero(step_m > wide_m):
        line = int(np.searchsorted(lines.start, k, side="right")) - 1
        before = lines.xy_m[lines.start[line] : k + 1]
        after = lines.xy_m[k + 1 : lines.start[line + 1]]
        if min(len(before), len(after)) < _FEWEST:
            continue
        curve = _curve(before, after, int(step_m[k] / wide_m * _MANY_MISSING))
        at.append(np.full(len(curve), k + 1))
        made.append(curve)
    added = np.concatenate(at)
    xy_m = np.insert(lines.xy_m, added, np.concatenate(made), axis=0)
    return Polylines.of(lines.start + np.searchsorted(added, lines.start, side="right"), xy_m)


def _curve(before: Float, after: Float, n: int) -> Float:
    """Return n points ``(n, 2)`` from the end of one line to the start of another (Hermite's).

    None where the two do not lead to each other.
    """
    way = after[0] - before[-1]
    far = float(np.hypot(*way))
    out, into = _end_way(before[::-1]), -_end_way(after)
    if min(out @ way, into @ way) < 0.5 * far:
        return np.empty((0, 2))
    t = (np.arange(1, n + 1) / (n + 1))[:, None]
    on: Float = before[-1] + way * t * t * (3 - 2 * t)
    return on + far * (out * t * (1 - t) ** 2 - into * t * t * (1 - t))


def _end_way(line: Float) -> Float:
    """Return the direction ``(2,)`` in which a line ends that is given from its end back."""
    last = min(_TELLING, len(line)) - 1
    here, near, there = line[0], line[last // 2], line[last]
    a, b = float(np.hypot(*(near - here))), float(np.hypot(*(there - here)))
    # of the parabola through three places
    way = (here - near) * b / (a * (b - a)) - (here - there) * a / (b * (b - a))
    unit: Float = way / max(float(np.hypot(*way)), 1e-12)
    return unit


def _lines(strands: _Strands) -> Polylines:
    """Return the lines of strands; that of a single plant is short."""
    alone = np.flatnonzero(np.diff(strands.start) == 1)
    at = strands.start[alone]
    xy_m = np.insert(strands.line_m, at + 1, strands.line_m[at] + 0.01 * strands.ahead[at], axis=0)
    return Polylines.of(strands.start + np.searchsorted(alone, np.arange(len(strands.start))), xy_m)


class BesideRows(NamedTuple):
    """How far plants stand beside the lines of their rows.

    ``left_m (n,)`` to the left of the line through all of them, below 0 to its right;
    ``alone_m (n,)`` from that of the others; and how many are ``free`` to say so: a line that
    bends follows few plants of itself, about a fourth of them and two a row.
    """

    left_m: Float
    alone_m: Float
    free: float

    def __repr__(self) -> str:
        return f"<BesideRows: {len(self.left_m)} plants>"


def beside_their_rows(xy_m: Float, row: NDArray[np.integer]) -> BesideRows:
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
    return BesideRows(left_m, alone_m, float(np.maximum(0.75 * n_plants - 2.0, 0.0).sum()))


def _traced(xy_m: Float, strands: _Strands, block: Int, spacing_m: float) -> TracedRows:
    owner = strands.owner
    off = xy_m[strands.plant] - strands.line_m
    off_m = np.abs(strands.ahead[:, 0] * off[:, 1] - strands.ahead[:, 1] * off[:, 0])
    steps = np.hypot(*np.diff(strands.line_m, axis=0).T)[np.diff(owner) == 0]
    usual = float(np.median(steps)) if len(steps) else np.nan
    times = np.round(steps / usual) if len(steps) else steps
    sure = (times >= 1) & (times <= 4)
    apart_m = float(np.median(steps[sure] / times[sure])) if sure.any() else np.nan
    return TracedRows(
        strands.plant, strands.start, block, strands.line_m, off_m, spacing_m, apart_m
    )
