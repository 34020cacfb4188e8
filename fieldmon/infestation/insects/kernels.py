"""Where what leaves a plant lands: kernels of distance, on the cells of a plot, in a wind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy.special import i0e

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Shape = Literal["exponential", "cauchy"]

# what lands near is summed over so many points a side of each cell, so many cells about
_POINTS, _NEAR = 6, 3
#: a kernel is cut off where so little of it is left, or beyond the plot
_LEFT = 0.005
# in a wind of so many metres a second, jumps go twice as far; and how strongly a metre a second
# gathers them downwind (concentration of a von Mises distribution: 2 in 3 m/s; our choice)
_DOUBLES_M_S, _GATHERS = 5.0, 2.0 / 3.0
_CALM: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class DistanceKernel:
    """How far jumps go, and which way.

    Parameters
    ----------
    shape
        ``"exponential"``: of the distance, `scale_m` its mean. ``"cauchy"``: in two dimensions,
        half of the jumps go farther than 1.7 times `scale_m`.
    scale_m
        Its scale in metres.
    across
        How far jumps go across the rows, where along them they go 1.
    long_share
        Share of jumps that land anywhere on the plot.

    Examples
    --------
    >>> import numpy as np
    >>> kernel = DistanceKernel("exponential", 3.0)
    >>> shares = kernel.on_cells(np.array([3.0, 3.0]), (2, 2))
    >>> shares.shape, round(float(shares.sum()), 9), float(shares[2, 2])
    ((5, 5), 1.0, 0.0)
    """

    shape: Shape
    scale_m: float
    across: float = 1.0
    long_share: float = 0.0

    def __post_init__(self) -> None:
        if self.shape not in {"exponential", "cauchy"}:
            raise SettingError(
                f"A kernel's shape must be 'exponential' or 'cauchy', but it is {self.shape!r}."
            )
        for name in ("scale_m", "across"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise SettingError(
                    f"A kernel's {name} must be above 0, but it is {getattr(self, name)}."
                )
        if not 0.0 <= self.long_share <= 1.0:
            raise SettingError(
                f"A kernel's share of long jumps must be in 0..1, but it is {self.long_share}."
            )

    def reach_m(self, wind_m_s: tuple[float, float] = _CALM) -> float:
        """Return beyond which distance it is cut off."""
        scale_m = self.scale_m * max(self.across, 1.0) * _stretch(wind_m_s)
        if self.shape == "exponential":
            return float(-np.log(_LEFT) * scale_m)
        return float(np.sqrt(_LEFT**-2.0 - 1.0) * scale_m)

    def on_cells(
        self,
        size_m: Floats,
        radius: tuple[int, int],
        wind_m_s: tuple[float, float] = _CALM,
        *,
        own: bool = False,
    ) -> Floats:
        """Return the share of jumps that lands on each cell about a plant, ``(2 a + 1, 2 b + 1)``.

        They sum to 1; long jumps are left out.

        Parameters
        ----------
        size_m
            ``(2,)`` size of a cell across the rows and along them.
        radius
            How many cells (a, b) across and along, to each side.
        wind_m_s
            Metres a second that the wind goes along the rows (x) and across them (y).
        own
            Whether what lands on the cell it came from counts; if not, all leave it.
        """
        a, b = radius
        y, x = np.arange(-a, a + 1), np.arange(-b, b + 1)
        shares = self._density(y[:, None] * size_m[0], x[None, :] * size_m[1], wind_m_s)
        h, w = min(a, _NEAR), min(b, _NEAR)
        near = np.s_[a - h : a + h + 1, b - w : b + w + 1]
        shares[near] = self._mean_density(y[near[0]], x[near[1]], size_m, wind_m_s)
        if not own:
            shares[a, b] = 0.0
        total = shares.sum()
        if total <= 0.0:  # all far below what a number can hold: to the plants beside it
            return _on_adjacent_cells(shares.shape, a, b)
        landed: Floats = shares / total
        return landed

    def _mean_density(
        self,
        y: NDArray[np.integer],
        x: NDArray[np.integer],
        size_m: Floats,
        wind_m_s: tuple[float, float],
    ) -> Floats:
        """Return the mean over points in each cell ``(len(y), len(x))``; none is its middle."""
        off = (np.arange(_POINTS) + 0.5) / _POINTS - 0.5
        fine_y = ((y[:, None] + off) * size_m[0]).ravel()
        fine_x = ((x[:, None] + off) * size_m[1]).ravel()
        fine = self._density(fine_y[:, None], fine_x[None, :], wind_m_s)
        mean: Floats = fine.reshape(len(y), _POINTS, len(x), _POINTS).mean(axis=(1, 3))
        return mean

    def _density(self, y_m: Floats, x_m: Floats, wind_m_s: tuple[float, float]) -> Floats:
        """Return how much lands at places about a plant, up to a factor."""
        y_m = y_m / self.across
        away = np.maximum(np.hypot(y_m, x_m) / (self.scale_m * _stretch(wind_m_s)), 1e-9)
        speed = float(np.hypot(*wind_m_s))
        shape = np.exp(-away) / away if self.shape == "exponential" else (1.0 + away**2) ** -1.5
        if speed == 0.0:
            return shape
        downwind = (x_m * wind_m_s[0] + y_m * wind_m_s[1]) / np.maximum(
            np.hypot(y_m, x_m) * speed, 1e-9
        )
        gathers = _GATHERS * speed
        blown: Floats = shape * np.exp(gathers * (downwind - 1.0)) / i0e(gathers)
        return blown


def _stretch(wind_m_s: tuple[float, float]) -> float:
    return 1.0 + float(np.hypot(*wind_m_s)) / _DOUBLES_M_S


def _on_adjacent_cells(shape: tuple[int, ...], a: int, b: int) -> NDArray[np.float64]:
    shares = np.zeros(shape)
    for y, x in ((a - 1, b), (a + 1, b), (a, b - 1), (a, b + 1)):
        if 0 <= y < shape[0] and 0 <= x < shape[1]:
            shares[y, x] = 1.0
    total = shares.sum()
    return shares / total if total else shares
