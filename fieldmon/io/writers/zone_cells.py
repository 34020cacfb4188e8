"""Zones as cells of a grid, for terminals that read grids, and as a picture of rates."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

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
_LEAST_CELL_M, _USUAL_CELL_M = 0.1, 1.0
#: of a grid: terminals hold it in memory
MOST_CELLS = 1_000_000
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
        ``(rows, columns)`` from the south-west: whether the middle of a cell is in a zone and
        nothing of the cell beyond plot and zones; and whether its middle is in either.
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
        Side of a cell; see `cell_for`.
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
    size = north_size, float(east_size)
    cells = ZoneCells(float(south), float(west), *size, sprayed, within, kind)
    near = _sprayed_at_the_rim(shapely.union(boundary, whole), cells)
    beyond = near.at[~near.inside]
    sprayed[beyond[:, 1], beyond[:, 0]] = False
    return cells


class _AtTheRim(NamedTuple):
    """Sprayed cells at the rim of an area, and maybe some beside these.

    `at` is ``(n, 2)`` column and row, `inside` ``(n,)`` whether a cell lies wholly in the area,
    `boxes` ``(n,)`` the cells.
    """

    at: NDArray[np.int64]
    inside: NDArray[np.bool_]
    boxes: NDArray[np.object_]


def _sprayed_at_the_rim(area: shapely.Geometry, cells: ZoneCells) -> _AtTheRim:
    size, corner = np.array([cells.east_size, cells.north_size]), [cells.west, cells.south]
    # of two points half a cell apart, what lies between is in the cell of either or next to it
    rim = shapely.segmentize(shapely.boundary(area), size.min() / 2)
    on = np.unique(np.floor((shapely.get_coordinates(rim) - corner) / size).astype(int), axis=0)
    around = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
    at = np.unique((on[:, None] + around).reshape(-1, 2), axis=0)
    rows, columns = cells.sprayed.shape
    at = at[((at >= 0) & (at < [columns, rows])).all(axis=1)]
    at = at[cells.sprayed[at[:, 1], at[:, 0]]]
    west, south = (at * size + corner).T
    boxes = shapely.box(west, south, west + size[0], south + size[1])
    shapely.prepare(area)
    return _AtTheRim(at, np.asarray(shapely.covers(area, boxes)), np.asarray(boxes))


def beside_and_missed(zones: Iterable[MultiPolygon], cells: ZoneCells) -> tuple[float, float]:
    """Return which share of the zones' area is sprayed beside them, and which of it is missed."""
    whole = shapely.union_all(list(zones))
    boxes = _sprayed_at_the_rim(whole, cells).boxes
    beside = float(shapely.area(shapely.difference(boxes, whole)).sum())
    sprayed = np.count_nonzero(cells.sprayed) * cells.north_size * cells.east_size
    return beside / whole.area, 1.0 - (sprayed - beside) / whole.area


def cell_for(boundary: MultiPolygon, zones: list[MultiPolygon]) -> tuple[float, float]:
    """Return how large cells should be, metres, and how large they are: no more than `MOST_CELLS`.

    A metre, or half of the narrowest zone: coarser cells miss too much along rims.
    """
    should = min(max(narrowest_m(zones), _LEAST_CELL_M), _USUAL_CELL_M)
    west, south, east, north = shapely.total_bounds([boundary, *zones])
    wide_m = (east - west) * M_PER_DEGREE * np.cos(np.radians((south + north) / 2))
    high_m = (north - south) * M_PER_DEGREE
    # as many whole cells each way, and one that is cut
    both = wide_m + high_m
    least = (both + np.sqrt(both**2 + 4 * (MOST_CELLS - 1) * wide_m * high_m)) / (
        2 * (MOST_CELLS - 1)
    )
    return should, max(should, float(least))


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
