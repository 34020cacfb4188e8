"""Plants taken as independent of each other: Bayes' rule by day, neighbours by night."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.compute.jit import loop
from fieldmon.infestation.chance_bounds import LEAST_CHANCE, MOST_CHANCE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Learning
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.plot.grid import Csr, PlantGrid

# of the type of the indices they are added to
_1, _2, _3 = np.uint32(1), np.uint32(2), np.uint32(3)


@dataclass(frozen=True, eq=False)
class IndependentPlants:
    """Plants taken as independent of each other: see :func:`learn` and :func:`overnight`."""

    grid: PlantGrid
    chance: NDArray[np.float64]
    pair_chance: None = None
    traces: None = None
    doubt: float = 0.0
    doubt_of_rates: float = 0.0
    since_inspected: None = None
    pest: None = None

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> IndependentPlants:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        return IndependentPlants(self.grid, learn(self.chance, self.grid, plants, found, learning))

    def overnight(self, spread: Spread) -> IndependentPlants:
        """Return what is believed the next morning."""
        return IndependentPlants(self.grid, overnight(self.chance, self.grid, spread))

    def treated(self, left: NDArray[np.float64]) -> IndependentPlants:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        return IndependentPlants(self.grid, np.maximum(self.chance * left, LEAST_CHANCE))


def learn(
    chance: NDArray[np.float64],
    grid: PlantGrid,
    plants: NDArray[np.int32],
    found: NDArray[np.bool_],
    learning: Learning,
) -> NDArray[np.float64]:
    """Return the chance map ``(n,)`` after inspecting `plants` ``(k,)`` with results `found`.

    An inspection that finds nothing lowers a plant's chance by Bayes' rule,
    p' = p (1 - d) / (1 - p d) with detection d; a find settles the plant and raises its neighbours
    to at least `beside_find`.
    """
    after = chance.copy()
    rule = (learning.detects(len(plants)), learning.beside_find, learning.treated)
    inspected = np.zeros(after.size, np.bool_)
    inspections = as_compiled(plants), as_compiled(found)
    _learn((after, inspected), grid.adjacent, *inspections, rule)
    return after


@loop
def _learn(
    plot: tuple[NDArray[np.float64], NDArray[np.bool_]],
    adjacent: Csr,
    plants: NDArray[np.int32],
    found: NDArray[np.bool_],
    rule: tuple[NDArray[np.float64], float, bool],
) -> None:
    after, inspected = plot
    detects, beside_find, treated = rule
    for k in range(plants.size):
        i = plants[k]
        inspected[i] = True
        if found[k]:
            after[i] = LEAST_CHANCE if treated else MOST_CHANCE
        else:
            p, d = after[i], detects[k]
            after[i] = min(max(p * (1.0 - d) / (1.0 - p * d), LEAST_CHANCE), MOST_CHANCE)
    for k in range(plants.size):
        if not found[k]:
            continue
        for e in range(adjacent.start[plants[k]], adjacent.start[plants[k] + 1]):
            j = adjacent.plant[e]
            if not inspected[j]:
                after[j] = min(max(after[j], beside_find), MOST_CHANCE)


def overnight(chance: NDArray[np.float64], grid: PlantGrid, spread: Spread) -> NDArray[np.float64]:
    """Return the chance map ``(n,)`` of the next morning, neighbours taken as independent."""
    rate = spread.rate_per_day
    after, escape = np.empty_like(chance), np.empty_like(chance)
    _escape_from_each(chance, escape, grid.adjacent.start, (rate, spread.to == "one"))
    _overnight(chance, after, grid.adjacent, escape, spread.arrivals_per_day)
    return after


@loop
def _escape_from_each(
    chance: NDArray[np.float64],
    escape: NDArray[np.float64],
    start: NDArray[np.int32],
    rule: tuple[float, bool],
) -> None:
    """Find the chance that a given neighbour of each plant escapes infestation by it in a night."""
    rate, to_one = rule
    for i in range(chance.size):
        transmits = rate / (start[i + 1] - start[i]) if to_one else rate
        escape[i] = 1.0 - chance[i] * transmits


@loop
def _overnight(
    chance: NDArray[np.float64],
    after: NDArray[np.float64],
    adjacent: Csr,
    escape: NDArray[np.float64],
    arrivals: float,
) -> None:
    start, plant = adjacent
    for i in range(chance.size):
        # unsigned: an index that may be negative is checked for it
        k, end = np.uint32(start[i]), np.uint32(start[i + 1])
        clean = (1.0 - chance[i]) * (1.0 - arrivals)
        if end - k == 4:  # most plants; a loop of unknown length costs twice this
            clean *= escape[np.uint32(plant[k])]
            clean *= escape[np.uint32(plant[k + _1])]
            clean *= escape[np.uint32(plant[k + _2])]
            clean *= escape[np.uint32(plant[k + _3])]
        else:
            for e in range(k, end):
                clean *= escape[np.uint32(plant[e])]
        infested = 1.0 - clean
        infested = infested if infested < MOST_CHANCE else MOST_CHANCE  # noqa: FURB136 - min is slower
        after[i] = infested if infested > LEAST_CHANCE else LEAST_CHANCE  # noqa: FURB136 - max is slower
