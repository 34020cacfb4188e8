"""Chances out: a Cloud Optimised GeoTIFF that any GIS opens."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyproj

from fieldmon.compute.jit import routine
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.infestation.prior.raster_risk import CHANCE_BAND
from fieldmon.io.atomic_write import write_whole
from fieldmon.io.rasters.interpolated_projection import smoothly
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]

NODATA = -9999.0
_TILE = 512
_LEAST_PIXEL_M = 0.05
# what rows need around them on the picture, pixels
_RIM = 2


class ChanceRaster(NamedTuple):
    """What was written: the picture ``(h, w)``, its north-west corner, pixel size and system."""

    values: NDArray[np.float32]
    west_m: float
    north_m: float
    pixel_m: float
    crs: str


def write_chance_raster(grid: PlantGrid, chance: Float, to: str | Path) -> ChanceRaster:
    """Write the chances ``(n,)`` of a grid's plants as a Cloud Optimised GeoTIFF.

    In the UTM zone of the plot, north up, float32 with nodata, with overviews (averages). Each
    plant fills the ground it has to itself; a pixel is half of the smaller spacing, so that no two
    plants share one unless they stand closer than the spacing says (the higher chance is shown
    then). The file appears whole or not at all.
    """
    if len(chance) != len(grid):
        raise PlotError(
            worded(
                "A chance map must have one chance a plant ({n}), but it has {n_2}.",
                n=len(grid),
                n_2=len(chance),
            )
        )
    picture = chance_raster(grid, np.asarray(chance, np.float64))
    write_whole(to, _packed(picture))
    return picture


def chance_raster(grid: PlantGrid, chance: Float) -> ChanceRaster:
    """Return the picture of the chances ``(n,)``, `NODATA` where no plant is."""
    zone = min(int((grid.frame.lon + 180.0) // 6.0) + 1, 60)
    crs = f"EPSG:{326 if grid.frame.lat >= 0 else 327}{zone:02d}"
    to_utm = pyproj.Transformer.from_crs("OGC:CRS84", crs, always_xy=True)
    pixel_m = max(min(grid.row_spacing_m, grid.plant_spacing_m) / 2, _LEAST_PIXEL_M)

    def on_map(xy_m: Float) -> Float:
        return np.stack(to_utm.transform(*grid.frame.lonlat(xy_m).T), axis=1)

    east, north = smoothly(grid.xy_m, on_map).T
    reach_m = np.hypot(grid.row_spacing_m, grid.plant_spacing_m) / 2 + _RIM * pixel_m
    west_m, south_m = (np.floor((v.min() - reach_m) / pixel_m) * pixel_m for v in (east, north))
    east_m, north_m = (np.ceil((v.max() + reach_m) / pixel_m) * pixel_m for v in (east, north))
    shape = (round((north_m - south_m) / pixel_m), round((east_m - west_m) / pixel_m))
    limits.check("pixels", shape[0] * shape[1], limits.WRITTEN_PIXELS, "the chance map")
    places = np.stack([(east - west_m) / pixel_m, (north_m - north) / pixel_m], axis=1)
    # a plant's ground is small: there the way from the picture to the rows is a plain turn
    middle = grid.xy_m.mean(axis=0)
    axes = on_map(middle + np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    turn = (axes[1:] - axes[0]).T / pixel_m * [[1.0], [-1.0]]
    values = np.full(shape, NODATA, np.float32)
    halves = np.array([grid.plant_spacing_m, grid.row_spacing_m]) / 2
    if grid.aisles_m is not None:  # rows run anyhow: the nearest plant's, wherever it is beside
        halves[:] = halves.max()
    _paint(values, places, chance.astype(np.float32), np.linalg.inv(turn), halves)
    return ChanceRaster(values, float(west_m), float(north_m), pixel_m, crs)


@routine
def _paint(
    values: NDArray[np.float32],
    places: Float,
    chance: NDArray[np.float32],
    to_rows_m: Float,
    halves_m: Float,
) -> None:
    """Give each pixel the chance of the nearest plant on whose ground its middle lies."""
    rows, columns = values.shape
    nearest = np.full(values.shape, np.inf, np.float32)
    corner = np.abs(np.linalg.inv(to_rows_m)) @ halves_m
    for i in range(len(places)):
        column, row = places[i, 0], places[i, 1]
        for r in range(max(int(row - corner[1]), 0), min(int(row + corner[1]) + 1, rows)):
            for c in range(
                max(int(column - corner[0]), 0), min(int(column + corner[0]) + 1, columns)
            ):
                right, down = c + 0.5 - column, r + 0.5 - row
                x = to_rows_m[0, 0] * right + to_rows_m[0, 1] * down
                y = to_rows_m[1, 0] * right + to_rows_m[1, 1] * down
                if abs(x) > halves_m[0] or abs(y) > halves_m[1]:
                    continue
                away = np.float32(x * x + y * y)
                if away < nearest[r, c]:
                    values[r, c], nearest[r, c] = chance[i], away
                elif away == nearest[r, c]:  # the other face of the same vine
                    values[r, c] = max(values[r, c], chance[i])
    # the pixel in which a plant stands is its own, whatever stands near
    for i in range(len(places)):
        r, c = int(places[i, 1]), int(places[i, 0])
        if nearest[r, c] >= 0.0:
            values[r, c], nearest[r, c] = chance[i], -1.0
        else:
            values[r, c] = max(values[r, c], chance[i])


def _packed(picture: ChanceRaster) -> bytes:
    from rasterio.io import MemoryFile  # noqa: PLC0415 - 0.2 s that only this needs
    from rasterio.shutil import copy  # noqa: PLC0415
    from rasterio.transform import from_origin  # noqa: PLC0415

    high, wide = picture.values.shape
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # affine 3 under rasterio 1.4
        place = from_origin(picture.west_m, picture.north_m, picture.pixel_m, picture.pixel_m)
        profile = {"driver": "GTiff", "dtype": "float32", "count": 1, "height": high, "width": wide}
        with MemoryFile(ext=".tif") as plain, MemoryFile(ext=".tif") as cloud:
            with plain.open(**profile, crs=picture.crs, transform=place, nodata=NODATA) as tif:
                tif.write(picture.values, 1)
                tif.set_band_description(1, CHANCE_BAND)
            copy(
                plain.name,
                cloud.name,
                driver="COG",
                COMPRESS="DEFLATE",
                PREDICTOR="YES",
                BLOCKSIZE=_TILE,
                OVERVIEWS="IGNORE_EXISTING",
                OVERVIEW_RESAMPLING="AVERAGE",
            )
            return bytes(cloud.getbuffer())
