"""Infestations from which no find descends: how likely they stay unseen, and how many there are.

An infestation sends out others independently of each other, so those that were never seen need not
be drawn. The chance that one that begins at a plant on a morning was not seen until today, with all
that came from it, follows night by night from the last back (the probability generating function
of a branching process: Harris 1963). With it, the number of those that are there now follows night
by night from the first on.

Mornings and nights are counted as in `drawn_ancestry`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.landing import Landing

    Floats = NDArray[np.float64]


class Unseen(NamedTuple):
    """How likely an infestation stays unseen, ``(t, n)`` each, by the morning on which it begins.

    Parameters
    ----------
    chance
        That nothing is seen of it and of all that comes from it.
    offspring
        That nothing is seen of what it sends out, as a logarithm.
    """

    chance: Floats
    offspring: Floats

    def __repr__(self) -> str:
        return f"<Unseen on {len(self.chance)} mornings>"


def stays_unseen(
    alone: Floats, taken: Floats, sends: Floats, shares: Floats, landing: Landing
) -> Unseen:
    """Return how likely infestations stay unseen.

    Parameters
    ----------
    alone
        ``(t, n)`` that no inspection shows an infestation, as a logarithm; minus infinity where the
        plant was found since.
    taken
        ``(t, n)`` the chance that the plant is infested already: what lands there does nothing.
    sends
        ``(t,)`` what an infested plant sends out in a night.
    shares
        ``(k,)`` how much of it goes by each kernel.
    """
    offspring, back = np.zeros_like(alone), np.conj(landing.mixed(shares))
    chance = np.empty_like(alone)
    for night in range(len(alone) - 1, -1, -1):
        np.exp(alone[night] + offspring[night], out=chance[night])
        if night:
            caught = landing.landed((1.0 - chance[night]) * (1.0 - taken[night]), back)
            offspring[night - 1] = offspring[night] - sends[night - 1] * caught
    return Unseen(chance, offspring)


def unseen_now(
    unseen: Unseen, active: Floats, roots: Floats, sends: Floats, shares: Floats, landing: Landing
) -> Floats:
    """Return how many infestations of which nothing was seen are expected, ``(t, n)``.

    On each morning at each plant.

    Parameters
    ----------
    active
        ``(t, n)`` how likely a plant of the finds' ancestry sends something out in a night.
    roots
        ``(t, n)`` how many infestations come to a plant from none.
    sends, shares
        As for `stays_unseen`.
    """
    mixed = landing.mixed(shares)
    there, so_far = np.zeros(active.shape[1]), np.empty_like(active)
    for morning in range(len(active)):
        new = roots[morning]
        if morning:
            senders = active[morning - 1] + there
            new = new + sends[morning - 1] * landing.landed(senders, mixed)
        there = there + unseen.chance[morning] * new * np.maximum(1.0 - there, 0.0)
        so_far[morning] = there
    return so_far
