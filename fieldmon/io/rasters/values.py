"""What was read from a raster: values on a grid of pixels, and what they are at each plant."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np

from fieldmon.compute.jit import routine
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.options import ReadOptions
from fieldmon.io.parse.crs import Transformation, system, transformation_from
from fieldmon.io.rasters.interpolated_projection import smoothly

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]

How: TypeAlias = Literal["nearest", "bilinear", "mean", "highest"]
#: ``(a, b, c, d, e, f)``: pixel (column, row) lies at x = a column + b row + c, y = d column + ...
Affine: TypeAlias = tuple[float, float, float, float, float, float]

_NOT_OF_RASTERS = ("layer", "where", "swap_axes", "encoding", "columns", "decimal", "delimiter")
# of the ground that a plant has to itself, this much each way is looked at: the rest is aisle
_FOOTPRINT = 0.5
_MOST_POINTS = 9


@dataclass(frozen=True)
class RasterOptions(ReadOptions):
    """What can be chosen when a raster is read.

    Parameters
    ----------
    band
        Number from 1, or description, of the band with the values; a backdrop takes one or three,
        ``"4,1,2"``.
    nodata
        The number that stands for no value, or ``"none"``: every number is a value.
    """

    band: str | None = None
    nodata: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in _NOT_OF_RASTERS:
            if getattr(self, name):
                raise SettingError(
                    worded("A raster has no {name} to choose. Leave it away.", name=name)
                )
        if self.nodata is not None and self.nodata != "none":
            try:
                float(self.nodata)
            except ValueError:
                raise SettingError(
                    worded(
                        'What stands for no value must be a number or "none", '
                        "but it is {nodata!r}.",
                        nodata=self.nodata,
                    )
                ) from None


@dataclass(frozen=True, eq=False)
class Raster:
    """One band of a raster, or the part of it about a plot.

    Parameters
    ----------
    values
        ``(h, w)`` float32 or float64, scale and offset applied; NaN where there is no value.
    to_map
        Where pixels lie, in the raster's own coordinate system; pixel (0, 0) begins at (c, f).
    crs
        That system, as text PROJ understands.
    is_classes
        The numbers are classes (the band has a colour table): they must not be averaged.
    described
        What the file calls the band; empty: nothing.
    scaled
        The scale and the offset that were applied.
    """

    values: NDArray[np.floating]
    to_map: Affine
    crs: str
    is_classes: bool = False
    described: str = ""
    scaled: tuple[float, float] = (1.0, 0.0)

    def __post_init__(self) -> None:
        self.values.setflags(write=False)

    @cached_property
    def transformation(self) -> Transformation:
        """Return how its coordinates become degrees."""
        rows, columns = self.values.shape
        middle = map_xy(self.to_map, np.array([[columns / 2, rows / 2]]))[0]
        return transformation_from(system(self.crs), (float(middle[0]), float(middle[1])))

    def stored(self, value: float) -> float:
        """Return how the file has a value: as nodata is named."""
        scale, offset = self.scaled
        return (value - offset) / scale

    def pixels(self, lonlat: Float) -> Float:
        """Return column and row of positions ``(n, 2)``, pixel (0, 0) reaching from 0 to 1."""
        return pixel_xy(self.to_map, projected(self.transformation, lonlat))

    def at(self, lonlat: Float, how: How = "nearest") -> Float:
        """Return the values at positions ``(n, 2)``, ``(n,)``; NaN where there is none.

        ``"nearest"`` is that of the pixel in which a position lies; ``"bilinear"`` weighs the four
        pixels about it, those without a value left out.
        """
        self._check(how)
        if how not in {"nearest", "bilinear"}:
            raise SettingError(
                worded("A position has no footprint to take the {how} of. Sample plants.", how=how)
            )
        return self._sampled(self.pixels(np.asarray(lonlat, np.float64).reshape(-1, 2)), how)

    def of_plants(self, grid: PlantGrid, how: How = "mean") -> Float:
        """Return the values of a grid's plants, ``(n,)``; NaN where there is none.

        ``"mean"`` and ``"highest"`` look at the middle of the ground that a plant has to itself:
        half the plant spacing along the row by half the row spacing across, at 9 x 9 points at
        most; points without a value are left out.
        """
        self._check(how)
        if how in {"nearest", "bilinear"}:
            return self._sampled(self._of_plants(grid), how)
        return _points(self.values, self._of_plants(grid), self._about(grid), how == "highest")

    def _of_plants(self, grid: PlantGrid) -> Float:
        """Return column and row of each plant, ``(n, 2)``."""
        return smoothly(grid.xy_m, lambda xy_m: self.pixels(grid.frame.lonlat(xy_m)))

    def _sampled(self, places: Float, how: How) -> Float:
        if how == "nearest":
            return _points(self.values, places, np.zeros((1, 2)), False)
        return _bilinear(self.values, places)

    def _check(self, how: How) -> None:
        if how not in get_args(How):
            raise SettingError(
                worded(
                    "A raster is sampled by {names}, but {how!r} was asked for.",
                    names=", ".join(get_args(How)),
                    how=how,
                )
            )
        if self.is_classes and how != "nearest":
            raise FileProblem(
                worded(
                    "Classes must not be averaged or compared, but this band "
                    "holds classes (it has a colour table) and the {how} was "
                    "asked for. Sample it by nearest.",
                    how=how,
                )
            )

    def _about(self, grid: PlantGrid) -> Float:
        """Return the points of a plant's footprint in pixels from the plant, ``(k, 2)``."""
        middle = grid.xy_m.mean(axis=0)
        sides_m = _FOOTPRINT * np.array([grid.plant_spacing_m, grid.row_spacing_m])
        if grid.aisles_m is not None:  # rows run anyhow: what is the plant's own either way
            sides_m[:] = sides_m.min()
        ends = np.array([[-0.5, 0.0], [0.5, 0.0], [0.0, -0.5], [0.0, 0.5]]) * sides_m
        places = self.pixels(grid.frame.lonlat(middle + ends))
        sides = places[1::2] - places[::2]  # in pixels, along and across
        steps = [
            (np.arange(n) + 0.5) / n - 0.5
            for n in np.clip(np.ceil(np.hypot(*sides.T)), 1, _MOST_POINTS).astype(int)
        ]
        along, across = (step.ravel() for step in np.meshgrid(*steps))
        about: Float = along[:, None] * sides[0] + across[:, None] * sides[1]
        return about


