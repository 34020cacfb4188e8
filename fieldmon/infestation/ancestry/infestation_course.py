"""From which morning on infestations can be seen, and send something out, by when they begin.

Mornings are counted as in `drawn_ancestry`: what began before the season is grown by its first
morning.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.insects.cohorts import Age
from fieldmon.infestation.insects.latency import HIDDEN_NIGHTS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.pests.pest import Pest

    Floats = NDArray[np.floating[Any]]
    Ints = NDArray[np.int64]

#: how many nights before the season are thought of
BEFORE = 6


class Course(NamedTuple):
    """How infestations go on that begin on t mornings.

    Parameters
    ----------
    shows
        ``(k, t)`` the morning from which on one can be seen, as each of k candidates has it.
    likely
        ``(k,)`` how likely each of them is.
    grown
        ``(t,)`` the morning from which on it sends something out at night.
    grown_by
        ``(t,)`` the last one to begin that has grown by a morning.
    """

    shows: Ints
    likely: Floats
    grown: Ints
    grown_by: Ints

    def __repr__(self) -> str:
        return f"<Course of {len(self.grown)} mornings>"

    @classmethod
    def that_may_hide(cls, mornings: int, likely: Floats) -> Course:
        """Return it where nobody named the pest: it may hide, and sends something out at once.

        `likely` ``(4,)`` are the chances of each of `HIDDEN_NIGHTS`.
        """
        begins = np.arange(mornings)
        shows = [
            np.where(begins <= BEFORE, begins, np.minimum(begins + nights, mornings - 1))
            for nights in HIDDEN_NIGHTS
        ]
        return cls(np.array(shows), likely, begins, begins)

    @classmethod
    def of_pest(cls, pest: Pest, nights: Floats) -> Course:
        """Return it for a pest whose season's nights were so long, and so warm for each stage.

        `nights` are ``(t - BEFORE - 1, 1 + stages)``, days and degree-days.
        """
        mornings = BEFORE + len(nights) + 1
        shows, grown = np.arange(mornings), np.arange(mornings)
        for begins in range(BEFORE + 1, mornings):
            ages = [Age()]
            for days, *warmth in nights[begins - BEFORE :].tolist():
                ages.append(ages[-1].older(pest, tuple(warmth), days))
            shows[begins] += _first([age.visible(pest) for age in ages])
            grown[begins] += _first([age.mobile(pest) for age in ages])
        # one that began later never is grown earlier
        grown_by = np.searchsorted(grown, np.arange(mornings), side="right") - 1
        return cls(shows[None], np.ones(1), grown, grown_by)

    @property
    def delays(self) -> bool:
        """Tell whether any of them grows before it sends something out."""
        return bool((self.grown_by < np.arange(len(self.grown_by))).any())

    def sending(self, so_far: Floats) -> Floats:
        """Return how many send something out, of how many there are so far, ``(t, n)`` each."""
        return so_far[self.grown_by] if self.delays else so_far


def _first(true: list[bool]) -> int:
    """Return the first place that is true, or the last one."""
    return true.index(True) if True in true else len(true) - 1
