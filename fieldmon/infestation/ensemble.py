"""Many simulated fields as a belief: slower than pairs, free of their shortcuts; to compare with.

Inspections change the fields where they are: a field that says otherwise takes the plants about
them from a field that says the same (a particle filter, resampled locally). Far away it stays as
it is, so that a thousand inspections a day do not leave one field only.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import routine
from fieldmon.compute.random_streams import RandomStreams, coin
from fieldmon.infestation.insects.spread import night
from fieldmon.infestation.pairs.clustering import CLUSTERING
from fieldmon.infestation.pairs.pairs import pair_chances
from fieldmon.infestation.plot_estimate import PlotEstimate, draw_fields

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Learning
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.plot.grid import Csr, PlantGrid

_FIELDS = 300
# plants up to three steps from one inspected come along from the other field
_RINGS = 3
_ROOM = 64
_MOST = 1.0 - 1e-6


@dataclass(frozen=True, eq=False)
class Ensemble:
    """A belief made of fields ``(m, n)``, each as likely as the others."""

    grid: PlantGrid
    fields: NDArray[np.bool_]
    chances: RandomStreams
    steps: int = 0
    traces: None = None
    doubt: float = 0.0
    doubt_of_rates: float = 0.0
    since_inspected: None = None
    pest: None = None

    @classmethod
    def of(
        cls, grid: PlantGrid, chance: NDArray[np.float64], clustering: float = CLUSTERING
    ) -> Ensemble:
        """Draw fields from a chance map, its neighbours alike as `pair_chances` has them."""
        fields = np.zeros((_FIELDS, len(grid)), np.bool_)
        believed = chance, pair_chances(chance, grid, clustering)
        draw_fields(believed, grid.adjacent, RandomStreams(0).key("fields"), fields)
        return cls(grid, fields, RandomStreams(0))

    @cached_property
    def chance(self) -> NDArray[np.float64]:
        """Chance of infestation of every plant, ``(n,)``; never quite 0, as fields are few."""
        share = self.fields.mean()
        chance: NDArray[np.float64] = (self.fields.sum(axis=0) + share) / (len(self.fields) + 1.0)
        return np.minimum(chance, _MOST)

    @cached_property
    def pair_chance(self) -> NDArray[np.float64]:
        """Chance that two plants side by side are both infested, ``(e,)``."""
        pair_chance = np.empty(len(self.grid.adjacent.plant))
        _pair_chance(self.fields, self.grid.adjacent, pair_chance)
        return pair_chance

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> Ensemble:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        fields = self.fields.copy()
        key = self.chances.key("learn", self.steps)
        rule = learning.detects(len(plants)), learning.treated
        _learn(fields, self.grid.adjacent, (plants, found), rule, key)
        return Ensemble(self.grid, fields, self.chances, self.steps + 1)

    def overnight(self, spread: Spread) -> Ensemble:
        """Return what is believed the next morning."""
        keys = [self.chances.key("night", self.steps, k) for k in range(len(self.fields))]
        after = [night(self.grid, f, spread, k) for f, k in zip(self.fields, keys, strict=True)]
        return Ensemble(self.grid, np.array(after), self.chances, self.steps + 1)

    def treated(self, left: NDArray[np.float64]) -> Ensemble:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        drawn = self.chances.of("treated", self.steps).random(self.fields.shape)
        return Ensemble(self.grid, self.fields & (drawn < left), self.chances, self.steps + 1)

    def estimate(self, sure: float = 0.9) -> PlotEstimate:
        """Return what the fields say of the whole plot."""
        counts = self.fields.sum(axis=1)
        low, high = np.quantile(counts, [0.5 - sure / 2, 0.5 + sure / 2])
        clean = float(np.mean(counts == 0))
        return PlotEstimate(float(counts.mean()), int(np.floor(low)), int(np.ceil(high)), clean)


@routine
def _pair_chance(
    fields: NDArray[np.bool_], adjacent: Csr, pair_chance: NDArray[np.float64]
) -> None:
    pair_chance[:] = 0.0
    m, n = fields.shape
    for k in range(m):
        for i in range(n):
            if fields[k, i]:
                for e in range(adjacent.start[i], adjacent.start[i + 1]):
                    pair_chance[e] += fields[k, adjacent.plant[e]]
    pair_chance /= m


@routine
def _learn(
    fields: NDArray[np.bool_],
    adjacent: Csr,
    looks: tuple[NDArray[np.int32], NDArray[np.bool_]],
    rule: tuple[NDArray[np.float64], bool],
    key: np.uint64,
) -> None:
    plants, found = looks
    detects, treated = rule
    m = fields.shape[0]
    block = np.empty(_ROOM, np.int64)
    for s in range(plants.size):
        i, detection = plants[s], detects[s]
        p = fields[:, i].mean()
        keeps = 0.0 if found[s] else (1.0 - detection) / max(1.0 - detection * p, 1e-9)
        size = _about(adjacent, i, block)
        was = fields[:, i].copy()
        for k in range(m):
            if was[k] == found[s] or (was[k] and coin(key, 2 * (s * m + k)) < keeps):
                continue
            other = _donor(was, found[s], coin(key, 2 * (s * m + k) + 1))
            if other < 0:
                fields[k, i] = found[s]
                continue
            for t in range(size):
                fields[k, block[t]] = fields[other, block[t]]
            fields[k, i] = found[s]
        if found[s] and treated:
            fields[:, i] = False


@routine
def _donor(was: NDArray[np.bool_], wanted: bool, drawn: float) -> int:  # noqa: FBT001 - a state
    """Return a field, drawn, in which the plant was as wanted; -1 if there is none."""
    first = int(drawn * was.size)
    for step in range(was.size):
        k = (first + step) % was.size
        if was[k] == wanted:
            return k
    return -1


@routine
def _about(adjacent: Csr, i: int, block: NDArray[np.int64]) -> int:
    """Write down the plants up to three steps from plant i; return how many."""
    block[0] = i
    size, first = 1, 0
    for _ in range(_RINGS):
        end = size
        for t in range(first, end):
            for e in range(adjacent.start[block[t]], adjacent.start[block[t] + 1]):
                j = adjacent.plant[e]
                if size < block.size and not (block[:size] == j).any():
                    block[size] = j
                    size += 1
        first = end
    return size
