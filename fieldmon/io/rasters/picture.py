"""What the reading process answers when a picture for the map is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from rasterio.enums import ColorInterp, Resampling
from rasterio.io import MemoryFile
from rasterio.shutil import copy

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Imported, ImportMessage, doubtful, seen
from fieldmon.io.rasters.opening import band_named, open_raster
from fieldmon.io.rasters.pixels import RasterPart, ReadPixels, part_of, read_pixels
from fieldmon.io.rasters.values import Backdrop, map_xy
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.io.rasters.opening import OpenRaster
    from fieldmon.io.rasters.values import RasterOptions

    Float = NDArray[np.float64]
    Bounds = tuple[float, float, float, float]

#: longest side of a backdrop, pixels
_SIDE = 2000
_STRETCH = (2.0, 98.0)
_VISIBLE_M = 0.5
_CORNERS = np.array([[0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])


def backdrop(
    folder: str, source: Source, options: RasterOptions, bounds: Bounds | None
) -> Imported[Backdrop]:
    """Return a picture of a source, or of what lies within bounds (west, south, east, north)."""
    with open_raster(folder, source, options) as opened:
        bands = _shown(opened, options.band)
        colours = _colours(opened, bands)
        kinds = {opened.tif.dtypes[band - 1] for band in bands}
        smooth = kinds <= {"uint8", "uint16"} and colours is None
        how = Resampling.average if smooth else Resampling.nearest
        part, read = read_for_picture(opened, bands, bounds, options, how)
        raw, missing, said = read.values, read.missing, list(read.messages)
        if colours is not None:
            image, missing = _coloured(raw[0], colours, missing)
        else:
            image, stretched = _stretched(raw, ~missing)
            said += stretched
        corners, bent = corners_on_map(opened, part)
        return Imported(Backdrop(*encoded(image, missing), corners), (*said, *bent))


def read_for_picture(
    opened: OpenRaster,
    bands: tuple[int, ...],
    bounds: Bounds | None,
    options: RasterOptions,
    resampling: Resampling,
) -> tuple[RasterPart, ReadPixels]:
    """Return at most 2000 pixels a side; refuse a raster without a value there."""
    part = part_of(opened, bounds, _SIDE * _SIDE, len(bands))
    shrink = min(1.0, _SIDE / max(part.shape))
    high, wide = (max(1, round(pixels * shrink)) for pixels in part.shape)
    part = RasterPart(part.window, (high, wide))
    read = read_pixels(opened, bands, part, options, resampling)
    missing = read.missing | ~np.isfinite(read.values).all(axis=0)
    if missing.all():
        raise FileProblem(
            worded(
                "{name} must show something, but there is no value in it. Choose another raster.",
                name=opened.name,
            )
            if bounds is None
            else worded(
                "{name} must show something about the plot, but there is no value in it there. "
                "Choose another raster.",
                name=opened.name,
            )
        )
    return part, ReadPixels(read.values, missing, read.messages)


def _shown(opened: OpenRaster, wanted: str | None) -> tuple[int, ...]:
    """Return the one or three bands that make the picture."""
    if wanted is not None:
        bands = tuple(band_named(opened, one) for one in wanted.split(","))
        if len(bands) not in {1, 3}:
            raise ChoiceNeeded(
                worded("A picture is made of one band or three, but {n} were named.", n=len(bands)),
                "band",
            )
        return bands
    meaning = opened.tif.colorinterp
    rgb = (ColorInterp.red, ColorInterp.green, ColorInterp.blue)
    if all(colour in meaning for colour in rgb):
        return tuple(meaning.index(colour) + 1 for colour in rgb)
    plain = [b for b in range(1, opened.tif.count + 1) if meaning[b - 1] != ColorInterp.alpha]
    return tuple(plain[:3]) if len(plain) >= 3 else tuple(plain[:1])


def _colours(opened: OpenRaster, bands: tuple[int, ...]) -> NDArray[np.uint8] | None:
    """Return the colour table of a band of classes, ``(k, 4)``, or None."""
    if len(bands) != 1 or opened.tif.colorinterp[bands[0] - 1] != ColorInterp.palette:
        return None
    table = opened.tif.colormap(bands[0])
    colours = np.zeros((max(table) + 1, 4), np.uint8)
    colours[list(table)] = list(table.values())
    return colours


def _coloured(
    classes: NDArray[Any], colours: NDArray[np.uint8], missing: NDArray[np.bool_]
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    known = classes < len(colours)
    painted = colours[np.where(known, classes, 0)]
    clear = missing | ~known | (painted[..., 3] == 0)
    return np.ascontiguousarray(painted[..., :3].transpose(2, 0, 1)), clear


def _stretched(
    raw: NDArray[Any], shown: NDArray[np.bool_]
) -> tuple[NDArray[np.uint8], list[ImportMessage]]:
    """Return the bands as bytes; other numbers are stretched so that the contrast is seen."""
    if raw.dtype == np.uint8:
        return raw, []
    image = np.zeros(raw.shape, np.uint8)
    spans = []
    for band, bytes_ in zip(raw.astype(np.float64), image, strict=True):
        low, high = np.percentile(band[shown], _STRETCH)
        spans.append(f"{low:.4g} to {high:.4g}")
        span = high - low if high > low else 1.0
        bytes_[shown] = np.clip((band[shown] - low) / span * 255.0, 0.0, 255.0)
    return image, [
        seen(worded("Contrast is stretched over the middle 96 %: {names}.", names="; ".join(spans)))
    ]


def corners_on_map(opened: OpenRaster, part: RasterPart) -> tuple[Float, list[ImportMessage]]:
    """Return the corners ``(4, 2)`` in degrees, and how far off the map the picture is between.

    A map draws the picture as two flat triangles between its corners; the projection bends it.
    """
    to_map = part.to_map(opened.to_map)
    size = np.array(part.shape[::-1])
    corners = opened.transformation.lonlat(map_xy(to_map, _CORNERS * size))
    steps = np.linspace(0.0, 1.0, 9)
    u, v = (axis.ravel()[:, None] for axis in np.meshgrid(steps, steps))
    bottom_left, top_left, top_right, bottom_right = _mercator(corners)
    lower = top_left + u * (bottom_right - bottom_left) + v * (bottom_left - top_left)
    upper = top_right + (u - 1) * (top_right - top_left) + v * (bottom_right - top_right)
    lonlat = opened.transformation.lonlat(map_xy(to_map, np.concatenate([u, v], axis=1) * size))
    if not (np.isfinite(lonlat).all() and (np.abs(lonlat[:, 1]) < 85.0).all()):
        raise FileProblem(
            worded(
                "{name} must lie where a web map reaches, but it does not. Cut it to the plot.",
                name=opened.name,
            )
        )
    off = np.hypot(*(np.where(u <= v, lower, upper) - _mercator(lonlat)).T)
    off_m = float((off * np.cos(np.radians(lonlat[:, 1]))).max()) * M_PER_DEGREE
    if off_m < _VISIBLE_M:
        return corners, []
    return corners, [
        doubtful(
            worded(
                "So large a picture is drawn up to {off_m:.3g} m off its place on the map.",
                off_m=off_m,
            )
        )
    ]


def _mercator(lonlat: Float) -> Float:
    """Return web Mercator, in degrees at the equator."""
    lat = np.radians(np.clip(lonlat[:, 1], -89.0, 89.0))
    y = np.degrees(np.log(np.tan(np.pi / 4 + lat / 2)))
    return np.stack([lonlat[:, 0], y], axis=1)


def encoded(image: NDArray[np.uint8], missing: NDArray[np.bool_]) -> tuple[bytes, str]:
    """Return a picture as JPEG, or as WebP where some of it is clear."""
    bands = np.broadcast_to(image, (3, *image.shape[1:]))
    driver, mime, quality = "JPEG", "image/jpeg", 85
    if missing.any():
        alpha = np.where(missing, 0, 255).astype(np.uint8)[None]
        bands = np.concatenate([bands, alpha])
        driver, mime, quality = "WEBP", "image/webp", 90
    count, height, width = bands.shape
    shape = {"count": count, "height": height, "width": width, "dtype": "uint8"}
    # through a GeoTIFF in memory, since these two can only be copied to
    with MemoryFile(ext=".tif") as plain, MemoryFile(ext=".img") as packed:
        with plain.open(driver="GTiff", **shape) as picture:
            picture.write(bands)
        copy(plain.name, packed.name, driver=driver, QUALITY=quality)
        return bytes(packed.getbuffer()), mime
