"""Where what plants send out lands, by a kernel of distance: on average, or drawn jump by jump."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np
from scipy import fft

from fieldmon.compute.jit import loop, routine
from fieldmon.compute.random_streams import coin, coin_bits
from fieldmon.infestation.cells import Cells
from fieldmon.infestation.chance_bounds import lesser

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.kernels import DistanceKernel
    from fieldmon.plot.grid import Csr, PlantGrid

    Floats = NDArray[np.float64]
    Mask = NDArray[np.bool_]
    Plants = NDArray[np.intp]

# seconds a cell of a sending plant's kernel, and a row of it; and of the transforms a cell and
# doubling, and at least (measured, see docs/benchmarks: only which way is quicker hangs on it)
_CELL_S, _ROW_S, _FFT_S, _FFTS_S = 0.22e-9, 5e-9, 0.5e-9, 7e-5
# kernels of a plot that are kept: winds change
_KEPT = 64
# where jumps go has coins of its own, a table for each plant that sends; a jump asks for several
_JUMPS = np.uint64(0xA0761D6478BD642F)
_WHICH, _FAR, _ANY = 2**32, 2**33, 2**34
# of so many jumps on average exp(-mean) is still a number; more are drawn by parts
_AT_ONCE = 30.0


class Landings(Protocol):
    """Who can draw where what plants send lands."""

    def reached(self, senders: Plants, sends: float, key: np.uint64, turn: int = 0) -> Mask:
        """Return the plants ``(n,)`` on which something lands, see `Dispersal.reached`."""
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

    def reached(self, senders: Plants, sends: float, key: np.uint64, turn: int = 0) -> Mask:
        """Draw where what plants send lands; return the plants ``(n,)`` on which something does.

        Each sends a number drawn by Poisson, and each jump goes to a cell drawn by the kernel. So a
        plant is reached with 1 - exp(-landed), as `landed` and `settle` have it, and it takes as
        long as there are senders and jumps. A sender's jumps are its own: with the same `key` and
        `turn` two histories differ only where they differ, and with more `sends` it adds jumps.

        Parameters
        ----------
        senders
            ``(k,)`` numbers of the plants that send.
        sends
            How much each sends on average.
        key, turn
            Name the table of coins.
        """
        found = np.zeros(len(self.cells.of_plant), np.bool_)
        where = self._at, self._of_cells, self._dealt
        _reach(senders, (sends, self.long_share), (key, turn), where, found)
        return found

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
    def _at(self) -> NDArray[np.int32]:
        """The cell of each plant, across and along, ``(n, 2)``."""
        at = np.divmod(self.cells.of_plant, self.cells.shape[1])
        return np.column_stack(at).astype(np.int32)

    @cached_property
    def _of_cells(self) -> tuple[NDArray[np.int32], NDArray[np.int32], tuple[int, int]]:
        """The plants of each cell, small enough to stay near the processor."""
        start, plant = self.cells.start.astype(np.int32), self.cells.plant.astype(np.int32)
        return start, plant, (int(self.cells.shape[0]), int(self.cells.shape[1]))

    @cached_property
    def _dealt(self) -> tuple[Floats, NDArray[np.int32], NDArray[np.int32]]:
        """The kernel as a table from which a cell is drawn by one coin.

        Walker's alias table (Vose 1991, IEEE Trans. Softw. Eng. 17:972): how much of each entry is
        its own cell, and how far across and along that one is, and the one that has the rest.
        """
        across, along = self.shares.shape
        own = self.shares.ravel() * self.shares.size
        other = np.arange(own.size, dtype=np.int32)
        _deal(own, other, np.empty(own.size, np.int32))
        steps = np.divmod(np.arange(own.size, dtype=np.int32), along)
        away = np.column_stack(steps).astype(np.int32) - np.array([across // 2, along // 2])
        away = away.astype(np.int32)
        return own, np.ascontiguousarray(away), np.ascontiguousarray(away[other])

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
    """What each plant sends goes to the plants next to it."""

    adjacent: Csr

    def reached(self, senders: Plants, sends: float, key: np.uint64, turn: int = 0) -> Mask:
        """Return the plants reached, as `Dispersal.reached`; so much goes to each of them."""
        found = np.zeros(len(self.adjacent.start) - 1, np.bool_)
        _reach_adjacent(senders, float(-np.expm1(-sends)), (key, turn), self.adjacent, found)
        return found


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
    """Return which plants are infested where so much has landed on each plant ``(n,)``.

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


