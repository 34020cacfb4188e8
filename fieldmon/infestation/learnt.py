"""What a season's own inspections tell of its insects, with intervals."""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import chance_figure, estimate, worded
from fieldmon.infestation.ancestry.origins import (
    ANYWHERE,
    AT_START,
    AT_START_ELSEWHERE,
    BY_EDGE,
    JUMPED,
    SIGMAS,
    Estimate,
)
from fieldmon.infestation.insects.jump_reach import kernel_means
from fieldmon.infestation.insects.pest_in_weather import PestSpread
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.plot_estimate import estimate_plot
from fieldmon.infestation.tracing.traced_pairs import TracedPairs

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.belief import Belief


@dataclass(frozen=True)
class Learnt:
    """A number that the inspections of a season tell: the best guess, and an interval of 90 %.

    Parameters
    ----------
    name
        ``"detection"``, ``"infested at the start"`` (plants), ``"arrivals a night"`` (plants),
        ``"jumps beyond neighbours"`` (the chance that insects do), ``"length of jumps"``
        (plants, if they do), ``"hiding"`` (the chance that new infestations hide for nights), or
        ``"more than told"`` (the share that the map goes on with, as if it had been told).
    value, low, high
        The guess and the interval; both ends are the guess where the number is a chance itself.
    told
        What the file of the pest says of it; None: nothing, or there is none.
    """

    name: str
    value: float
    low: float
    high: float
    told: float | None = None

    @property
    def is_share(self) -> bool:
        """Tell whether it is a chance or a share, not a number of plants."""
        return self.name in _SHARES

    def sentence(self) -> Worded:
        """Return it in words, the interval in brackets."""
        value, low, high = (
            chance_figure(one) if self.is_share else estimate(one)
            for one in (self.value, self.low, self.high)
        )
        if self.name == "detection":
            return worded(
                "An inspection finds {value} of what is there ({low} to {high}).",
                value=value,
                low=low,
                high=high,
            )
        if self.name == _INFESTED_AT_START:
            return worded(
                "{value} plants were infested at the start ({low} to {high}).",
                value=value,
                low=low,
                high=high,
            )
        if self.name == "arrivals a night":
            said = {"value": value, "low": low, "high": high}
            if self.told is None or (told := estimate(self.told)) == value:
                return worded(
                    "{value} plants a night are infested from outside ({low} to {high}).", **said
                )
            return worded(
                "{value} plants a night are infested from outside ({low} to {high}); the file of "
                "the pest says {told}.",
                **said,
                told=told,
            )
        if self.name == "length of jumps":
            return worded(
                "If they do, jumps go {value} plants on average ({low} to {high}).",
                value=value,
                low=low,
                high=high,
            )
        return self._guess_alone()

    def _guess_alone(self) -> Worded:
        """Return it in words where there is no interval to tell."""
        chance = chance_figure(self.value)
        if self.name == "hiding":
            return worded(
                "New infestations hide for some nights with a chance of {value}.", value=chance
            )
        if self.name == "more than told":
            return worded(
                "Far more was found than was told: the map goes on as if {value} of the plants had "
                "been told.",
                value=chance,
            )
        return worded("Insects jump beyond the next plant with a chance of {value}.", value=chance)


_INFESTED_AT_START = "infested at the start"
_SHARES = ("detection", "jumps beyond neighbours", "hiding", "more than told")
# a chance below this is said to be 0 %: how far insects would jump is then of no use
_SAID = 0.005


def worth_saying(learnt: Iterable[Learnt]) -> tuple[Learnt, ...]:
    """Return what there is to say: nothing of the length of jumps where insects do not jump."""
    told = tuple(learnt)
    no_jumps = any(one.name == "jumps beyond neighbours" and one.value < _SAID for one in told)
    return tuple(one for one in told if not (no_jumps and one.name == "length of jumps"))


def learnt_from(
    belief: Belief, detection: float, night: Spread | None = None
) -> tuple[Learnt, ...]:
    """Return what a belief has learnt, where inspections were told to have a `detection`.

    Nothing for beliefs that learn no more than where the insects are.

    Parameters
    ----------
    belief
        What is believed.
    detection
        What inspections were told to find of what is there.
    night
        What insects are told to do in a night; None: as they do where nobody said anything.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.infestation.tracing.traced_pairs import TracedPairs
    >>> from fieldmon.plot.layout import rectangle
    >>> at_first = TracedPairs.of(rectangle(9, 9), np.full(81, 0.02))
    >>> learnt_from(at_first, 0.84)[0].sentence()
    'An inspection finds 84 % of what is there (71 % to 94 %).'
    """
    if not isinstance(belief, TracedPairs):
        return ()
    found = belief.counts.detection(detection)
    spread = Spread() if night is None else night
    at_start, arrivals = _come_from_none(belief, spread)
    jumps = belief.jumps
    return (
        *_more_than_told(belief),
        Learnt("detection", found.value, found.low, found.high),
        Learnt(_INFESTED_AT_START, *astuple(at_start)),
        replace(
            Learnt("arrivals a night", *astuple(arrivals)), told=_told_to_arrive(belief, spread)
        ),
        Learnt("jumps beyond neighbours", jumps, jumps, jumps),
        *_length(belief),
        *_hiding(belief),
    )


