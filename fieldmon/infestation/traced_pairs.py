"""Chances of plants and pairs that know of more than the plants next to an infestation.

Beside a plant lies what `fieldmon.infestation.pairs` says of pairs of neighbours. Beyond, insects
jump by a mixture of kernels (`jump_reach`), arrive from outside, and are overlooked; a find is
traced to where it came from and what it sent out (`tracing`). Which of that is so, and how much,
the season's own inspections tell (`clustering`, `origins`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.infestation.ancestry import MOST_PLANTS, Ancestry, ToldNight
from fieldmon.infestation.calibration_slope import finds_noted, no_inspections
from fieldmon.infestation.chance_bounds import (
    AS_GOOD_AS_CLEAN,
    KNOWN,
    LEAST_CHANCE,
    MOST_CHANCE,
)
from fieldmon.infestation.clustering import (
    CLUSTERING,
    ClusterEstimate,
    chance_apart,
    kept_evidence,
    leaning,
    learn_clustering,
    no_evidence,
)
from fieldmon.infestation.cohorts import Cohorts
from fieldmon.infestation.heavier_priors import (
    IN_DOUBT,
    TOLD,
    doubt_between,
    heavier_than,
    likeliest,
    odds_times,
    refuted,
)
from fieldmon.infestation.jump_reach import pest_reach_of, reach_of
from fieldmon.infestation.latency import Latency
from fieldmon.infestation.origins import (
    ANYWHERE,
    AT_START,
    AT_START_ELSEWHERE,
    BY_ADJACENT,
    BY_EDGE,
    JUMPED,
    N_ORIGINS,
    OriginCounts,
)
from fieldmon.infestation.pair_changes import pairs_scaled
from fieldmon.infestation.pairs import Neighbourhood, pair_chances, pairs_left
from fieldmon.infestation.pest_in_weather import PestSpread, kernel_of
from fieldmon.infestation.plot_estimate import drawn_numbers
from fieldmon.infestation.prior import odds_ratio
from fieldmon.infestation.traced_day import KernelRoom, TracedDay, learn_day
from fieldmon.infestation.traced_night import TracedNight, told_from_outside
from fieldmon.infestation.tracing import Raised, Traces, rescale_traced
from fieldmon.infestation.uninspected_days import Counted, Since, UninspectedDays

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Learning
    from fieldmon.infestation.jump_reach import Reach
    from fieldmon.infestation.spread import Spread
    from fieldmon.pests.pest import Pest
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# an infested plant of which nothing is known has sent out so many before the season: half as many
# as it may, see `traced_night`
_SENT = 3.5
# only another inspection can say that a plant found and left where it is may be clean
_UNKNOWN = 0.95
# one that seems clean on a later day may have been cleaned without a word: so likely it was not
# (our choice)
_STILL_INFESTED, _PROBABLE = 0.7, 0.5
# what was inspected around a plant never lowers it by more in a day (as an exponent)
_MOST_LOWERED = 3.0
# what jumps were expected to bring is not made up from a chance of jumping below this
_LEAST_JUMPS = 0.05
# where more were infested at the start than was told, so much of that (as a logarithm) remains in
# doubt: finds beside finds are put down to clusters first (chosen on nine real maps, and on 36
# seasons with 3 to 30 % infested where 1.5 % were told)
_STILL_TOO_FEW = 0.7
# the ancestry of finds knows the number better than origins, by which it is doubted: so much of
# the doubt remains (chosen on 400 seasons of ten worlds). What was found and left sends out more
# each night at a rate that nobody knows: then it is more (chosen on 80 seasons of ten worlds)
_LESS_DOUBT, _MORE_DOUBT = 0.85, 1.2
# two maps are believed: the odds by the ancestry of finds and those by origins with such powers,
# times so much (chosen on 560 seasons of ten worlds)
_ANCESTRY, _ORIGINS, _BOTH = 0.63, 0.42, 1.15
# of a flat map the mean is rounded
_AVERAGE = 1.0 - 1e-9


@dataclass(frozen=True, eq=False)
class TracedPairs:
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
    others
        Other such maps that are possible still; None: nothing was inspected yet.
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
    others: tuple[TracedPairs, ...] | None = None

    @classmethod
    def of(
        cls,
        grid: PlantGrid,
        chance: Floats,
        clustering: float = CLUSTERING,
        *,
        by_ancestry: bool = True,
    ) -> TracedPairs:
        """Begin with the `chance` ``(n,)`` of each plant of a `grid`.

        `clustering` is the correlation of neighbours, see
        :func:`fieldmon.infestation.pairs.pair_chances`; `by_ancestry` whether mornings know who
        infested whom.
        """
        chance = np.clip(chance, LEAST_CHANCE, MOST_CHANCE)
        shares = np.zeros((len(chance), N_ORIGINS), np.float32)
        elsewhere = chance < chance.mean() * _AVERAGE
        shares[~elsewhere, AT_START] = shares[elsewhere, AT_START_ELSEWHERE] = 1.0
        at_start = np.array([chance[~elsewhere].sum(), chance[elsewhere].sum()])
        together = pair_chances(chance, grid, clustering)
        unseen, counts = np.full(len(chance), _SENT), OriginCounts.none()
        ancestry = None
        if by_ancestry and len(chance) <= MOST_PLANTS:
            ancestry = Ancestry.of(grid, chance)
        return cls(
            grid, chance, together, shares, unseen, counts, no_evidence(), at_start,
            latency=Latency.none(chance), slope_sums=no_inspections(chance), ancestry=ancestry,
        )  # fmt: skip

    def of_pest(self, pest: Pest) -> TracedPairs:
        """Return the same, of a plot on which this pest lives."""
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
        """Return the kernels of the plot in a wind."""
        if self.pest is None or not self.known_to_jump:
            return reach_of(self.grid)
        return pest_reach_of(self.grid, kernel_of(self.pest.movement), wind_m_s)

    @property
    def jumps(self) -> float:
        """Chance that the plot's insects jump beyond the plants next to them."""
        return self._jumps(self.evidence)

    def _jumps(self, evidence: Floats) -> float:
        return 1.0 if self.known_to_jump else float(chance_apart(evidence))

    @property
    def beyond(self) -> Floats:
        """What an infested plant sends out by each kernel if insects jump, ``(6,)``."""
        beyond: Floats = self.reach.beyond * self.counts.scale[JUMPED:]
        return beyond

    @property
    def in_sight(self) -> TracedPairs:
        """The same of what an inspection can see: a day is planned by it."""
        hidden = self._hidden()
        if hidden is None:
            return self
        start, other = self.grid.adjacent
        seen = 1.0 - hidden
        both = self.pair_chance * np.repeat(seen, np.diff(start)) * seen[other]
        return replace(self, chance=np.maximum(self.chance * seen, LEAST_CHANCE), pair_chance=both)

    @property
    def doubt(self) -> float:
        """How far the expected number may be off, see `Belief`.

        As `doubt_of_rates` has it, but offspring is as doubtful as what it came from: of twice as
        many that were there at the start, there is twice as much. And as far as finds proved what
        was told of the start too low. Once the ancestry of finds has its say, it is less, or
        more where finds are left infested.
        """
        brought = self._brought_so_far
        expected, beside = float(brought.sum()), float(brought[BY_ADJACENT])
        # what came from the plant beside it came from where that one did
        came = brought * (1.0 + beside / max(expected - beside, 1e-12))
        came[BY_ADJACENT] = beside
        start = float(self.at_start @ self.counts.scale[[AT_START, AT_START_ELSEWHERE]])
        more = max(float(np.log(start / self.at_start.sum())), 0.0)
        doubt = float(np.hypot(self._doubt_of(came, expected), _STILL_TOO_FEW * more))
        ancestry = self.ancestry
        if ancestry is not None and ancestry.knows and not ancestry.waits:
            doubt *= _MORE_DOUBT if ancestry.left.any() else _LESS_DOUBT
        return float(np.hypot(doubt, self._in_doubt_besides))

    @property
    def doubt_of_rates(self) -> float:
        """How far the expected number may be off as rates are not known, see `Belief`.

        As far as what each origin brings is known, and as infestations that jumped come in groups.
        """
        brought = self._brought_so_far
        doubt = self._doubt_of(brought, float(brought.sum()))
        return float(np.hypot(doubt, self._in_doubt_besides))

    @property
    def since_inspected(self) -> Since | None:
        """What the number may have become on days without inspections, see `Belief`."""
        return self.uninspected.draws(self.arrivals_found)

    @property
    def _in_doubt_besides(self) -> float:
        """How far the number may be off yet of days without inspections before the last one.

        And as another share than was told may be infested.
        """
        left = float(np.sqrt(self.uninspected.left))
        if self.is_heavier:
            left = float(np.hypot(left, IN_DOUBT))
        if not self.others:
            return left
        maps = (self, *self.others)
        likely, expected = np.array([(one.likely, float(one.chance.sum())) for one in maps]).T
        return float(np.hypot(left, doubt_between(likely, expected)))

    @property
    def _variance_since_inspected(self) -> float:
        return self.uninspected.variance(self.arrivals_found)

    @property
    def _brought_so_far(self) -> Floats:
        brought: Floats = np.einsum("i,ik->k", self.chance, self.shares, dtype=np.float64)
        return brought

    def _doubt_of(self, brought: Floats, expected: float) -> float:
        """Return the doubt of a number of which so much hangs on each origin, ``(N_ORIGINS,)``."""
        origins = float(((brought * self.counts.doubt) ** 2).sum()) / expected**2
        sent = float((self.unseen * self.chance).sum()) / expected
        relatives = 2.0 * self.jumps * float(self.beyond.sum()) * sent
        return float(np.sqrt(origins + relatives / expected))

    @cached_property
    def traces(self) -> Traces:
        """What a day needs to trace a find."""
        kernel = np.einsum("k,kij->ij", self.beyond, self.reach.kernels)
        afar = self.shares[:, JUMPED:].sum(axis=1, dtype=np.float64)
        so_far = self.unseen, afar, self.evidence, self.slope_sums
        return Traces(self.reach.cells, kernel, *so_far)

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> TracedPairs:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`.

        That is the likeliest map: this one, or one of the others.
        """
        if not len(plants):
            return self
        days = [TracedPairs._inspected(self, plants, found, learning)]
        others = self.others
        if others is None or (not others and refuted(float(days[0].day.likely[0]), found)):
            others = self._heavier(found, learning)
        days += [TracedPairs._inspected(one, plants, found, learning) for one in others]
        best, left = likeliest(days, finds_noted(days[0].after.slope_sums))
        settled = tuple(replace(one.settled(), others=()) for one in left)
        return replace(best.settled(), others=settled)

    def _heavier(self, found: NDArray[np.bool_], learning: Learning) -> tuple[TracedPairs, ...]:
        """Return maps like this one that were told of more, of the plants not inspected yet.

        Those that inspections, with results `found` ``(k,)``, leave possible.
        """
        known = self.chance > KNOWN
        told = self.chance[~known & (self.unseen > _SENT / 2.0)]
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
        told = np.clip(odds_times(self.chance, factor), LEAST_CHANCE, _UNKNOWN)
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

    def _inspected(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> _LearntDay:
        """Return what inspections change about them, by this map alone."""
        n, nothing = len(self.chance), np.zeros((2, N_ORIGINS))
        none = np.zeros((2, n))
        told = self.counts.detects(learning.detects(len(plants)))
        shown = self._shown(plants, told)
        inspections = as_compiled(plants), as_compiled(found), shown
        lean = leaning(self.evidence)
        clusters = ClusterEstimate.none(n, self.evidence, lean)
        believed = self.chance.copy(), self.pair_chance.copy()
        learn_clustering(believed, self.grid.linked, inspections, clusters, lean)
        evidence = kept_evidence(clusters.evidence)
        jumps = self._jumps(evidence)
        # before any find of the day is traced: that is done with what is known of jumps by now
        shares = self._jumping(believed, jumps / self.jumps)
        day = TracedDay(
            shares, believed[0].copy(), none[0], none[1], nothing[0], nothing[1], np.zeros(1)
        )
        traces = self.traces.own()
        each = self.reach.kernels * self.beyond[:, None, None]
        room = KernelRoom(each, Neighbourhood.of(n, believed[0]), Raised.of(n))
        rule = learning.treated, jumps
        # of what a clean inspection leaves, so much was hidden, and the rest overlooked
        hidden = (told - shown) / np.maximum(told * (1.0 - shown), LEAST_CHANCE)
        inspections_of = *inspections, hidden.clip(0.0, 1.0)
        learn_day(believed, self.grid.linked, inspections_of, rule, (day, traces), room)
        cleaned = self._doubt_known(believed, (plants, found, told))
        ancestry = self.ancestry and self.ancestry.without_left(cleaned)
        after = replace(
            self, chance=believed[0], pair_chance=believed[1], shares=day.shares,
            unseen=traces.unseen, evidence=evidence, slope_sums=traces.slope_sums,
            likely=self.likely + float(day.likely[0]),
            ancestry=ancestry and ancestry.learn(plants, found, told, treated=learning.treated),
            cohorts=self.cohorts and self.cohorts.inspected(plants, found, told),
            latency=self.latency and self.latency.inspected(plants, found, told),
            uninspected=self.uninspected.inspected(
                self._expected_finds(plants, shown), self._variance_since_inspected
            ),
        )  # fmt: skip
        return _LearntDay(self, after, day, jumps * self.beyond)

    def _doubt_known(
        self,
        believed: tuple[Floats, Floats],
        inspections: tuple[NDArray[np.int32], NDArray[np.bool_], Floats],
    ) -> NDArray[np.int32]:
        """Doubt in place that plants known before are infested yet, where they only seemed clean.

        Return those that probably are not.
        """
        plants, found, detects = inspections
        asked = (self.chance[plants] > KNOWN) & ~np.isin(plants, plants[found])
        if not asked.any():
            return np.empty(0, np.int32)
        missed = np.ones(len(self.chance))
        np.multiply.at(missed, plants[asked], 1.0 - detects[asked])
        known = np.unique(plants[asked])
        overlooked = _STILL_INFESTED * missed[known]
        chance, both = believed
        scale = np.ones(len(chance))
        scale[known] = overlooked / (overlooked + 1.0 - _STILL_INFESTED) / chance[known]
        chance *= scale
        both[:] = pairs_scaled(both, self.grid.adjacent, scale, chance)
        return known[chance[known] < _PROBABLE]

    def _jumping(self, believed: tuple[Floats, Floats], ratio: float) -> NDArray[np.float32]:
        """Believe in what jumps have brought `ratio` times as much, in place; return the shares."""
        shares = self.shares.copy()
        afar = shares[:, JUMPED:].sum(axis=1, dtype=np.float64)
        rescale_traced(believed, self.grid.linked, afar, ratio)
        shares[:, JUMPED:] *= np.float32(ratio)
        shares /= shares.sum(axis=1, keepdims=True)
        return shares

    def _shown(self, plants: NDArray[np.int32], detects: Floats) -> Floats:
        """Return the chance that inspections find what is there, seen yet or not, ``(k,)``."""
        hidden = self._hidden(plants)
        return detects if hidden is None else detects * (1.0 - hidden)

    def _hidden(self, plants: NDArray[np.int32] | None = None) -> Floats | None:
        """Return the share of plants' chances that no inspection can see, ``(k,)``; None: none."""
        if self.cohorts is not None and self.cohorts.ages:
            return self.cohorts.hidden if plants is None else self.cohorts.hidden[plants]
        if self.latency is not None and self.latency.matters:
            return self.latency.hidden(
                self.chance if plants is None else self.chance[plants], plants
            )
        return None

    def _expected_finds(self, plants: NDArray[np.int32], shown: Floats) -> float:
        """Return how many finds are expected among plants ``(k,)`` that were not found yet."""
        chance = self.chance[plants]
        return float(shown @ np.where(chance > KNOWN, 0.0, chance))

    def lowered(self, after: TracedPairs, day: TracedDay, beyond: Floats) -> Floats:
        """Return how much less likely plants are as no relatives were found about them, ``(n,)``.

        What clean inspections took from the chances about a plant, it would have infested, or
        would have been infested by, in that proportion.
        """
        sent = self.reach.brought(day.dropped, beyond) * after.unseen / after.chance
        sent += self.reach.brought(day.cleared * self.unseen, beyond, back=True)
        return np.exp(-np.minimum(sent, _MOST_LOWERED))

    def counting(self, before: TracedPairs, day: TracedDay) -> TracedPairs:
        """Return the same with each origin believed as it now counts."""
        expected = day.expected / before.counts.scale
        expected[JUMPED:] /= max(self.jumps, _LEAST_JUMPS)
        counts = self.counts.and_those(day.found, expected)
        ratio = counts.scale / before.counts.scale
        scaled = self.shares * ratio.astype(np.float32)
        total = np.maximum(scaled.sum(axis=1, dtype=np.float64), LEAST_CHANCE)
        shares = scaled / total[:, None].astype(np.float32)
        return replace(self.times(total), shares=shares, counts=counts)

    def times(self, scale: Floats) -> TracedPairs:
        """Return the same with all chances ``(n,)`` times a scale, but those of known finds."""
        scale = np.where(self.chance > KNOWN, 1.0, scale)
        chance = np.clip(self.chance * scale, LEAST_CHANCE, np.maximum(self.chance, _UNKNOWN))
        both = pairs_scaled(self.pair_chance, self.grid.adjacent, scale, chance)
        return replace(self, chance=chance, pair_chance=both)

    def overnight(self, spread: Spread) -> TracedPairs:
        """Return what is believed the next morning."""
        night = TracedNight(self, spread)
        morning = self._with_ancestry(night.morning(tells_apart=True), night)
        others = self.others and tuple(one.overnight(spread) for one in self.others)
        return replace(self._in_doubt(morning, night), others=others)

    def _in_doubt(self, morning: TracedPairs, night: TracedNight) -> TracedPairs:
        """Return the next morning with what is in doubt of it if nobody inspected today."""
        told = self.chance > KNOWN
        known, counted = int(np.count_nonzero(told)), self.uninspected.counted
        if counted is not None:  # others became likely only while nobody inspected
            known = min(known, counted.known)
        # of those of which it is not certain
        before, after = (max(float(b.chance.sum()) - known, LEAST_CHANCE) for b in (self, morning))
        anywhere, by_edge = night.from_outside(self.reach)
        new = float(((1.0 - self.chance) * (anywhere + by_edge)).sum())
        sent = max(after - before - new, 0.0) * known / (known + before)
        if self.uninspected.begins:
            drawn, none = drawn_numbers(self.grid, (self.chance, self.pair_chance), ~told)
            counted = Counted(drawn / before, none, before, self.doubt, known)
        uninspected = self.uninspected.overnight(before, after, (new, sent), counted)
        return replace(morning, uninspected=uninspected)

    def in_hindsight(self, spread: Spread) -> TracedPairs:
        """Return the same as the ancestry of finds has it by now, before the night of a `spread`.

        It is what to tell in the evening; the night begins without it, as it would count twice.
        The ancestry is the one that the next morning is told by: another draw may believe twice as
        much, and the number would jump overnight.
        """
        if self.ancestry is None or not self.ancestry.waits:
            return self
        night = TracedNight(self, spread)
        by_origins = night.morning(tells_apart=False)
        morning = self._with_ancestry(by_origins, night)
        # what was found and treated today can only come back in the night
        scale = np.where(self.chance > AS_GOOD_AS_CLEAN, morning.chance / by_origins.chance, 1.0)
        told = self.times(scale)
        return _levelled(replace(told, ancestry=morning.ancestry))

    def _with_ancestry(self, by_origins: TracedPairs, night: TracedNight) -> TracedPairs:
        """Return what both maps say after a night."""
        if self.ancestry is None:
            return by_origins
        hiding = self.latency.likely if self.latency is not None else self.ancestry.hiding
        # what goes far comes from anywhere
        sends = night.sends * (1.0 - self.reach.anywhere)
        arrives = told_from_outside(self.reach, night.spread)
        told = ToldNight(sends, arrives, wind_m_s=by_origins.wind_m_s)
        if isinstance(night.spread, PestSpread):
            told = told._replace(length=(night.spread.days, *night.spread.warmth))
        ancestry, chance = replace(self.ancestry, hiding=hiding).overnight(told)
        if chance is not None:
            # a logarithmic pool of both maps (Genest & Zidek 1986)
            odds = _BOTH * _odds(chance) ** _ANCESTRY * _odds(by_origins.chance) ** _ORIGINS
            both = np.where(ancestry.left, by_origins.chance, odds / (1.0 + odds))
            by_origins = by_origins.times(both / by_origins.chance)
        elif ancestry.is_old:
            ancestry = ancestry.anew(by_origins.chance)
        return _levelled(replace(by_origins, ancestry=ancestry))

    def untold_night(self, spread: Spread) -> TracedPairs:
        """Return the same chances next morning; where they came from is not told apart any more.

        No find can be traced by it, but it is worked out in half the time.
        """
        night = TracedNight(self, spread)
        return self._in_doubt(night.morning(tells_apart=False), night)

    @property
    def arrivals_found(self) -> float:
        """How many finds came from outside of the plot, as the season's inspections have it."""
        return float(self.counts.found[[ANYWHERE, BY_EDGE]].sum())

    def treated(self, left: Floats) -> TracedPairs:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        start, other = self.grid.adjacent
        # found since the night, and treated then
        found = (self.unseen == 0.0) & (self.chance < _PROBABLE)
        apart = np.repeat(found, np.diff(start)) | found[other]
        believed = self.chance, self.pair_chance
        chance, together = pairs_left(believed, self.grid, left, apart)
        latency = self.latency and self.latency.treated(left)
        ancestry = self.ancestry and self.ancestry.anew(chance)
        others = self.others and tuple(one.treated(left) for one in self.others)
        return replace(
            self, chance=chance, pair_chance=together, latency=latency, ancestry=ancestry,
            others=others,
        )  # fmt: skip


class _LearntDay(NamedTuple):
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

    before: TracedPairs
    after: TracedPairs
    day: TracedDay
    beyond: Floats

    @property
    def likely(self) -> float:
        """The logarithm of how likely the map is by now."""
        return self.after.likely

    def settled(self) -> TracedPairs:
        """Return what is believed of the whole plot by that."""
        lowered = self.after.times(self.before.lowered(self.after, self.day, self.beyond))
        return _levelled(lowered.counting(self.before, self.day))


def _levelled(belief: TracedPairs) -> TracedPairs:
    """Return the same, what may hide being part of the chances as they are by now."""
    latency = belief.latency and belief.latency.levelled(belief.chance)
    return replace(belief, latency=latency)


def _odds(chance: Floats) -> Floats:
    odds: Floats = chance / (1.0 - chance)
    return odds
