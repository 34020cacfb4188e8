"""Where jumps land: to the plants beside one along and across the rows, and farther."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.infestation.reach import RADIUS, KernelsOnCells, reach_of, transformed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.floating[Any]]


@dataclass(frozen=True, eq=False)
class Landing(KernelsOnCells):
    """The kernels by which insects go from plant to plant, ``(8, d, d)``.

    To the next plant along the row, across the rows, and those of
    :func:`fieldmon.infestation.reach.kernels`.
    """

    def met(self, sent: Floats, there: Floats, first: int) -> Floats:
        """Return how much of what was sent would meet something there, by each kernel, ``(2, 8)``.

        In the first nights, and in all.

        Parameters
        ----------
        sent, there
            ``(t, n)`` what each plant sends in a night, and the chance that something is met at
            each plant.
        first
            How many nights are the first ones.
        """
        total = np.zeros((2, *self.spectra.shape[1:]), self.spectra.dtype)
        for night, (one, other) in enumerate(zip(sent, there, strict=True)):
            # over a night in which nothing is sent there is nothing to add
            if one.any():
                total[int(night >= first)] += self._sent(one) * np.conj(self._sent(other))
        total[1] += total[0]
        # half of a spectrum stands for all of it
        total[:, :, 1 : (self.padded[1] + 1) // 2] *= 2.0
        met: Floats = np.einsum("tij,kij->tk", total, self.spectra).real
        return met.astype(np.float64) / (self.padded[0] * self.padded[1])


@lru_cache(maxsize=2)
def landing_of(grid: PlantGrid) -> Landing:
    """Return the kernels of a plot, made once."""
    reach = reach_of(grid)
    beside = np.zeros((2, 2 * RADIUS + 1, 2 * RADIUS + 1))
    beside[0, RADIUS, [RADIUS - 1, RADIUS + 1]] = 0.5
    beside[1, [RADIUS - 1, RADIUS + 1], RADIUS] = 0.5
    kernels = np.concatenate([beside, reach.kernels])
    spectra, padded = transformed(reach.cells, kernels)
    # half the digits take half the time, and ancestries are not drawn as exactly as that
    return Landing(reach.cells, kernels, spectra.astype(np.complex64), padded, reach.at_edge)
