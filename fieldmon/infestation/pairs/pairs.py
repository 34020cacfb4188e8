"""Chances of plants and of pairs of neighbours: the pair approximation, and what a find teaches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.compute.jit import inlined, inner_inlined, inner_loop, loop
from fieldmon.infestation.chance_bounds import (
    LEAST_CHANCE,
    MOST_CHANCE,
    bounded_chance,
    bounded_pair_chance,
    greater,
    lesser,
)
from fieldmon.infestation.pairs.clustering import (
    CLUSTERING,
    ClusterEstimate,
    learn_clustering,
)
from fieldmon.infestation.pairs.pair_nights import night_of_pairs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Learning
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.plot.grid import Csr, Linked, PlantGrid

# what is added to it is an int64
_0 = np.int64(0)
_1 = np.uint64(1)
# an inspection teaches about plants up to three away, as long as it changes a chance by this
_RINGS, _LEAST_CHANGE = 3, 1e-6
# the ring of the plants beside the one inspected
_ADJACENT_RING = 2


@dataclass(frozen=True, eq=False)
class PairApproximation:
    """A chance for every plant and for every two plants side by side.

    The pair approximation of epidemics on lattices (Keeling 1999, Proc. R. Soc. B 266:859): what
    a plant's other neighbours do is taken as independent once its own state is given.
    """

    grid: PlantGrid
    chance: NDArray[np.float64]
    pair_chance: NDArray[np.float64]
    traces: None = None
    doubt: float = 0.0
    doubt_of_rates: float = 0.0
    since_inspected: None = None
    pest: None = None

    @classmethod
    def of(
        cls, grid: PlantGrid, chance: NDArray[np.float64], clustering: float = CLUSTERING
    ) -> PairApproximation:
        """Begin with a chance map, see :func:`pair_chances`."""
        chance = np.clip(chance, LEAST_CHANCE, MOST_CHANCE)
        return cls(grid, chance, pair_chances(chance, grid, clustering))

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> PairApproximation:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        n, linked = len(self.chance), self.grid.linked
        believed = self.chance.copy(), self.pair_chance.copy()
        detects = as_compiled(learning.detects(len(plants)))
        inspections = as_compiled(plants), as_compiled(found), detects
        learn_clustering(believed, linked, inspections, ClusterEstimate.none(n), 0.0)
        _learn_pairs(believed, linked, inspections, learning.treated, Neighbourhood.of(n))
        return PairApproximation(self.grid, *believed)

    def overnight(self, spread: Spread) -> PairApproximation:
        """Return what is believed the next morning."""
        believed = self.chance, self.pair_chance
        return PairApproximation(self.grid, *night_of_pairs(believed, self.grid.linked, spread))

    def treated(self, left: NDArray[np.float64]) -> PairApproximation:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        believed = self.chance, self.pair_chance
        apart = self.pair_chance == 0.0
        return PairApproximation(self.grid, *pairs_left(believed, self.grid, left, apart))


def pairs_left(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    grid: PlantGrid,
    left: NDArray[np.float64],
    apart: NDArray[np.bool_],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return chances of plants and pairs after a treatment that leaves these shares ``(n,)``.

    `apart` ``(e,)`` are the pairs of plants found and treated before: what is found there from now
    on came since, and has nothing in common with what is beside it.
    """
    chance, pair_chance = believed
    (start, other), after = grid.adjacent, np.maximum(chance * left, LEAST_CHANCE)
    n = np.diff(start)
    both = pair_chance * np.repeat(left, n) * left[other]
    return after, np.where(apart, np.repeat(after, n) * after[other], both)


def pair_chances(
    chance: NDArray[np.float64], grid: PlantGrid, clustering: float = CLUSTERING
) -> NDArray[np.float64]:
    """Return the chance that both of two plants side by side are infested, ``(e,)``.

    In the order of ``grid.adjacent``. `clustering` is the correlation of the two: about the chance
    that a plant beside an infested one is infested too, where few are.
    """
    pair_chance = np.empty(len(grid.adjacent.plant))
    _pair_chances(as_compiled(chance), grid.adjacent, clustering, pair_chance)
    return pair_chance


def pairs_of(
    believed: tuple[NDArray[np.float64], NDArray[np.float64] | None], grid: PlantGrid
) -> NDArray[np.float64]:
    """Return what is believed of pairs ``(e,)``; as records have it, where nothing is.

    `believed` is ``chance (n,)`` and ``pair_chance (e,)`` or None.
    """
    chance, pair_chance = believed
    return pair_chances(chance, grid) if pair_chance is None else pair_chance


@loop
def _pair_chances(
    chance: NDArray[np.float64], adjacent: Csr, clustering: float, pair_chance: NDArray[np.float64]
) -> None:
    for i in range(chance.size):
        for e in range(adjacent.start[i], adjacent.start[i + 1]):
            p, q = chance[i], chance[adjacent.plant[e]]
            both = p * q + clustering * np.sqrt(p * (1.0 - p) * q * (1.0 - q))
            pair_chance[e] = min(both, p, q)


class Neighbourhood(NamedTuple):
    """Room for the plants about which an inspection teaches, nearest first.

    `plant` ``(n,)`` lists them; `ring` ``(n,)`` is how many steps each plant is away, from 1, and
    0 where nothing has reached it; `after` ``(n,)`` is what is believed of it then.

    `alone` ``(n,)`` is each plant's chance by its own inspections of the day, without what others
    told of it. With it a find is one way more in which the plants beside it may be infested;
    empty, several finds are independent signs of the plant between them.
    """

    plant: NDArray[np.int64]
    ring: NDArray[np.int64]
    after: NDArray[np.float64]
    alone: NDArray[np.float64]

    @classmethod
    def of(cls, n: int, morning: NDArray[np.float64] | None = None) -> Neighbourhood:
        """Return room for `n` plants; with the chances of a `morning` a find is one way more."""
        alone = np.empty(0) if morning is None else morning.copy()
        return cls(np.empty(n, np.int64), np.zeros(n, np.int64), np.empty(n), alone)


