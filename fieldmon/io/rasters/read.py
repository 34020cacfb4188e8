"""Reading rasters: pictures of the ground, and values that plants stand on.

A GeoTIFF in any coordinate system, turned or not, alone or in a zip archive. It is opened in a
process of its own (`sandbox`), from a copy, and only by GDAL's GeoTIFF reader: what points at other
files or at the network is no raster here.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FileProblem
from fieldmon.io.import_report import doubtful
from fieldmon.io.options import Source, source_name
from fieldmon.io.rasters.values import Backdrop, Raster, RasterOptions
from fieldmon.io.sandbox import process

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.import_report import Imported, ImportMessage
    from fieldmon.plot.field import Field

_LOOKED_AT = 10_000
_FULL = 0.999


def read_raster(
    source: Source,
    options: RasterOptions | None = None,
    near: Field | None = None,
    plants: NDArray[np.float64] | None = None,
) -> Imported[Raster]:
    """Return one band of a raster.

    Parameters
    ----------
    source
        Path or upload.
    options
        What was chosen about how to read it.
    near
        Read only what lies about this plot; the share of the plot that has values is told.
    plants
        ``(n, 2)`` degrees: that share is of these; None: of its area.

    Raises
    ------
    ChoiceNeeded
        Where the band or the coordinate system must be chosen.
    FileProblem
        Where the raster is unusable, or holds nothing of the plot.
    """
    read: Imported[Raster] = _read("reading:raster", source, options, near)
    if near is None:
        return read
    return read.having(read.value, _coverage(read.value, near, source_name(source), plants))


def read_backdrop(
    source: Source, options: RasterOptions | None = None, near: Field | None = None
) -> Imported[Backdrop]:
    """Return a picture of the ground for a map: the whole raster, or what lies about a plot."""
    picture: Imported[Backdrop] = _read("picture:backdrop", source, options, near)
    return picture


def read_relief(
    source: Source, options: RasterOptions | None = None, near: Field | None = None
) -> Imported[Backdrop]:
    """Return the relief that a raster of heights (metres) shows, lit from the north-west.

    All of it, or what lies about a plot. How much steeper it is drawn than it is, is told.
    """
    picture: Imported[Backdrop] = _read("relief:relief", source, options, near)
    return picture


def looks_like_heights(source: Source, options: RasterOptions | None = None) -> bool:
    """Return whether a raster is more likely heights than a picture: one band, of no colours."""
    looks: bool = _read("relief:looks_like_heights", source, options, None)
    return looks


def _read(task: str, source: Source, options: RasterOptions | None, near: Field | None) -> Any:  # noqa: ANN401 - each caller says
    options = options or RasterOptions()
    bounds = None
    if near is not None:
        bounds = near.boundary.bounds
        if options.near is None:
            options = replace(
                options, near=((bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2)
            )
    if isinstance(source, str | Path):
        source = Path(source).absolute()
    with working_folder() as folder:
        return process.call(f"fieldmon.io.rasters.{task}", folder, source, options, bounds)


def _coverage(
    raster: Raster, field: Field, name: str, plants: NDArray[np.float64] | None
) -> list[ImportMessage]:
    """Return a doubt where the plot has values in part only; refuse where it has none."""
    places = _within(field) if plants is None else plants
    covered = float(np.mean(~np.isnan(raster.at(places))))
    if covered == 0.0:
        raise FileProblem(
            worded(
                "{name} must hold values on plot {plot}, but there it holds "
                "none: it ends beside it or says nodata. Choose another "
                "raster, or name what stands for no value.",
                name=name,
                plot=field.name,
            )
        )
    if covered >= _FULL:
        return []
    return [
        doubtful(
            worded(
                "The raster covers {value:.3g} % of plot {name}; the rest has no value.",
                value=100 * covered,
                name=field.name,
            )
        )
    ]


def _within(field: Field) -> NDArray[np.float64]:
    """Return positions spread evenly over a plot, ``(n, 2)`` degrees."""
    west, south, east, north = field.boundary.bounds
    share = field.boundary.area / ((east - west) * (north - south))
    n = int(np.sqrt(_LOOKED_AT / max(share, 1e-3)))
    steps = (np.arange(n) + 0.5) / n
    lon, lat = np.meshgrid(west + (east - west) * steps, south + (north - south) * steps)
    inside = shapely.contains_xy(field.boundary, lon, lat)
    if not inside.any():  # thinner than the steps
        inner = shapely.point_on_surface(field.boundary)
        return np.array([[inner.x, inner.y]])
    return np.stack([lon[inside], lat[inside]], axis=1)


__all__ = [
    "Backdrop",
    "Raster",
    "RasterOptions",
    "looks_like_heights",
    "read_backdrop",
    "read_raster",
    "read_relief",
]
