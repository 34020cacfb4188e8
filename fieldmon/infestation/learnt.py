"""What a season's own inspections tell of its insects, with intervals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import written
from fieldmon.infestation.origins import (
    ANYWHERE,
    ARRIVE,
    ARRIVE_BY_EDGE,
    AT_START,
    AT_START_ELSEWHERE,
    BY_EDGE,
    JUMPED,
)
from fieldmon.infestation.reach import kernel_means
from fieldmon.infestation.traced_pairs import TracedPairs

if TYPE_CHECKING:
    from fieldmon.infestation.belief import Belief

# 90 % of a normal distribution lie within so many standard deviations
_SIGMAS = 1.645


@dataclass(frozen=True)
class Learnt:
    """A number that the inspections of a season tell: the best guess, and an interval of 90 %.

    Parameters
    ----------
    name
        ``"detection"``, ``"infested at the start"`` (plants), ``"arrivals a night"`` (plants),
        ``"jumps beyond neighbours"`` (the chance that insects do), or ``"length of jumps"``
        (plants, if they do).
    value, low, high
        The guess and the interval; both ends are the guess where the number is a chance itself.
    """

    name: str
    value: float
    low: float
    high: float

    @property
    def is_share(self) -> bool:
        """Tell whether it is a chance or a share, not a number of plants."""
        return self.name in _SHARES

    def sentence(self) -> str:
        """Return it in words."""
        form = ".0%" if self.is_share else ".1f"
        if self.low == self.high:
            return f"{self.name} {written(self.value, form)}"
        between = f"{written(self.low, form)} to {written(self.high, form)}"
        return f"{self.name} {written(self.value, form)} ({between})"


_SHARES = ("detection", "jumps beyond neighbours")


def learnt_from(belief: Belief, detection: float) -> tuple[Learnt, ...]:
    """Return what a belief has learnt, where inspections were told to have a `detection`.

    Nothing for beliefs that learn no more than where the insects are.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.infestation.traced_pairs import TracedPairs
    >>> from fieldmon.plot.layout import rectangle
    >>> at_first = TracedPairs.of(rectangle(9, 9), np.full(81, 0.02))
    >>> learnt_from(at_first, 0.84)[0].sentence()
    'detection 84 % (71 % to 94 %)'
    """
    if not isinstance(belief, TracedPairs):
        return ()
    n, counts = len(belief.chance), belief.counts
    found = counts.detection(detection)
    suspected = counts.estimate(AT_START, float(belief.at_start[0]))
    elsewhere = counts.estimate(AT_START_ELSEWHERE, float(belief.at_start[1]))
    anywhere = counts.estimate(ANYWHERE, n * ARRIVE)
    edge = counts.estimate(BY_EDGE, n * ARRIVE_BY_EDGE)
    jumps = belief.jumps
    return (
        Learnt("detection", found.value, found.low, found.high),
        Learnt(
            "infested at the start",
            suspected.value + elsewhere.value,
            suspected.low + elsewhere.low,
            suspected.high + elsewhere.high,
        ),
        Learnt(
            "arrivals a night",
            anywhere.value + edge.value,
            anywhere.low + edge.low,
            anywhere.high + edge.high,
        ),
        Learnt("jumps beyond neighbours", jumps, jumps, jumps),
        _length(belief),
    )


def _length(belief: TracedPairs) -> Learnt:
    """Return how far jumps go on average, to first order in what is not known of the kernels."""
    share = belief.beyond / belief.beyond.sum()
    means = kernel_means(belief.reach.cells.size_m, belief.reach.kernels)
    mean = float(share @ means)
    doubt = share * (means - mean) * belief.counts.doubt[JUMPED:]
    off = _SIGMAS * float(np.sqrt((doubt**2).sum()))
    return Learnt("length of jumps", mean, max(mean - off, 1.0), mean + off)
