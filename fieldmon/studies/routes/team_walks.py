"""Walks of several from one corner: each the best in what the others leave, and a bound."""

from __future__ import annotations

from itertools import combinations
from time import process_time
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.planning.routes.exact_walk import best_walk

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# each walk is looked for again so often; so often one of two that meet looks elsewhere
_ROUNDS, _TRIES = 5, 12
# two walks are shaken so often, until so often in vain; what is left counts so much more or less,
# and at first so much less than before is taken for what may come of it
_SHAKES, _SHAKES_IN_VAIN, _MORE_OR_LESS, _WORSE = 200, 80, (0.1, 0.3, 0.6), 0.02
# prices of plants: so many, for so many seconds of the processor; a step that gained nothing so
# often is made shorter, and directions are remembered so far
_PRICES, _WITHIN_S, _PATIENCE, _MEMORY = 300, 20.0, 8, 0.7


class TeamWalks(NamedTuple):
    """Places ``(k, 2)`` of each walk, what they hold together, and what none can exceed."""

    places: list[Int]
    reward: float
    bound: float


def team_walks(
    reward: Float, budget: int, n_walks: int, tell: Callable[[float], object] | None = None
) -> TeamWalks:
    """Return walks that hold much together, nobody meeting another in a row, and a bound.

    `tell` hears again and again which share of the work is done at least, 0 to 1.
    """
    tell = tell or (lambda _: None)
    search = _TeamWalkSearch(reward, budget, n_walks)
    most = _all_steps(reward, budget, n_walks)
    search.improve()
    search.shake(most, lambda share: tell(share / 2))
    search.keep_apart()
    held = search.held
    most = min(most, _by_prices(reward, budget, n_walks, held, lambda done: tell((1 + done) / 2)))
    return TeamWalks(search.places, held, max(most, held))


def meetings(places: Sequence[Int], n_plants: int) -> list[tuple[int, int, int]]:
    """Return who are in one row at one step: two walks and the row, each once.

    All begin at once and make a step at a time. Who passes from place to place within a row is in
    it, too.
    """
    rows = []
    for walk in places:
        inside = (walk[:, 1] > 0) & (walk[:, 1] <= n_plants)
        rows.append(np.where(inside, walk[:, 0], -1))
    found = []
    for a, b in combinations(range(len(rows)), 2):
        both = min(len(rows[a]), len(rows[b]))
        same = (rows[a][:both] == rows[b][:both]) & (rows[a][:both] >= 0)
        found += [(a, b, int(row)) for row in np.unique(rows[a][:both][same])]
    return found


