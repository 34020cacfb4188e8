"""Which plants lie near lines and points, and how far positions lie outside a plot."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arrays import read_only
from fieldmon.compute.jit import routine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

#: positions farther from the plot than this are not even brought into its plane of metres
FAR_M = 100_000.0
_EARTH_M = 6_371_000.0


class PlantRows(NamedTuple):
    """Plants row by row, as compiled loops search them.

    Parameters
    ----------
    x_m, y_m
        ``(n,)`` positions, x ascending within each row.
    start
        ``(r + 1,)`` where each row starts.
    low_m, high_m
        ``(r,)`` smallest and largest y of the row.
    """

    x_m: Floats
    y_m: Floats
    start: NDArray[np.int64]
    low_m: Floats
    high_m: Floats

    @classmethod
    def of(cls, grid: PlantGrid) -> PlantRows:
        """Return the rows of a grid."""
        y_m = grid.xy_m[:, 1].copy()
        starts = grid.row_start[:-1]
        return cls(
            grid.xy_m[:, 0].copy(),
            y_m,
            grid.row_start,
            np.minimum.reduceat(y_m, starts),
            np.maximum.reduceat(y_m, starts),
        )


def outside_m(grid: PlantGrid, lonlat: Floats) -> Floats:
    """Return how far positions ``(m, 2)`` lie outside the plot, ``(m,)`` metres; 0 inside.

    To the kilometre beyond 100 km; infinite where the numbers are no longitude and latitude.
    """
    on_earth = (np.abs(lonlat[:, 0]) <= 360.0) & (np.abs(lonlat[:, 1]) <= 90.0)
    lon, lat = (np.deg2rad(np.where(on_earth, degrees, 0.0)) for degrees in lonlat.T)
    lon_0, lat_0 = np.deg2rad([grid.frame.lon, grid.frame.lat])
    chord = np.sin((lat - lat_0) / 2) ** 2 + (
        np.cos(lat) * np.cos(lat_0) * np.sin((lon - lon_0) / 2) ** 2
    )
    off_m: Floats = 2.0 * _EARTH_M * np.arcsin(np.sqrt(np.clip(chord, 0.0, 1.0)))
    off_m[~on_earth] = np.inf
    near = off_m < FAR_M
    xy_m = grid.frame.xy_m(lonlat[near])
    shapely.prepare(grid.drivable_m)
    # most are inside, and that is soon seen
    beyond = ~shapely.contains_xy(grid.drivable_m, xy_m)
    off_m[near] = 0.0
    outer = np.flatnonzero(near)[beyond]
    off_m[outer] = shapely.distance(grid.drivable_m, shapely.points(xy_m[beyond]))
    return off_m


class SearchRows(NamedTuple):
    """A grid's plants as loops search them, and which plant each is; None: as they are numbered.

    Where rows bend, x does not ascend along them: there plants stand in level strips instead.
    """

    rows: PlantRows
    plant: NDArray[np.int64] | None

    @classmethod
    def of(cls, grid: PlantGrid) -> SearchRows:
        """Return the rows of a grid, or strips two row spacings wide."""
        if grid.aisles_m is None:
            return cls(PlantRows.of(grid), None)
        x, y = grid.xy_m.T
        strip = np.floor((y - y.min()) / (2 * grid.row_spacing_m)).astype(np.int64)
        plant = np.lexsort((x, strip))
        starts = np.flatnonzero(np.diff(strip[plant], prepend=-1))
        y_m = y[plant]
        low, high = (v.reduceat(y_m, starts) for v in (np.minimum, np.maximum))
        return cls(PlantRows(x[plant], y_m, read_only(np.append(starts, len(y))), low, high), plant)

    def sorted(self, values: Floats) -> Floats:
        """Return one value a plant ``(n,)`` in the order of the search."""
        return values.copy() if self.plant is None else values[self.plant]

    def numbered(self, values: Floats) -> Floats:
        """Return values in the order of the search ``(n,)`` as plants are numbered."""
        if self.plant is None:
            return values
        back = np.empty_like(values)
        back[self.plant] = values
        return back


@routine
def distance_m(rows: PlantRows, pieces: Floats, farthest_m: float) -> Floats:
    """Return metres from each plant to straight pieces ``(s, 4)``; infinite beyond `farthest_m`."""
    squares = np.full(rows.x_m.size, np.inf)
    for ax, ay, bx, by in pieces:
        length_m2 = max((bx - ax) ** 2 + (by - ay) ** 2, 1e-12)
        for row in range(rows.low_m.size):
            if rows.low_m[row] > max(ay, by) + farthest_m:
                continue
            if rows.high_m[row] < min(ay, by) - farthest_m:
                continue
            end = rows.start[row + 1]
            i = first_from(rows.x_m, rows.start[row], end, min(ax, bx) - farthest_m)
            while i < end and rows.x_m[i] <= max(ax, bx) + farthest_m:
                x, y = rows.x_m[i] - ax, rows.y_m[i] - ay
                share = min(max((x * (bx - ax) + y * (by - ay)) / length_m2, 0.0), 1.0)
                square = (x - share * (bx - ax)) ** 2 + (y - share * (by - ay)) ** 2
                if square <= farthest_m * farthest_m:
                    squares[i] = min(squares[i], square)
                i += 1
    metres: Floats = np.sqrt(squares)
    return metres


@routine
def first_from(x_m: Floats, first: int, end: int, least_m: float) -> int:
    """Return the first index in ``first:end`` whose x is at least `least_m` (else `end`)."""
    while first < end:
        middle = (first + end) // 2
        if x_m[middle] < least_m:
            first = middle + 1
        else:
            end = middle
    return first
