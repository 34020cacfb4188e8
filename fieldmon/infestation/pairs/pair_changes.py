"""What chances of pairs become where those of the plants change: by arrivals, by second thoughts.

Each entry of ``grid.adjacent`` is worked out by itself, in one walk over them: as arrays, a night
on 100 000 plants would make and read a dozen of 400 000 numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.infestation.chance_bounds import bounded_pair_chance, greater, lesser

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Csr

    Floats = NDArray[np.float64]


def pairs_scaled(
    pair_chance: Floats, adjacent: Csr, scale: Floats, chance: Floats
) -> NDArray[np.float64]:
    """Return ``(e,)`` chances of pairs where those of their plants were multiplied.

    Parameters
    ----------
    pair_chance
        ``(e,)`` before.
    adjacent
        The plants beside each.
    scale
        ``(n,)`` by how much each plant's chance was multiplied.
    chance
        ``(n,)`` what it is now.
    """
    both = np.empty_like(pair_chance)
    _scale_pairs((pair_chance, both), adjacent, scale, chance)
    return both


def pairs_after_arrivals(
    believed: tuple[Floats, Floats], adjacent: Csr, arrives: Floats, chance: Floats
) -> NDArray[np.float64]:
    """Return ``(e,)`` chances of pairs after something arrived at each plant by itself.

    Parameters
    ----------
    believed
        ``(n,)`` and ``(e,)`` before.
    adjacent
        The plants beside each.
    arrives
        ``(n,)`` chance that something arrives.
    chance
        ``(n,)`` what is believed of each plant now.
    """
    both = np.empty_like(believed[1])
    _let_arrive(believed, both, adjacent, arrives, chance)
    return both


@loop
def _scale_pairs(
    pairs: tuple[Floats, Floats], adjacent: Csr, scale: Floats, chance: Floats
) -> None:
    before, both = pairs
    for i in range(chance.size):
        for e in range(adjacent.start[i], adjacent.start[i + 1]):
            j = adjacent.plant[e]
            scaled = before[e] * np.sqrt(scale[i] * scale[j])
            both[e] = bounded_pair_chance(scaled, chance[i], chance[j])


@loop
def _let_arrive(
    believed: tuple[Floats, Floats],
    both: Floats,
    adjacent: Csr,
    arrives: Floats,
    chance: Floats,
) -> None:
    before, pair_before = believed
    for i in range(chance.size):
        for e in range(adjacent.start[i], adjacent.start[i + 1]):
            j = adjacent.plant[e]
            clean = greater(1.0 - before[i] - before[j] + pair_before[e], 0.0)
            neither = clean * (1.0 - arrives[i]) * (1.0 - arrives[j])
            p, q = chance[i], chance[j]
            at_least = greater(p + q - 1.0, 0.0)
            both[e] = lesser(greater(p + q - 1.0 + neither, at_least), lesser(p, q))
