"""The pixels read of an open raster: which part, how finely, and where they have no value."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from rasterio.enums import MaskFlags, Resampling
from rasterio.windows import Window

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.import_report import ImportMessage, Remedy, guessed, seen
from fieldmon.io.parse.crs import km_between
from fieldmon.io.rasters.values import Affine, map_xy, pixel_xy, projected
from fieldmon.io.sandbox import limits
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.rasters.opening import OpenRaster
    from fieldmon.io.rasters.values import RasterOptions

    Float = NDArray[np.float64]
    Bounds = tuple[float, float, float, float]

# about a plot, this much more of the raster is read: of its size, and metres
_MARGIN = 0.25
_MARGIN_M = 30.0
# what people write for no value and forget to declare
_SENTINELS = (-9999.0, -99999.0, -32768.0, -999999.0)
_HUGE = 1e30


class RasterPart(NamedTuple):
    """The part of a raster that is read, and the pixels ``(h, w)`` it is read to."""

    window: Window
    shape: tuple[int, int]

    @property
    def step(self) -> float:
        """Return how many pixels of the file become one."""
        return float(max(self.window.width / self.shape[1], self.window.height / self.shape[0]))

    def to_map(self, of_file: Affine) -> Affine:
        """Return where the pixels lie that were read."""
        a, b, _, d, e, _ = of_file
        x, y = map_xy(of_file, np.array([[self.window.col_off, self.window.row_off]]))[0]
        wide = self.window.width / self.shape[1]
        high = self.window.height / self.shape[0]
        return (a * wide, b * high, float(x), d * wide, e * high, float(y))


@dataclass(frozen=True, eq=False)
class ReadPixels:
    """What was read of a raster.

    Parameters
    ----------
    values
        ``(bands, h, w)`` as they are stored.
    missing
        ``(h, w)`` whether a pixel has no value.
    messages
        What the raster is, how much of it was read, and what was seen on the way.
    """

    values: NDArray[Any]
    missing: NDArray[np.bool_]
    messages: tuple[ImportMessage, ...]


def part_of(opened: OpenRaster, bounds: Bounds | None, most: int, n_bands: int = 1) -> RasterPart:
    """Return what is read: within bounds or all, not more pixels than `most`."""
    window = _window(opened, bounds)
    step = max(1.0, math.sqrt(window.width * window.height / most))
    high = max(1, int(window.height / step))
    wide = max(1, min(int(window.width / step), most // high))
    shape = (min(high, most // wide), wide)
    # GDAL decodes the smallest overview that is fine enough, or the raster itself
    overview = max((o for o in opened.tif.overviews(1) if o <= step), default=1)
    pixel_bytes = sum(np.dtype(kind).itemsize for kind in opened.tif.dtypes)
    decoded = window.width * window.height / overview**2 * max(pixel_bytes, n_bands)
    if decoded > limits.RASTER_BYTES:
        raise FileProblem(
            worded(
                "{size} of a raster may be read at most, but {name} ({width} "
                "x {height} pixels) would take {has}. Cut it to the plot, "
                "or save it as a Cloud Optimised GeoTIFF, which holds smaller "
                "copies of itself.",
                size=limits.size(limits.RASTER_BYTES),
                name=opened.name,
                width=opened.tif.width,
                height=opened.tif.height,
                has=limits.size(decoded),
            )
        )
    return RasterPart(window, shape)


def _window(opened: OpenRaster, bounds: Bounds | None) -> Window:
    whole = Window(0, 0, opened.tif.width, opened.tif.height)
    if bounds is None:
        return whole
    places = pixel_xy(opened.to_map, projected(opened.transformation, _around(bounds)))
    places = places[np.isfinite(places).all(axis=1)]
    if len(places):
        low = np.clip(np.floor(places.min(axis=0)), 0, (whole.width, whole.height)).astype(int)
        high = np.clip(np.ceil(places.max(axis=0)), 0, (whole.width, whole.height)).astype(int)
        if (high > low).all():
            return Window(*(int(n) for n in (*low, *(high - low))))
    middle = opened.transformation.lonlat(
        map_xy(opened.to_map, np.array([[whole.width / 2, whole.height / 2]]))
    )[0]
    plot = ((bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2)
    away = km_between(plot, (float(middle[0]), float(middle[1])))
    raise FileProblem(
        worded(
            "{name} must lie on the plot, at least in part, but its middle is "
            "{away:.3g} km away, at {value:.4f}, {lat:.4f}. Choose another "
            "raster, or name its right coordinate system.",
            name=opened.name,
            away=away,
            value=middle[0],
            lat=middle[1],
        )
    )


def _around(bounds: Bounds) -> Float:
    """Return points along a box about the bounds, ``(n, 2)`` degrees."""
    west, south, east, north = bounds
    degrees = _MARGIN_M / M_PER_DEGREE
    by_lat = max((north - south) * _MARGIN, degrees)
    by_lon = max((east - west) * _MARGIN, degrees / max(math.cos(math.radians(south)), 0.01))
    steps = np.linspace(0.0, 1.0, 9)
    lon, lat = np.meshgrid(
        west - by_lon + steps * (east - west + 2 * by_lon),
        south - by_lat + steps * (north - south + 2 * by_lat),
    )
    return np.stack([lon.ravel(), np.clip(lat.ravel(), -90, 90)], axis=1)


def _without_value(
    opened: OpenRaster,
    bands: tuple[int, ...],
    part: RasterPart,
    raw: NDArray[Any],
    nodata: str | None,
) -> tuple[NDArray[np.bool_], list[ImportMessage]]:
    """Return which pixels ``(h, w)`` hold no value, by the file's word or by what was chosen."""
    if nodata == "none":
        return np.zeros(part.shape, bool), []
    # black may be declared as nodata, but a pixel is missing only where all colours are
    missing = np.ones(part.shape, bool)
    for band in bands:
        if MaskFlags.all_valid in opened.tif.mask_flag_enums[band - 1]:
            missing[:] = False
            break
        missing &= opened.tif.read_masks(band, window=part.window, out_shape=part.shape) == 0
    if nodata is not None:
        return missing | (raw == float(nodata)).all(axis=0), []
    declared = [opened.tif.nodatavals[band - 1] for band in bands]
    found = [] if any(value is not None for value in declared) else _undeclared(raw, missing)
    return missing, found


