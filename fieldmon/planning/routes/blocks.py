"""Several ladders instead of one, where parts of a plot lie far apart.

A single ladder puts all aisles in one order up the plot. Where parts lie beside each other, that
makes long ways short. Here each block of aisles has a ladder of its own, with half the way to what
is nearest outside as the way to its gate; between blocks, what is left of the true way is charged.
How that bounds every route is in ``docs/route_bound.md``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from fieldmon.planning.routes.aisle_ways import Costs
from fieldmon.planning.routes.binned import proposals
from fieldmon.planning.routes.priced import REACH, AtPrices, Priced, least_by_kind
from fieldmon.planning.routes.stops import stops_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fieldmon.planning.routes.ladders import Ladders, Rungs
    from fieldmon.planning.routes.priced import Drawn
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# parts that are nearer than this are better seen as one
_NEAR_M = 15.0
# all ways of choosing among more blocks than this would take long
_MOST_BLOCKS = 9
# drives through so many blocks at most are told apart by more than their set
_FEW_BLOCKS = 3
# drives that fill the hours: through so many of the best sets, with so many prices tried
_SETS, _HALVINGS = 3, 12
_HALF = 0.5 * (1.0 - 1e-9)


class Visited(NamedTuple):
    """A drive through some blocks: its worth and reward, and the drives of those, in order."""

    worth: float
    reward: float
    drives: tuple[tuple[int, bool, Drawn], ...]


class Tours(NamedTuple):
    """Shortest ways from the gate through each set of the m blocks, bit k standing for block k.

    ``closed_m`` ``(2^m,)`` back to the gate; ``open_m`` ``(2^m, m)`` ending in a block; ``before``
    ``(2^m, m)`` the block before the last one.
    """

    closed_m: Float
    open_m: Float
    before: Int


class Blocks(AtPrices):
    """Best drives through blocks of a plot at any price, as `Priced` gives them on one ladder."""

    def __init__(self, ladders: Ladders, block: Int, reward: Float, robot: Robot) -> None:
        rungs = ladders.rungs
        self.of_all, self.robot, self.costs = reward, robot, Costs.of(robot)
        n, nearest = int(block.max()) + 1, _way_out(rungs, block)
        members = [np.flatnonzero(block == k) for k in range(n)]
        self.tours = _tours(_apart_m(rungs, block, nearest))
        own = [ladders.among(m, _gate(rungs, m, nearest), hanging=True) for m in members]
        self.closed = [Priced(ladder, reward, replace(robot, returns=True)) for ladder in own]
        self.open = [Priced(ladder, reward, replace(robot, returns=False)) for ladder in own]
        bits = np.arange(1 << n)[:, None] >> np.arange(n)
        self._in = (bits & 1).astype(np.float64)
        self._held = np.array([float(each.reward.sum()) for each in self.closed])
        self._least: Float | None = None

    @property
    def how(self) -> str:
        """Say what it is."""
        return f"price of time on {len(self.closed)} ladders, one for each part of the plot"

    def best(self, price: float) -> Visited:
        """Return the best drive at a price of reward a second."""
        closed, opened = self._each(price)
        worths = self._worths(price, closed, opened)
        chosen, last = (int(k) for k in np.unravel_index(np.argmax(worths), worths.shape))
        return self._visited(chosen, last, float(worths[chosen, last]), (closed, opened))

    def filling(self, price: float, seconds: float) -> Iterator[Int]:
        """Yield stops that fill about so many seconds, through the best sets of blocks at a price.

        At one price the best set may leave most of the time unused and, at the next lower price,
        another set, or the same one, take far too long. So each set has a price of its own here,
        and the block in which most time is won or lost is driven for the time that is left.
        """
        worths = self._least
        if worths is None:
            worths = self._worths(price, *self._each(price))
        for at in np.argsort(worths.max(axis=1))[: -_SETS - 1 : -1].tolist():
            last = int(np.argmax(worths[at]))
            low, high = price / REACH, price * REACH
            for _ in range(_HALVINGS):
                middle = float(np.sqrt(low * high))
                if self.seconds(self._through(at, last, middle), middle) > seconds:
                    low = middle
                else:
                    high = middle
            short, long = self._through(at, last, high), self._through(at, last, low)
            if short.drives:
                yield from self._between(short, long, (low, high), seconds)

    def bound_by_kind(self, seconds: float, price: float, until_s: float) -> float:
        """Return what no drive in so many seconds can reach: the most of all kinds of drives.

        A kind is a set of blocks and, of few, what is driven in the one with most reward.
        """
        least = least_by_kind(self._kinds, seconds + self.costs.change_s, price, until_s)
        self._least = least.max(axis=2)
        return max(float(least.max()), 0.0)

    def _kinds(self, price: float) -> tuple[Float, Float]:
        """Return worth and reward of the best drive of each kind at a price, ``(2^m, l, k)``."""
        closed, opened = self._each(price)
        worth = self._worths(price, closed, opened)[:, :, None]
        reward = self._rewards(closed, opened)[:, :, None]
        if len(self.closed) > _FEW_BLOCKS:
            return worth, reward
        own = [each.kinds(price) for each in self.closed]
        ends = [each.kinds(price) for each in self.open] if opened else []
        n_kinds = max(one[0].size for one in own)
        worth, reward = (np.repeat(values, n_kinds, axis=2) for values in (worth, reward))
        for chosen in range(1, len(worth)):
            rich = int(np.argmax(self._held * self._in[chosen]))
            for last in range(worth.shape[1]):
                at_end = bool(opened) and last == rich
                best = (opened if at_end else closed)[rich]
                kinds = [each.ravel() for each in (ends if at_end else own)[rich]]
                size = len(kinds[0])
                worth[chosen, last, :size] += kinds[0] - best.worth
                worth[chosen, last, size:] = -np.inf
                reward[chosen, last, :size] += kinds[1] - best.reward
        return worth, reward

    def _rewards(self, closed: list[Drawn], opened: list[Drawn]) -> Float:
        """Return what each set of blocks holds, ``(2^m, l)``, by the block it ends in."""
        held = self._in @ np.array([drawn.reward for drawn in closed])
        if self.robot.returns:
            whole: Float = held[:, None]
            return whole
        more = np.array([one.reward - two.reward for one, two in zip(opened, closed, strict=True)])
        rewards: Float = held[:, None] + more
        rewards[0] = 0.0
        return rewards

    def _between(
        self, short: Visited, long: Visited, prices: tuple[float, float], seconds: float
    ) -> Iterator[Int]:
        """Yield stops that take longer than a short drive and less than a long one."""
        low, high = prices
        yield self.stops(short, high)
        took_s = [
            ((a[2].reward - a[2].worth) / high, (b[2].reward - b[2].worth) / low)
            for a, b in zip(short.drives, long.drives, strict=True)
        ]
        k = int(np.argmax([after - before for before, after in took_s]))
        block, ends, _ = short.drives[k]
        left_s = seconds - self.seconds(short, high) + took_s[k][0]
        priced = (self.open if ends else self.closed)[block]
        if left_s > 0.0 and took_s[k][1] > 0.0:
            for drawn, price in proposals(priced, low, left_s):
                found = [self._stops_in(*drive, high) for drive in short.drives]
                found[k] = self._stops_in(block, ends, drawn, price)
                yield np.concatenate(found)

    def _each(self, price: float) -> tuple[list[Drawn], list[Drawn]]:
        """Return the best drive in each block at a price, closed and, on one-way days, open."""
        opened = [] if self.robot.returns else [each.best(price) for each in self.open]
        return [each.best(price) for each in self.closed], opened

    def _worths(self, price: float, closed: list[Drawn], opened: list[Drawn]) -> Float:
        """Return what each set of blocks is worth, ``(2^m, l)``, by the block it ends in."""
        metre = price * self.costs.metre_s
        worth = self._in @ np.array([drawn.worth for drawn in closed])
        if self.robot.returns:
            whole: Float = (worth - metre * self.tours.closed_m)[:, None]
            return whole
        more = np.array([one.worth - two.worth for one, two in zip(opened, closed, strict=True)])
        worths: Float = worth[:, None] + more - metre * self.tours.open_m
        # a day on which nothing is driven
        worths[0] = 0.0
        return worths

    def _through(self, chosen: int, last: int, price: float) -> Visited:
        """Return the best drive through a set of blocks at a price."""
        closed, opened = self._each(price)
        worth = float(self._worths(price, closed, opened)[chosen, last])
        return self._visited(chosen, last, worth, (closed, opened))

    def _visited(
        self, chosen: int, last: int, worth: float, drawn: tuple[list[Drawn], list[Drawn]]
    ) -> Visited:
        closed, opened = drawn
        order = _order(self.tours, chosen, -1 if self.robot.returns else last)
        drives = tuple(
            (k, True, opened[k]) if opened and k == last else (k, False, closed[k]) for k in order
        )
        return Visited(worth, sum(drive.reward for _, _, drive in drives), drives)

    def stops(self, drawn: Visited, price: float) -> Int:
        """Return the plants of a drive in the order of one way to drive it."""
        found = [self._stops_in(*drive, price) for drive in drawn.drives]
        return np.concatenate([np.empty(0, np.int64), *found])

    def _stops_in(self, block: int, ends: bool, drive: Drawn, price: float | Float) -> Int:  # noqa: FBT001 - as in `Visited`
        priced = (self.open if ends else self.closed)[block]
        prices = np.broadcast_to(np.asarray(price, np.float64), drive.way.shape)
        return stops_of(priced, drive, prices, replace(self.robot, returns=not ends))


def blockings(rungs: Rungs) -> Iterator[Int]:
    """Yield ways of taking aisles ``(k,)`` together that lie near each other, finest first."""
    apart_m = rungs.apart_m[:, :, :-1, :-1].min(axis=(0, 1))
    np.fill_diagonal(apart_m, 0.0)
    if len(apart_m) < 2:
        return
    tree = linkage(squareform(np.minimum(apart_m, apart_m.T), checks=False), "single")
    far = np.unique(tree[tree[:, 2] > _NEAR_M, 2])
    seen = set()
    for cut_m in far:
        block = fcluster(tree, cut_m * (1.0 - 1e-9), "distance") - 1
        n = int(block.max()) + 1
        if 1 < n <= _MOST_BLOCKS and n not in seen:
            seen.add(n)
            yield block


def _way_out(rungs: Rungs, block: Int) -> Float:
    """Return for each end ``(2, k)`` half the way to what is nearest outside its block.

    The gate is never met half-way: the whole way is granted where that is less.
    """
    outside = block[:, None] != block
    ways = np.where(outside, rungs.apart_m[:, :, :-1, :-1], np.inf).min(axis=(1, 3))
    to_gate = rungs.apart_m[:, 0, :-1, -1]
    nearest: Float = np.minimum(_HALF * ways, (1.0 - 1e-9) * to_gate)
    return nearest


def _gate(rungs: Rungs, own: Int, nearest: Float) -> tuple[Float, float]:
    """Return the metres from a block's ends to its gate, and where up the plot that is."""
    nearest = nearest[:, own]
    return nearest, float(rungs.up[own[int(np.argmin(nearest.min(axis=0)))]])