@dataclass(frozen=True, eq=False)
class Backdrop:
    """A picture of the ground for a map.

    Parameters
    ----------
    image
        The picture as it is saved, at most 2000 pixels wide and high; clear where there is nothing.
    mime
        What kind: ``"image/webp"``.
    corners_lonlat
        ``(4, 2)`` where its corners lie, in the order of deck.gl's BitmapLayer: bottom left, top
        left, top right, bottom right.
    """

    image: bytes
    mime: str
    corners_lonlat: Float

    def __post_init__(self) -> None:
        self.corners_lonlat.setflags(write=False)


def map_xy(to_map: Affine, places: Float) -> Float:
    """Return map coordinates ``(n, 2)`` of columns and rows ``(n, 2)``."""
    a, b, c, d, e, f = to_map
    column, row = places[:, 0], places[:, 1]
    return np.stack([a * column + b * row + c, d * column + e * row + f], axis=1)


def pixel_xy(to_map: Affine, xy: Float) -> Float:
    """Return columns and rows ``(n, 2)`` of map coordinates ``(n, 2)``."""
    a, b, c, d, e, f = to_map
    turn = a * e - b * d
    x, y = xy[:, 0] - c, xy[:, 1] - f
    return np.stack([(e * x - b * y) / turn, (a * y - d * x) / turn], axis=1)


def projected(through: Transformation, lonlat: Float) -> Float:
    """Return degrees ``(n, 2)`` in the system that a transformation comes from."""
    if through.transformer is None:
        return lonlat
    x, y = through.transformer.transform(lonlat[:, 0], lonlat[:, 1], direction="INVERSE")
    return np.stack([x, y], axis=1)


@routine
def _points(
    values: NDArray[np.floating],
    places: Float,
    about: Float,
    highest: bool,  # noqa: FBT001 - numba takes no keywords cheaply
) -> Float:
    """Return mean or highest value of the points ``(k, 2)`` about each place ``(n, 2)``."""
    rows, columns = values.shape
    out = np.full(len(places), np.nan)
    for i in range(len(places)):
        total, least, most, n = 0.0, np.inf, -np.inf, 0
        for k in range(len(about)):
            column, row = places[i, 0] + about[k, 0], places[i, 1] + about[k, 1]
            # so that NaN and infinity fail it too
            if not (0.0 <= column < columns and 0.0 <= row < rows):
                continue
            value = values[int(row), int(column)]
            if not np.isnan(value):
                total += value
                least, most = min(least, value), max(most, value)
                n += 1
        if n:
            # of equal values the mean is that value to the bit, however many they are
            out[i] = most if highest or least == most else total / n
    return out


@routine
def _bilinear(values: NDArray[np.floating], places: Float) -> Float:
    rows, columns = values.shape
    out = np.full(len(places), np.nan)
    for i in range(len(places)):
        column, row = places[i, 0], places[i, 1]
        if not (0.0 <= column < columns and 0.0 <= row < rows):
            continue
        if np.isnan(values[int(row), int(column)]):
            continue
        left, above = int(np.floor(column - 0.5)), int(np.floor(row - 0.5))
        total, weights, least, most = 0.0, 0.0, np.inf, -np.inf
        for r in range(above, above + 2):
            for c in range(left, left + 2):
                if 0 <= r < rows and 0 <= c < columns and not np.isnan(values[r, c]):
                    weight = (1.0 - abs(column - 0.5 - c)) * (1.0 - abs(row - 0.5 - r))
                    total += weight * values[r, c]
                    weights += weight
                    least, most = min(least, values[r, c]), max(most, values[r, c])
        out[i] = most if least == most else total / weights
    return out
