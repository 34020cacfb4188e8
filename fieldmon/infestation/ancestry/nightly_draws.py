"""The ancestries drawn in one night: what they are weighed by, and what they say of each plant."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.ancestry.ancestry_arrays import Weights
from fieldmon.infestation.ancestry.drawn_ancestry import DrawnSums, draw_ancestries
from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.ancestry.inspected_infestations import InspectedInfestations
from fieldmon.infestation.ancestry.unseen_offspring import unseen_now

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.ancestry import Ancestry
    from fieldmon.infestation.ancestry.ancestry_rates import Rates
    from fieldmon.infestation.ancestry.infestations import Finds, Infestations
    from fieldmon.infestation.insects.jump_landing import Landing

    Floats = NDArray[np.floating[Any]]

# so much of each draw is left out at the beginning
_LEFT_OUT = 0.1
#: finds older than so many days keep their origin
SETTLED = 10


@dataclass(frozen=True, eq=False)
class NightlyDraws:
    """Ancestries that are drawn in a night, each from the one before, in place.

    Parameters
    ----------
    of, landing
        What is known, and where jumps land.
    inspected
        What inspections say.
    infestations, at
        The ancestry drawn last, and which infestation not found is at each plant.
    finds
        What was found of it.
    lasting
        As `Weights` has it.
    drawn
        Sums over the ancestries of the last draw.
    """

    of: Ancestry
    landing: Landing
    inspected: InspectedInfestations
    infestations: Infestations
    at: NDArray[np.int64]
    finds: Finds
    lasting: Floats
    drawn: DrawnSums

    @classmethod
    def begun(cls, of: Ancestry, landing: Landing) -> NightlyDraws:
        """Return none yet."""
        inspected, infestations = InspectedInfestations.by(of, landing), of.infestations.copied(0)
        finds, lasting = infestations.finds, inspected.lasting(infestations)
        t, n = inspected.missed.shape
        drawn = DrawnSums.none(t, n, landing.kernels.shape[1], delays=inspected.course.delays)
        at = infestations.places(n, t - 1)
        return cls(of, landing, inspected, infestations, at, finds, lasting, drawn)

    def weights(self, rates: Rates) -> Weights:
        """Return what ancestries are weighed by at such rates."""
        t = len(self.inspected.missed)
        kernel = np.einsum("k,kij->ij", rates.shares, self.landing.kernels)
        roots = rates.roots(self.of.start, self.landing.at_edge, t)
        return Weights(
            self.landing.cells, kernel, np.cumsum(kernel) / kernel.sum(), self.of.sent(rates),
            np.ascontiguousarray(roots.T), BEFORE, max(t - 1 - SETTLED, 0),
            self.inspected.course.grown, self.inspected.course.grown_by, self.lasting,
        )  # fmt: skip

    def draw(self, weights: Weights, seed: int, sweeps: int) -> int:
        """Draw anew, and sum up; but for who was there, return means. Return of how many."""
        for sums in self.drawn:
            sums.fill(0.0)
        draws = seed, sweeps, int(_LEFT_OUT * sweeps)
        last_find = self.of.last_find + BEFORE
        kept = draw_ancestries(self.infestations, self.at, weights, last_find, draws, self.drawn)
        for sums in self.drawn[2:]:
            np.divide(sums, kept, out=sums)
        return kept

    def counted(self, kept: int, weights: Weights, shares: Floats) -> DrawnChances:
        """Return what the last draw says of each plant, of so many ancestries."""
        taken, active = self.drawn.there, self.drawn.active
        taken /= kept
        if active is None:
            active = taken.copy()
        else:
            active /= kept
        taken[self.finds.ends, self.finds.plant] = 1.0
        unfound = unseen_now(
            self.inspected.unseen, active, weights.roots.T, (weights.sends, shares),
            self.landing, self.inspected.course,
        )  # fmt: skip
        return DrawnChances(active, taken, unfound)


class DrawnChances(NamedTuple):
    """What drawn ancestries say of each plant on each morning, ``(t, n)`` each.

    Parameters
    ----------
    active
        How likely it sends something out in the night.
    taken
        How likely it is infested already by the ancestry of finds.
    unfound
        How many infestations of which nothing was seen are expected there.
    """

    active: Floats
    taken: Floats
    unfound: Floats
