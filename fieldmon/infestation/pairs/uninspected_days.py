"""How doubtful the number of infested plants becomes while nobody inspects.

From one day's inspections to the next day's a chance map says itself how far its number may be off:
so it is in seasons that are inspected daily. Of days without inspections it does not know that the
rate at which insects multiply is a guess, nor how they behave otherwise than it believes.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import gammaincinv, nbdtrik, ndtri, pdtrik

from fieldmon.compute.arrays import read_only

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: how far a number may be off beyond what the chance map says of itself; and how far the logarithm
#: of the rate at which it grows (1 sigma; our choice)
LEVEL_DOUBT = 0.3
RATE_DOUBT = 0.5
# what arrives from outside is a guess of ours: how many finds it is worth, and how many of those
# found are not told from others. So it may well be that nothing arrives, or many times as much
_ARRIVALS_KNOWN, _NOT_TOLD = 0.35, 3.0
# an inspection is worth no more than of a number that is as doubtful as this
_MOST_VARIANCE = 1.0
# draws that are spread evenly: steps by the roots of 3, 7, 11, 13 and 17, as others are by those of
# 2 and 5
_STEPS = 0.7320508075688772, 0.6457513110645907, 0.3166247903553998
_WHOLE_STEPS = 0.605551275463989, 0.123105625617661
# of more than this whole numbers tell nothing
_FEW = 1e3
# more growth than this, as a logarithm, would be no number
_MOST_GROWN = 100.0
_LEAST = 1e-9


def arrivals_known(found: float) -> float:
    """Return by how many finds it is known what arrives, of so many that came from outside."""
    return _ARRIVALS_KNOWN + max(found - _NOT_TOLD, 0.0)


class Counted(NamedTuple):
    """How many were infested on the first morning without inspections, as the chance map had it.

    Parameters
    ----------
    drawn
        ``(k,)`` in drawn fields, over what was expected.
    none
        Logarithm of the chance that there were none.
    expected
        How many were expected.
    doubt
        How far that might be off by then, as a share (`Belief.doubt`).
    known
        How many more there were of which it was certain.
    """

    drawn: Floats
    none: float
    expected: float
    doubt: float
    known: int = 0


class Since(NamedTuple):
    """What a number may have become on days without inspections.

    Parameters
    ----------
    counted
        How many there were on the first morning of them.
    grew
        ``(k,)`` draws of how many times as many these are now: nothing heals.
    came
        ``(k,)`` draws of what arrived or was sent out by known plants, over all that is expected
        now.
    now
        How many are expected now, had nothing been treated since.
    """

    counted: Counted
    grew: Floats
    came: Floats
    now: float

    @property
    def times(self) -> Floats:
        """By what the number now may have to be multiplied, of all plants together, ``(k,)``."""
        return self.grew * (self.counted.expected / self.now) + self.came

    def numbers(self, factors: Floats, expected: float, n: int) -> Floats:
        """Return how many there may be of n plants, ``(k,)``, where so many are expected.

        Parameters
        ----------
        factors
            ``(k,)`` by what the odds of being infested may have to be multiplied.
        expected
            How many are expected now.
        n
            How many plants may be infested.
        """
        one, other = ((np.arange(len(factors)) + 1) * step % 1.0 for step in _WHOLE_STEPS)
        left = self.counted.expected * expected / self.now
        then = of_odds(self.counted.drawn * left, factors, max(n, 1))
        # each multiplies by itself, as in a birth process (Yule 1925)
        more = np.maximum(self.grew, 1.0 + _LEAST)
        few = np.maximum(then, _LEAST)
        born = np.where(few < _FEW, np.ceil(nbdtrik(one, few, 1.0 / more)), few * (more - 1.0))
        grown = then + np.maximum(np.nan_to_num(born), 0.0)
        here = np.where(self.grew > 1.0, grown, then * self.grew)
        numbers: Floats = np.minimum(here + _whole(expected * self.came, other), n)
        return numbers

    def chance_of_none(self, factors: Floats, expected: float) -> float:
        """Return the chance that there is none now: none was there, and none arrived."""
        none = self.counted.none * factors * (expected / self.now) - expected * self.came
        return float(np.exp(none).mean())


def of_odds(counts: Floats, factors: Floats, n: int) -> Floats:
    """Return numbers of n plants whose odds are so many times as high, as finds change a level."""
    # never more than there are plants; where all are infested, odds have no bound, and the least
    # factor may be 0
    share = np.minimum(counts / n, 1.0 - 1e-12)
    changed: Floats = np.minimum(counts * factors / (1.0 + share * (factors - 1.0)), n)
    return changed


def _whole(mean: Floats, places: NDArray[np.floating[Any]]) -> Floats:
    """Return whole numbers with such means, as by a Poisson law, at places spread evenly."""
    few = np.nan_to_num(pdtrik(places, np.clip(mean, _LEAST, _FEW)))
    return np.where(mean < _FEW, np.maximum(np.ceil(few), 0.0), mean)


@lru_cache(maxsize=8)
def _even_draws(n: int, known: float) -> tuple[Floats, Floats, Floats]:
    """Return draws of levels, of rates, and of what arrives, ``(n,)`` each, spread evenly.

    What arrives is `known` by so many finds.
    """
    one, other, third = ((np.arange(n) + 1) * step % 1.0 for step in _STEPS)
    levels = gammaincinv(LEVEL_DOUBT**-2.0, one) * LEVEL_DOUBT**2.0
    faster = np.exp(RATE_DOUBT * ndtri(other))
    return read_only(levels), read_only(faster), read_only(gammaincinv(known, third))


class UninspectedDays(NamedTuple):
    """Days without inspections until now, and what of earlier ones is still in doubt.

    Parameters
    ----------
    days
        How many days without inspections there were since the last.
    grown
        The logarithm of how many times as many are expected as on the first morning of them.
    left
        The variance that is left of days without inspections before it.
    arrived
        The share of them that arrived from outside since, and of their offspring, leaving out
        those that were `sent`.
    sent
        The share of them that plants sent out since of which it is certain that they are infested,
        and of their offspring.
    looked
        Whether somebody inspected today.
    counted
        How many there were on that morning; None: there was no day without inspections.
    """

    days: int = 0
    grown: float = 0.0
    left: float = 0.0
    arrived: float = 0.0
    sent: float = 0.0
    looked: bool = False
    counted: Counted | None = None

    def variance(self, arrivals_found: float = 0.0) -> float:
        """Return by how much the number varies, as a share of it, squared.

        `arrivals_found` tells of finds that came from outside.
        """
        if self.days == 0:
            return self.left
        by_arrivals = self.arrived**2 / arrivals_known(arrivals_found)
        by_rate = RATE_DOUBT**2 * (self.grown**2 + self.sent**2)
        since = LEVEL_DOUBT**2 + by_rate + by_arrivals
        return self.left + min(since, _MOST_VARIANCE)

    def draws(self, arrivals_found: float = 0.0) -> Since | None:
        """Return what the number may have become; None: there was no day without inspections."""
        if self.counted is None:
            return None
        known = arrivals_known(arrivals_found)
        levels, faster, outside = _even_draws(len(self.counted.drawn), known)
        arrived = self.arrived * (1.0 - self.sent) * outside / known
        came = levels * (arrived + self.sent * faster)
        times = levels * np.exp(np.minimum(self.grown * faster, _MOST_GROWN))
        grew = np.maximum(times * (1.0 - self.arrived), min(float(np.exp(self.grown)), 1.0))
        now = self.counted.expected * float(np.exp(min(self.grown, _MOST_GROWN)))
        now /= max(1.0 - self.sent, _LEAST)
        return Since(self.counted, grew, came, now)

    def inspected(self, found: float, variance: float) -> UninspectedDays:
        """Return the same after inspections that were expected to find so many.

        Each find that was to be expected tells as much of the number as in a Poisson law.
        """
        return UninspectedDays(left=variance / (1.0 + variance * found), looked=True)

    @property
    def begins(self) -> bool:
        """Whether this is the first morning without inspections, if nobody comes today."""
        return self.counted is None and not self.looked

    def overnight(
        self,
        before: float,
        after: float,
        new: tuple[float, float] = (0.0, 0.0),
        counted: Counted | None = None,
    ) -> UninspectedDays:
        """Return the same after a night in which so many become so many.

        `new` are how many of these come from outside, and how many are sent out by plants of which
        it is certain that they are infested. `counted` tells of this morning, where it `begins`
        days without inspections.
        """
        if self.looked:
            return UninspectedDays(left=self.left)
        others = max(after - new[1], _LEAST)
        share, by_known = min(new[0] / others, 1.0), min(new[1] / after, 1.0)
        arrived = share + self.arrived * (1.0 - share)
        sent = by_known + self.sent * (1.0 - by_known)
        grown = self.grown + float(np.log(others / before))
        counted = self.counted if counted is None else counted
        return UninspectedDays(self.days + 1, grown, self.left, arrived, sent, counted=counted)

    @property
    def array(self) -> Floats:
        """What to keep of it on a morning, ``(5,)`` or, with what was counted, ``(9 + k,)``."""
        counted = () if self.counted is None else self.counted
        return np.concatenate([self[:5], *(np.atleast_1d(part) for part in counted[::-1])])

    @classmethod
    def of_array(cls, kept: Floats) -> UninspectedDays:
        """Return what such an array has kept."""
        days, grown, left, arrived, sent = map(float, kept[:5])
        counted = None
        if len(kept) > 5:
            known, doubt, expected, none = map(float, kept[5:9])
            counted = Counted(kept[9:], none, expected, doubt, int(known))
        return cls(int(days), grown, left, arrived, sent, counted=counted)
