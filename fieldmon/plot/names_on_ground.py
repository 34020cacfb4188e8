"""Names of rows and plants against where these stand: strayed, exchanged, out of order."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import joined, worded
from fieldmon.plot.adjacency import NEXT
from fieldmon.plot.grid import block_number, plant_numbers
from fieldmon.plot.plant_names import numbers_in

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plant_names import PlantNames
    from fieldmon.plot.row_tracing import TracedRows

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]
    Mask = NDArray[np.bool_]

# a row found is the one that so many of its plants name
_MOST = 0.6
# so many row spacings from the rest of its row a plant strays; between two of another row, so many
_ACROSS, _BETWEEN = 1.5, 0.8
# at the end of another row it is in line with so many of that, as nearly as this
_END, _IN_LINE = 3, 0.25
# and so many beside the line of so many plants of that row; fewer than so many make none
_BESIDE, _LINE, _LEAST_LINE = 0.7, 8, 4
# fewer rows tell no order; of more, so many may be exchanged, or such a share
_LEAST_ROWS, _FEW, _SHARE = 7, 2, 0.1
# rows of fewer plants tell none either
_TELLS = 3
# of so many rows, a share may be numbered from the other end than all others
_OTHER_END = 0.1
# so many rows, and such a share of them, have plants in the order of their numbers, where that
# means anything; so few plants tell none, and those nearer than such a share of their spacing
_LEAST_IN_ORDER, _IN_ORDER, _LEAST_STEPS, _CLOSE = 3, 0.75, 3, 0.5
# plants are out of order where that is so many times how far steps usually are from their numbers
_SIGMAS = 7.0
_NAMED = 5


class Stray(NamedTuple):
    """A plant among those of another row than it names.

    `other` is one of these, and `away_m` how far it is from the rest of its own row; infinite
    where there is no rest.
    """

    plant: int
    other: int
    away_m: float


def strays(xy_m: Float, traced: TracedRows, label: Int) -> tuple[Stray, ...]:
    """Return which plants ``(n, 2)`` stand amid a row that was traced, of which others are named.

    `label` ``(n,)`` numbers the row that each plant names.
    """
    row = np.empty(len(label), np.int64)
    row[traced.plant] = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    one, sure = _named_by_most(row, label)
    right = label == label[one][row]
    doubted = np.flatnonzero(~right & sure[row])
    if not len(doubted) or not np.isfinite(traced.row_spacing_m):
        return ()
    away_m, beside_m = _from_the_rest(xy_m, label, right, doubted)
    amid = _is_between(traced, row, right) | _ends_row(traced, row, right)
    far = np.where(amid[doubted], _BETWEEN, _ACROSS)
    gone = (away_m > far * traced.row_spacing_m) & (beside_m > _BESIDE * traced.row_spacing_m)
    return tuple(
        Stray(int(k), int(one[row[k]]), float(m))
        for k, m in zip(doubted[gone], away_m[gone], strict=True)
    )


def _named_by_most(row: Int, label: Int) -> tuple[Int, Mask]:
    """Return of each row found a plant with its commonest name, and whether most have that."""
    pair, first, times = np.unique(
        np.stack([row, label], axis=1), axis=0, return_index=True, return_counts=True
    )
    order = np.lexsort((times, pair[:, 0]))
    last = order[np.append(np.diff(pair[order, 0]) > 0, True)]
    sure: Mask = (times[last] >= _MOST * np.bincount(row)) & (times[last] > 1)
    return first[last].astype(np.int64), sure


def _from_the_rest(xy_m: Float, label: Int, right: Mask, plants: Int) -> tuple[Float, Float]:
    """Return how far plants are from the nearest of their name that stands in its row.

    And how far beside the line of those about that one: a row goes on beyond a gap.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    away_m, beside_m = np.full(len(plants), np.inf), np.full(len(plants), np.inf)
    for name in np.unique(label[plants]).tolist():
        rest = np.flatnonzero(right & (label == name))
        asked = np.flatnonzero(label[plants] == name)
        if not len(rest):
            continue
        own_m = xy_m[plants[asked]]
        far_m, near = cKDTree(xy_m[rest]).query(own_m, k=min(_LINE, len(rest)))
        away_m[asked] = far_m.reshape(len(asked), -1)[:, 0]
        if len(rest) >= _LEAST_LINE:
            about_m = xy_m[rest[near]]
            middle_m = about_m.mean(axis=1)
            across = np.linalg.svd(about_m - middle_m[:, None])[2][:, 1]
            beside_m[asked] = np.abs(((own_m - middle_m) * across).sum(axis=1))
    return away_m, beside_m


