"""How far insects may jump beyond the plants next to them, and what that brings to each plant."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import fft

from fieldmon.infestation.cells import Cells
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.infestation.prior.prior import edge_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.floating[Any]]
    Spectrum = NDArray[np.complexfloating[Any, Any]]

#: what jumps farther than so many plants comes from anywhere
RADIUS = 12
# mean jumps and the scale of a Cauchy kernel, in plants (our choice: what finds can tell apart)
_NEAR, _MIDDLE, _FAR = 2.0, 4.0, 3.0
#: how the jumps of a pest that jumps are shared out before anything is found: to the plants next to
#: it; and by each kernel of :func:`kernels` (our choice)
TO_ADJACENT = 0.5
BEYOND = np.array([0.25, 0.05, 0.05, 0.05, 0.05, 0.05])
#: the same of a pest whose kernel was published, its own kernel first, see :func:`pest_kernels`
OF_PEST = np.array([0.6, 0.1, 0.1, 0.05, 0.05, 0.1])
# kernels go together on small plots, for which calls cost most, so many numbers at once; on large
# ones they would not fit near the processor
_AT_ONCE = 10_000
# a pest's kernel is followed so many of its scales, and so many plants at most
_SCALES, _WIDEST = 3.0, 30


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


def pest_kernels(
    size_m: NDArray[np.float64], kernel: DistanceKernel, wind_m_s: tuple[float, float] = (0.0, 0.0)
) -> Floats:
    """Return the candidates of a pest with a kernel of its own, ``(6, d, d)``.

    Its own kernel; half and twice as far; three times as far along the rows, and across them; and
    Cauchy, for those that go farthest. The wind turns and stretches them all.
    """
    plant_m = float(np.sqrt(size_m.prod()))
    radius = int(np.ceil(_SCALES * kernel.reach_m(wind_m_s) / -np.log(0.005) / plant_m))
    radius = min(max(radius, RADIUS), _WIDEST)
    candidates = (
        kernel,
        replace(kernel, scale_m=kernel.scale_m / 2.0),
        replace(kernel, scale_m=kernel.scale_m * 2.0),
        replace(kernel, across=kernel.across / 3.0),
        replace(kernel, across=kernel.across * 3.0),
        DistanceKernel("cauchy", _FAR * plant_m),
    )
    return np.array([each.on_cells(size_m, (radius, radius), wind_m_s) for each in candidates])


def kernel_means(size_m: Floats, of: Floats | None = None) -> Floats:
    """Return how far jumps of each kernel go on average, ``(6,)`` plants; None: of `kernels`."""
    of = kernels(size_m) if of is None else of
    radius = of.shape[1] // 2
    steps = np.arange(-radius, radius + 1) / np.sqrt(size_m.prod())
    away = np.hypot(steps[None, :] * size_m[1], steps[:, None] * size_m[0])
    means: Floats = (of * away).sum(axis=(1, 2))
    return means


@dataclass(frozen=True, eq=False)
class KernelsOnCells:
    """Kernels on the cells of a plot, ready to be used.

    Parameters
    ----------
    cells
        The plants in cells.
    kernels
        ``(k, d, d)`` how what is sent is shared out over the cells about a plant. Each sums to 1.
    spectra
        ``(k, h, w)`` their Fourier transforms, on cells with room about them. All is worked out
        with as many digits as they have.
    padded
        Cells across and along with that room.
    at_edge
        ``(n,)`` how much more arrives from outside at each plant than on average, if it comes by
        the edge.
    """

    cells: Cells
    kernels: Floats
    spectra: Spectrum
    padded: tuple[int, int]
    at_edge: Floats

    def mixed(self, shares: Floats) -> Spectrum:
        """Return the transform of the kernels' mixture, of which each has a share ``(k,)``."""
        # not by a matrix library: its threads cost a hundred times what is added here
        spectrum: Spectrum = np.einsum("k,kij->ij", shares.astype(self._real), self.spectra)
        return spectrum

    def landed(self, sent: Floats, mixed: Spectrum) -> Floats:
        """Return what lands on each plant, ``(n,)``, of what all plants send out.

        Parameters
        ----------
        sent
            ``(n,)`` what each plant sends.
        mixed
            By what it goes, see `mixed`; conjugated it goes the other way, from where it would
            land to where it came from.
        """
        return self._landed(self._sent(sent) * mixed)

    def _sent(self, values: Floats) -> Spectrum:
        size = self.padded[0] * self.padded[1]
        if self._alone:
            room = np.zeros(size, self._real)
            room[self._place] = values
        else:
            room = np.bincount(self._place, values, size).astype(self._real)
        sent: Spectrum = fft.rfft2(room.reshape(self.padded))
        return sent

    def _landed(self, spectrum: Spectrum) -> Floats:
        on_cells = fft.irfft2(spectrum, self.padded)
        landed: Floats = on_cells.reshape(*spectrum.shape[:-2], -1).take(self._place, axis=-1)
        return np.maximum(landed, 0.0, out=landed)

    @property
    def _real(self) -> np.dtype[np.floating[Any]]:
        return self.spectra.real.dtype

    @cached_property
    def _place(self) -> NDArray[np.int64]:
        """The cell of each plant among those with room about them, ``(n,)``."""
        across, along = np.divmod(self.cells.of_plant, self.cells.shape[1])
        place: NDArray[np.int64] = across * self.padded[1] + along
        return place

    @cached_property
    def _alone(self) -> bool:
        """Tell whether no two plants stand in one cell."""
        return bool(np.diff(self.cells.start).max() <= 1)


