"""How doubtful the number of infested plants becomes while nobody inspects.

From one day's inspections to the next day's a chance map says itself how far its number may be off:
so it is in seasons that are inspected daily. Of days without inspections it does not know that the
rate at which insects multiply is a guess, nor how they behave otherwise than it believes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import gammaincinv, ndtri, pdtrik

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: how far a number may be off beyond what the chance map says of itself, where nobody named the
#: pest and where somebody did; and how far the logarithm of the rate at which it grows (1 sigma;
#: our choice)
LEVEL_DOUBT, OF_A_PEST = 0.3, 0.25
RATE_DOUBT = 0.5
# what arrives from outside is a guess of ours: how many finds it is worth, and how many of those
# found are not told from others. So it may well be that nothing arrives, or many times as much
_ARRIVALS_KNOWN, _NOT_TOLD = 0.35, 3.0
# a single number tells of no more doubt than this
_MOST_VARIANCE = 1.0
# draws that are spread evenly: steps by the roots of 3, 7 and 11, as others are by those of 2 and 5
_DRAWS, _STEPS = 400, (0.7320508075688772, 0.6457513110645907, 0.3166247903553998)
# the roots of 13 and 17; and of more than this whole numbers tell nothing
_WHOLE_STEPS, _FEW = (0.605551275463989, 0.123105625617661), 1e3
#: more growth than this, as a logarithm, would be no number
MOST_GROWN = 100.0


def arrivals_known(found: float) -> float:
    """Return by how many finds it is known what arrives, of so many that came from outside."""
    return _ARRIVALS_KNOWN + max(found - _NOT_TOLD, 0.0)


class Since(NamedTuple):
    """What a number may have become since somebody inspected, as multiples of what is expected.

    Parameters
    ----------
    before
        How many there were then: nothing heals, however slowly they multiplied.
    inside, came
        ``(400,)`` even draws of what these have become, and of what arrived.
    idle
        Whether there were days without inspections; else the chance map says all of it.
    """

    before: float
    inside: Floats
    came: Floats
    idle: bool

    @property
    def times(self) -> Floats:
        """What the number may have become of all together, as a multiple, ``(400,)``."""
        return self.inside + self.came

    @property
    def unhealed(self) -> Floats:
        """How many of all are no offspring since: these were there, or arrived, ``(400,)``."""
        unhealed = self.before + self.came
        return unhealed if self.idle else np.minimum(unhealed, 1.0)

    def numbers(self, counts: Floats, n: int) -> Floats:
        """Return how many there may be of n plants, ``(400,)``, where so many are believed."""
        if not self.idle:
            return counts
        one, other = ((np.arange(_DRAWS) + 1) * step % 1.0 for step in _WHOLE_STEPS)
        then = _whole(counts * self.before, one) / self.before
        came = _whole(counts * self.came, other)
        numbers: Floats = np.minimum(then * self.inside + came, n)
        return numbers


def _whole(mean: Floats, places: NDArray[np.floating[Any]]) -> Floats:
    """Return whole numbers with such means, as by a Poisson law, at places spread evenly."""
    few = np.nan_to_num(pdtrik(places, np.clip(mean, 1e-9, _FEW)))
    return np.where(mean < _FEW, np.maximum(np.ceil(few), 0.0), mean)


class Unwatched(NamedTuple):
    """Days without inspections until now, and what of earlier ones is still in doubt.

    Parameters
    ----------
    days
        How many days without inspections there were since the last.
    grown
        The logarithm of how many times as many infested plants are expected as on that evening.
    left
        The variance that is left of days without inspections before it.
    arrived
        The share of them that arrived from outside since, and of their offspring.
    looked
        Whether somebody inspected today.
    """

    days: int = 0
    grown: float = 0.0
    left: float = 0.0
    arrived: float = 0.0
    looked: bool = False

    def variance(self, *, named: bool, arrivals_found: float = 0.0) -> float:
        """Return by how much the number varies, as a share of it, squared.

        `named` tells of a named pest, and `arrivals_found` of finds that came from outside.

        Examples
        --------
        >>> morning = Unwatched(looked=True).overnight(10.0, 12.0)
        >>> morning.variance(named=False)
        0.0
        >>> round(morning.overnight(12.0, 15.0).variance(named=False), 2)
        0.13
        """
        if self.days == 0:
            return self.left
        level = OF_A_PEST if named else LEVEL_DOUBT
        by_arrivals = self.arrived**2 / arrivals_known(arrivals_found)
        since = level**2 + (RATE_DOUBT * self.grown) ** 2 + by_arrivals
        return self.left + min(since, _MOST_VARIANCE)

    def draws(self, *, named: bool, arrivals_found: float = 0.0) -> Since:
        """Return what the number may have become since somebody inspected."""
        before = min(float(np.exp(-self.grown)), 1.0)
        if self.days == 0:
            ones = np.ones(_DRAWS)
            return Since(before, ones * (1.0 - self.arrived), ones * self.arrived, idle=False)
        one, other, third = ((np.arange(_DRAWS) + 1) * step % 1.0 for step in _STEPS)
        level = OF_A_PEST if named else LEVEL_DOUBT
        levels = gammaincinv(level**-2.0, one) * level**2.0
        faster = np.exp(RATE_DOUBT * ndtri(other))
        known = arrivals_known(arrivals_found)
        came = self.arrived * gammaincinv(known, third) / known
        grew = np.exp(np.minimum(self.grown * (faster - 1.0), MOST_GROWN))
        return Since(before, levels * grew * (1.0 - self.arrived), levels * came, idle=True)

    def inspected(self, found: float, variance: float) -> Unwatched:
        """Return the same after inspections that were expected to find so many.

        Each find that was to be expected tells as much of the number as in a Poisson law.
        """
        return Unwatched(left=variance / (1.0 + variance * found), looked=True)

    def overnight(self, before: float, after: float, new: float = 0.0) -> Unwatched:
        """Return the same after a night in which so many become so many, some from outside."""
        grown, share = float(np.log(after / before)), min(new / after, 1.0)
        if self.looked:
            return Unwatched(0, grown, self.left, share)
        arrived = share + self.arrived * (1.0 - share)
        return Unwatched(self.days + 1, self.grown + grown, self.left, arrived)

    @property
    def array(self) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        """What to keep of it on a morning, ``(4,)``."""
        return np.array(self[:4], np.float64)

    @classmethod
    def of_array(cls, kept: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Unwatched:
        """Return what such an array has kept."""
        days, grown, left, arrived = map(float, kept)
        return cls(int(days), grown, left, arrived)
