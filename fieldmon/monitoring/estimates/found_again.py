"""Whether plants that are taken as treated were found infested again: then nobody treats them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import bdtrc

from fieldmon.compute.wording import worded
from fieldmon.infestation.insects.pest_in_weather import PestSpread
from fieldmon.infestation.inspections import FOUND, SKIPPED

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.estimates.history import History

# a plant that was treated has so many neighbours to infest it anew
_NEIGHBOURS = 4
# with so much a night at least, whatever was told: insects may be faster than anybody thinks
_ANEW_PER_NIGHT = 0.2
# what is told is no chance, but once in so many seasons
_CHANCE = 1e-3


@dataclass(frozen=True)
class FoundAgain:
    """Plants found infested, taken as treated at once, and found again on a later day.

    Parameters
    ----------
    again
        How many of those `inspected` were found infested again.
    inspected
        How many plants found before were inspected on a later day; the first such day counts.
    """

    again: int
    inspected: int

    def sentence(self, how: str = "") -> Worded:
        """Return how many were found again; `how` says how one says that finds are only flagged."""
        return worded(
            "{n} of {total} {total:plant|plants} found before {n:was|were} infested again when "
            "inspected again, although finds are taken as treated at once; if nobody treats them, "
            "say so: {how}",
            n=self.again, total=self.inspected, how=how or worded("finds are only flagged."),
        )  # fmt: skip


def found_again(history: History, day: int) -> FoundAgain | None:
    """Return how many plants were found again up to a day, where that can hardly be chance.

    It is not so where fewer than half of them were, nor where as many could be infested anew: with
    all their neighbours infested, by what the season believes of a night, or by 20 % a night; or as
    often as those are that were not found before. What a recorded treatment reached in between is
    left out. None: nothing is to be said.
    """
    if not history.belief.treated:
        return None
    first, again_on, again, others = _looks(history, day)
    inspected = again_on <= day
    for one in history.treatments:
        inspected &= ~(one.plants & (first <= one.day) & (one.day <= again_on))
    total, n = int(inspected.sum()), int((again & inspected).sum())
    if not n or 2 * n < total:
        return None
    begun, last = int(first[inspected].min()), int(again_on[inspected].max())
    left = np.cumsum([0.0, *(_left_clean(history, night) for night in range(begun, last))])
    anew = -np.expm1(left[again_on[inspected] - begun] - left[first[inspected] - begun])
    anew = np.maximum(anew, others[again_on[inspected]])
    return FoundAgain(n, total) if bdtrc(n - 1, total, anew.mean()) < _CHANCE else None


class _Looks(NamedTuple):
    """What was seen of plants after their finds; a day that was not is the one after all.

    Parameters
    ----------
    first, again_on
        ``(n,)`` day of each plant's first find, and of its next inspection.
    again
        ``(n,)`` whether it was found infested on that.
    others
        ``(d,)`` of each day: the share found of the plants that were not found before it.
    """

    first: NDArray[np.int64]
    again_on: NDArray[np.int64]
    again: NDArray[np.bool_]
    others: NDArray[np.float64]


def _looks(history: History, day: int) -> _Looks:
    done = history.until(day)
    looked = done.result != SKIPPED
    plant, on = done.plant[looked], history.days[: len(done)][looked]
    found = done.result[looked] == FOUND
    first, again_on = np.full((2, len(history.grid)), day + 1, np.int64)
    np.minimum.at(first, plant[found], on[found])
    later = on > first[plant]
    np.minimum.at(again_on, plant[later], on[later])
    again = np.zeros(len(history.grid), np.bool_)
    again[plant[found & (on == again_on[plant])]] = True
    found_of = np.bincount(on[~later & found], minlength=day + 1)
    others = found_of / np.maximum(np.bincount(on[~later], minlength=day + 1), 1)
    return _Looks(first, again_on, again, others)


def _left_clean(history: History, day: int) -> float:
    """Return the logarithm of the least chance that a night leaves a plant clean."""
    night = history.night(day)
    clean = (1.0 - night.rate_per_day) ** _NEIGHBOURS * (1.0 - night.arrivals_per_day)
    if isinstance(night, PestSpread) and night.movement is not None:
        clean *= np.exp(-night.sends)
    return float(np.log(max(min(clean, 1.0 - _ANEW_PER_NIGHT), 1e-12)))