def with_start(
    learnt: Iterable[Learnt], ever: Estimate, first: Estimate | None = None, since: float = 1.0
) -> tuple[Learnt, ...]:
    """Return the same with as many infested at the start as can be where so many `ever` were.

    On the first evening these are the same plants; later what is learnt counts as far as it rests
    on inspections made since, so that a day without results, or with few, changes it no more.

    Parameters
    ----------
    learnt
        What is learnt. The number at the start is by the ancestry of finds, and `ever` by the
        chance map, which is pooled of two.
    ever
        How many plants have been infested by now: all that were found, and those not found yet.
    first
        How many had been on the season's first evening; None: nothing was inspected on that day.
    since
        The share of the inspections that were made after it.
    """

    def agreeing(one: Learnt) -> Learnt:
        at_start = Estimate(one.value, one.low, one.high).at_most(ever)
        at_start = at_start if first is None else first.mixed(at_start, since)
        return Learnt(one.name, *astuple(at_start))

    return tuple(agreeing(one) if one.name == _INFESTED_AT_START else one for one in learnt)


def _told_to_arrive(belief: TracedPairs, night: Spread) -> float | None:
    """Return how many plants a night the file of the pest says; None: no pest was named."""
    if not isinstance(night, PestSpread):
        return None
    return len(belief.chance) * sum(belief.said_from_outside(night))


def _come_from_none(belief: TracedPairs, night: Spread) -> tuple[Estimate, Estimate]:
    """Return how many were infested at the start, and how many a night are from outside.

    By the ancestry of finds where there is one: of 61 at the start it says 57 to 67 (a week of
    24 seasons in ten worlds). The origins of finds say 28 to 64: whatever was at the start and
    was never found is not among them.
    """
    if belief.ancestry is not None:
        at_start = belief.ancestry.infested_at_start
        if at_start is not None:
            return at_start, belief.ancestry.arrivals
    n, estimate = len(belief.chance), belief.counts.estimate
    anywhere, by_edge = belief.told_from_outside(night)
    suspected, elsewhere = map(float, belief.at_start)
    # an earlier season tells of other origins, but never of those at the start
    if belief.counts.expected[[AT_START, AT_START_ELSEWHERE]].any():
        at_start = estimate(AT_START, suspected) + estimate(AT_START_ELSEWHERE, elsewhere)
    else:
        # nothing was inspected yet: in as much doubt as what is there now
        now = estimate_plot(belief.grid, belief.chance, belief.pair_chance, doubt=belief.doubt)
        told = (suspected + elsewhere) / now.expected
        at_start = Estimate(suspected + elsewhere, now.low * told, now.high * told)
    return (
        at_start,
        estimate(ANYWHERE, n * anywhere) + estimate(BY_EDGE, n * by_edge),
    )


def _hiding(belief: TracedPairs) -> tuple[Learnt, ...]:
    """Return whether new infestations hide; nothing where the pest that was named says it."""
    if belief.latency is None:
        return ()
    hides = 1.0 - float(belief.latency.likely[0])
    return (Learnt("hiding", hides, hides, hides),)


def _more_than_told(belief: TracedPairs) -> tuple[Learnt, ...]:
    """Return as if which share had been told the map goes on, where far more is infested."""
    if not belief.is_heavier:
        return ()
    share = float(belief.at_start.sum()) / len(belief.chance)
    return (Learnt("more than told", share, share, share),)


def _length(belief: TracedPairs) -> tuple[Learnt, ...]:
    """Return how far jumps go on average, to first order in what is not known of the kernels.

    Nothing where all land anywhere.
    """
    if not belief.beyond.any():
        return ()
    share = belief.beyond / belief.beyond.sum()
    means = kernel_means(belief.reach.cells.size_m, belief.reach.kernels)
    mean = float(share @ means)
    doubt = share * (means - mean) * belief.counts.doubt[JUMPED:]
    off = SIGMAS * float(np.sqrt((doubt**2).sum()))
    return (Learnt("length of jumps", mean, max(mean - off, 1.0), mean + off),)
