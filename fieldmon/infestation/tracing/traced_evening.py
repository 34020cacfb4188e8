"""What a day's inspections change in a traced map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Generic

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.infestation.ancestry.origins import JUMPED, N_ORIGINS
from fieldmon.infestation.chance_bounds import KNOWN, LEAST_CHANCE
from fieldmon.infestation.pairs.clustering import (
    ClusterEstimate,
    kept_evidence,
    leaning,
    learn_clustering,
)
from fieldmon.infestation.pairs.pair_changes import pairs_scaled
from fieldmon.infestation.pairs.pairs import Neighbourhood
from fieldmon.infestation.tracing.traced_day import KernelRoom, TracedDay, learn_day
from fieldmon.infestation.tracing.traced_map import PROBABLE, Map, TracedMap, from_afar
from fieldmon.infestation.tracing.tracing import Raised, rescale_traced

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Learning

    Floats = NDArray[np.float64]

# one that seems clean on a later day may have been cleaned without a word: so likely it was not
# (our choice)
_STILL_INFESTED = 0.7
# what was inspected around a plant never lowers it by more in a day (as an exponent)
_MOST_LOWERED = 3.0
# what jumps were expected to bring is not made up from a chance of jumping below this
_LEAST_JUMPS = 0.05


@dataclass(frozen=True, eq=False)
class LearntDay(Generic[Map]):
    """What a day's inspections say to a map, before the whole plot is thought over.

    Parameters
    ----------
    before, after
        The map before them, and with what they change about themselves.
    day
        What they say beside that.
    beyond
        What an infested plant sends out by each kernel, ``(6,)``.
    """

    before: Map
    after: Map
    day: TracedDay
    beyond: Floats

    @property
    def likely(self) -> float:
        """The logarithm of how likely the map is by now."""
        return self.after.likely

    def settled(self) -> Map:
        """Return what is believed of the whole plot by that."""
        lower = lowered(self.before, self.after, self.day, self.beyond)
        return counting(self.after.times(lower), self.before, self.day).levelled()


def inspected(
    before: Map, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
) -> LearntDay[Map]:
    """Return what inspections of `plants` ``(k,)`` with results `found` say to a map."""
    n, nothing = len(before.chance), np.zeros((2, N_ORIGINS))
    none = np.zeros((2, n))
    told = before.counts.detects(learning.detects(len(plants)))
    shown = _shown(before, plants, told)
    inspections = as_compiled(plants), as_compiled(found), shown
    lean = leaning(before.evidence)
    clusters = ClusterEstimate.none(n, before.evidence, lean)
    believed = before.chance.copy(), before.pair_chance.copy()
    learn_clustering(believed, before.grid.linked, inspections, clusters, lean)
    evidence = kept_evidence(clusters.evidence)
    jumps = before.jumps_by(evidence)
    # before any find of the day is traced: that is done with what is known of jumps by now
    shares = _jumping(before, believed, jumps / before.jumps)
    day = TracedDay(
        shares, believed[0].copy(), none[0], none[1], nothing[0], nothing[1], np.zeros(1)
    )
    traces = before.traces.own()
    each = before.reach.kernels * before.beyond[:, None, None]
    room = KernelRoom(each, Neighbourhood.of(n, believed[0]), Raised.of(n))
    rule = learning.treated, jumps
    # of what a clean inspection leaves, so much was hidden, and the rest overlooked
    hidden = (told - shown) / np.maximum(told * (1.0 - shown), LEAST_CHANCE)
    inspections_of = *inspections, hidden.clip(0.0, 1.0)
    learn_day(believed, before.grid.linked, inspections_of, rule, (day, traces), room)
    cleaned = _doubt_known(before, believed, (plants, found, told))
    ancestry = before.ancestry and before.ancestry.without_left(cleaned)
    after = replace(
        before, chance=believed[0], pair_chance=believed[1], shares=day.shares,
        unseen=traces.unseen, evidence=evidence, slope_sums=traces.slope_sums,
        likely=before.likely + float(day.likely[0]),
        ancestry=ancestry and ancestry.learn(plants, found, told, treated=learning.treated),
        cohorts=before.cohorts and before.cohorts.inspected(plants, found, told),
        latency=before.latency and before.latency.inspected(plants, found, told),
        uninspected=before.uninspected.inspected(
            _expected_finds(before, plants, shown),
            before.uninspected.variance(before.arrivals_found),
        ),
    )  # fmt: skip
    return LearntDay(before, after, day, jumps * before.beyond)


def _shown(before: TracedMap, plants: NDArray[np.int32], detects: Floats) -> Floats:
    """Return the chance that inspections find what is there, seen yet or not, ``(k,)``."""
    hidden = before.hidden(plants)
    return detects if hidden is None else detects * (1.0 - hidden)


def _expected_finds(before: TracedMap, plants: NDArray[np.int32], shown: Floats) -> float:
    """Return how many finds are expected among plants ``(k,)`` that were not found yet."""
    chance = before.chance[plants]
    return float(shown @ np.where(chance > KNOWN, 0.0, chance))


def _jumping(
    before: TracedMap, believed: tuple[Floats, Floats], ratio: float
) -> NDArray[np.float32]:
    """Believe in what jumps have brought `ratio` times as much, in place; return the shares."""
    shares = before.shares.copy()
    rescale_traced(believed, before.grid.linked, from_afar(shares), ratio)
    shares[:, JUMPED:] *= np.float32(ratio)
    shares /= shares.sum(axis=1, keepdims=True)
    return shares


def _doubt_known(
    before: TracedMap,
    believed: tuple[Floats, Floats],
    inspections: tuple[NDArray[np.int32], NDArray[np.bool_], Floats],
) -> NDArray[np.int32]:
    """Doubt in place that plants known before are infested yet, where they only seemed clean.

    Return those that probably are not.
    """
    plants, found, detects = inspections
    asked = (before.chance[plants] > KNOWN) & ~np.isin(plants, plants[found])
    if not asked.any():
        return np.empty(0, np.int32)
    missed = np.ones(len(before.chance))
    np.multiply.at(missed, plants[asked], 1.0 - detects[asked])
    known = np.unique(plants[asked])
    overlooked = _STILL_INFESTED * missed[known]
    chance, both = believed
    scale = np.ones(len(chance))
    scale[known] = overlooked / (overlooked + 1.0 - _STILL_INFESTED) / chance[known]
    chance *= scale
    both[:] = pairs_scaled(both, before.grid.adjacent, scale, chance)
    return known[chance[known] < PROBABLE]


def lowered(before: TracedMap, after: TracedMap, day: TracedDay, beyond: Floats) -> Floats:
    """Return how much less likely plants are as no relatives were found about them, ``(n,)``.

    What clean inspections took from the chances about a plant, it would have infested, or
    would have been infested by, in that proportion.
    """
    reach = before.reach
    mixed = reach.mixed(beyond)
    sent = reach.landed(day.dropped, mixed) * after.unseen / after.chance
    sent += reach.landed(day.cleared * before.unseen, np.conj(mixed, out=mixed))
    return np.exp(-np.minimum(sent, _MOST_LOWERED))


def counting(after: Map, before: TracedMap, day: TracedDay) -> Map:
    """Return a map after a day with each origin believed as it now counts."""
    expected = day.expected / before.counts.scale
    expected[JUMPED:] /= max(after.jumps, _LEAST_JUMPS)
    counts = after.counts.and_those(day.found, expected)
    ratio = counts.scale / before.counts.scale
    scaled = after.shares * ratio.astype(np.float32)
    total = np.maximum(scaled.sum(axis=1, dtype=np.float64), LEAST_CHANCE)
    shares = scaled / total[:, None].astype(np.float32)
    return replace(after.times(total), shares=shares, counts=counts)
