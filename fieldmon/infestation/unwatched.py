"""How doubtful the number of infested plants becomes while nobody inspects.

From one day's inspections to the next day's a chance map says itself how far its number may be off:
so it is in seasons that are inspected daily. Of days without inspections it does not know that the
rate at which insects multiply is a guess, nor how they behave otherwise than it believes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: how far a number may be off beyond what the chance map says of itself, where nobody named the
#: pest and where somebody did; and how far the logarithm of the rate at which it grows (1 sigma;
#: our choice)
LEVEL_DOUBT, OF_A_PEST = 0.3, 0.25
RATE_DOUBT = 0.5


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
    looked
        Whether somebody inspected today.
    """

    days: int = 0
    grown: float = 0.0
    left: float = 0.0
    looked: bool = False

    def variance(self, *, named: bool) -> float:
        """Return by how much the logarithm of the number varies; `named` tells of a named pest.

        Examples
        --------
        >>> morning = Unwatched(looked=True).overnight(0.2)
        >>> morning.variance(named=False)
        0.0
        >>> round(morning.overnight(0.2).variance(named=False), 2)
        0.13
        """
        if self.days == 0:
            return self.left
        level = OF_A_PEST if named else LEVEL_DOUBT
        return self.left + level**2 + (RATE_DOUBT * self.grown) ** 2

    def inspected(self, found: float, *, named: bool) -> Unwatched:
        """Return the same after inspections that were expected to find so many.

        Each find that was to be expected tells as much of the number as in a Poisson law.
        """
        variance = self.variance(named=named)
        return Unwatched(left=variance / (1.0 + variance * found), looked=True)

    def overnight(self, grown: float) -> Unwatched:
        """Return the same after a night by whose logarithm the expected number grows."""
        if self.looked:
            return Unwatched(grown=grown, left=self.left)
        return Unwatched(self.days + 1, self.grown + grown, self.left)

    @property
    def array(self) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        """What to keep of it on a morning, ``(3,)``."""
        return np.array(self[:3], np.float64)

    @classmethod
    def of_array(cls, kept: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Unwatched:
        """Return what such an array has kept."""
        days, grown, left = map(float, kept)
        return cls(int(days), grown, left)
