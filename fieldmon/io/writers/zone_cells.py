"""Zones as cells of a grid, for terminals that read grids, and as a picture of rates."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.sandbox import limits
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray
    from shapely import MultiPolygon

# cells across the narrowest thing that must be told apart
_ACROSS = 2.0
#: where nothing is said of a cell: outside the plot
NODATA = -1.0


@dataclass(frozen=True, eq=False)
class ZoneCells:
    """Which cells of a grid in degrees are sprayed.

    Parameters
    ----------
    south, west
        Latitude and longitude of the grid's south-west corner.
    north_size, east_size
        Size of a cell, degrees.
    sprayed, within
        ``(rows, columns)`` from the south-west: whether the middle of a cell is in a zone, and in
        the plot.
    kind
        As grids of ISO 11783-10 are written: 1, a zone's number in each cell; 2, a rate.
    """

    south: float
    west: float
    north_size: float
    east_size: float
    sprayed: NDArray[np.bool_]
    within: NDArray[np.bool_]
    kind: int = 1

    def __post_init__(self) -> None:
        if self.kind not in {1, 2}:
            raise SettingError(
                worded(
                    "A grid must be of kind 1 or 2, but it is {kind}.",
                    kind=self.kind,
                )
            )

    def __repr__(self) -> str:
        rows, columns = self.sprayed.shape
        return f"<ZoneCells: {rows} x {columns}, {np.count_nonzero(self.sprayed)} sprayed>"


def zone_cells(
    boundary: MultiPolygon, zones: Iterable[MultiPolygon], cell_m: float, kind: int = 1
) -> ZoneCells:
    """Return the cells of a plot, of at most `cell_m` a side.

    Parameters
    ----------
    boundary, zones
        Lon/lat.
    cell_m
        Side of a cell; half of the narrowest zone shows all of them.
    kind
        See `ZoneCells`.

    Raises
    ------
    SettingError
        If a cell has no size.
    FileProblem
        If there would be more cells than a file may hold.
    """
    if not cell_m > 0.0:
        raise SettingError(
            worded(
                "The cells of a grid must have a size above 0, but it is {cell_m:g} m.",
                cell_m=cell_m,
            )
        )
    whole = shapely.union_all(list(zones))
    # rows reach past an assumed outline by half a spacing
    west, south, east, north = shapely.total_bounds([boundary, whole])
    east_size = cell_m / (M_PER_DEGREE * np.cos(np.radians((south + north) / 2)))
    north_size = cell_m / M_PER_DEGREE
    columns = max(1, int(np.ceil((east - west) / east_size)))
    rows = max(1, int(np.ceil((north - south) / north_size)))
    limits.check("pixels", rows * columns, limits.WRITTEN_PIXELS, "the map of rates")
    lon, lat = np.meshgrid(
        west + (np.arange(columns) + 0.5) * east_size, south + (np.arange(rows) + 0.5) * north_size
    )
    shapely.prepare(whole)
    shapely.prepare(boundary)
    sprayed: NDArray[np.bool_] = np.asarray(shapely.contains_xy(whole, lon, lat))
    within: NDArray[np.bool_] = sprayed | np.asarray(shapely.contains_xy(boundary, lon, lat))
    return ZoneCells(float(south), float(west), north_size, float(east_size), sprayed, within, kind)


def narrowest_m(zones: Iterable[MultiPolygon]) -> float:
    """Return about half of how wide the narrowest piece of any zone is, metres."""
    parts = shapely.get_parts(list(zones))
    lat = np.radians(shapely.get_y(shapely.centroid(parts)))
    scaled = shapely.transform(
        parts, lambda xy: xy * [M_PER_DEGREE * np.cos(float(lat.mean())), M_PER_DEGREE]
    )
    boxes = shapely.oriented_envelope(scaled)
    around, area = shapely.length(boxes), shapely.area(boxes)
    # the shorter side of a rectangle of that outline and area
    side = around / 4 - np.sqrt(np.maximum((around / 4) ** 2 - area, 0.0))
    return float(side.min()) / _ACROSS


def rates_geotiff(cells: ZoneCells, rate_l_ha: float) -> bytes:
    """Return a GeoTIFF of litres a hectare, float32, WGS 84, north up; outside the plot nodata."""
    from rasterio.io import MemoryFile  # noqa: PLC0415 - 0.2 s that only this needs
    from rasterio.transform import from_origin  # noqa: PLC0415

    rows, columns = cells.sprayed.shape
    values = np.where(cells.sprayed, rate_l_ha, np.where(cells.within, 0.0, NODATA))
    north = cells.south + rows * cells.north_size
    profile = {"driver": "GTiff", "dtype": "float32", "count": 1, "height": rows, "width": columns}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # affine 3 under rasterio 1.4
        place = from_origin(cells.west, north, cells.east_size, cells.north_size)
        with MemoryFile(ext=".tif") as memory:
            with memory.open(
                **profile, crs="EPSG:4326", transform=place, nodata=NODATA, compress="deflate"
            ) as tif:
                tif.write(values[::-1].astype(np.float32), 1)
                tif.set_band_description(1, "l/ha")
            return bytes(memory.getbuffer())
