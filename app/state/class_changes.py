"""How plants change their classes in the course of a day: only what changes is kept of a map."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Classes = NDArray[np.integer]


class ClassChange(NamedTuple):
    """At which second which plants came to be of which classes, ``(k,)`` each."""

    at_s: float
    plants: NDArray[np.int64]
    classes: Classes


class ClassChanges:
    """The changes of a day so far, in order.

    Parameters
    ----------
    morning
        ``(n,)`` the classes before the first.
    """

    def __init__(self, morning: Classes) -> None:
        self._last = self._before = morning
        self._all: list[ClassChange] = []

    @property
    def so_far(self) -> list[ClassChange]:
        """Return them, from the morning's classes on."""
        return [*self._all]

    @property
    def last_s(self) -> float:
        """Return the second of the last one; 0: there is none."""
        return self._all[-1].at_s if self._all else 0.0

    def add(self, at_s: float, now: Classes) -> None:
        """Take classes ``(n,)`` in; those of the same second as the last ones take their place."""
        if self._all and at_s == self.last_s:
            self._all.pop()
            self._last = self._before
        plants = np.flatnonzero(now != self._last)
        self._all.append(ClassChange(at_s, plants, now[plants]))
        self._before, self._last = self._last, now