def _undeclared(raw: NDArray[Any], missing: NDArray[np.bool_]) -> list[ImportMessage]:
    """Take out what looks like an undeclared nodata value, and say so."""
    if raw.dtype.kind not in "if":
        return []
    huge = np.zeros(raw.shape, bool)
    if raw.dtype.kind == "f":
        np.greater(np.abs(raw), _HUGE, out=huge)
    sentinels = [n for n in _SENTINELS if (raw == n).any()]
    odd = huge.all(axis=0) | np.logical_or.reduce([(raw == n).all(axis=0) for n in sentinels])
    odd &= ~missing
    if not odd.any():
        return []
    missing |= odd
    what = ", ".join([*(f"{n:g}" for n in sentinels), *(["more than 1e30"] if huge.any() else [])])
    return [
        guessed(
            worded(
                "Values of {what} were taken as no value, although the raster "
                "declares none ({value:.3g} % of the pixels read).",
                what=what,
                value=100 * odd.mean(),
            ),
            remedy=Remedy("nodata", "none", worded("They are values")),
        )
    ]


def read_pixels(
    opened: OpenRaster,
    bands: tuple[int, ...],
    part: RasterPart,
    options: RasterOptions,
    resampling: Resampling = Resampling.nearest,
) -> ReadPixels:
    """Return a part of some bands."""
    values = opened.tif.read(
        bands, window=part.window, out_shape=(len(bands), *part.shape), resampling=resampling
    )
    missing, said = _without_value(opened, bands, part, values, options.nodata)
    messages = (_what_was_read(opened, bands, part), *opened.messages, *said)
    return ReadPixels(values, missing, messages)


def _what_was_read(opened: OpenRaster, bands: tuple[int, ...], part: RasterPart) -> ImportMessage:
    """Return what the raster is, and how much of it was read."""
    tif = opened.tif
    window = part.window
    middle = np.array([window.col_off + window.width / 2, window.row_off + window.height / 2])
    ends = opened.transformation.lonlat(
        map_xy(opened.to_map, middle + np.array([[0.0, 0.0], [1.0, 0.0]]))
    )
    metres = 1000 * km_between(*((float(lon), float(lat)) for lon, lat in ends))
    listed = f"band{'s' if len(bands) > 1 else ''} {', '.join(map(str, bands))} of {tif.count}"
    shrunk = f"; read at every {part.step:.3g}th pixel" if part.step > 1.001 else ""
    return seen(
        worded(
            "{name}: {listed} ({value}), {width} x {height} pixels of {metres:.3g} m{shrunk}.",
            name=opened.name,
            listed=listed,
            value=tif.dtypes[bands[0] - 1],
            width=tif.width,
            height=tif.height,
            metres=metres,
            shrunk=shrunk,
        )
    )