def _apart_m(rungs: Rungs, block: Int, nearest: Float) -> Float:
    """Return the metres ``(m + 1, m + 1)`` left of the ways between blocks; the last is the gate.

    They are made to be no longer than any way round by other blocks.
    """
    n = int(block.max()) + 1
    left = rungs.apart_m[:, :, :-1, :-1] - nearest[:, None, :, None] - nearest[None, :, None, :]
    left = left.min(axis=(0, 1))
    to_gate = (rungs.apart_m[:, 0, :-1, -1] - nearest).min(axis=0)
    metres = np.zeros((n + 1, n + 1))
    for a in range(n):
        metres[a, n] = metres[n, a] = to_gate[block == a].min()
        for b in range(n):
            if a != b:
                metres[a, b] = left[np.ix_(block == a, block == b)].min()
    metres = np.maximum(np.minimum(metres, metres.T), 0.0)
    for k in range(n + 1):
        metres = np.minimum(metres, metres[:, [k]] + metres[[k]])
    return metres


def _tours(metres: Float) -> Tours:
    """Return the shortest ways through every set of blocks (Held and Karp)."""
    n = len(metres) - 1
    open_m, before = np.full((1 << n, n), np.inf), np.full((1 << n, n), -1)
    for chosen in range(1, 1 << n):
        for last in range(n):
            rest = chosen & ~(1 << last)
            if rest == chosen:
                continue
            if rest == 0:
                open_m[chosen, last] = metres[n, last]
                continue
            ways = open_m[rest] + metres[:n, last]
            before[chosen, last] = int(np.argmin(ways))
            open_m[chosen, last] = ways[before[chosen, last]]
    closed_m = (open_m + metres[:n, n]).min(axis=1)
    closed_m[0] = 0.0
    return Tours(closed_m, open_m, before)


def _order(tours: Tours, chosen: int, last: int) -> list[int]:
    """Return the blocks of a set in the order of a shortest way."""
    order: list[int] = []
    if chosen and last < 0:
        last = int(np.argmin(tours.open_m[chosen]))
    while chosen:
        order.append(last)
        chosen, last = chosen & ~(1 << last), int(tours.before[chosen, last])
    return order[::-1]
