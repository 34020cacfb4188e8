"""Infestations from which no find descends: how likely they stay unseen, and how many there are.

An infestation sends out others independently of each other, so those that were never seen need not
be drawn. The chance that one that begins at a plant on a morning was not seen until today, with all
that came from it, follows night by night from the last back (the probability generating function
of a branching process: Harris 1963). With it, the number of those that are there now follows night
by night from the first on.

Mornings and nights are counted as in `drawn_ancestry`.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.infestation_course import Course
    from fieldmon.infestation.insects.jump_landing import Landing

    Floats = NDArray[np.floating[Any]]


class Unseen(NamedTuple):
    """How likely an infestation stays unseen, ``(t, n)`` each, by the morning on which it begins.

    Parameters
    ----------
    chance
        That nothing is seen of it and of all that comes from it.
    offspring
        That nothing is seen of what it sends out.
    sent_since
        That nothing is seen of what one sends out from a morning on.
    """

    chance: Floats
    offspring: Floats
    sent_since: Floats

    def __repr__(self) -> str:
        return f"<Unseen on {len(self.chance)} mornings>"


def stays_unseen(
    alone: Floats, taken: Floats, jumps: tuple[Floats, Floats], landing: Landing, course: Course
) -> Unseen:
    """Return how likely infestations stay unseen.

    Parameters
    ----------
    alone
        ``(t, n)`` the chance that no inspection shows an infestation; 0 where the plant was found
        since.
    taken
        ``(t, n)`` the chance that the plant is infested already: what lands there does nothing.
    jumps
        ``(t,)`` what an infested plant sends out in a night, and ``(k,)`` how much of it goes by
        each kernel.
    course
        When they send something out.
    """
    sends, shares = jumps
    back, lost = np.conj(landing.mixed(shares)), np.zeros_like(alone[0])
    chance, offspring = np.empty((2, *alone.shape), alone.dtype)
    delays = course.delays
    sent_since = np.empty_like(offspring) if delays else offspring
    for night in range(len(alone) - 1, -1, -1):
        np.exp(lost, out=sent_since[night])
        if delays:
            offspring[night] = sent_since[course.grown[night]]
        np.multiply(alone[night], offspring[night], out=chance[night])
        if night:
            caught = (1.0 - chance[night]) * (1.0 - taken[night])
            lost -= float(sends[night - 1]) * landing.landed(caught, back)
    return Unseen(chance, offspring, sent_since)


def unseen_now(
    unseen: Unseen,
    active: Floats,
    roots: Floats,
    jumps: tuple[Floats, Floats],
    landing: Landing,
    course: Course,
) -> Floats:
    """Return how many infestations of which nothing was seen are expected, ``(t, n)``.

    On each morning at each plant.

    Parameters
    ----------
    active
        ``(t, n)`` how likely a plant of the finds' ancestry sends something out in a night.
    roots
        ``(t, n)`` how many infestations come to a plant from none.
    jumps, course
        As for `stays_unseen`.
    """
    sends, shares = jumps
    mixed = landing.mixed(shares)
    so_far = np.empty_like(active)
    np.multiply(roots[0], unseen.chance[0], out=so_far[0])
    for night, (before, there) in enumerate(pairwise(so_far)):
        new = landing.landed(active[night] + so_far[course.grown_by[night]], mixed)
        new *= float(sends[night])
        new += roots[night + 1]
        new *= unseen.chance[night + 1]
        new *= np.maximum(1.0 - before, 0.0)
        np.add(before, new, out=there)
    return so_far
