"""What inspections say of infestations: how likely they overlook one, or find it when it was."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.ancestry.unseen_offspring import Unseen, stays_unseen

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.ancestry.ancestry import Ancestry
    from fieldmon.infestation.ancestry.infestation_course import Course
    from fieldmon.infestation.ancestry.infestations import Finds, Infestations
    from fieldmon.infestation.insects.jump_landing import Landing

    Floats = NDArray[np.floating[Any]]

# what is divided by is never nothing
_TINY = float(np.finfo(np.float32).tiny)


class InspectedInfestations(NamedTuple):
    """What inspections say of infestations by the morning on which they begin, ``(t, n)`` each.

    Parameters
    ----------
    missed
        How likely all from that morning on overlook one, if nothing hides, as a logarithm.
    overlooked
        How likely they do, if it hides as it may.
    unseen
        How likely nothing is seen of it and of what comes from it.
    course
        When they can be seen, and send something out.
    """

    missed: Floats
    overlooked: Floats
    unseen: Unseen
    course: Course

    @classmethod
    def by(cls, of: Ancestry, landing: Landing) -> InspectedInfestations:
        """Return what the inspections up to the last night say."""
        t, n = BEFORE + len(of.sends) + 1, len(of.grid)
        # half the digits: on a large plot it is memory that takes the time
        taken = np.zeros((t, n), np.float32)
        taken[: len(of.taken)] = of.taken
        missed = np.zeros((t, n), np.float32)
        np.cumsum(of.missed[::-1], axis=0, out=missed[BEFORE:-1][::-1])
        missed[:BEFORE] = missed[BEFORE]
        course = of.course
        overlooked = overlooked_until_last(missed, course)
        alone = overlooked.copy()
        alone[np.arange(t)[:, None] <= of.last_find + BEFORE] = 0.0
        # nor does another begin where one goes on
        alone[:, of.left] = 0.0
        unseen = stays_unseen(alone, taken, (of.sent(of.rates), of.rates.shares), landing, course)
        return cls(missed, overlooked, unseen, course)

    def lasting(self, infestations: Infestations) -> Floats:
        """Return how likely they go on to their end as seen, as `Weights.lasting` has it."""
        t, n = self.missed.shape
        found = infestations.there & infestations.found
        lasting = np.ones((n + len(found), t), np.float32)
        np.multiply(self.overlooked.T, self.unseen.offspring.T, out=lasting[:n])
        lasting[n:][found] = until_found(self.missed, self.unseen, infestations.finds, self.course)
        np.maximum(lasting, _TINY, out=lasting)
        return lasting


def overlooked_until_last(missed: Floats, course: Course) -> Floats:
    """Return how likely infestations are overlooked until the last morning, ``(t, n)``.

    Parameters
    ----------
    missed
        ``(t, n)`` the same if nothing hides, as a logarithm, of an infestation that begins on each
        morning.
    course
        When they can be seen.
    """
    once_shown = np.exp(missed)
    overlooked = np.zeros_like(once_shown)
    for shows, likely in zip(course.shows, course.likely.tolist(), strict=True):
        for begins, shown in enumerate(shows):
            overlooked[begins] += likely * once_shown[shown]
    return overlooked


def until_found(
    missed: Floats,
    unseen: Unseen,
    finds: Finds,
    course: Course,
) -> Floats:
    """Return how likely it is to find what was found, when it was, ``(k, t)``, by its beginning.

    `missed` and `course` are as `overlooked_until_last` has them.
    """
    first, ends, plant = finds
    chance = np.zeros((len(plant), len(missed)))
    for shows, likely in zip(course.shows, course.likely, strict=True):
        seen = shows <= first[:, None]
        overlooked = missed[:, plant][shows].T - missed[first, plant][:, None]
        chance += likely * seen * np.exp(np.where(seen, overlooked, 0.0))
    sent_later = np.maximum(unseen.sent_since[ends, plant], _TINY)
    sent = unseen.offspring[:, plant].T / sent_later[:, None]
    return chance * np.minimum(sent, 1.0)
