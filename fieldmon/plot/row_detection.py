"""Which way the rows run and how far apart plants stand, found from what is known of a plot."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree

from fieldmon.compute.wording import counted, worded
from fieldmon.errors import NoRowsError, PlotError
from fieldmon.plot.projection import Frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field

    Float = NDArray[np.float64]

#: so near to each other no two plants stand
SAME_PLANT_M = 0.05
_BINS_PER_DEG = 4
_EDGE_SMOOTH_DEG = 2.0
# plants this part of the usual distance beside a line are on it
_IN_LINE = 0.3
#: in row spacings: plants scattered anyhow stray by about 0.3 from any lines seen in them
NO_ROWS = 0.2
# directions with lines as wide apart as the best, and as straight as this, are rows as well
_AS_WIDE, _IN_ROWS, _LONGER = 0.93, 0.05, 1.15
# and are another direction from here on
_OTHER_DEG = 1.0
_MOST_PAIRS = 200_000
# rows are found from this many plants in the middle of the plot; others only repeat them
_MOST_PLANTS = 10_000


@dataclass(frozen=True)
class RowDirection:
    """A direction in which plants stand in rows.

    Parameters
    ----------
    bearing_deg
        Clockwise from true north, in 0..180.
    n_rows
        How many rows they make along it.
    row_spacing_m
        How far these are apart.
    """

    bearing_deg: float
    n_rows: int
    row_spacing_m: float

    def __str__(self) -> str:
        # 179.7 is along 0, as are its rows
        return f"{counted(self.n_rows, 'row')} along {round(self.bearing_deg) % 180} degrees"


@dataclass(frozen=True)
class Rows:
    """How rows run on a plot, and how that is known.

    Parameters
    ----------
    bearing_deg
        Direction of the rows in 0..180, clockwise from true north.
    row_spacing_m, plant_spacing_m
        Typical distances, or None where the evidence does not show them.
    how
        The evidence in words, for people.
    directions
        Every direction in which plants stand in rows, the one taken first: of a square planting
        two, of a triangular one three; empty where there is one only.
    """

    bearing_deg: float
    row_spacing_m: float | None
    plant_spacing_m: float | None
    how: str
    directions: tuple[RowDirection, ...] = ()


def rows_from_lines(field: Field) -> Rows:
    """Return the direction and spacing of the rows that were drawn; raise `PlotError` if none."""
    if field.row_lines.is_empty:
        raise PlotError(
            worded(
                "Rows of plot {name!r} must be drawn to find their direction, but none are.",
                name=field.name,
            )
        )
    lines = shapely.get_parts(field.row_lines)
    points, line = shapely.get_coordinates(lines, return_index=True)
    frame = field.frame()
    edges_m = np.diff(frame.xy_m(points), axis=0)[line[1:] == line[:-1]]
    bearing_deg = main_bearing(edges_m)
    middles = shapely.get_coordinates(shapely.line_interpolate_point(lines, 0.5, normalized=True))
    gaps = np.diff(np.sort(frame.turned(bearing_deg).xy_m(middles)[:, 1]))
    # pieces of one row lie on one line: their gap is no spacing
    apart = gaps[gaps > 0.3]
    spacing_m = float(np.median(apart)) if len(apart) else None
    return Rows(bearing_deg, spacing_m, None, f"from {len(lines)} drawn rows")


def rows_from_plants(lonlat: Float, near_bearing_deg: float | None = None) -> Rows:
    """Return direction and spacings of the rows in which measured plants stand.

    Rows are where plants stand closest, unless they stand much straighter in another direction
    (hops on wires, say). Missing plants, ragged ends and positions some decimetres off do no
    harm.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees; no two plants in one place (see `distinct`).
    near_bearing_deg
        Where rows are known to run about there, degrees; None: anywhere.
    """
    if len(lonlat) < 2:
        raise NoRowsError(
            worded(
                "Rows can be found from 2 plants or more, but {n} {n:is|are} there. Add plants, or "
                "say that they stand in no rows.",
                n=len(lonlat),
            )
        )
    east_north_m = _middle_of(frame_around(lonlat).xy_m(lonlat))
    pairs = _Pairs.of(east_north_m)
    bearings = _promising_bearings(pairs) if near_bearing_deg is None else [near_bearing_deg]
    seen = [_lines(east_north_m, pairs, b) for b in bearings]
    best, others = _longest(seen, min(seen, key=_unlikeliness))
    rows = f"{best.n_lines} row" + "s" * (best.n_lines != 1)
    stray = f", {best.off_m:.2f} m beside their line" if np.isfinite(best.off_m) else ""
    doubt = "; they hardly stand in rows, so check the bearing" if best.blur > NO_ROWS else ""
    return Rows(
        best.bearing_deg % 180.0,
        best.row_spacing_m,
        best.plant_spacing_m,
        f"from {len(east_north_m)} plants in {rows}{stray}{doubt}",
        tuple(_direction(lonlat, lines) for lines in (best, *others)) if others else (),
    )


def row_ends(lonlat: Float, bearing_deg: float, row_spacing_m: float) -> Float:
    """Return where straight rows of plants begin and end, ``(r, 2, 2)`` lon/lat.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` plants.
    bearing_deg, row_spacing_m
        Along which they stand in rows, and how far these are about apart.
    """
    frame = frame_around(lonlat).turned(bearing_deg)
    x, y = frame.xy_m(lonlat).T
    line = split_lines(y, row_spacing_m)
    n_on = np.bincount(line)
    y_m = np.bincount(line, y) / n_on
    start = np.concatenate([[0], np.cumsum(n_on)[:-1]])
    along = x[np.argsort(line, kind="stable")]
    ends_m = [
        np.stack([end.reduceat(along, start), y_m], axis=1) for end in (np.minimum, np.maximum)
    ]
    return frame.lonlat(np.concatenate(ends_m)).reshape(2, -1, 2).swapaxes(0, 1)


def _direction(lonlat: Float, lines: _LinesSeen) -> RowDirection:
    """Return a direction with the number of rows that all plants make along it."""
    bearing_deg, spacing_m = lines.bearing_deg % 180.0, lines.row_spacing_m or np.inf
    return RowDirection(bearing_deg, len(row_ends(lonlat, bearing_deg, spacing_m)), spacing_m)


def _longest(seen: list[_LinesSeen], best: _LinesSeen) -> tuple[_LinesSeen, list[_LinesSeen]]:
    """Return of directions as good as the best one that with the longest lines, and the others."""
    if best.blur > NO_ROWS or best.row_spacing_m is None:
        return best, []
    least_m = _AS_WIDE * best.row_spacing_m
    good = [
        lines
        for lines in seen
        if (lines.row_spacing_m or 0.0) >= least_m and lines.blur <= max(2 * best.blur, _IN_ROWS)
    ]
    longest = max(good, key=lambda lines: lines.n_plants / lines.n_lines)
    # hardly longer ones are no reason to leave the best
    if best.n_lines < _LONGER * longest.n_lines:
        longest = best
    kept = [longest]
    for lines in good:  # several bearings may have been made exact to one
        if all(_between_deg(lines.bearing_deg, other.bearing_deg) > _OTHER_DEG for other in kept):
            kept.append(lines)
    return longest, kept[1:]


def _between_deg(a_deg: float, b_deg: float) -> float:
    return abs((a_deg - b_deg + 90.0) % 180.0 - 90.0)


def distinct(lonlat: Float, apart_m: float = SAME_PLANT_M) -> NDArray[np.intp]:
    """Return which plants ``(k,)`` are left if of those closer than `apart_m` the first is kept."""
    pairs = cKDTree(frame_around(lonlat).xy_m(lonlat)).query_pairs(apart_m, output_type="ndarray")
    return np.delete(np.arange(len(lonlat)), pairs[:, 1])


def nearest_m(xy_m: Float) -> Float:
    """Return how far the nearest other plant is from each ``(n,)``, of two plants or more."""
    near_m: Float = cKDTree(xy_m).query(xy_m, k=2)[0][:, 1]
    return near_m


def frame_around(lonlat: Float) -> Frame:
    """Return the plane, x east, centred on the given positions; raise `PlotError` if it cannot."""
    if not len(lonlat):
        raise PlotError(worded("There must be at least one plant position, but there is none."))
    if not np.isfinite(lonlat).all():
        bad = int(np.flatnonzero(~np.isfinite(lonlat).all(axis=1))[0])
        raise PlotError(
            worded(
                "Every plant must have a longitude and a latitude, but plant "
                "{value} has none. Leave it out or measure it again.",
                value=bad + 1,
            )
        )
    lon, lat = (np.min(lonlat, axis=0) + np.max(lonlat, axis=0)) / 2
    return Frame(float(lon - 360.0 if lon > 180.0 else lon), float(lat))


def split_lines(y_m: Float, row_spacing_m: float) -> NDArray[np.intp]:
    """Return the line ``(n,)`` of each plant, 0 the lowest, by where plants are dense across y.

    Lines need not be evenly spaced, but half a row spacing apart.
    """
    from scipy.signal import find_peaks  # noqa: PLC0415 - half a second to import

    low = y_m.min() - row_spacing_m
    bin_m = row_spacing_m / 20
    place = ((y_m - low) / bin_m).astype(np.intp)
    density = _smoothed(
        np.bincount(place, minlength=place.max() + 20).astype(float), 3, mode="constant"
    )
    peaks = find_peaks(density, distance=10)[0]
    valleys = [a + np.argmin(density[a:b]) for a, b in pairwise(peaks)]
    return np.unique(np.searchsorted(valleys, place), return_inverse=True)[1]


def _middle_of(east_north_m: Float) -> Float:
    if len(east_north_m) <= _MOST_PLANTS:
        return east_north_m
    far_m = np.hypot(*(east_north_m - np.median(east_north_m, axis=0)).T)
    return east_north_m[np.argpartition(far_m, _MOST_PLANTS)[:_MOST_PLANTS]]


class _Pairs(NamedTuple):
    """Differences between many pairs of plants, evenly sampled."""

    apart_m: Float  # (k, 2) east, north
    distance_m: Float
    near_m: float  # usual distance to the nearest plant

    @classmethod
    def of(cls, east_north_m: Float) -> _Pairs:
        n = len(east_north_m)
        near_m = float(np.median(nearest_m(east_north_m)))
        if near_m == 0:
            raise PlotError(
                worded(
                    "Plants must stand apart, but most share their position "
                    "with another one. Check the columns, or leave doubles "
                    "out."
                )
            )
        centres = np.unique(np.linspace(0, n - 1, min(n, max(20, _MOST_PAIRS // n))).astype(int))
        apart = (east_north_m[None] - east_north_m[centres][:, None]).reshape(-1, 2)
        distance = np.hypot(*apart.T)
        some = distance > near_m / 4
        return cls(apart[some], distance[some], near_m)

    def within(self, spacings: float) -> _Pairs:
        close = self.distance_m <= spacings * self.near_m
        return _Pairs(self.apart_m[close], self.distance_m[close], self.near_m)

    def turned(self, bearing_deg: float) -> tuple[Float, Float]:
        return _along_across(self.apart_m, bearing_deg)


class _LinesSeen(NamedTuple):
    """Plants seen as lines in one direction."""

    bearing_deg: float
    n_plants: int
    n_lines: int
    row_spacing_m: float | None
    plant_spacing_m: float | None
    off_m: float  # 1 sigma beside the line

    @property
    def blur(self) -> float:
        """Return how far plants stray, in row spacings: 0 in line, about 0.3 anywhere.

        Lines of one plant are straight without meaning anything; they count against a direction.
        """
        off = self.off_m / self.row_spacing_m if self.row_spacing_m else self.off_m
        return off / (1 - self.n_lines / self.n_plants) if self.n_lines < self.n_plants else np.inf


def _unlikeliness(lines: _LinesSeen) -> float:
    """Return a rank for directions: straight lines first, and lines far apart (so: dense ones)."""
    return lines.blur / (lines.row_spacing_m or 1.0)


def _promising_bearings(pairs: _Pairs) -> list[float]:
    """Return the bearings along which many near plants stand in line, best first."""
    local = pairs.within(8)
    thin = local.apart_m[:: len(local.apart_m) // 40_000 + 1]
    bearings = np.arange(0.0, 180.0, 0.5)
    in_line = np.array(
        [
            np.count_nonzero(np.abs(_along_across(thin, b)[1]) < _IN_LINE * pairs.near_m)
            for b in bearings
        ],
        dtype=float,
    )
    in_line = _smoothed(in_line, 1, mode="wrap")
    enough = in_line.max() / 2
    chosen: list[float] = []
    while in_line.max() >= enough and len(chosen) < 6:
        bearing = float(bearings[np.argmax(in_line)])
        chosen.append(bearing)
        in_line[np.abs((bearings - bearing + 90) % 180 - 90) < 10] = 0
    return chosen


def _lines(east_north_m: Float, pairs: _Pairs, bearing_deg: float) -> _LinesSeen:
    """Return the lines about a bearing, which is made exact from near pairs to far ones."""
    reach = 8.0
    farthest = float(pairs.distance_m.max()) / pairs.near_m
    while True:
        local = pairs.within(reach)
        for _ in range(3):
            x, y = local.turned(bearing_deg)
            same = np.abs(y) < _IN_LINE * pairs.near_m
            bearing_deg -= _tilt_deg(x[same], y[same])
        if reach >= farthest:
            break
        reach *= 2
    row_spacing_m = _row_spacing(pairs, bearing_deg)
    split_m = row_spacing_m or 4 * pairs.near_m
    for _ in range(3):
        x, y = _along_across(east_north_m, bearing_deg)
        line = split_lines(y, split_m)
        n_on = np.bincount(line)
        x_off, y_off = (v - (np.bincount(line, v) / n_on)[line] for v in (x, y))
        bearing_deg -= _tilt_deg(x_off, y_off)
    freedom = len(y) - len(n_on) - 1
    off_m = float(np.sqrt(np.sum(y_off**2) / freedom)) if freedom > 0 else np.inf
    if len(n_on) > 1:
        row_spacing_m = float(np.median(np.diff(np.bincount(line, y) / n_on)))
    return _LinesSeen(
        bearing_deg,
        len(line),
        len(n_on),
        row_spacing_m if len(n_on) > 1 else None,
        _plant_spacing(x, line, pairs.near_m),
        max(off_m, 0.01 * pairs.near_m),
    )


def _tilt_deg(x: Float, y: Float) -> float:
    """Return by how much lines rise to the left of x, degrees."""
    spread = float(np.sum(x * x))
    return float(np.rad2deg(np.arctan(np.sum(x * y) / spread))) if spread else 0.0


def _along_across(east_north_m: Float, bearing_deg: float) -> tuple[Float, Float]:
    turn = np.deg2rad(bearing_deg)
    sin, cos = np.sin(turn), np.cos(turn)
    east, north = east_north_m.T
    return east * sin + north * cos, north * sin - east * cos


def _row_spacing(pairs: _Pairs, bearing_deg: float) -> float | None:
    """Return the first distance across the rows at which plants stand often again."""
    from scipy.signal import find_peaks  # noqa: PLC0415 - half a second to import

    x, y = pairs.within(20).turned(bearing_deg)
    bins = 20
    beside = np.abs(y[np.abs(x) < 8 * pairs.near_m]) / pairs.near_m * bins
    often = np.bincount(beside.astype(int), minlength=20 * bins + 1).astype(float)
    often = _smoothed(often, 2)
    falling = np.flatnonzero(np.diff(often) > 0)
    if not len(falling):
        return None
    # rows do not stand closer than half the distance to the nearest plant
    own_row = max(falling[0], bins // 2)
    peaks, _ = find_peaks(often[own_row:], height=often[own_row:].max() / 2)
    return float((own_row + peaks[0] + 0.5) / bins * pairs.near_m) if len(peaks) else None


def _plant_spacing(x: Float, line: NDArray[np.intp], near_m: float) -> float | None:
    """Return the distance in a row, longer gaps counted as that of several missing plants."""
    order = np.lexsort((x, line))
    gaps = np.diff(x[order])[np.diff(line[order]) == 0]
    gaps = gaps[gaps > near_m / 4]
    if not len(gaps):
        return None
    # where half are missing, the middle gap lies between that of none and that of one
    spacings = [_step_of(gaps, usual) for usual in np.quantile(gaps, [0.5, 0.25])]
    return min(spacings, key=lambda step: float(np.abs(gaps / step - np.round(gaps / step)).mean()))


def _step_of(gaps: Float, usual: float) -> float:
    """Return the distance of which gaps are multiples, from about what it is."""
    steps = np.round(gaps / usual)
    sure = (steps >= 1) & (steps <= 4)
    return float(np.median(gaps[sure] / steps[sure]))


def main_bearing(edges_m: Float) -> float:
    """Return the bearing (0..180) that most metres of edge share, within a few degrees."""
    length = np.hypot(*edges_m.T)
    bearing_deg = np.rad2deg(np.arctan2(edges_m[:, 0], edges_m[:, 1])) % 180.0
    if not length.any():
        return 0.0  # of no length at all: any will do
    n = 180 * _BINS_PER_DEG
    metres = np.bincount((bearing_deg * _BINS_PER_DEG).astype(int) % n, length, n)
    smooth = _smoothed(metres, _EDGE_SMOOTH_DEG * _BINS_PER_DEG, mode="wrap")
    peak = (np.argmax(smooth) + 0.5) / _BINS_PER_DEG
    off = (bearing_deg - peak + 90.0) % 180.0 - 90.0
    near = np.abs(off) <= 2 * _EDGE_SMOOTH_DEG
    return float((peak + np.average(off[near], weights=length[near])) % 180.0)


def _smoothed(values: NDArray[Any], width: float, mode: str = "reflect") -> Float:
    """Return values in a row, each the mean of those about it by a bell of so many places."""
    from scipy.ndimage import gaussian_filter1d  # noqa: PLC0415 - few plots are measured ones

    smooth: Float = gaussian_filter1d(values, width, mode=mode)
    return smooth