@loop
def _reach(
    senders: Plants,
    sends: tuple[float, float],
    coins: tuple[np.uint64, int],
    where: tuple[
        NDArray[np.int32],
        tuple[NDArray[np.int32], NDArray[np.int32], tuple[int, int]],
        tuple[Floats, NDArray[np.int32], NDArray[np.int32]],
    ],
    found: Mask,
) -> None:
    """Draw jumps and mark the plants that they reach; `sends` ends with the share of long ones."""
    mean, long_share = sends
    key, turn = coins
    at, (start, plant, shape), (own, to, to_other) = where
    (across, along), n = shape, found.size
    none = np.exp(-lesser(mean, _AT_ONCE))
    for i in senders:
        drawn = coin(key, turn * n + i)
        if drawn < none and mean <= _AT_ONCE:
            continue
        table = coin_bits(key ^ _JUMPS, turn * n + i)
        for jump in range(_jumps(drawn, mean, none, table)):
            if long_share > 0.0 and coin(table, jump + _FAR) < long_share:
                found[int(coin(table, jump + _ANY) * n)] = True
                continue
            lands = coin(table, jump) * own.size
            cell = int(lands)
            step = to[cell] if lands - cell < own[cell] else to_other[cell]
            y, x = at[i, 0] + step[0], at[i, 1] + step[1]
            if 0 <= y < across and 0 <= x < along:
                first = start[y * along + x]
                here = start[y * along + x + 1] - first
                if here > 1:
                    first += int(coin(table, jump + _WHICH) * here)
                if here > 0:
                    found[plant[first]] = True


@routine
def _jumps(drawn: float, mean: float, none: float, table: np.uint64) -> int:
    """Return a number drawn by Poisson: by one coin, of many jumps by one for each part."""
    number, part = 0, 1
    while True:
        here = lesser(mean, _AT_ONCE)
        chance = none if mean >= _AT_ONCE or part == 1 else np.exp(-here)
        below, k = chance, 0
        while drawn >= below and chance > 0.0:
            k += 1
            chance *= here / k
            below += chance
        number += k
        mean -= _AT_ONCE
        if mean <= 0.0:
            return number
        drawn = coin(table, part + 2 * _ANY)
        part += 1


@loop
def _reach_adjacent(
    senders: Plants, chance: float, coins: tuple[np.uint64, int], adjacent: Csr, found: Mask
) -> None:
    key, turn = coins
    start, plant = adjacent
    for i in senders:
        table = coin_bits(key ^ _JUMPS, turn * found.size + i)
        for e in range(start[i], start[i + 1]):
            if coin(table, e - start[i]) < chance:
                found[plant[e]] = True


@loop
def _deal(own: Floats, other: NDArray[np.int32], work: NDArray[np.int32]) -> None:
    """Make an alias table in place of shares whose mean is 1; `work` is room for as many."""
    small, large = 0, own.size
    for k in range(own.size):
        if own[k] < 1.0:
            work[small] = k
            small += 1
        else:
            large -= 1
            work[large] = k
    while small > 0 and large < own.size:
        small -= 1
        poor, rich = work[small], work[large]
        other[poor] = rich
        own[rich] -= 1.0 - own[poor]
        if own[rich] < 1.0:
            large += 1
            work[small] = rich
            small += 1
    # what is left over is 1 but for rounding
    for k in range(small):
        own[work[k]] = 1.0
    for k in range(large, own.size):
        own[work[k]] = 1.0
