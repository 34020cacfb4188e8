"""What is believed of a plot whose finds are traced: the likeliest map, and others beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.calibration_slope import finds_noted
from fieldmon.infestation.chance_bounds import KNOWN, LEAST_CHANCE
from fieldmon.infestation.pairs.clustering import CLUSTERING
from fieldmon.infestation.pairs.heavier_priors import (
    TOLD,
    heavier_than,
    likeliest,
    odds_times,
    refuted,
)
from fieldmon.infestation.pairs.pairs import pair_chances
from fieldmon.infestation.prior.prior import odds_ratio
from fieldmon.infestation.tracing import traced_doubt, traced_night
from fieldmon.infestation.tracing.traced_evening import inspected
from fieldmon.infestation.tracing.traced_map import MOST_UNKNOWN, SENT, TracedMap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief, Learning
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.pairs.uninspected_days import Since

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TracedPairs(TracedMap):
    """The likeliest map of a plot, as the belief in it; its parameters are those of `TracedMap`.

    Parameters
    ----------
    others
        Other such maps that are possible still; None: nothing was inspected yet.
    """

    others: tuple[TracedPairs, ...] | None = None

    @property
    def doubt(self) -> float:
        """How far the expected number may be off, see `Belief`."""
        return traced_doubt.doubt_of_number(self, self.others or ())

    @property
    def doubt_of_rates(self) -> float:
        """How far the expected number may be off as rates are not known, see `Belief`."""
        return traced_doubt.doubt_of_rates(self, self.others or ())

    @property
    def since_inspected(self) -> Since | None:
        """What the number may have become on days without inspections, see `Belief`."""
        return self.uninspected.draws(self.arrivals_found)

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> TracedPairs:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`.

        That is the likeliest map: this one, or one of the others.
        """
        if not len(plants):
            return self
        days = [inspected(self, plants, found, learning)]
        others = self.others
        if others is None or (not others and refuted(float(days[0].day.likely[0]), found)):
            others = self._heavier(found, learning)
        days += [inspected(one, plants, found, learning) for one in others]
        best, left = likeliest(days, finds_noted(days[0].after.slope_sums))
        settled = tuple(replace(one.settled(), others=()) for one in left)
        return replace(best.settled(), others=settled)

    def _heavier(self, found: NDArray[np.bool_], learning: Learning) -> tuple[TracedPairs, ...]:
        """Return maps like this one that were told of more, of the plants not inspected yet.

        Those that inspections, with results `found` ``(k,)``, leave possible.
        """
        known = self.chance > KNOWN
        told = self.chance[~known & (self.unseen > SENT / 2.0)]
        if not len(told):
            return ()
        return tuple(
            self._told_of(odds_ratio(told, share), known, self.likely - TOLD + likely)
            for share, likely in heavier_than(
                float(told.mean()), found, learning.detects(len(found))
            )
        )

    def _told_of(self, factor: float, known: NDArray[np.bool_], likely: float) -> TracedPairs:
        """Return this map with so much higher odds of the plants that are not `known` ``(n,)``."""
        told = np.clip(odds_times(self.chance, factor), LEAST_CHANCE, MOST_UNKNOWN)
        chance = np.where(known, self.chance, told)
        of = self.chance if self.others is None else self.at_start
        ancestry = self.ancestry and replace(
            self.ancestry, start=odds_times(self.ancestry.start, factor)
        )
        return replace(
            self, chance=chance, pair_chance=pair_chances(chance, self.grid, CLUSTERING),
            at_start=self.at_start * float(chance.sum() / of.sum()), ancestry=ancestry,
            latency=self.latency and self.latency.levelled(chance),
            likely=likely, is_heavier=True,
        )  # fmt: skip

    def overnight(self, spread: Spread) -> TracedPairs:
        """Return what is believed the next morning."""
        morning = traced_night.by_origins(self, spread, tells_apart=True)
        morning = traced_night.with_ancestry(self, morning, spread)
        others = self.others and tuple(one.overnight(spread) for one in self.others)
        return replace(self._not_inspected_by(morning, spread), others=others)

    def untold_night(self, spread: Spread) -> TracedPairs:
        """Return the same chances next morning; where they came from is not told apart any more.

        No find can be traced by it, but it is worked out in half the time.
        """
        morning = traced_night.by_origins(self, spread, tells_apart=False)
        return self._not_inspected_by(morning, spread)

    def _not_inspected_by(self, morning: TracedPairs, spread: Spread) -> TracedPairs:
        """Return the next morning with what is in doubt of it if nobody inspected today."""
        days = traced_doubt.uninspected_by(morning, self, self.others or (), spread)
        return replace(morning, uninspected=days)

    def in_hindsight(self, spread: Spread) -> TracedPairs:
        """Return the same as the ancestry of finds has it by now, before the night of a `spread`.

        It is what to tell in the evening; the night begins without it, as it would count twice.
        """
        return traced_night.in_hindsight(self, spread)

    def treated(self, left: Floats) -> TracedPairs:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        others = self.others and tuple(one.treated(left) for one in self.others)
        return replace(super().treated(left), others=others)


def in_sight(belief: Belief) -> Belief:
    """Return what is believed of what inspections can see: a day is planned by it."""
    return belief.in_sight if isinstance(belief, TracedPairs) else belief


def in_hindsight(evening: Belief, night: Spread) -> Belief:
    """Return what is believed of an evening as its finds say of others, before a night."""
    return evening.in_hindsight(night) if isinstance(evening, TracedPairs) else evening
