"""Uneven ground for the physical simulation: of a raster of heights, or rough by chance."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import ndimage

from fieldmon.compute.ranges import AllowedRange
from fieldmon.errors import FileProblem, SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]

#: ground beyond the outermost plants
MARGIN_M = 30.0
_CELL_M = 0.25
_MOST_CELLS = 4_000_000
#: bumps are about so far apart
_BUMP_M = 1.0
ROUGH_M = AllowedRange(0.0, 0.3, unit=" metres")


class UnevenGround(NamedTuple):
    """Heights on an even grid in the plot's frame.

    Parameters
    ----------
    low_m
        ``(2,)`` the corner of the first height, x and y.
    cell_m
        Between heights, both ways.
    height_m
        ``(rows, columns)``, y and x rising; the lowest is 0.
    """

    low_m: Float
    cell_m: float
    height_m: Float

    def __repr__(self) -> str:
        return f"<UnevenGround: up to {self.height_m.max():.2f} m, every {self.cell_m:g} m>"

    def at(self, xy_m: Float) -> Float:
        """Return the height ``(k,)`` at places ``(k, 2)``, even between four heights."""
        column, row = ((np.atleast_2d(xy_m) - self.low_m) / self.cell_m).T
        heights: Float = ndimage.map_coordinates(
            self.height_m, [row, column], order=1, mode="nearest"
        )
        return heights


def rough_ground(grid: PlantGrid, rough_m: float, seed: int = 1) -> UnevenGround:
    """Return ground with bumps about a metre apart.

    Parameters
    ----------
    grid
        The plants that stand on it.
    rough_m
        Standard deviation of heights, 0 to 0.3 m; 0: level.
    seed
        Of the bumps.

    Examples
    --------
    >>> from fieldmon.drive.ground import rough_ground
    >>> from fieldmon.plot.layout import rectangle
    >>> round(float(rough_ground(rectangle(3, 4), 0.02).height_m.std()), 3)
    0.02
    """
    if ROUGH_M.broken(rough_m):
        raise SettingError(
            f"Roughness must be 0 to {ROUGH_M.most:g} metres (standard deviation of heights), but "
            f"it is {rough_m:g}."
        )
    flat = _level(grid)
    if not rough_m:
        return flat
    noise = np.random.default_rng(seed).standard_normal(flat.height_m.shape)
    bumps = ndimage.gaussian_filter(noise, _BUMP_M / 2 / flat.cell_m, mode="wrap")
    bumps *= rough_m / bumps.std()
    return flat._replace(height_m=bumps - bumps.min())


def ground_of_raster(grid: PlantGrid, field: Field, heights: Source) -> UnevenGround:
    """Return ground as a raster of heights has it; where it says nothing, as nearby.

    Raise what `read_raster` raises, and `FileProblem` where it holds no height of the plot.
    """
    from fieldmon.io.rasters.read import read_raster  # noqa: PLC0415 - half a second
    from fieldmon.io.rasters.relief import filled  # noqa: PLC0415

    flat = _level(grid)
    rows, columns = np.indices(flat.height_m.shape).reshape(2, -1) * flat.cell_m
    places = flat.low_m + np.stack([columns, rows], axis=1)
    read = read_raster(heights, None, field).value.at(grid.frame.lonlat(places), "bilinear")
    height_m = read.reshape(flat.height_m.shape)
    missing = ~np.isfinite(height_m)
    if missing.all():
        raise FileProblem("The raster of heights holds no height of this plot.")
    height_m = filled(height_m, missing)
    return flat._replace(height_m=height_m - height_m.min())


def _level(grid: PlantGrid) -> UnevenGround:
    low = grid.xy_m.min(axis=0) - MARGIN_M
    wide, deep = grid.xy_m.max(axis=0) + MARGIN_M - low
    # a very large plot has coarser ground
    cell = max(_CELL_M, float(np.sqrt(wide * deep / _MOST_CELLS)))
    shape = int(np.ceil(deep / cell)) + 1, int(np.ceil(wide / cell)) + 1
    return UnevenGround(low, cell, np.zeros(shape))