def _is_between(traced: TracedRows, row: Int, right: Mask) -> Mask:
    """Return which plants stand between two next to them, whose names are those of their row."""
    of, good = row[traced.plant], right[traced.plant]
    step_m = np.hypot(*np.diff(traced.line_m, axis=0).T)
    joined = (np.diff(of) == 0) & (step_m < NEXT * traced.plant_spacing_m)
    between = np.zeros(len(row), np.bool_)
    between[traced.plant[1:-1]] = joined[:-1] & joined[1:] & good[:-2] & good[2:]
    return between


def _ends_row(traced: TracedRows, row: Int, right: Mask) -> Mask:
    """Return which plants end a row, next to and in line with some whose names are those of it."""
    ends = np.zeros(len(row), np.bool_)
    near_m = _IN_LINE * traced.row_spacing_m
    for first, stop in pairwise(traced.row_start.tolist()):
        if stop - first <= _END:
            continue
        for end, way in ((first, 1), (stop - 1, -1)):
            beside = end + way * np.arange(1, _END + 1)
            step_m = float(np.hypot(*(traced.line_m[end] - traced.line_m[beside[0]])))
            close = step_m < NEXT * traced.plant_spacing_m and traced.off_m[end] < near_m
            ends[traced.plant[end]] = close and bool(right[traced.plant[beside]].all())
    return ends


def said_of_strays(found: Sequence[Stray], names: PlantNames, lonlat: Float) -> str:
    """Return a doubt that names the plants that stray; empty where none do."""
    if not found or names.row is None:
        return ""
    some = []
    for plant, other, away_m in found[:_NAMED]:
        called = "" if names.plant is None else str(names.plant[plant])
        kinds = {
            "plant": called or "{:.6f} / {:.6f}".format(*lonlat[plant]),
            "row": str(names.row[plant]),
            "other": str(names.row[other]),
        }
        if np.isfinite(away_m):
            one = worded(
                "plant {plant} of row {row} stands in row {other}, {away} from the rest of its row",
                away=distance_figure(away_m),
                **kinds,
            )
        else:
            one = worded(
                "plant {plant} of row {row} stands in row {other}, and no other plant is of its "
                "row",
                **kinds,
            )
        some.append(one)
    return worded(
        "{n} {n:plant stands|plants stand} amid another row than the file names: {some}. "
        "Rows are drawn as the file names them: correct {n:its row|their rows} there.",
        n=len(found),
        some=joined("; ", [*some, *["..."] * (len(found) > _NAMED)]),
    )


def doubts_of_order(grid: PlantGrid) -> list[str]:
    """Return a doubt for rows, and one for plants, out of an order in which all others are named.

    Where names are in no order, that says nothing.
    """
    return [
        said
        for said in (
            _rows_out_of_order(grid),
            _plants_out_of_order(grid),
            _rows_from_the_other_end(grid),
        )
        if said
    ]