class _TeamWalkSearch:
    """Walks on their way to be good ones."""

    def __init__(self, reward: Float, budget: int, n_walks: int) -> None:
        self.reward, self.budget = reward, budget
        self.places = [np.zeros((1, 2), np.int64) for _ in range(n_walks)]
        self.banned = [np.zeros(len(reward), np.bool_) for _ in range(n_walks)]

    @property
    def held(self) -> float:
        """Return what the walks hold together."""
        return float(self.reward[self.taken()].sum())

    def taken(self, *leaving_out: int) -> NDArray[np.bool_]:
        """Return which plants the walks pass, but for some of them."""
        taken = np.zeros(self.reward.shape, np.bool_)
        for k, walk in enumerate(self.places):
            if k not in leaving_out:
                taken |= _passed(walk, self.reward.shape)
        return taken

    def look(self, k: int) -> None:
        """Take the best walk in what the others leave."""
        rest = np.where(self.taken(k) | self.banned[k][:, None], 0.0, self.reward)
        self.places[k] = best_walk(rest, self.budget).place

    def improve(self) -> None:
        """Look for one walk after the other, as long as they hold more together."""
        held = -1.0
        for _ in range(_ROUNDS):
            for k in range(len(self.places)):
                self.look(k)
            if self.held <= held:
                break
            held = self.held

    def shake(self, most: float, tell: Callable[[float], object]) -> None:
        """Give two walks other ways at random, and let them look again; keep the best.

        It ends early where the walks hold the `most` that any can. `tell` hears which share of the
        shakes is done.
        """
        rng = np.random.default_rng(0)
        best, held, in_vain = [*self.places], self.held, 0
        now = held
        for k, worse in enumerate(np.maximum(_WORSE * np.linspace(1.0, -1.0, _SHAKES), 0.0)):
            tell(k / _SHAKES)
            if len(self.places) < 2 or held >= most or in_vain >= _SHAKES_IN_VAIN:
                break
            if worse == 0.0 and now < held:
                # from now on nothing is given up any more
                self.places, now = [*best], held
            before = [*self.places]
            self._shake_two(rng)
            after = self.held
            if after < now * (1.0 - worse):
                self.places = before
            else:
                now = after
            in_vain = in_vain + 1 if worse == 0.0 and after <= held else 0
            if after > held:
                best, held = [*self.places], after
        self.places = best

    def _shake_two(self, rng: np.random.Generator) -> None:
        two = rng.permutation(len(self.places))[:2].tolist()
        spread = rng.choice(_MORE_OR_LESS)
        left = np.where(self.taken(*two), 0.0, self.reward)
        for k in two:
            # the other's plants count for anything between nothing and all
            own = np.where(self.taken(k), rng.random(left.shape), 1.0)
            own = left * own * rng.uniform(1.0 - spread, 1.0 + spread, left.shape)
            self.places[k] = best_walk(own, self.budget).place
        for k in two * 2:
            self.look(k)

    def keep_apart(self) -> None:
        """Turn walks round, or let the poorer of two look elsewhere, until nobody meets."""
        for _ in range(_TRIES * len(self.places)):
            self._turn_round()
            met = meetings(self.places, self.reward.shape[1])
            if not met:
                return
            a, b, row = met[0]
            k = min((a, b), key=lambda each: self._held_in(each, row))
            self.banned[k][row] = True
            self.look(k)
        while met := meetings(self.places, self.reward.shape[1]):
            # the later of two that still meet stays at home
            self.places[met[0][1]] = np.zeros((1, 2), np.int64)

    def _turn_round(self) -> None:
        """Walk each the way round on which it meets fewer of those before it."""
        for k in range(1, len(self.places)):
            ways = [self.places[k], self.places[k][::-1]]
            before = self.places[:k]
            met = [len(meetings([*before, way], self.reward.shape[1])) for way in ways]
            self.places[k] = np.ascontiguousarray(ways[int(np.argmin(met))])

    def _held_in(self, k: int, row: int) -> float:
        return float(self.reward[row][_passed(self.places[k], self.reward.shape)[row]].sum())


def _passed(walk: Int, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Return which plants a walk passes, ``(m, n)``."""
    passed = np.zeros(shape, np.bool_)
    row, column = walk[(walk[:, 1] > 0) & (walk[:, 1] <= shape[1])].T
    passed[row, column - 1] = True
    return passed


def _all_steps(reward: Float, budget: int, n_walks: int) -> float:
    """Return what one walk with the steps of all can hold: it makes their walks one by one."""
    m, n = reward.shape
    # with so many everything is passed
    together = min(n_walks * budget, (m + 1) * (n + 1) + 2 * m)
    return float(best_walk(reward, together).reward)


def _by_prices(
    reward: Float, budget: int, n_walks: int, held: float, tell: Callable[[float], object]
) -> float:
    """Return a bound by prices of plants, as of a team's day: see `fieldmon.planning.team`.

    `tell` hears which share of the prices, or of the time for them, is gone.
    """
    began = process_time()
    price = direction = np.zeros(reward.shape)
    least, kept, step, in_vain = np.inf, price, 1.0, 0
    for k in range(_PRICES):
        gone_s = process_time() - began
        tell(max(k / _PRICES, min(gone_s / _WITHIN_S, 1.0)))
        walk = best_walk(np.maximum(reward - price, 0.0), budget)
        value = float(price.sum()) + n_walks * walk.reward
        if value < least:
            least, kept, in_vain = value, price, 0
        else:
            in_vain += 1
        if in_vain >= _PATIENCE:
            price, step, in_vain = kept, 0.6 * step, 0
        visits = _passed(walk.place, reward.shape) & (reward > price)
        direction = 1.0 - n_walks * visits + _MEMORY * direction
        direction = np.where((price <= 0.0) & (direction > 0.0), 0.0, direction)
        norm = float((direction**2).sum())
        if norm == 0.0 or value <= held * (1.0 + 1e-6) or gone_s > _WITHIN_S:
            break
        price = np.clip(price - step * (value - held) / norm * direction, 0.0, reward)
    return least