@inner_loop
def update_neighbourhood(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    result: tuple[int, bool],
    rule: tuple[float, bool],
    reached: Neighbourhood,
) -> int:
    """Let one inspection teach about a plant and those near it; return how many it reached.

    `believed` is ``chance (n,)`` and ``pair_chance (e,)``, changed in place; `rule` the detection
    and whether finds are treated. Exact where the plants' neighbourhood is a tree; round the loops
    of a lattice the messages that arrive by several ways are combined as if independent. What it
    says about plants farther than three away is left out.
    """
    chance, pair_chance = believed
    i, found = result
    detection, treated = rule
    p = chance[i]
    after = MOST_CHANCE if found else p * (1.0 - detection) / (1.0 - p * detection)
    reached.plant[0], reached.ring[i], reached.after[i] = i, 1, bounded_chance(after)
    if not found and reached.alone.size > 0:
        own = reached.alone[i]
        reached.alone[i] = bounded_chance(own * (1.0 - detection) / (1.0 - own * detection))
    # unsigned, here and below: an index that may be negative is checked for it
    n, first = np.uint64(1), np.uint64(0)
    for ring in range(2, _RINGS + 2):
        end = n
        for t in range(first, end):
            n = _propagate(believed, linked, (np.uint64(reached.plant[t]), ring), reached, n)
        first = end
    for t in range(n):
        _update_pairs(believed, linked, np.uint64(reached.plant[t]), reached)
    for t in range(n):
        j = np.uint64(reached.plant[t])
        chance[j], reached.ring[j] = reached.after[j], 0
    if found and treated:
        chance[i] = LEAST_CHANCE
        for e in range(linked.start[i], linked.start[i + 1]):
            pair_chance[e] = pair_chance[linked.back[e]] = 0.0
    return int(n)


# the next two are copied into `update_neighbourhood`: calling them costs a quarter of what they do
@inlined
def _propagate(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    source: tuple[np.uint64, int],
    reached: Neighbourhood,
    n: np.uint64,
) -> np.uint64:
    """Pass on what a plant has learnt to its neighbours in the next ring."""
    chance, pair_chance = believed
    j, ring = source
    p, after = chance[j], reached.after[j]
    if abs(after - p) < _LEAST_CHANGE:
        return n
    for e in range(np.uint32(linked.start[j]), np.uint32(linked.start[j + _1])):
        k = np.uint32(linked.plant[e])
        q, its_ring = chance[k], reached.ring[k]
        own = q if its_ring == 0 else reached.after[k]
        if its_ring == 0:
            reached.plant[n], reached.ring[k] = k, ring
            n += _1
        elif its_ring != ring:
            continue
        conditional = _conditional(p, q, pair_chance[e], after)
        if ring == _ADJACENT_RING and after > p and reached.alone.size > 0:
            by_itself = pair_chance[e] / q * reached.alone[k] / reached.alone[j]
            # never less than was believed already, never more than the find's own news
            ways = greater(1.0 - (1.0 - q) * (1.0 - lesser(by_itself, 1.0)), q)
            conditional = lesser(conditional, ways)
        if conditional < q:
            own *= conditional / q
        else:
            own = 1.0 - (1.0 - own) * (1.0 - conditional) / (1.0 - q)
        reached.after[k] = bounded_chance(own)
    return n


@inlined
def _update_pairs(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    j: np.uint64,
    reached: Neighbourhood,
) -> None:
    """Bring the pairs of a plant and those farther out to their new chances.

    What an infested plant says about its neighbour changes by as much as the neighbour has learnt
    from others.
    """
    chance, pair_chance = believed
    p, after, ring = chance[j], reached.after[j], reached.ring[j]
    for e in range(np.uint32(linked.start[j]), np.uint32(linked.start[j + _1])):
        k = np.uint32(linked.plant[e])
        its_ring = reached.ring[k]
        if its_ring != 0 and (its_ring < ring or (its_ring == ring and k < j)):
            continue
        q = chance[k]
        own = q if its_ring == 0 else reached.after[k]
        conditional = _conditional(p, q, pair_chance[e], after)
        from_others = own / (1.0 - own) * (1.0 - conditional) / conditional
        if_infested = lesser(pair_chance[e] / p, 1.0)
        odds = if_infested * from_others
        if_infested = odds / (odds + 1.0 - if_infested + LEAST_CHANCE)
        both = bounded_pair_chance(if_infested * after, own, after)
        pair_chance[e] = pair_chance[np.uint32(linked.back[e])] = both


@inner_inlined
def _conditional(p: float, q: float, pair_chance: float, after: float) -> float:
    """Return the chance of a plant, q until now, when its neighbour's goes from p to `after`."""
    both = bounded_pair_chance(pair_chance, p, q)
    return bounded_chance(both / p * after + (q - both) / (1.0 - p) * (1.0 - after))


@loop
def _learn_pairs(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    linked: Linked,
    inspections: tuple[NDArray[np.int32], NDArray[np.bool_], NDArray[np.float64]],
    treated: bool,  # noqa: FBT001 - a rule, in a compiled loop
    reached: Neighbourhood,
) -> None:
    plants, found, detects = inspections
    for k in range(plants.size):
        result, rule = (_0 + plants[k], found[k]), (detects[k], treated)
        update_neighbourhood(believed, linked, result, rule, reached)