def _rows_out_of_order(grid: PlantGrid) -> str:
    if grid.line_called is None and grid.line_named is None:
        return ""
    keys: list[tuple[object, ...]]
    if grid.line_called is not None:
        keys = [(n,) for n in grid.line_called[:, 1].tolist()]
        odd = grid.line_odd
    else:
        named = [] if grid.line_named is None else grid.line_named.tolist()
        keys, odd = [_natural(one) for one in named], np.array([not one for one in named])
    first = np.unique(grid.row_line, return_index=True)[1]
    block = block_number(grid, grid.row_start[first])
    odd = odd | (np.bincount(grid.row_line[grid.row]) < _TELLS)  # of strays others tell
    some: list[str] = []
    signs = list(grid.line_signs.values())
    for k in range(1, grid.n_blocks + 1):
        lines = np.flatnonzero((block == k) & ~odd)
        for at in out_of_order([keys[line] for line in lines.tolist()]):
            beside = [signs[lines[j]] for j in (at - 1, at + 1) if 0 <= j < len(lines)]
            one = {"row": signs[lines[at]], "before": beside[0], "after": beside[-1]}
            some.append(
                worded("row {row} stands beside {before}", **one)
                if len(beside) == 1
                else worded("row {row} stands between {before} and {after}", **one)
            )
    if not some:
        return ""
    return worded(
        "Rows stand in the order of their names, but for {n}: {some}. Look whether names are "
        "exchanged in the file.",
        n=len(some),
        some=joined(", ", [*some[:_NAMED], *["..."] * (len(some) > _NAMED)]),
    )


def _natural(name: str) -> tuple[object, ...]:
    """Return what sorts names by their words and numbers."""
    parts = re.split(r"(\d+)", name.casefold())
    return tuple((k % 2, int(part) if k % 2 else part) for k, part in enumerate(parts) if part)


def out_of_order(keys: Sequence[object]) -> list[int]:
    """Return which of a sequence, of which nearly all others rise or fall, stand out of order.

    Examples
    --------
    >>> out_of_order([1, 2, 7, 4, 5, 6, 3, 8]), out_of_order([5, 1, 3, 2, 7, 4, 8, 6])
    ([2, 6], [])
    """
    n = len(keys)
    if n < _LEAST_ROWS:
        return []
    known = {key: rank for rank, key in enumerate(sorted(set(keys)))}  # type: ignore[type-var]
    rank = np.array([known[key] for key in keys])
    if len(known) < n:
        return []
    most = max(_FEW, int(_SHARE * n))
    found: list[list[int]] = []
    for way in (rank, n - 1 - rank):
        elsewhere = np.flatnonzero(way != np.arange(n)).tolist()  # exchanged among themselves
        found.append(min(elsewhere, _left_of_longest_rise(way), key=len))
    best = min(found, key=len)
    return best if len(best) <= most else []


def _left_of_longest_rise(rank: NDArray[np.integer]) -> list[int]:
    """Return the places of a permutation that are not in its longest rising subsequence."""
    n = len(rank)
    ends: list[int] = []
    before = np.full(n, -1)
    for k in range(n):
        at = int(np.searchsorted(rank[ends], rank[k]))
        before[k] = ends[at - 1] if at else -1
        ends[at : at + 1] = [k]
    kept, k = set[int](), ends[-1]
    while k >= 0:
        kept.add(k)
        k = int(before[k])
    return [k for k in range(n) if k not in kept]


class _NumberSteps(NamedTuple):
    """How numbers go on from plant to plant ``(n,)``, which have a place in an order, row by row.

    ``told (n - 1,)`` are steps that tell it, ``up`` and ``down`` how many of a row rise and fall,
    ``asked`` the rows in which enough do; ``line`` is the row of each plant.
    """

    line: NDArray[np.integer]
    number: Int
    step: Int
    step_m: Float
    told: Mask
    up: Int
    down: Int
    asked: Mask

    @classmethod
    def of(cls, grid: PlantGrid, called: Int) -> _NumberSteps:
        """Return the steps of the numbers that plants are `called`."""
        vines = np.unique(grid.vine)
        line, number = grid.row_line[grid.row[vines]], called[vines]
        step = np.diff(number)
        step_m = np.hypot(*np.diff(grid.xy_m[vines], axis=0).T)
        told = (np.diff(line) == 0) & (step != 0) & (step_m > _CLOSE * grid.plant_spacing_m)
        up, down = (
            np.bincount(line[1:][told & one], minlength=int(line.max()) + 1)
            for one in (step > 0, step < 0)
        )
        asked = up + down >= _LEAST_STEPS
        asked[_counted_from_one(grid, vines, line)] = False
        return cls(line, number, step, step_m, told, up, down, asked)


