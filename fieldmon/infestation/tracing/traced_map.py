"""One map: the chances of plants and pairs, and from where each came.

It knows of more than the plants next to an infestation. Beside a plant lies what
`fieldmon.infestation.pairs.pairs` says of pairs of neighbours. Beyond, insects jump by a mixture of
kernels (`jump_reach`), arrive from outside, and are overlooked; a find is traced to where it came
from and what it sent out (`tracing`). Which of that is so, and how much, the season's own
inspections tell (`clustering`, `origins`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Self, TypeVar

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.compute.jit import loop
from fieldmon.infestation.ancestry.ancestry import MOST_PLANTS, Ancestry
from fieldmon.infestation.ancestry.origins import (
    ANYWHERE,
    ARRIVE,
    ARRIVE_BY_EDGE,
    AT_START,
    AT_START_ELSEWHERE,
    BY_EDGE,
    JUMPED,
    N_ORIGINS,
    OriginCounts,
)
from fieldmon.infestation.calibration_slope import no_inspections
from fieldmon.infestation.chance_bounds import KNOWN, LEAST_CHANCE, MOST_CHANCE
from fieldmon.infestation.insects.cohorts import Cohorts
from fieldmon.infestation.insects.jump_reach import pest_reach_of, reach_of
from fieldmon.infestation.insects.latency import Latency
from fieldmon.infestation.insects.pest_in_weather import PestSpread, kernel_of
from fieldmon.infestation.pairs.clustering import CLUSTERING, chance_apart, no_evidence
from fieldmon.infestation.pairs.heavier_priors import TOLD
from fieldmon.infestation.pairs.pair_changes import pairs_scaled
from fieldmon.infestation.pairs.pairs import pair_chances, pairs_left
from fieldmon.infestation.pairs.uninspected_days import UninspectedDays
from fieldmon.infestation.tracing.tracing import Traces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.jump_reach import Reach
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.pests.pest import Pest
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

#: an infested plant of which nothing is known has sent out so many before the season: clusters of
#: eight, with `MOST_SENT` (our choice)
SENT = 3.5
#: only another inspection can say that a plant found and left where it is may be clean
MOST_UNKNOWN = 0.95
#: an infestation with a lower chance is none, probably
PROBABLE = 0.5
# of a flat map the mean is rounded
_AVERAGE = 1.0 - 1e-9


@dataclass(frozen=True, eq=False)
class TracedMap:
    """A chance for every plant and every two neighbours, by where infestations come from.

    Parameters
    ----------
    grid
        The plants.
    chance, pair_chance
        ``(n,)`` and ``(e,)``, see `Belief`.
    shares
        ``(n, N_ORIGINS)`` float32: how much of each plant's chance each origin brought.
    unseen
        ``(n,)`` how many infestations a plant would have sent out since it was seen clean.
    counts
        What each origin brought, and was expected to.
    evidence
        ``(4,)`` of how infested plants stand, see `ClusterEstimate`.
    at_start
        ``(2,)`` how many were believed infested on the first morning: among plants suspected as
        much as the average one or more, and among the others. Each is learnt by itself: where a
        suspicion proves wrong, that says nothing of the others.
    cohorts
        Which part of each chance is of young infestations; None: no pest was named, and all show
        and spread at once.
    wind_m_s
        Where the wind has gone of late, by which finds are traced.
    latency
        For how many nights infestations hide, as far as inspections tell; None: a pest was named.
    slope_sums
        ``(6,)`` how far differences between chances came true, see `calibration_slope`.
    ancestry
        Who infested whom; None: the plot has too many plants, or infestations of the pest that was
        named end of themselves.
    uninspected
        The days without inspections until now.
    likely
        The logarithm of how likely it is that so many were infested as this map was told, and that
        inspections so far had their results.
    is_heavier
        Whether it takes more for infested on the first morning than was told, see `heavier_priors`.
    """

    grid: PlantGrid
    chance: Floats
    pair_chance: Floats
    shares: NDArray[np.float32]
    unseen: Floats
    counts: OriginCounts
    evidence: Floats
    at_start: Floats
    cohorts: Cohorts | None = None
    wind_m_s: tuple[float, float] = (0.0, 0.0)
    latency: Latency | None = None
    slope_sums: Floats = field(default_factory=no_inspections)
    ancestry: Ancestry | None = None
    uninspected: UninspectedDays = field(default_factory=UninspectedDays)
    likely: float = TOLD
    is_heavier: bool = False

    @classmethod
    def of(
        cls,
        grid: PlantGrid,
        chance: Floats,
        clustering: float = CLUSTERING,
        *,
        by_ancestry: bool = True,
    ) -> Self:
        """Begin with the `chance` ``(n,)`` of each plant of a `grid`.

        `clustering` is the correlation of neighbours, see
        :func:`fieldmon.infestation.pairs.pairs.pair_chances`; `by_ancestry` whether mornings know
        who infested whom.
        """
        chance = np.clip(chance, LEAST_CHANCE, MOST_CHANCE)
        shares = np.zeros((len(chance), N_ORIGINS), np.float32)
        elsewhere = chance < chance.mean() * _AVERAGE
        shares[~elsewhere, AT_START] = shares[elsewhere, AT_START_ELSEWHERE] = 1.0
        at_start = np.array([chance[~elsewhere].sum(), chance[elsewhere].sum()])
        together = pair_chances(chance, grid, clustering)
        unseen, counts = np.full(len(chance), SENT), OriginCounts.none()
        ancestry = None
        if by_ancestry and len(chance) <= MOST_PLANTS:
            ancestry = Ancestry.of(grid, chance)
        return cls(
            grid, chance, together, shares, unseen, counts, no_evidence(), at_start,
            latency=Latency.none(chance), slope_sums=no_inspections(chance), ancestry=ancestry,
        )  # fmt: skip

    def of_pest(self, pest: Pest) -> Self:
        """Return the map of a plot on which this pest lives; how long one hides is not learnt."""
        cohorts = Cohorts.none(pest, len(self.chance))
        # an ancestry knows no infestation that ends of itself
        lives = pest.mortality_per_day == 0.0
        ancestry = self.ancestry.of_pest(pest) if lives and self.ancestry is not None else None
        return replace(self, cohorts=cohorts, latency=None, ancestry=ancestry)

    @property
    def pest(self) -> Pest | None:
        """The pest that lives on the plot; None: nobody named it."""
        return None if self.cohorts is None else self.cohorts.pest

    @property
    def known_to_jump(self) -> bool:
        """Tell whether the pest is known to go beyond the plants next to it."""
        return self.pest is not None and self.pest.movement.kernel != "adjacent"

    @property
    def reach(self) -> Reach:
        """The kernels of the plot."""
        return self.reach_in(self.wind_m_s)

    def reach_in(self, wind_m_s: tuple[float, float]) -> Reach:
        """Return the kernels of the plot in a night with such a wind."""
        if self.pest is None or not self.known_to_jump:
            return reach_of(self.grid)
        return pest_reach_of(self.grid, kernel_of(self.pest.movement), wind_m_s)

    @property
    def jumps(self) -> float:
        """Chance that the plot's insects jump beyond the plants next to them."""
        return self.jumps_by(self.evidence)

    def jumps_by(self, evidence: Floats) -> float:
        """Return that chance as such `evidence` ``(4,)`` has it."""
        return 1.0 if self.known_to_jump else float(chance_apart(evidence))

    @property
    def beyond(self) -> Floats:
        """What an infested plant sends out by each kernel if insects jump, ``(6,)``."""
        beyond: Floats = self.reach.beyond * self.counts.scale[JUMPED:]
        return beyond

    @property
    def in_sight(self) -> Self:
        """The same of what an inspection can see: a day is planned by it."""
        hidden = self.hidden()
        if hidden is None:
            return self
        start, other = self.grid.adjacent
        seen = 1.0 - hidden
        both = self.pair_chance * np.repeat(seen, np.diff(start)) * seen[other]
        return replace(self, chance=np.maximum(self.chance * seen, LEAST_CHANCE), pair_chance=both)

    @cached_property
    def traces(self) -> Traces:
        """What a day needs to trace a find."""
        kernel = np.einsum("k,kij->ij", self.beyond, self.reach.kernels)
        so_far = self.unseen, from_afar(self.shares), self.evidence, self.slope_sums
        return Traces(self.reach.cells, kernel, *so_far)

    def hidden(self, plants: NDArray[np.int32] | None = None) -> Floats | None:
        """Return the share of plants' chances that no inspection can see, ``(k,)``; None: none."""
        if self.cohorts is not None and self.cohorts.ages:
            return self.cohorts.hidden if plants is None else self.cohorts.hidden[plants]
        if self.latency is not None and self.latency.matters:
            return self.latency.hidden(
                self.chance if plants is None else self.chance[plants], plants
            )
        return None

    def times(self, scale: Floats) -> Self:
        """Return the same with all chances ``(n,)`` times a scale, but those of known finds."""
        scale = np.where(self.chance > KNOWN, 1.0, scale)
        chance = np.clip(self.chance * scale, LEAST_CHANCE, np.maximum(self.chance, MOST_UNKNOWN))
        both = pairs_scaled(self.pair_chance, self.grid.adjacent, scale, chance)
        return replace(self, chance=chance, pair_chance=both)

    def treated(self, left: Floats) -> Self:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        start, other = self.grid.adjacent
        # found since the night, and treated then
        found = (self.unseen == 0.0) & (self.chance < PROBABLE)
        apart = np.repeat(found, np.diff(start)) | found[other]
        believed = self.chance, self.pair_chance
        chance, together = pairs_left(believed, self.grid, left, apart)
        latency = self.latency and self.latency.treated(left)
        ancestry = self.ancestry and self.ancestry.anew(chance)
        return replace(
            self, chance=chance, pair_chance=together, latency=latency, ancestry=ancestry
        )

    def levelled(self) -> Self:
        """Return the same, what may hide being part of the chances as they are by now."""
        return replace(self, latency=self.latency and self.latency.levelled(self.chance))

    @property
    def arrivals_found(self) -> float:
        """How many finds came from outside of the plot, as the season's inspections have it."""
        return float(self.counts.found[[ANYWHERE, BY_EDGE]].sum())

    def from_outside(self, reach: Reach, spread: Spread) -> tuple[float, Floats]:
        """Return what a night brings a plant from outside: anywhere, and by the edge ``(n,)``."""
        scale, (anywhere, by_edge) = self.counts.scale, self.told_from_outside(spread)
        return anywhere * float(scale[ANYWHERE]), by_edge * scale[BY_EDGE] * reach.at_edge

    def told_from_outside(self, spread: Spread) -> tuple[float, float]:
        """Return the share of all plants taken to be infested from outside in a night.

        Anywhere, and by the edge: as said, but never less than a little. What is said may be wrong,
        and a find far from all others must have come from somewhere.
        """
        anywhere, by_edge = self.said_from_outside(spread)
        return max(anywhere, ARRIVE), max(by_edge, ARRIVE_BY_EDGE)

    def said_from_outside(self, spread: Spread) -> tuple[float, float]:
        """Return the share of all plants that is said to be infested from outside in a night.

        Anywhere, and by the edge.
        """
        if not isinstance(spread, PestSpread):
            return spread.arrivals_per_day, 0.0
        # said of plants at the edge
        return spread.arrivals_per_day, spread.edge_per_day / float(self.reach.at_edge.max())


#: a map and what becomes of it, be it one with others beside it
Map = TypeVar("Map", bound=TracedMap)


def from_afar(shares: NDArray[np.float32]) -> Floats:
    """Return the share of each plant's chance that jumps brought, ``(n,)``."""
    afar = np.empty(len(shares))
    _sum_jumps(as_compiled(shares), afar)
    return afar


# numpy takes nine times as long to add up six numbers of each plant
@loop
def _sum_jumps(shares: NDArray[np.float32], afar: Floats) -> None:
    for i in range(afar.size):
        afar[i] = 0.0
        for o in range(JUMPED, N_ORIGINS):
            afar[i] += shares[i, o]
