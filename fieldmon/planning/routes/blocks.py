"""Several ladders instead of one, where parts of a plot lie far apart.

A single ladder puts all aisles in one order up the plot. Where parts lie beside each other, that
makes long ways short. Here each block of aisles has a ladder of its own, with half the way to what
is nearest outside as the way to its gate; between blocks, what is left of the true way is charged.
How that bounds every route is in ``docs/best_routes.md``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from fieldmon.planning.routes.priced import Costs, Priced
from fieldmon.planning.routes.relaxation import ladder_among
from fieldmon.planning.routes.stops import stops_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fieldmon.planning.routes.priced import Drawn
    from fieldmon.planning.routes.relaxation import Rungs
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# parts that are nearer than this are better seen as one
_NEAR_M = 15.0
# all ways of choosing among more blocks than this would take long
_MOST_BLOCKS = 9
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


class Blocks:
    """Best drives through blocks of a plot at any price, as `Priced` gives them on one ladder."""

    def __init__(
        self, aisles: Aisles, rungs: Rungs, block: Int, reward: Float, robot: Robot
    ) -> None:
        self.reward, self.robot, self.costs = reward, robot, Costs.of(robot)
        n, nearest = int(block.max()) + 1, _way_out(rungs, block)
        members = [np.flatnonzero(block == k) for k in range(n)]
        self.tours = _tours(_between(rungs, block, nearest))
        ladders = [ladder_among(aisles, rungs, own, _gate(rungs, own, nearest)) for own in members]
        self.cross_links = sum(ladder.cross_links for ladder in ladders)
        self.closed = [Priced(ladder, reward, _returning(robot, back=True)) for ladder in ladders]
        self.open = [Priced(ladder, reward, _returning(robot, back=False)) for ladder in ladders]
        bits = np.arange(1 << n)[:, None] >> np.arange(n)
        self._in = (bits & 1).astype(np.float64)

    def best(self, price: float) -> Visited:
        """Return the best drive at a price of reward a second."""
        metre = price * self.costs.metre_s
        closed = [each.best(price) for each in self.closed]
        worth = self._in @ np.array([drawn.worth for drawn in closed])
        if self.robot.returns:
            chosen = int(np.argmax(worth - metre * self.tours.closed_m))
            total = float(worth[chosen] - metre * self.tours.closed_m[chosen])
            return self._visited(chosen, -1, total, closed)
        opened = [each.best(price) for each in self.open]
        more = np.array([one.worth - two.worth for one, two in zip(opened, closed, strict=True)])
        worths = worth[:, None] + more - metre * self.tours.open_m
        chosen, last = (int(k) for k in np.unravel_index(np.argmax(worths), worths.shape))
        if worths[chosen, last] <= 0.0:
            return Visited(0.0, 0.0, ())
        drawn = [*closed]
        drawn[last] = opened[last]
        return self._visited(chosen, last, float(worths[chosen, last]), drawn)

    def _visited(self, chosen: int, last: int, worth: float, drawn: list[Drawn]) -> Visited:
        order = _order(self.tours, chosen, last)
        drives = tuple((k, k == last, drawn[k]) for k in order)
        return Visited(worth, sum(drawn[k].reward for k in order), drives)

    def bound(self, drawn: Visited, price: float, seconds: float) -> float:
        """Return what no drive in so many seconds can reach, by the best drive at a price."""
        return max(drawn.worth + price * (seconds + self.costs.change_s), 0.0)

    def seconds(self, drawn: Visited, price: float) -> float:
        """Return the seconds that a drive takes at least."""
        return (drawn.reward - drawn.worth) / price - self.costs.change_s

    def stops(self, drawn: Visited, price: float) -> Int:
        """Return the plants of a drive in the order of one way to drive it."""
        found = [np.empty(0, np.int64)]
        for k, ends, drive in drawn.drives:
            priced = self.open[k] if ends else self.closed[k]
            robot = _returning(self.robot, back=not ends)
            found.append(stops_of(priced, drive, np.full(len(drive.way), price), robot))
        return np.concatenate(found)


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


def _returning(robot: Robot, *, back: bool) -> Robot:
    from dataclasses import replace  # noqa: PLC0415

    return replace(robot, returns=back)


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


def _between(rungs: Rungs, block: Int, nearest: Float) -> Float:
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
