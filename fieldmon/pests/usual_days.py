"""What a day without weather is taken for: the days that stand for it, and how much each counts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    Days = NDArray[np.datetime64]

#: a day of hours is known if so many of them are
LEAST_HOURS = 18
# a gap of up to so many days is as the days about it, even where other years are known
_SHORT = 14
# the same days of other years, so many to each side
_ABOUT = 7
# beyond all of them: the first or last so many days
_NEAREST = 7


class StandIns(NamedTuple):
    """Indices of the days that stand for one, and what each of them counts."""

    which: Ints
    weight: Floats

    def mean(self, values: Floats) -> float:
        """Return the mean of what each of the known days has, ``(k,)``."""
        return float((values[self.which] * self.weight).sum() / self.weight.sum())


@dataclass(frozen=True, eq=False)
class UsualDays:
    """Which of the days whose weather is known stand for one whose weather is not.

    Parameters
    ----------
    known
        ``(k,)`` datetime64[D] in order, each once, at least one.
    """

    known: Days

    def of(self, on: np.datetime64) -> StandIns:
        """Return what stands for a day.

        In a gap of up to two weeks the days on both sides, the nearer counting more; else the same
        days of other years, a week to each side; else in a gap the days on both sides too, before
        the first known day the first seven, and after the last the last seven.
        """
        day = int(on.astype("datetime64[D]").astype(np.int64))
        after = int(np.searchsorted(self._numbers, day))
        if after < len(self.known) and self._numbers[after] == day:
            return StandIns(np.array([after]), np.ones(1))
        inside = 0 < after < len(self.known)
        if inside and self._numbers[after] - self._numbers[after - 1] - 1 <= _SHORT:
            return self._between(day, after)
        other_years = self._same_days(on)
        if len(other_years):
            return _evenly(other_years)
        if inside:
            return self._between(day, after)
        n = len(self.known)
        return _evenly(np.arange(min(_NEAREST, n)) if after == 0 else np.arange(n)[-_NEAREST:])

    def _between(self, day: int, after: int) -> StandIns:
        """Return the known days before and after one, each counting by how near it is."""
        first, last = self._numbers[after - 1], self._numbers[after]
        later = float((day - first) / (last - first))
        return StandIns(np.array([after - 1, after]), np.array([1.0 - later, later]))

    def _same_days(self, on: np.datetime64) -> Ints:
        apart = np.abs(self._of_year - int(_of_year(on)))
        near = np.minimum(apart, 365 - apart) <= _ABOUT
        return np.flatnonzero(near & (self._years != on.astype("datetime64[Y]")))

    @cached_property
    def _numbers(self) -> Ints:
        return self.known.astype("datetime64[D]").astype(np.int64)

    @cached_property
    def _years(self) -> Days:
        return self.known.astype("datetime64[Y]")

    @cached_property
    def _of_year(self) -> Ints:
        return _of_year(self.known)


def _evenly(which: Ints) -> StandIns:
    return StandIns(which, np.ones(len(which)))


def _of_year(days: Days | np.datetime64) -> Ints:
    """Return which day of its year each is, from 1."""
    since = days.astype("datetime64[D]") - days.astype("datetime64[Y]").astype("datetime64[D]")
    number: Ints = since.astype(np.int64) + 1
    return number
