"""What lands on each plant of what all plants send out, by a kernel of distance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np
from scipy import fft

from fieldmon.compute.jit import loop
from fieldmon.compute.random_streams import coin
from fieldmon.infestation.cells import Cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.kernels import DistanceKernel
    from fieldmon.plot.grid import Csr, PlantGrid

    Floats = NDArray[np.float64]

# seconds a cell of a sending plant's kernel, and a row of it; and of the transforms a cell and
# doubling, and at least (measured, see docs/benchmarks: only which way is quicker hangs on it)
_CELL_S, _ROW_S, _FFT_S, _FFTS_S = 0.22e-9, 5e-9, 0.5e-9, 7e-5
# kernels of a plot that are kept: winds change
_KEPT = 64


class Landings(Protocol):
    """Who can say what lands where."""

    def landed(self, sent: Floats) -> Floats:
        """Return what lands on each plant ``(n,)`` of what each sends ``(n,)``."""
        ...


@dataclass(frozen=True, eq=False)
class Dispersal:
    """A kernel laid on a plot, for plants in any rows, with holes and in any parts.

    What lands where no plant stands is lost. Where several plants share a cell they share what
    lands on it.

    Parameters
    ----------
    cells
        The plants in cells.
    shares
        ``(2 a + 1, 2 b + 1)`` of what a plant sends, how much lands on each cell about it.
    long_share
        Share that lands on any plant of the plot, all alike, whatever the distance.
    """

    cells: Cells
    shares: Floats
    long_share: float = 0.0

    @classmethod
    def of(
        cls,
        grid: PlantGrid,
        kernel: DistanceKernel,
        wind_m_s: tuple[float, float] = (0.0, 0.0),
        *,
        own: bool = False,
    ) -> Dispersal:
        """Return a kernel laid on a plot, see :meth:`DistanceKernel.on_cells`."""
        cells = cells_of(grid)
        across, along = (int(side) for side in cells.shape)
        reach = np.ceil(kernel.reach_m(wind_m_s) / cells.size_m).astype(int)
        radius = max(1, min(across - 1, reach[0])), max(1, min(along - 1, reach[1]))
        shares = kernel.on_cells(cells.size_m, radius, wind_m_s, own=own)
        return cls(cells, shares, kernel.long_share)

    def landed(self, sent: Floats) -> Floats:
        """Return what lands on each plant ``(n,)`` of what each sends ``(n,)``.

        By whichever is quicker: a sum over the plants that send, or Fourier transforms.
        """
        rows, columns = np.minimum(self.shares.shape, self.cells.shape)
        room = self._padded[0] * self._padded[1]
        sum_s = np.count_nonzero(sent) * rows * (_ROW_S + _CELL_S * columns)
        fft_s = _FFTS_S + _FFT_S * room * np.log2(room)
        near = self.by_sum(sent) if sum_s < fft_s else self.by_fft(sent)
        if self.long_share == 0.0:
            return near
        anywhere = self.long_share * sent.sum() / len(sent)
        landed: Floats = (1.0 - self.long_share) * near + anywhere
        return landed

    def by_sum(self, sent: Floats) -> Floats:
        """Return what lands by the kernel, added up plant by plant that sends."""
        table = np.zeros(tuple(self.cells.shape))
        _add(np.flatnonzero(sent), sent, (self.cells.of_plant, table), self.shares)
        return self._shared(table)

    def by_fft(self, sent: Floats) -> Floats:
        """Return the same by Fourier transforms: the time it takes hangs on the plot alone."""
        across, along = (int(side) for side in self.cells.shape)
        # along the rows first and back last: rows beside the plot are empty, or not asked for
        waves = fft.rfft(self.cells.summed(sent), self._padded[1], axis=1)
        waves = fft.fft(waves, self._padded[0], axis=0) * self._spectrum
        rows = fft.ifft(waves, axis=0, overwrite_x=True)[:across]
        table = fft.irfft(rows, self._padded[1], axis=1)[:, :along]
        return self._shared(np.maximum(table, 0.0))

    def _shared(self, table: Floats) -> Floats:
        return table.ravel()[self.cells.of_plant] * self._part

    @cached_property
    def _part(self) -> Floats:
        """The share of what lands on its cell that each plant gets, ``(n,)``."""
        part: Floats = 1.0 / np.diff(self.cells.start)[self.cells.of_plant]
        return part

    @cached_property
    def _padded(self) -> tuple[int, int]:
        """Cells across and along with room for the kernel beside the plot."""
        radius = (np.array(self.shares.shape) - 1) // 2
        across, along = (
            fft.next_fast_len(int(side + r), real=True)
            for side, r in zip(self.cells.shape, radius, strict=True)
        )
        return across, along

    @cached_property
    def _spectrum(self) -> NDArray[np.complex128]:
        room = np.zeros(self._padded)
        a, b = ((side - 1) // 2 for side in self.shares.shape)
        # negative offsets come from the far end of the room
        y, x = np.arange(-a, a + 1) % room.shape[0], np.arange(-b, b + 1) % room.shape[1]
        np.add.at(room, (y[:, None], x[None, :]), self.shares)
        spectrum: NDArray[np.complex128] = fft.rfft2(room)
        return spectrum


@dataclass(frozen=True, eq=False)
class ToAdjacent:
    """What each plant sends goes to the plants next to it, shared out evenly."""

    adjacent: Csr

    def landed(self, sent: Floats) -> Floats:
        """Return what lands on each plant ``(n,)`` of what each sends ``(n,)``."""
        start, plant = self.adjacent
        degree = np.diff(start)
        each = np.repeat(sent / np.maximum(degree, 1), degree)
        landed: Floats = np.bincount(plant, each, len(sent)).astype(np.float64)
        return landed


@lru_cache(maxsize=4)
def cells_of(grid: PlantGrid) -> Cells:
    """Return the cells of a plot, made once."""
    return Cells.of(grid)


@lru_cache(maxsize=_KEPT)
def dispersal_of(
    grid: PlantGrid, kernel: DistanceKernel, wind_m_s: tuple[float, float]
) -> Dispersal:
    """Return a kernel laid on a plot in a wind, made once."""
    return Dispersal.of(grid, kernel, wind_m_s)


def settle(
    infested: NDArray[np.bool_], landed: Floats, key: np.uint64, turn: int = 0
) -> NDArray[np.bool_]:
    """Return who is infested where so much has landed on each plant ``(n,)``.

    What lands is a number drawn by Poisson, so a clean plant stays clean with exp(-landed). Its
    coin is its own: with the same `key` and `turn` two histories differ only where they differ.
    """
    after = infested.copy()
    _settle(landed, key, turn, after)
    return after


@loop
def _settle(landed: Floats, key: np.uint64, turn: int, after: NDArray[np.bool_]) -> None:
    n = after.size
    for i in range(n):
        if not after[i]:
            # 1 - exp(-x) is never above x, and most coins are: few have to ask for it
            drawn = coin(key, turn * n + i)
            after[i] = drawn < landed[i] and drawn < -np.expm1(-landed[i])


@loop
def _add(
    senders: NDArray[np.intp],
    sent: Floats,
    on: tuple[NDArray[np.int64], Floats],
    shares: Floats,
) -> None:
    """Add to a table of cells what each sender's kernel brings there."""
    of_plant, table = on
    across, along = table.shape
    a, b = shares.shape[0] // 2, shares.shape[1] // 2
    for i in senders:
        y, x, value = of_plant[i] // along, of_plant[i] % along, sent[i]
        first, end = max(0, x - b), min(along, x + b + 1)
        for row in range(max(0, y - a), min(across, y + a + 1)):
            # parts of rows: an index that may be negative is checked for it, cell by cell
            lands, kernel = table[row, first:end], shares[row - y + a, first - x + b :]
            for k in range(lands.size):
                lands[k] += value * kernel[k]
