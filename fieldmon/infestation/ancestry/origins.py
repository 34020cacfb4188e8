"""Where infestations come from, and how a season's own inspections tell how often they do.

Each chance is a sum of what each origin brought. An inspection expects so much of a find from each,
and a find is shared out among them in that proportion (stochastic declustering: Zhuang, Ogata &
Vere-Jones 2002). An origin that brings more finds than expected brings more in future, and what it
brought already counts for more. So chances mean what they say where the model does not hold.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import gammaincinv

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: infested on the first morning, among plants that the first map suspected as much as the average
#: one or more, and among the others; from outside, anywhere or by the plot's edge; by the plant
#: beside it; overlooked at an inspection; and by jumps of each kernel of `jump_reach.kernels`, from
#: `JUMPED` on
AT_START, ANYWHERE, BY_EDGE, BY_ADJACENT, OVERLOOKED, AT_START_ELSEWHERE, JUMPED = range(7)
N_ORIGINS = JUMPED + 6
# how many finds what was believed before the season is worth, of each origin (our choice): little
# where a plot's insects differ most from another's
_PRIOR_FINDS = np.full(N_ORIGINS, 5.0)
_PRIOR_FINDS[[AT_START, AT_START_ELSEWHERE]] = 1.0
_PRIOR_FINDS[[ANYWHERE, BY_EDGE]] = 0.5
#: share of the plants infested from outside in a night, at least, anywhere and by the edge, before
#: anything was found (our choice)
ARRIVE, ARRIVE_BY_EDGE = 0.0002, 0.0001
#: 90 % of a normal distribution lie within so many standard deviations
SIGMAS = 1.645
# inspections are taken to overlook so much at least and at most
_DETECTS = (0.05, 0.99)


@dataclass(frozen=True)
class Estimate:
    """A number that a season's inspections tell: the best guess, and the interval of 90 %."""

    value: float
    low: float
    high: float

    @classmethod
    def of_rate(cls, finds: float, expected: float, times: float = 1.0) -> Estimate:
        """Return `times` the rate that so many finds tell, where so many were expected (Gamma)."""
        low, high = gammaincinv(finds, (0.05, 0.95)) / expected
        return cls(times * finds / expected, times * float(low), times * float(high))

    def __add__(self, other: Estimate) -> Estimate:
        """Return the estimate of both numbers together, as wide as if both were off alike."""
        return Estimate(self.value + other.value, self.low + other.low, self.high + other.high)

    def mixed(self, other: Estimate, share: float) -> Estimate:
        """Return the estimate that has so large a share of another, end by end."""
        both = zip(astuple(self), astuple(other), strict=True)
        return Estimate(*((1.0 - share) * one + share * two for one, two in both))

    def at_most(self, other: Estimate) -> Estimate:
        """Return the estimate of a number of which it is known that it is no more than another."""
        ends = min(self.low, other.low), min(self.high, other.high)
        return Estimate(min(self.value, other.value), *ends)


@dataclass(frozen=True, eq=False)
class OriginCounts:
    """Finds of each origin, and those that would be expected if it were as was believed at first.

    Parameters
    ----------
    found, expected
        ``(N_ORIGINS,)`` each, over the season so far.
    """

    found: Floats
    expected: Floats

    def __repr__(self) -> str:
        return f"<OriginCounts: {self.found.sum():.0f} finds, {self.expected.sum():.1f} expected>"

    @classmethod
    def none(cls) -> OriginCounts:
        """Return what is known before anything was inspected."""
        return cls(np.zeros(N_ORIGINS), np.zeros(N_ORIGINS))

    def and_those(self, found: Floats, expected: Floats) -> OriginCounts:
        """Return these with those of a day."""
        return replace(self, found=self.found + found, expected=self.expected + expected)

    @property
    def scale(self) -> Floats:
        """Return how many times as much each origin brings as was believed at first."""
        scale: Floats = (_PRIOR_FINDS + self.found) / (_PRIOR_FINDS + self.expected)
        return scale

    @property
    def doubt(self) -> Floats:
        """Return how far each scale may be off, as a share of it (1 sigma), ``(N_ORIGINS,)``."""
        doubt: Floats = 1.0 / np.sqrt(_PRIOR_FINDS + self.found)
        return doubt

    def estimate(self, origin: int, times: float = 1.0) -> Estimate:
        """Return `times` the scale of an origin: a gamma distribution of it, 5 % to 95 %."""
        prior = float(_PRIOR_FINDS[origin])
        found, expected = float(self.found[origin]), float(self.expected[origin])
        return Estimate.of_rate(prior + found, prior + expected, times)

    def detects(self, told: Floats) -> Floats:
        """Return what inspections really detect, ``(k,)``, where they are `told` to."""
        detects: Floats = np.clip(1.0 - (1.0 - told) * self.scale[OVERLOOKED], *_DETECTS)
        return detects

    def detection(self, told: float) -> Estimate:
        """Return the detection as the season tells it, where it was `told`."""
        missed = self.estimate(OVERLOOKED, 1.0 - told)
        value, low, high = np.clip(
            1.0 - np.array([missed.value, missed.high, missed.low]), 0.0, 1.0
        )
        return Estimate(float(value), float(low), float(high))
