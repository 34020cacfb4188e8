"""How the chance map follows from what is done and found on a real plot."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.array_arguments import must_be_shaped
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.earlier_season import Believed, EarlierSeason
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.inspections import after_their_find
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import USUAL_PER_DAY
from fieldmon.plot.robot import Robot

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.pests.pest import Pest
    from fieldmon.plot.grid import PlantGrid


@checked
@dataclass(frozen=True)
class BeliefSettings:
    """How the chance map follows from what is done and found on a real plot.

    Parameters
    ----------
    spread
        What the insects are taken to do in a night. The default is our choice for a plot whose
        pest nobody measured: each infested plant infests each of its neighbours with 2 % a night
        (8 % a night altogether: doubling in nine days), and 1 plant in 5 000 is infested from
        outside. The thesis's 30 to 80 % are meant for its simulator.
    treated
        Whether plants found infested are treated at once (the thesis's rule), or only flagged.
    traces
        Whether finds are traced beyond the plants next to them, and the season's own inspections
        tell how far insects jump, how many arrive and how many are overlooked. Seasons begun
        before that was known go on without.
    earlier
        What an earlier season of the plot or the estate learnt; None: nothing is known of one.

    Examples
    --------
    >>> import fieldmon as fm
    >>> flagged = fm.BeliefSettings(treated=False)
    >>> flagged.spread.rate_per_day
    0.02
    """

    spread: Spread = field(
        default_factory=lambda: Spread(rate_per_day=USUAL_PER_DAY, arrivals_per_day=0.0002)
    )
    treated: bool = True
    traces: bool = True
    earlier: EarlierSeason | None = None

    def __post_init__(self) -> None:
        must_hold_kinds(self, "The belief's")

    def first_morning(
        self,
        grid: PlantGrid,
        chance: NDArray[np.float64],
        pest: Pest | None = None,
        detection: float = Robot().detects,
    ) -> Belief:
        """Return what is believed at first, from the `chance` ``(n,)`` of each plant of a `grid`.

        Only where finds are traced is anything made of a `pest`, and of an earlier season: of what
        it learnt of the detection only if the same `detection` is told.
        """
        must_be_shaped("The first morning's", {"chance": (chance, (len(grid),))})
        if not self.traces:
            return PairApproximation.of(grid, chance)
        traced = TracedPairs.of(grid, chance)
        if pest is not None:
            traced = traced.of_pest(pest)
        if self.earlier is None:
            return traced
        return self.earlier.begin(traced, self.believed(grid, pest, detection))

    def believed(self, grid: PlantGrid, pest: Pest | None, detection: float) -> Believed:
        """Return what the numbers that are learnt on a `grid` are multiples of.

        With a `pest`, by which nights go, and the `detection` that is told.
        """
        name = "" if pest is None else pest.name
        return Believed.of(grid, name, self.spread.rate_per_day, detection)

    def evening(
        self,
        morning: Belief,
        plants: NDArray[np.int32],
        found: NDArray[np.bool_],
        detection: float | NDArray[np.float64],
    ) -> Belief:
        """Return what is believed after a day's inspections.

        Where finds are treated at once, what is inspected again after its find that day is no news.

        Parameters
        ----------
        morning
            What was believed before.
        plants, found
            ``(k,)`` plants in the order in which they were inspected, and whether each was found
            infested.
        detection
            Chance that an inspection finds what is there: one for all, or ``(k,)``.
        """
        if self.treated and (again := after_their_find(plants, found)).any():
            plants, found = plants[~again], found[~again]
            detection = detection if np.ndim(detection) == 0 else np.asarray(detection)[~again]
        if not len(plants):
            return morning
        return morning.learn(plants, found, Learning(detection, treated=self.treated))

    def overnight(self, evening: Belief) -> Belief:
        """Return what is believed the morning after an `evening`."""
        return evening.overnight(self.spread)