def _plants_out_of_order(grid: PlantGrid) -> str:
    if grid.plant_called is None:
        return ""
    line, number, step, step_m, told, up, down, asked = _NumberSteps.of(grid, grid.plant_called)
    n_lines = len(asked)
    rises = (up >= down)[line[1:]]
    back = told & np.where(rises, step < 0, step > 0)
    per_number_m = float(np.median(step_m[told] / np.abs(step[told]))) if told.any() else 0.0
    numbers_m = np.abs(step) * per_number_m
    usual_m = 1.4826 * float(np.median(np.abs(step_m - numbers_m)[told])) if told.any() else 0.0
    back &= step_m + numbers_m > _SIGMAS * usual_m
    wrong = asked & (np.bincount(line[1:][back], minlength=n_lines) > 0)
    n_in_order = np.count_nonzero(asked & (np.minimum(up, down) == 0))
    if not wrong.any() or n_in_order < max(_LEAST_IN_ORDER, _IN_ORDER * np.count_nonzero(asked)):
        return ""
    some = []
    signs = list(grid.line_signs.values())
    for row in np.flatnonzero(wrong)[:_NAMED].tolist():
        at = int(np.flatnonzero(back & (line[1:] == row))[0])
        near = range(max(at - 1, 0), min(at + 3, len(line)))
        beside = ", ".join(f"{number[k]}" for k in near if line[k] == row)
        some.append(worded("row {row} ({plants})", row=signs[row], plants=beside))
    n = int(np.count_nonzero(wrong))
    return worded(
        "Plants stand in their rows in the order of their numbers, but for those of {n} "
        "{n:row|rows}: {some}. Look whether their numbers are exchanged in the file.",
        n=n,
        some=joined(", ", [*some, *["..."] * (n > _NAMED)]),
    )


def _rows_from_the_other_end(grid: PlantGrid) -> str:
    """Return which rows are numbered from the other end than all others of their block.

    Where others are numbered from one end, or from both by turns as one walks up and down them.
    """
    if grid.plant_called is None:
        return ""
    steps = _NumberSteps.of(grid, grid.plant_called)
    sure = steps.asked & (np.minimum(steps.up, steps.down) == 0)
    first = np.unique(grid.row_line, return_index=True)[1]
    block = block_number(grid, grid.row_start[first])
    wrong: list[int] = []
    for k in range(1, grid.n_blocks + 1):
        lines = np.flatnonzero(block == k)
        asked = np.flatnonzero(sure[lines])
        if len(asked) < _LEAST_ROWS:
            continue
        rises = steps.up[lines[asked]] > 0
        ways = [_minority(rises), _minority(rises ^ (asked % 2 == 1))]
        odd = min(ways, key=np.count_nonzero)
        if np.count_nonzero(odd) <= max(1, int(_OTHER_END * len(asked))):
            wrong += lines[asked[odd]].tolist()
    if not wrong:
        return ""
    signs = list(grid.line_signs.values())
    some = [signs[line] for line in wrong[:_NAMED]]
    n = len(wrong)
    return worded(
        "Plants of {n} {n:row|rows} are numbered from the other end than those of all others: "
        "{some}. Look whether {n:it was|they were} counted so; if not, turn "
        "{n:its|their} numbers in the file.",
        n=n,
        some=joined(", ", [*some, *["..."] * (n > _NAMED)]),
    )


def _minority(of: Mask) -> Mask:
    """Return which are unlike most."""
    rarer: Mask = of == (2 * np.count_nonzero(of) < len(of))
    return rarer


def _counted_from_one(grid: PlantGrid, vines: Int, line: NDArray[np.integer]) -> Int:
    """Return the lines whose plants do not have the numbers in their names."""
    if grid.plant_named is None:
        return np.empty(0, np.int64)
    wrong = numbers_in(grid.plant_named[vines]) != plant_numbers(grid, vines).number
    return np.unique(line[wrong]).astype(np.int64)
