"""What an inspection teaches about the plants, and what a night does to the chance map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numba as nb
import numpy as np

from fieldmon.compiled import loop
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.grid import Csr, PlantGrid
    from fieldmon.spread import Spread

# no plant is ever taken as certainly clean or certainly infested: evidence must be able to undo it
_LEAST, _MOST = 1e-6, 1.0 - 1e-6
_1, _2, _3 = np.uint32(1), np.uint32(2), np.uint32(3)


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
    after, spares = np.empty_like(chance), np.empty_like(chance)
    _spare(chance, spares, grid.adjacent.start, (each, spread.to == "one"))
    _overnight(chance, after, grid.adjacent, spares, spread.arrivals_per_day)
    return after


@loop
def _spare(
    chance: NDArray[np.float64],
    spares: NDArray[np.float64],
    start: NDArray[np.int32],
    rule: tuple[float, bool],
) -> None:
    """Find the chance that a plant does not infest a given neighbour in a night."""
    rate, one = rule
    for i in range(chance.size):
        share = rate / (start[i + 1] - start[i]) if one else rate
        spares[i] = 1.0 - chance[i] * share


@loop
def _overnight(
    chance: NDArray[np.float64],
    after: NDArray[np.float64],
    adjacent: Csr,
    spares: NDArray[np.float64],
    arrivals: float,
) -> None:
    start, plant = adjacent
    for i in range(chance.size):
        # unsigned: an index that may be negative is checked for it
        k, end = np.uint32(start[i]), np.uint32(start[i + 1])
        clean = (1.0 - chance[i]) * (1.0 - arrivals)
        if end - k == 4:  # most plants; a loop of unknown length costs twice this
            clean *= spares[np.uint32(plant[k])]
            clean *= spares[np.uint32(plant[k + _1])]
            clean *= spares[np.uint32(plant[k + _2])]
            clean *= spares[np.uint32(plant[k + _3])]
        else:
            for e in range(k, end):
                clean *= spares[np.uint32(plant[e])]
        infested = 1.0 - clean
        infested = infested if infested < _MOST else _MOST  # noqa: FURB136 - min is slower
        after[i] = infested if infested > _LEAST else _LEAST  # noqa: FURB136 - max is slower
