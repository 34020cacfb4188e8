"""How far insects may jump beyond the plants next to them, and what that brings to each plant."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy import fft

from fieldmon.infestation.cells import Cells
from fieldmon.infestation.prior import PriorSettings, edge_chance

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

#: what jumps farther than so many plants comes from anywhere
RADIUS = 12
# mean jumps and the scale of a Cauchy kernel, in plants (our choice: what finds can tell apart)
_NEAR, _MIDDLE, _FAR = 2.0, 4.0, 3.0
#: how the jumps of a pest that jumps are shared out before anything is found: to the plants next to
#: it; and by each kernel of :func:`kernels` (our choice)
BESIDE = 0.5
BEYOND = np.array([0.25, 0.05, 0.05, 0.05, 0.05, 0.05])


def kernels(size_m: Floats) -> Floats:
    """Return how jumps of each kind are shared out over cells about a plant, ``(6, d, d)``.

    Exponential, a mean of 2 plants all round; of 4 plants up and down the rows and across them,
    each way on its own, as wind and rows have it; and Cauchy, for those that go farthest. A plant
    is the square root of the ground that it has. Each kind sums to 1.
    """
    steps = np.arange(-RADIUS, RADIUS + 1) / np.sqrt(size_m.prod())
    y, x = np.meshgrid(steps * size_m[0], steps * size_m[1], indexing="ij")
    away = np.hypot(x, y)
    away[RADIUS, RADIUS] = 1.0
    middle = np.exp(-away / _MIDDLE) / away
    made = np.array(
        [
            np.exp(-away / _NEAR) / away,
            *(middle * np.maximum(turned / away, 0.0) ** 2 for turned in (x, y, -x, -y)),
            (1.0 + (away / _FAR) ** 2) ** -1.5,
        ]
    )
    made[:, RADIUS, RADIUS] = 0.0
    shared: Floats = made / made.sum(axis=(1, 2), keepdims=True)
    return shared


def kernel_means(size_m: Floats) -> Floats:
    """Return how far jumps of each kernel go on average, ``(6,)`` plants."""
    steps = np.arange(-RADIUS, RADIUS + 1) / np.sqrt(size_m.prod())
    away = np.hypot(steps[None, :] * size_m[1], steps[:, None] * size_m[0])
    means: Floats = (kernels(size_m) * away).sum(axis=(1, 2))
    return means


@dataclass(frozen=True, eq=False)
class Reach:
    """The kernels of a plot, ready to be used.

    Parameters
    ----------
    cells
        The plants in cells.
    kernels
        ``(6, d, d)`` as :func:`kernels` has them.
    spectra
        ``(6, h, w)`` their Fourier transforms, on cells with room about them.
    padded
        Cells across and along with that room.
    at_edge
        ``(n,)`` how much more arrives from outside at each plant than on average, if it comes by
        the edge.
    """

    cells: Cells
    kernels: Floats
    spectra: NDArray[np.complex128]
    padded: tuple[int, int]
    at_edge: Floats

    def brought(self, values: Floats, shares: Floats, *, back: bool = False) -> Floats:
        """Return what comes to each plant of what all plants send, ``(n,)``.

        Parameters
        ----------
        values
            ``(n,)`` what each plant sends.
        shares
            ``(6,)`` how much of it goes by each kernel.
        back
            Whether it goes the other way: from where it would land to where it came from.
        """
        # not by a matrix library: its threads cost a hundred times what is added here
        spectrum = np.einsum("k,kij->ij", shares, self.spectra)
        return self._landed(self._sent(values) * (np.conj(spectrum) if back else spectrum))

    def brought_by_each(self, values: Floats) -> Floats:
        """Return the same for each kernel by itself, ``(6, n)``."""
        sent = self._sent(values)
        return np.array([self._landed(sent * spectrum) for spectrum in self.spectra])

    def _sent(self, values: Floats) -> NDArray[np.complex128]:
        sent: NDArray[np.complex128] = fft.rfft2(self.cells.summed(values), self.padded)
        return sent

    def _landed(self, spectrum: NDArray[np.complex128]) -> Floats:
        across, along = self.cells.shape
        landed = fft.irfft2(spectrum, self.padded)[:across, :along]
        brought: Floats = np.maximum(landed.ravel()[self.cells.of_plant], 0.0)
        return brought


@lru_cache(maxsize=2)
def reach_of(grid: PlantGrid) -> Reach:
    """Return the kernels of a plot, made once."""
    cells = Cells.of(grid)
    made = kernels(cells.size_m)
    across, along = (fft.next_fast_len(int(side) + 2 * RADIUS, real=True) for side in cells.shape)
    room = np.zeros((len(made), across, along))
    room[:, : made.shape[1], : made.shape[2]] = made
    spectra = fft.rfft2(np.roll(room, (-RADIUS, -RADIUS), axis=(1, 2)))
    at_edge = edge_chance(grid, PriorSettings())
    return Reach(cells, made, spectra, (across, along), at_edge / max(at_edge.mean(), 1e-9))
