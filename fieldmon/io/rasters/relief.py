"""What the reading process answers when the relief of a raster of heights is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rasterio.enums import ColorInterp, Resampling
from scipy import ndimage

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import Imported, seen
from fieldmon.io.rasters.opening import band_named, open_raster
from fieldmon.io.rasters.picture import corners_on_map, encoded, read_for_picture
from fieldmon.io.rasters.values import Backdrop, map_xy
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.io.rasters.opening import OpenRaster
    from fieldmon.io.rasters.pixels import RasterPart
    from fieldmon.io.rasters.values import RasterOptions

    Float = NDArray[np.float64]
    Bounds = tuple[float, float, float, float]

# coarse heights are drawn on at least so many pixels, as a smooth surface
_FINE = 600
# four lights from the west half of the sky, each on what faces it (Mark, USGS OFR 92-422, 1992)
_AZIMUTHS = np.deg2rad([225.0, 270.0, 315.0, 360.0])
_ALTITUDE = np.deg2rad(30.0)
_FLAT = float(np.sin(_ALTITUDE))
# slopes are drawn so much steeper that the steepest but five in a hundred seem so steep
_SEEMS = np.tan(np.deg2rad(25.0))
_STEEPER = 10.0
# the grey of what no light meets, and of the flat
_GREYS = (120.0, 226.0)


def relief(
    folder: str, source: Source, options: RasterOptions, bounds: Bounds | None
) -> Imported[Backdrop]:
    """Return the relief of a source, or of what lies within bounds (west, south, east, north)."""
    with open_raster(folder, source, options) as opened:
        band = 1 if options.band is None else band_named(opened, options.band)
        part, read = read_for_picture(opened, (band,), bounds, options, Resampling.average)
        heights, missing = read.values[0].astype(np.float64), read.missing
        low, high = heights[~missing].min(), heights[~missing].max()
        heights, missing = finer(filled(heights, missing), missing)
        slope = slopes(heights, _ground(opened, part, heights.shape))
        times = steeper(slope[:, ~missing])
        grey = _GREYS[0] + shade(times * slope) / _FLAT * (_GREYS[1] - _GREYS[0])
        corners, bent = corners_on_map(opened, part)
        said = seen(
            worded(
                "Heights of {low:.5g} to {high:.5g} m; slopes are drawn {times:.3g} times as "
                "steep as they are, so that they are seen.",
                low=low,
                high=high,
                times=times,
            )
        )
        picture = Backdrop(*encoded(np.clip(grey, 0, 255).astype(np.uint8)[None], missing), corners)
        return Imported(picture, (*read.messages, said, *bent))


def looks_like_heights(
    folder: str, source: Source, options: RasterOptions, _bounds: Bounds | None
) -> bool:
    """Return whether a source holds one band of numbers that are neither colours nor classes."""
    with open_raster(folder, source, options) as opened:
        meaning = opened.tif.colorinterp
        bands = [k for k, one in enumerate(meaning) if one != ColorInterp.alpha]
        is_one = len(bands) == 1 and meaning[bands[0]] != ColorInterp.palette
        return is_one and opened.tif.dtypes[bands[0]] != "uint8"


def filled(heights: Float, missing: NDArray[np.bool_]) -> Float:
    """Return the heights; where there is none, that of the nearest pixel that has one."""
    if not missing.any():
        return heights
    near = ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    nearest: Float = heights[tuple(near)]
    return nearest


def finer(heights: Float, missing: NDArray[np.bool_]) -> tuple[Float, NDArray[np.bool_]]:
    """Return the same ground on more pixels where there are few, as a smooth surface."""
    times = int(np.ceil(_FINE / max(heights.shape)))
    if times <= 1:
        return heights, missing
    smooth = ndimage.zoom(heights, times, order=3, mode="nearest", grid_mode=True)
    return smooth, missing.repeat(times, axis=0).repeat(times, axis=1)


def slopes(heights: Float, ground: Float) -> Float:
    """Return metres up per metre to the east and to the north, ``(2, h, w)``.

    `ground` ``(2, 2)`` says how many metres to the east and north a column, and a row, goes.
    """
    down = np.gradient(heights, axis=0) if heights.shape[0] > 1 else np.zeros_like(heights)
    across = np.gradient(heights, axis=1) if heights.shape[1] > 1 else np.zeros_like(heights)
    up: Float = np.einsum("ij,jhw->ihw", np.linalg.inv(ground).T, np.stack([across, down]))
    return up


def steeper(slope: Float) -> float:
    """Return how many times as steep slopes ``(2, n)`` are drawn: 1 to 10."""
    usual = float(np.percentile(np.hypot(*slope), 95))
    return float(np.clip(_SEEMS / max(usual, 1e-9), 1.0, _STEEPER)) if usual > 1e-9 else 1.0


def shade(slope: Float) -> Float:
    """Return how light ground of these slopes ``(2, h, w)`` is, 0 to 1; the flat is 0.5."""
    east, north = slope
    upright = 1.0 / np.sqrt(1.0 + east**2 + north**2)
    faces = np.arctan2(-east, -north)  # downhill, clockwise from north
    light: Float = np.zeros_like(east)
    for azimuth in _AZIMUTHS:
        towards = -(east * np.sin(azimuth) + north * np.cos(azimuth)) * np.cos(_ALTITUDE)
        lit = np.clip((towards + np.sin(_ALTITUDE)) * upright, 0.0, None)
        light += np.sin(faces - azimuth) ** 2 * lit / 2.0
    return light


def _ground(opened: OpenRaster, part: RasterPart, shape: tuple[int, ...]) -> Float:
    """Return how many metres to the east and north a pixel's column, and its row, goes."""
    high, wide = part.shape
    ends = np.array([[wide / 2, high / 2], [wide / 2 + 1, high / 2], [wide / 2, high / 2 + 1]])
    lonlat = opened.transformation.lonlat(map_xy(part.to_map(opened.to_map), ends))
    metres = M_PER_DEGREE * np.array([np.cos(np.deg2rad(lonlat[0, 1])), 1.0])
    a_step = ((lonlat[1:] - lonlat[0]) * metres).T
    steps: Float = a_step * [wide / shape[1], high / shape[0]]
    return steps
