"""Where jumps land: to the plants beside one along and across the rows, and farther."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy import fft

from fieldmon.infestation.reach import RADIUS, reach_of, transformed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.cells import Cells
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Landing:
    """The kernels by which insects go from plant to plant, ready to be used.

    Parameters
    ----------
    cells
        The plants in cells.
    kernels
        ``(8, d, d)``: to the next plant along the row, across the rows, and those of
        :func:`fieldmon.infestation.reach.kernels`. Each sums to 1.
    spectra, padded
        Their Fourier transforms, on so many cells across and along.
    at_edge
        ``(n,)`` how much more arrives from outside at each plant than on average, if it comes by
        the edge.
    """

    cells: Cells
    kernels: Floats
    spectra: NDArray[np.complex128]
    padded: tuple[int, int]
    at_edge: Floats

    def mixed(self, shares: Floats) -> NDArray[np.complex128]:
        """Return the transform of the kernels' mixture, of which each has a share ``(8,)``."""
        spectrum: NDArray[np.complex128] = np.einsum("k,kij->ij", shares, self.spectra)
        return spectrum

    def landed(self, sent: Floats, mixed: NDArray[np.complex128]) -> Floats:
        """Return what lands on each plant, ``(n,)``, of what all plants send out.

        Parameters
        ----------
        sent
            ``(n,)`` what each plant sends.
        mixed
            By what it goes, see `mixed`; conjugated it goes the other way, from where it would
            land to where it came from.
        """
        across, along = self.cells.shape
        landed = fft.irfft2(self._sent(sent) * mixed, self.padded)[:across, :along]
        brought: Floats = np.maximum(landed.ravel()[self.cells.of_plant], 0.0)
        return brought

    def met(self, sent: Floats, there: Floats) -> Floats:
        """Return how much of what was sent would meet something there, by each kernel, ``(8,)``.

        Parameters
        ----------
        sent, there
            ``(t, n)`` what each plant sends in a night, and the chance that something is met at
            each plant.
        """
        total = np.zeros(self.spectra.shape[1:], np.complex128)
        for one, other in zip(sent, there, strict=True):
            total += self._sent(one) * np.conj(self._sent(other))
        # half of a spectrum stands for all of it
        twice = np.full(self.spectra.shape[2], 2.0)
        twice[0] = 1.0
        if self.padded[1] % 2 == 0:
            twice[-1] = 1.0
        met: Floats = ((self.spectra * total).real * twice).sum(axis=(1, 2))
        return met / (self.padded[0] * self.padded[1])

    def _sent(self, values: Floats) -> NDArray[np.complex128]:
        sent: NDArray[np.complex128] = fft.rfft2(self.cells.summed(values), self.padded)
        return sent


@lru_cache(maxsize=2)
def landing_of(grid: PlantGrid) -> Landing:
    """Return the kernels of a plot, made once."""
    reach = reach_of(grid)
    beside = np.zeros((2, 2 * RADIUS + 1, 2 * RADIUS + 1))
    beside[0, RADIUS, [RADIUS - 1, RADIUS + 1]] = 0.5
    beside[1, [RADIUS - 1, RADIUS + 1], RADIUS] = 0.5
    kernels = np.concatenate([beside, reach.kernels])
    return Landing(reach.cells, kernels, *transformed(reach.cells, kernels), reach.at_edge)
