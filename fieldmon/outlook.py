"""What a chance map says of the plot as a whole: how many are still infested, and is it clean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numba as nb
import numpy as np

from fieldmon.belief import pairs
from fieldmon.chance import coin
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.grid import Csr, PlantGrid

_DRAWS = 400


@dataclass(frozen=True)
class Outlook:
    """How many plants are infested, as believed.

    Parameters
    ----------
    expected
        Expected number of infested plants.
    low, high
        Interval that holds the number with the chance asked for (90 % unless told).
    chance_clean
        Chance that no plant is infested.
    """

    expected: float
    low: int
    high: int
    chance_clean: float

    def sentence(self) -> str:
        """Return the outlook in words."""
        return (
            f"About {self.expected:.0f} plants are still infested "
            f"(between {self.low} and {self.high}); "
            f"the chance that the plot is clean is {self.chance_clean:.0%}."
        )


def outlook(
    grid: PlantGrid,
    chance: NDArray[np.float64],
    both: NDArray[np.float64] | None = None,
    sure: float = 0.9,
    key: np.uint64 = np.uint64(0),  # noqa: B008 - a number, not a call with effects
) -> Outlook:
    """Return what a chance map ``(n,)`` says of the whole plot.

    Parameters
    ----------
    both
        Chance ``(e,)`` that two plants side by side are both infested (`Belief.both`); without
        it they share their fate as :func:`fieldmon.belief.pairs` has it. Taken as independent,
        the number would seem far surer than it is.
    sure
        Chance that the interval holds the number.
    key
        Which fields are drawn for the interval: the same key, the same answer.
    """
    if not 0.0 < sure < 1.0:
        raise SettingError(f"'sure' must be a chance between 0 and 1, but it is {sure}.")
    if both is None:
        both = pairs(chance, grid)
    counts = np.empty(_DRAWS)
    clean = _draw(chance, both, grid.adjacent, key, counts)
    expected = float(chance.sum())
    # round the loops of a lattice the drawn fields are a little off the map: put right together
    counts *= expected / max(float(counts.mean()), 1e-9)
    low, high = np.quantile(counts, [0.5 - sure / 2, 0.5 + sure / 2])
    return Outlook(expected, int(np.floor(low)), int(np.ceil(high)), clean)


@nb.njit(cache=True, nogil=True)
def _draw(
    chance: NDArray[np.float64],
    both: NDArray[np.float64],
    adjacent: Csr,
    key: np.uint64,
    counts: NDArray[np.float64],
) -> float:
    """Draw fields plant after plant, each given its neighbours drawn before; count the infested.

    Returns the chance that the same chain draws no infested plant at all.
    """
    n = chance.size
    drawn = np.zeros(n, np.bool_)
    log_clean = 0.0
    for i in range(n):
        log_clean += np.log1p(-_given(chance, both, adjacent, drawn, i))
    for k in range(counts.size):
        total = 0
        for i in range(n):
            drawn[i] = coin(key, k * n + i) < _given(chance, both, adjacent, drawn, i)
            total += drawn[i]
        counts[k] = total
    return float(np.exp(log_clean))


@nb.njit(cache=True, nogil=True)
def draw_fields(
    believed: tuple[NDArray[np.float64], NDArray[np.float64]],
    adjacent: Csr,
    key: np.uint64,
    fields: NDArray[np.bool_],
) -> None:
    """Draw whole fields ``(m, n)`` in place from ``chance (n,)`` and ``both (e,)``."""
    chance, both = believed
    for k in range(fields.shape[0]):
        for i in range(chance.size):
            given = _given(chance, both, adjacent, fields[k], i)
            fields[k, i] = coin(key, k * chance.size + i) < given


@nb.njit(cache=True)
def _given(
    chance: NDArray[np.float64],
    both: NDArray[np.float64],
    adjacent: Csr,
    drawn: NDArray[np.bool_],
    i: int,
) -> float:
    """Return the chance of plant i given its neighbours of lower number."""
    p = chance[i]
    odds = p / (1.0 - p)
    for e in range(adjacent.start[i], adjacent.start[i + 1]):
        j = adjacent.plant[e]
        if j > i:
            continue
        q = chance[j]
        c = min(both[e], p, q)
        if drawn[j]:
            odds *= (c / p) / max((q - c) / (1.0 - p), 1e-9)
        else:
            odds *= (1.0 - c / p) / max(1.0 - (q - c) / (1.0 - p), 1e-9)
    return float(min(odds / (1.0 + odds), 1.0 - 1e-9))
