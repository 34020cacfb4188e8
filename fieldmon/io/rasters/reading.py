"""What the reading process answers when the values of a raster are asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rasterio.enums import ColorInterp

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Imported, ImportMessage, doubtful, seen
from fieldmon.io.rasters.opening import band_named, open_raster
from fieldmon.io.rasters.pixels import part_of, read_pixels
from fieldmon.io.rasters.values import Raster
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.io.rasters.opening import OpenRaster
    from fieldmon.io.rasters.values import RasterOptions

    Float = NDArray[np.float64]
    Bounds = tuple[float, float, float, float]


def raster(
    folder: str, source: Source, options: RasterOptions, bounds: Bounds | None
) -> Imported[Raster]:
    """Return one band of a source, or what lies within bounds (west, south, east, north)."""
    with open_raster(folder, source, options) as opened:
        band = _band(opened, options.band)
        kind = np.dtype(opened.tif.dtypes[band - 1])
        part = part_of(opened, bounds, limits.PIXELS)
        read = read_pixels(opened, (band,), part, options)
        values = read.values[0].astype(np.result_type(kind, np.float32))
        values[read.missing] = np.nan
        values[~np.isfinite(values)] = np.nan
        scaled, said = _scaled(opened, band, values)
        messages = (*read.messages, *said, *_empty(values))
        is_classes = opened.tif.colorinterp[band - 1] == ColorInterp.palette
        text = opened.crs.to_wkt()
        called = opened.tif.descriptions[band - 1] or ""
        to_map = part.to_map(opened.to_map)
        return Imported(Raster(values, to_map, text, bool(is_classes), called, scaled), messages)


def _band(opened: OpenRaster, wanted: str | None) -> int:
    """Return the number of the band with the values; ask where several could be it."""
    tif = opened.tif
    bands = [b for b in range(1, tif.count + 1) if tif.colorinterp[b - 1] != ColorInterp.alpha]
    if wanted is not None:
        return band_named(opened, wanted)
    if len(bands) == 1:
        return bands[0]
    if not bands:
        raise FileProblem(
            worded("{name} must hold a band of values, but it only holds a mask.", name=opened.name)
        )
    names = [
        f"{b} ({tif.descriptions[b - 1] or tif.colorinterp[b - 1].name}, {tif.dtypes[b - 1]})"
        for b in bands
    ]
    raise ChoiceNeeded(
        worded(
            "{name} holds {n} bands. Choose the one with the values: {names}.",
            name=opened.name,
            n=len(bands),
            names=", ".join(names[:20]),
        ),
        "band",
        tuple(str(b) for b in bands),
    )


def _scaled(
    opened: OpenRaster, band: int, values: NDArray[np.floating]
) -> tuple[tuple[float, float], list[ImportMessage]]:
    """Apply the scale and offset that a band declares, in place; return them."""
    scale, offset = opened.tif.scales[band - 1], opened.tif.offsets[band - 1]
    if (scale, offset) == (1.0, 0.0):
        return (1.0, 0.0), []
    if not (np.isfinite([scale, offset]).all() and scale != 0.0):
        return (1.0, 0.0), [
            doubtful(
                worded(
                    "Scale {scale:g} and offset {offset:g} make no sense and were ignored.",
                    scale=scale,
                    offset=offset,
                )
            )
        ]
    values *= scale
    values += offset
    return (scale, offset), [
        seen(
            worded(
                "Values were scaled as the band says: times {scale:g}, plus {offset:g}.",
                scale=scale,
                offset=offset,
            )
        )
    ]


def _empty(values: NDArray[np.floating]) -> list[ImportMessage]:
    """Return how much of what was read has no value."""
    share = float(np.isnan(values).mean())
    if share == 1.0:
        raise FileProblem(
            worded(
                "A raster must hold values, but all that was read of this one "
                "is nodata. Choose another band or raster, or name what "
                "stands for no value."
            )
        )
    return (
        [seen(worded("{value:.3g} % of the pixels read have no value.", value=100 * share))]
        if share
        else []
    )
