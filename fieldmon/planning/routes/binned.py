"""Good drives on a ladder that fill the hours: the sweep again, with time in steps.

At one price the best drive may be far too short and, at the next lower price, far too long. Here
the most reward is kept for each number of steps of time, each aisle being driven as one of a few
prices has it. Times are rounded: what comes out is a proposal, not a bound.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.planning.routes.priced import Drawn

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fieldmon.planning.routes.frontier import Tables
    from fieldmon.planning.routes.ladders import Ladder
    from fieldmon.planning.routes.priced import Offered, Priced

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_NEVER = -1e300
_PRICES = (0.6, 0.8, 1.0, 1.25, 1.6)
_MOST_STEPS = 2500
_CELLS = 12_000_000
# proposals are drawn up for a little more and a little less than the hours
_SHARES = (1.02, 1.0, 0.98)


class _Offers(NamedTuple):
    """What each way of driving each aisle holds and takes at each price, ``(e, 12, p)``."""

    reward: Float
    steps: Int


def proposals(priced: Priced, price: float, seconds: float) -> Iterator[tuple[Drawn, Float]]:
    """Yield drives that take about so many seconds, with the price ``(e,)`` in each aisle."""
    ladder, tables = priced.ladder, priced.tables
    prices = price * np.array(_PRICES)
    e, s = len(ladder.across_m), len(tables.passes)
    n_steps = int(min(_MOST_STEPS, max(_CELLS // (e * s), 60)))
    step_s = seconds * max(_SHARES) / n_steps
    drawn = [priced.ways(each) for each in prices]
    reward = np.stack([each.reward for each in drawn], axis=2)
    worth = np.stack([each.worth for each in drawn], axis=2)
    possible = worth > _NEVER / 2
    taken = np.where(possible, reward - worth, 0.0) / prices
    steps = np.where(possible, np.round(taken / step_s), -1).astype(np.int64)
    up = np.zeros((3, e, 2), np.int64)
    for passes in range(3):
        place = np.concatenate([np.zeros((1, 2)), np.cumsum(ladder.up_m, axis=0)])
        place = np.round(passes * place * priced.costs.metre_s / step_s)
        up[passes, :-1] = np.diff(place, axis=0)
    best = np.empty((2, s, n_steps + 1))
    choice = np.full((e, s, n_steps + 1), -1, np.int32)
    ends = np.full(n_steps + 1, _NEVER)
    _sweep(ladder, tables, _Offers(reward, steps), up, (best, choice, ends))
    for share in _SHARES:
        last = int(np.argmax(ends[: int(n_steps * share / max(_SHARES)) + 1]))
        if ends[last] > 0.0:
            yield _traced(priced, drawn, (choice, steps, up), last, prices)


def _traced(
    priced: Priced,
    drawn: list[Offered],
    swept: tuple[NDArray[np.int32], Int, Int],
    last: int,
    prices: Float,
) -> tuple[Drawn, Float]:
    """Trace back a drive that ends with so many steps."""
    choice, steps, up = swept
    ladder, tables = priced.ladder, priced.tables
    e, n_prices = len(ladder.across_m), len(prices)
    way, of = np.zeros(e, np.int64), np.zeros(e, np.int64)
    passes = np.zeros((e, 2), np.int64)
    state, left = 1, last
    for k in range(e - 1, -1, -1):
        t, of[k] = divmod(int(choice[k, state, left]), n_prices)
        before, way[k], after = (tables.gate if k == ladder.gate else tables.aisle)[t]
        passes[k] = tables.passes[after]
        left -= int(steps[k, way[k], of[k]] + up[passes[k, 0], k, 0] + up[passes[k, 1], k, 1])
        state = int(before)
    cut = np.stack([each.cut for each in drawn], axis=2)[np.arange(e), way, of]
    reward = np.stack([each.reward for each in drawn], axis=2)[np.arange(e), way, of]
    return Drawn(0.0, float(reward.sum()), way, cut, passes), prices[of]


@loop
def _sweep(  # noqa: C901 - one loop over all
    ladder: Ladder,
    tables: Tables,
    offers: _Offers,
    up: Int,
    room: tuple[Float, NDArray[np.int32], Float],
) -> None:
    """Find the most reward for every state and number of steps."""
    best, choice, ends = room
    n, n_prices = ladder.across_m.size, offers.steps.shape[2]
    n_steps = ends.size - 1
    best[:] = _NEVER
    best[0, 0, 0] = 0.0
    for k in range(n):
        source, target = best[k % 2], best[(k + 1) % 2]
        target[:] = _NEVER
        ways = tables.gate if k == ladder.gate else tables.aisle
        for t in range(ways.shape[0]):
            before, way, after = ways[t, 0], ways[t, 1], ways[t, 2]
            if after == 1 and k < ladder.gate:
                continue
            if k + 1 == n and after != 1:
                continue
            on = up[tables.passes[after, 0], k, 0] + up[tables.passes[after, 1], k, 1]
            for p in range(n_prices):
                if offers.steps[k, way, p] < 0:
                    continue
                by, more = offers.steps[k, way, p] + on, offers.reward[k, way, p]
                if p > 0 and by == offers.steps[k, way, p - 1] + on:
                    continue
                code = np.int32(t * n_prices + p)
                for b in range(by, n_steps + 1):
                    worth = source[before, b - by] + more
                    if worth > target[after, b]:
                        target[after, b] = worth
                        choice[k, after, b] = code
    for b in range(n_steps + 1):
        ends[b] = best[n % 2, 1, b]
