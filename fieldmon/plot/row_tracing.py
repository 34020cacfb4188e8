"""Plants traced into the rows in which they stand: bent, in blocks of several directions."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from fieldmon.compute.arrays import offsets
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_order import StrandRows, in_line, neighbouring_strands
from fieldmon.plot.row_pieces import Windows, pieces
from fieldmon.plot.strands import Strands, lines_of, ordered

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_NEIGHBOURS = 20
# plants farther apart along a row than this many spacings are of different pieces: a headland may
# lie between them; pieces of one block that are level with each other are one row again
_GAP = 3.3
_REFITS = 2
# the lines of so many of the nearest plants may be a plant's own
_ASKED = 8
# beside a block of rows that run another way, so many plants at an end may be seen in line with it
_DEEP = 20
# a plant continues a row if it stands a step beyond its end, so many steps off at most, and so many
# times as far from those of the row in which it was seen
_OFF_END, _FARTHER = 0.2, 1.6
# blocks of fewer plants, or of fewer a row, may be scraps of others
_SCRAP, _SHORT = 12, 6


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
    rows = StrandRows.of(strands, neighbouring_strands(strands, float(np.sqrt(area_m2))))
    if label is not None:
        rows = _by_label(strands, rows, label)
    strands = _joined(xy_m, strands, rows)
    if label is None:
        strands, rows = _absorbed(xy_m, strands, rows, _GAP * spacing_m)
    for _ in range(_REFITS if label is None else 0):
        strands = _nearest_lines(xy_m, strands)
    for _ in range(_DEEP if label is None else 0):
        before = strands
        strands, rows = _ends_taken_back(xy_m, strands, rows)
        if strands is before:
            break
    return _traced(xy_m, strands, rows.block, rows.spacing_m)


def _by_label(strands: Strands, rows: StrandRows, label: Int) -> StrandRows:
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
) -> Strands:
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
    return ordered(xy_m, strand, _from_one_end(graph, strand), angle)


def _from_one_end(graph: coo_array, strand: Int) -> Float:
    """Return how far each plant is from one end of its strand, along the strand."""
    anyone = np.unique(strand, return_index=True)[1]
    far = dijkstra(graph, directed=False, indices=anyone, min_only=True)
    order = np.lexsort((far, strand))
    last = order[np.append(np.flatnonzero(np.diff(strand[order])), len(strand) - 1)]
    along: Float = dijkstra(graph, directed=False, indices=last, min_only=True)
    return along


def _joined(xy_m: Float, strands: Strands, rows: StrandRows) -> Strands:
    """Return the strands that are level with each other as one, end to end."""
    along = np.zeros(len(xy_m))
    row = np.empty(len(xy_m), np.int64)
    members: dict[int, list[int]] = {}
    for strand, of in enumerate(rows.row.tolist()):
        members.setdefault(of, []).append(strand)
    for of, parts in members.items():
        gone = 0.0
        last: Float | None = None
        for strand in in_line(strands, rows, parts):
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
    return ordered(xy_m, row, along)


def _absorbed(
    xy_m: Float, strands: Strands, rows: StrandRows, reach_m: float
) -> tuple[Strands, StrandRows]:
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
        strands, rows = ordered(xy_m, row, along), rows._replace(block=block)
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


def _nearest_lines(xy_m: Float, strands: Strands) -> Strands:
    """Return the rows with each plant in that whose line is nearest, and in its order there."""
    row, along, _ = _continued(xy_m, lines_of(strands), None)
    if len(np.unique(row)) < len(strands.start) - 1:
        return strands
    return ordered(xy_m, row, along)


def _ends_taken_back(xy_m: Float, strands: Strands, rows: StrandRows) -> tuple[Strands, StrandRows]:
    """Return the rows with plants that continue them closely, but were seen in line another way.

    As at a block whose rows run across: its neighbour's ends stand in line with its rows.
    """
    owner, n_plants = strands.owner, np.diff(strands.start)
    long = np.flatnonzero(n_plants >= _SHORT)
    if not len(long) or len(n_plants) < 2:
        return strands, rows
    step_m = np.hypot(*np.diff(xy_m[strands.plant], axis=0).T)
    step_m[np.diff(owner) != 0] = np.inf
    own_m = np.minimum(np.append(np.inf, step_m), np.append(step_m, np.inf))
    wanted, claims = [], []
    for last in (False, True):
        end = strands.start[long + 1] - 1 if last else strands.start[long]
        inner = np.stack([end - k if last else end + k for k in range(4)])
        usual_m = np.median(np.hypot(*(np.diff(xy_m[strands.plant[inner]], axis=0).T)).T, axis=0)
        away = strands.ahead[end] * (1.0 if last else -1.0)
        wanted.append(xy_m[strands.plant[end]] + usual_m[:, None] * away)
        claims.append(np.stack([long, np.full(len(long), 1 if last else -1)], axis=1))
    of = np.concatenate(claims)
    usual_m = np.hypot(*(np.concatenate(wanted) - xy_m[strands.plant[_ends(strands, of)]]).T)
    off_m, at = cKDTree(xy_m[strands.plant]).query(np.concatenate(wanted))
    takes = (off_m <= _OFF_END * usual_m) & (owner[at] != of[:, 0])
    takes &= own_m[at] > _FARTHER * usual_m
    if not takes.any():
        return strands, rows
    row, along = np.empty(len(xy_m), np.int64), np.empty(len(xy_m))
    row[strands.plant] = owner
    gone = np.append(0.0, np.cumsum(np.hypot(*np.diff(strands.line_m, axis=0).T)))
    along[strands.plant] = gone - gone[strands.start[owner]]
    best = np.flatnonzero(takes)[np.argsort(off_m[takes], kind="stable")[::-1]]
    for k in best.tolist():  # the nearest one has the last word
        plant, (line, side) = strands.plant[at[k]], of[k]
        row[plant] = line
        along[plant] = along[strands.plant[_ends(strands, of[k : k + 1])[0]]] + side * usual_m[k]
    left_over, row = np.unique(row, return_inverse=True)
    block = np.unique(rows.block[left_over], return_inverse=True)[1]
    return ordered(xy_m, row, along), rows._replace(block=block)


def _ends(strands: Strands, of: Int) -> Int:
    """Return the places of ends: of rows ``(k, 2)``, and 1 for the last plant, -1 for the first."""
    return np.where(of[:, 1] > 0, strands.start[of[:, 0] + 1] - 1, strands.start[of[:, 0]])


def _traced(xy_m: Float, strands: Strands, block: Int, spacing_m: float) -> TracedRows:
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