@dataclass(frozen=True, eq=False)
class Reach(KernelsOnCells):
    """The kernels beyond the plants next to one, ``(6, d, d)`` as :func:`kernels` has them.

    Parameters
    ----------
    adjacent
        Share of what a plant sends that goes to the plants next to it.
    beyond
        ``(6,)`` share that goes by each kernel.
    anywhere
        Share that lands anywhere.
    """

    adjacent: float = TO_ADJACENT
    beyond: Floats = field(default_factory=lambda: BEYOND)
    anywhere: float = 0.0

    def brought_by_each(self, values: Floats) -> Floats:
        """Return what each kernel brings each plant of the ``values (n,)`` sent, ``(6, n)``."""
        sent = self._sent(values)
        at_once = max(_AT_ONCE // sent.size, 1)
        parts = [
            self._landed(sent * self.spectra[k : k + at_once])
            for k in range(0, len(self.spectra), at_once)
        ]
        return np.concatenate(parts)


@lru_cache(maxsize=2)
def reach_of(grid: PlantGrid) -> Reach:
    """Return the kernels of a plot, made once."""
    cells = Cells.of(grid)
    made = kernels(cells.size_m)
    return Reach(cells, made, *transformed(cells, made), _at_edge(grid))


@lru_cache(maxsize=8)
def pest_reach_of(
    grid: PlantGrid, kernel: DistanceKernel, wind_m_s: tuple[float, float] = (0.0, 0.0)
) -> Reach:
    """Return the kernels of a pest on a plot in a wind, made once.

    What they bring to the cells of the plants next to it is told apart: there chances of pairs
    know more.
    """
    usual = reach_of(grid)
    cells = usual.cells
    made = pest_kernels(cells.size_m, kernel, wind_m_s)
    h = made.shape[1] // 2
    shares = OF_PEST * (1.0 - kernel.long_share)
    next_to = np.s_[:, [h - 1, h + 1, h, h], [h, h, h - 1, h + 1]]
    near = made[next_to].sum(axis=1)
    made[next_to] = 0.0
    far = np.maximum(1.0 - near, 1e-12)
    made /= far[:, None, None]
    return Reach(
        cells,
        made,
        *transformed(cells, made),
        usual.at_edge,
        adjacent=float(shares @ near),
        beyond=shares * far,
        anywhere=kernel.long_share,
    )


def transformed(cells: Cells, made: Floats) -> tuple[NDArray[np.complex128], tuple[int, int]]:
    """Return the transforms of kernels ``(6, d, d)``, and the cells with room about them."""
    d = made.shape[1]
    # what goes over one edge comes in again over the other, but only so far that no plant is there
    across, along = (
        fft.next_fast_len(max(int(side) + d // 2, d), real=True) for side in cells.shape
    )
    room = np.zeros((len(made), across, along))
    about = np.arange(d) - d // 2
    room[:, about[:, None], about] = made
    return fft.rfft2(room), (across, along)


def _at_edge(grid: PlantGrid) -> Floats:
    at_edge = edge_chance(grid, PriorSettings())
    by_edge: Floats = at_edge / max(at_edge.mean(), 1e-9)
    return by_edge
