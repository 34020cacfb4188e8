"""The same problem as a mixed-integer program, solved with a proof: for small instances.

In each row one goes in from the left and from the right, or through once or twice; headlands are
walked 0, 1 or 2 times between rows; at every row end passes are even. That it all hangs together
is said by a flow from the start to every row end that is come by. Nothing of the five states of
the sweep is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]


class Solved(NamedTuple):
    """The most reward found, a bound on all, and whether the two are proved to meet."""

    reward: float
    bound: float
    proved: bool


class _Columns(NamedTuple):
    """Numbers of the variables.

    In from the left and from the right as far as each plant, plants that count, ``(m, n)`` each;
    rows walked through once, twice ``(m,)``; headland passes ``(m - 1, 2)``; half the passes at
    row ends ``(m, 2)``; row ends come by ``(m, 2)``; flow each way on links ``(2, links)``.
    """

    left: Int
    right: Int
    counts: Int
    once: Int
    twice: Int
    passes: Int
    half: Int
    used: Int
    flow: Int


class _Rules:
    """Linear rules, collected one by one: low <= sum of value x variable <= high."""

    def __init__(self) -> None:
        self.row: list[int] = []
        self.column: list[int] = []
        self.value: list[float] = []
        self.low: list[float] = []
        self.high: list[float] = []

    def add(self, terms: list[tuple[int, float]], low: float, high: float) -> None:
        """Add one rule."""
        self.row += [len(self.low)] * len(terms)
        self.column += [int(column) for column, _ in terms]
        self.value += [value for _, value in terms]
        self.low.append(low)
        self.high.append(high)


def solve(reward: Float, budget: int, seconds: float = 60.0) -> Solved:
    """Return the most reward of a closed walk of at most so many steps, by HiGHS."""
    from scipy.optimize import Bounds, LinearConstraint, milp  # noqa: PLC0415 - slow to import
    from scipy.sparse import coo_array  # noqa: PLC0415

    columns, n = _columns(*reward.shape)
    rules = _Rules()
    _in_rows(rules, columns)
    _at_ends(rules, columns)
    _steps(rules, columns, budget)
    most, whole, cost = np.ones(n), np.ones(n), np.zeros(n)
    most[columns.passes], most[columns.half] = 2.0, 4.0
    most[columns.flow], whole[columns.flow] = np.inf, 0.0
    cost[columns.counts] = -reward
    shape = len(rules.low), n
    matrix = coo_array((rules.value, (rules.row, rules.column)), shape=shape).tocsc()
    found = milp(
        cost,
        integrality=whole,
        bounds=Bounds(np.zeros(n), most),
        constraints=LinearConstraint(matrix, rules.low, rules.high),
        options={"time_limit": seconds, "mip_rel_gap": 0.0},
    )
    held = 0.0 if found.x is None else -float(found.fun)
    bound = float(reward.sum()) if found.mip_dual_bound is None else -float(found.mip_dual_bound)
    return Solved(held, bound, found.status == 0)


def _columns(m: int, n: int) -> tuple[_Columns, int]:
    shapes = [(m, n)] * 3 + [(m,)] * 2 + [(m - 1, 2), (m, 2), (m, 2), (2, 3 * m - 2)]
    first, made = 0, []
    for shape in shapes:
        size = int(np.prod(shape))
        made.append(np.arange(first, first + size).reshape(shape))
        first += size
    return _Columns(*made), first


def _in_rows(rules: _Rules, c: _Columns) -> None:
    """To go in as far as a plant is to pass those before it; what was passed counts."""
    m, n = c.counts.shape
    for i in range(m):
        rules.add([(c.once[i], 1.0), (c.twice[i], 1.0)], 0.0, 1.0)
        for j in range(n):
            if j:
                rules.add([(c.left[i, j], 1.0), (c.left[i, j - 1], -1.0)], -1.0, 0.0)
                rules.add([(c.right[i, j - 1], 1.0), (c.right[i, j], -1.0)], -1.0, 0.0)
            ways = [(int(k), -1.0) for k in (c.left[i, j], c.right[i, j], c.once[i], c.twice[i])]
            rules.add([(c.counts[i, j], 1.0), *ways], -4.0, 0.0)


def _at_ends(rules: _Rules, c: _Columns) -> None:
    """Make passes even at every row end, and what is come by hang together."""
    m, n = c.counts.shape
    links = [(2 * i, 2 * i + 1) for i in range(m)]
    links += [(2 * i + s, 2 * i + 2 + s) for i in range(m - 1) for s in range(2)]
    passes = [[(int(c.once[i]), 1.0), (int(c.twice[i]), 2.0)] for i in range(m)]
    passes += [[(int(c.passes[i, s]), 1.0)] for i in range(m - 1) for s in range(2)]
    for end in range(2 * m):
        i, side = divmod(end, 2)
        here = [
            term for link, terms in zip(links, passes, strict=True) if end in link for term in terms
        ]
        rules.add([*here, (c.half[i, side], -2.0)], 0.0, 0.0)
        deep = c.left[i, 0] if side == 0 else c.right[i, n - 1]
        rules.add([(deep, 1.0), (c.used[i, side], -1.0)], -1.0, 0.0)
        inward = []
        for k, link in enumerate(links):
            if end in link:
                sign = 1.0 if link[1] == end else -1.0
                inward += [(int(c.flow[0, k]), sign), (int(c.flow[1, k]), -sign)]
                rules.add([*passes[k], (c.used[i, side], -2.0)], -2.0, 0.0)
        if end:
            rules.add([*inward, (c.used[i, side], -1.0)], 0.0, 0.0)
    for k, terms in enumerate(passes):
        for way in range(2):
            room = [(column, -float(2 * m)) for column, _ in terms]
            rules.add([(c.flow[way, k], 1.0), *room], -np.inf, 0.0)


def _steps(rules: _Rules, c: _Columns, budget: int) -> None:
    m, n = c.counts.shape
    terms = [(int(k), 2.0) for k in (*c.left.ravel(), *c.right.ravel())]
    terms += [(int(k), 1.0) for k in c.passes.ravel()]
    for i in range(m):
        terms += [(int(c.once[i]), n + 1.0), (int(c.twice[i]), 2.0 * (n + 1))]
    rules.add(terms, 0.0, float(budget))
