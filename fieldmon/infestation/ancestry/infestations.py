"""The infestations of an ancestry: where each is, from when until when, and from which it came."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.cell_squares import NOBODY

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Ints = NDArray[np.int64]

#: places for infestations that were not found: at least so many
LEAST_ROOM = 32


class Finds(NamedTuple):
    """Infestations that were found: the mornings of the first and the last, and where, ``(k,)``."""

    seen: Ints
    ends: Ints
    plant: Ints

    def __repr__(self) -> str:
        return f"<{len(self.plant)} finds>"


class Infestations(NamedTuple):
    """The infestations of an ancestry, ``(m,)`` each, with room for more.

    Parameters
    ----------
    plant
        Where each is.
    begins, ends
        From which morning on the plant sends something out at night, and until which: that on which
        it was found and destroyed, or the last.
    found, seen
        Whether it was found, and the morning on which it was first; of others the last. One found
        long ago, of which no more is known, has 0.
    parent, children
        The infestation from which it came (`NOBODY`: none), and how many came from it.
    there
        Whether the place is taken.
    earliest
        The first morning on which it may have begun: after the plant's find before.
    """

    plant: Ints
    begins: Ints
    ends: Ints
    found: NDArray[np.bool_]
    parent: Ints
    children: Ints
    there: NDArray[np.bool_]
    earliest: Ints
    seen: Ints

    @classmethod
    def empty(cls, places: int) -> Infestations:
        """Return places for so many, none taken."""
        ints = np.zeros((7, places), np.int64)
        ints[3] = NOBODY
        plant, begins, ends, parent, children, earliest, seen = ints
        found, there = np.zeros((2, places), np.bool_)
        return cls(plant, begins, ends, found, parent, children, there, earliest, seen)

    @classmethod
    def left_on(cls, plants: Ints) -> Infestations:
        """Return those of plants ``(k,)`` that are known and left from the first morning on."""
        made = cls.empty(max(LEAST_ROOM, len(plants)))
        known = slice(0, len(plants))
        made.plant[known] = plants
        made.begins[known] = made.ends[known] = made.earliest[known] = BEFORE
        made.found[known] = made.there[known] = True
        return made

    def __repr__(self) -> str:
        hidden = np.count_nonzero(self.there & ~self.found)
        return f"<Infestations: {np.count_nonzero(self.found)} found, {hidden} not>"

    def copied(self, places: int) -> Infestations:
        """Return the same with so many places more."""
        wider = Infestations.empty(len(self.plant) + places)
        for mine, own in zip(wider, self, strict=True):
            mine[: len(own)] = own
        return wider

    def goes_on(self, last: int) -> NDArray[np.bool_]:
        """Return which are infested on the last morning: not found, or found and left, ``(m,)``."""
        goes_on: NDArray[np.bool_] = self.there & (~self.found | (self.ends == last))
        return goes_on

    @property
    def finds(self) -> Finds:
        """Those that were found, in the order of their places."""
        found = self.there & self.found
        return Finds(self.seen[found], self.ends[found], self.plant[found])

    def places(self, n: int, last: int) -> Ints:
        """Return which one goes on at each of n plants on the last morning, or `NOBODY`."""
        at = np.full(n, NOBODY)
        goes_on = np.flatnonzero(self.goes_on(last))
        at[self.plant[goes_on]] = goes_on
        return at
