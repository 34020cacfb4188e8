"""Where jumps land: to the plants beside one along and across the rows, and farther."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.infestation.insects.jump_reach import (
    OF_PEST,
    KernelsOnCells,
    pest_kernels,
    reach_of,
    transformed,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.kernels import DistanceKernel
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.floating[Any]]

#: how jumps are shared out at first, in finds: along and across the rows to the next plant, and by
#: the kernels of `jump_reach` (our choice)
SHARES = np.array([1.0, 1.0, 0.15, 0.03, 0.03, 0.03, 0.03, 0.03])
#: the same of a pest with a kernel of its own, which brings what lands next to a plant, too
SHARES_OF_PEST = np.concatenate([[0.3, 0.3], (SHARES.sum() - 0.6) * OF_PEST])


@dataclass(frozen=True, eq=False)
class Landing(KernelsOnCells):
    """The kernels by which insects go from plant to plant, ``(8, d, d)``.

    To the next plant along the row, across the rows, and those of
    :func:`fieldmon.infestation.insects.jump_reach.kernels` or, of a pest that has its own, of
    `pest_kernels`.

    Parameters
    ----------
    first
        ``(8,)`` how jumps are shared out before anything is found, in finds.
    """

    first: Floats

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
    return _landing(grid, reach_of(grid).kernels, SHARES)


@lru_cache(maxsize=8)
def pest_landing_of(
    grid: PlantGrid, kernel: DistanceKernel, wind_m_s: tuple[float, float] = (0.0, 0.0)
) -> Landing:
    """Return the kernels of a pest on a plot in a wind, made once."""
    kernels = pest_kernels(reach_of(grid).cells.size_m, kernel, wind_m_s)
    return _landing(grid, kernels, SHARES_OF_PEST)


def _landing(grid: PlantGrid, kernels: Floats, first: Floats) -> Landing:
    reach, radius = reach_of(grid), kernels.shape[1] // 2
    beside = np.zeros((2, 2 * radius + 1, 2 * radius + 1))
    beside[0, radius, [radius - 1, radius + 1]] = 0.5
    beside[1, [radius - 1, radius + 1], radius] = 0.5
    kernels = np.concatenate([beside, kernels])
    spectra, padded = transformed(reach.cells, kernels)
    # half the digits take half the time, and ancestries are not drawn as exactly as that
    spectra = spectra.astype(np.complex64)
    return Landing(reach.cells, kernels, spectra, padded, reach.at_edge, first)
