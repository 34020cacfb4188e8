"""What an inspection teaches about the plants, and what a night does to the chance map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numba as nb
import numpy as np

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.grid import Csr, PlantGrid
    from fieldmon.spread import Spread

# no plant is ever taken as certainly clean or certainly infested: evidence must be able to undo it
_LEAST, _MOST = 1e-6, 1.0 - 1e-6


@dataclass(frozen=True)
class Learning:
    """How findings change the chance map.

    Parameters
    ----------
    detection
        Chance that an inspection finds what is there.
    beside_find
        Chance that a plant next to a find is infested too, whatever was believed before
        (infestations come in clusters; our choice).
    treated
        Whether a find is destroyed at once (the thesis's rule), or only flagged.
    """

    detection: float = 0.84
    beside_find: float = 0.3
    treated: bool = True

    def __post_init__(self) -> None:
        for name in ("detection", "beside_find"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise SettingError(
                    f"{name} must be a chance in 0..1, but it is {getattr(self, name)}."
                )


def learn(
    chance: NDArray[np.float64],
    grid: PlantGrid,
    plants: NDArray[np.int32],
    found: NDArray[np.bool_],
    learning: Learning,
) -> NDArray[np.float64]:
    """Return the chance map ``(n,)`` after inspecting `plants` ``(k,)`` with results `found`.

    A clean look lowers a plant's chance by Bayes' rule, p' = p (1 - d) / (1 - p d) with detection
    d; a find settles the plant and raises its neighbours to at least `beside_find`.
    """
    after = chance.copy()
    rule = (learning.detection, learning.beside_find, learning.treated)
    _learn(after, grid.adjacent, plants, found, rule)
    return after


@nb.njit(cache=True, nogil=True)
def _learn(
    after: NDArray[np.float64],
    adjacent: Csr,
    plants: NDArray[np.int32],
    found: NDArray[np.bool_],
    rule: tuple[float, float, bool],
) -> None:
    d, beside_find, treated = rule
    inspected = np.zeros(after.size, np.bool_)
    for k in range(plants.size):
        i = plants[k]
        inspected[i] = True
        if found[k]:
            after[i] = _LEAST if treated else _MOST
        else:
            p = after[i]
            after[i] = min(max(p * (1.0 - d) / (1.0 - p * d), _LEAST), _MOST)
    for k in range(plants.size):
        if not found[k]:
            continue
        for e in range(adjacent.start[plants[k]], adjacent.start[plants[k] + 1]):
            j = adjacent.plant[e]
            if not inspected[j]:
                after[j] = min(max(after[j], beside_find), _MOST)


def overnight(chance: NDArray[np.float64], grid: PlantGrid, spread: Spread) -> NDArray[np.float64]:
    """Return the chance map ``(n,)`` of the next morning, neighbours taken as independent."""
    each = spread.rate_per_day
    after = np.empty_like(chance)
    _overnight(chance, after, grid.adjacent, (each, spread.to == "one", spread.arrivals_per_day))
    return after


@nb.njit(cache=True, nogil=True)
def _overnight(
    chance: NDArray[np.float64],
    after: NDArray[np.float64],
    adjacent: Csr,
    rule: tuple[float, bool, float],
) -> None:
    rate, one, arrivals = rule
    start, plant = adjacent
    for i in range(chance.size):
        stays_clean = (1.0 - chance[i]) * (1.0 - arrivals)
        for k in range(start[i], start[i + 1]):
            j = plant[k]
            share = rate / (start[j + 1] - start[j]) if one else rate
            stays_clean *= 1.0 - chance[j] * share
        after[i] = min(max(1.0 - stays_clean, _LEAST), _MOST)


def pairs(
    chance: NDArray[np.float64], grid: PlantGrid, company: float = 0.3
) -> NDArray[np.float64]:
    """Return the chance that both of two plants side by side are infested, ``(e,)``.

    In the order of ``grid.adjacent``. `company` is the correlation of the two: about the chance
    that a plant beside an infested one is infested too, where few are.
    """
    start, other = grid.adjacent
    one = np.repeat(np.arange(len(chance)), np.diff(start))
    p, q = chance[one], chance[other]
    both = p * q + company * np.sqrt(p * (1.0 - p) * q * (1.0 - q))
    return np.minimum(both, np.minimum(p, q))
