"""Rows drawn from what is known of them: their end posts, or the slope of the ground."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString, MultiLineString

from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError
from fieldmon.plot.line_layout import copies
from fieldmon.plot.polylines import Polylines, sampled
from fieldmon.plot.row_detection import frame_around

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.field import Field

    Float = NDArray[np.float64]

_STEP_DEG, _FINE_DEG = 0.1, 0.01
# posts of one row lie nearer to one line than this part of the distance to the next row
_IN_LINE = 0.35
_MOST_STEPS = 20_000
# a row through places is looked at as finely; places nearer than that are one
_SMOOTH_M, _SAME_M = 1.0, 0.01
# a walked line strays so far; other rows are beside it up to so far; it is looked at so often
_STRAYS_M, _BESIDE_M, _MOST_LOOKED_AT = 2.0, 12.0, 2000
# rows are level or fall over so much of their length
_FALL_M = 10.0


def rows_from_posts(lonlat: Float, names: NDArray[np.str_] | None = None) -> MultiLineString:
    """Return rows from their end posts, two a row.

    Posts of one name are a pair; without names those are that lie in line, one way for all rows.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees, in any order.
    names
        ``(n,)`` the row of each; None: not known.

    Raises
    ------
    PlotError
        If posts are not two a row, or no direction pairs them.
    """
    n = len(lonlat)
    if names is not None and not (names == "").any():
        row, count = np.unique(names, return_inverse=True, return_counts=True)[1:]
        if (count != 2).any():
            wrong = str(names[row == np.flatnonzero(count != 2)[0]][0])
            raise PlotError(
                worded(
                    "Rows must have two end posts each, but row {wrong!r} has "
                    "{n}. Add or remove posts.",
                    wrong=wrong,
                    n=int(count[count != 2][0]),
                )
            )
        return _drawn(lonlat, np.argsort(row, kind="stable").reshape(-1, 2))
    if n < 4 or n % 2:
        raise PlotError(
            worded(
                "End posts must be two a row, of two rows or more, but there "
                "are {n}. Add those that are missing, or name the row of each "
                "post.",
                n=n,
            )
        )
    return _drawn(lonlat, _pairs_in_line(frame_around(lonlat).xy_m(lonlat)))


def _drawn(lonlat: Float, pairs: NDArray[np.intp]) -> MultiLineString:
    return MultiLineString([lonlat[pair] for pair in pairs])


def _pairs_in_line(xy_m: Float) -> NDArray[np.intp]:
    """Return pairs of posts ``(r, 2)`` that lie in line, the same way for all."""
    coarse = np.arange(0.0, 180.0, _STEP_DEG)
    best = coarse[np.argmin([_badness(xy_m, deg) for deg in coarse])]
    fine = best + np.arange(-_STEP_DEG, _STEP_DEG, _FINE_DEG)
    best = fine[np.argmin([_badness(xy_m, deg) for deg in fine])]
    order, within, between = _in_turn(xy_m, float(best))
    if within.max() > _IN_LINE * between.min():
        raise PlotError(
            worded(
                "End posts must lie two by two in line, but of {n} posts some "
                "do not. Name the row of each post, or draw the rows as "
                "lines.",
                n=len(xy_m),
            )
        )
    return order.reshape(-1, 2)


def _in_turn(xy_m: Float, angle_deg: float) -> tuple[NDArray[np.intp], Float, Float]:
    """Return posts sorted across a direction, the gaps within their pairs and between them."""
    turn = np.deg2rad(angle_deg)
    across = xy_m[:, 1] * np.cos(turn) - xy_m[:, 0] * np.sin(turn)
    order = np.argsort(across)
    gaps = np.diff(across[order])
    return order, gaps[::2], gaps[1::2]


def _badness(xy_m: Float, angle_deg: float) -> float:
    """Return how badly pairs are in line; of equally good ways rows are the longer ones."""
    order, within, between = _in_turn(xy_m, angle_deg)
    pairs = xy_m[order].reshape(-1, 2, 2)
    length = float(np.hypot(*(pairs[:, 1] - pairs[:, 0]).T).mean())
    return float(within.mean() / max(between.min(), 1e-9) + 1e-3 * between.mean() / length)


def smooth_row(lonlat: Float) -> LineString:
    """Return a row that runs smoothly through some places ``(k, 2)``, in their order.

    A cubic spline along the chords between them; two are a straight row.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 - half a second to import

    frame = frame_around(lonlat)
    xy_m = frame.xy_m(lonlat)
    step_m = np.hypot(*np.diff(xy_m, axis=0).T)
    apart = np.append(True, step_m > _SAME_M)
    xy_m, at_m = xy_m[apart], np.append(0.0, np.cumsum(step_m))[apart]
    if len(xy_m) < 2:
        raise PlotError(
            worded("A row must lead somewhere, but all of its places are one. Draw it again.")
        )
    if len(xy_m) < 3:
        return LineString(lonlat[apart])
    n = int(np.clip(at_m[-1] / _SMOOTH_M, 2 * len(xy_m), _MOST_STEPS))
    curve = CubicSpline(at_m, xy_m, bc_type="natural")(np.linspace(0.0, at_m[-1], n + 1))
    thin = shapely.simplify(shapely.linestrings(curve), 0.02)
    return LineString(frame.lonlat(shapely.get_coordinates(thin)))


def turns_back(row: LineString) -> bool:
    """Return whether a line runs back beside itself, as a track walked up and down several rows.

    Half of it is nearer to another part of it than a row spacing of 12 m, and four times as far
    along the line. Rings and hairpins, wide enough to drive, are rows.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    lonlat = shapely.get_coordinates(row)
    walked = LineString(frame_around(lonlat).xy_m(lonlat))
    line = LineString(shapely.get_coordinates(walked.simplify(_STRAYS_M)))
    n = int(np.clip(line.length / _STRAYS_M, 1, _MOST_LOOKED_AT))
    at_m = np.linspace(0.0, line.length, n + 1)
    tree = cKDTree(shapely.get_coordinates(shapely.line_interpolate_point(line, at_m)))
    near = tree.query_pairs(_BESIDE_M, output_type="ndarray")
    away_m = np.hypot(*(tree.data[near[:, 0]] - tree.data[near[:, 1]]).T)
    back = near[at_m[near[:, 1]] - at_m[near[:, 0]] > 4.0 * np.maximum(away_m, _STRAYS_M)]
    return len(np.unique(back)) > (n + 1) / 2


def contour_row(field: Field, height_m: Callable[[Float], Float], step_m: float) -> MultiLineString:
    """Return the contour through the middle of a plot, as far as the plot reaches.

    Of this row all others are copies (see `fieldmon.plot.layout.lay`): the spacing of rows stays,
    and they follow the slope as terraces do.

    Parameters
    ----------
    field
        The plot.
    height_m
        Heights ``(n,)`` of positions ``(n, 2)`` lon/lat; NaN where not known.
    step_m
        How finely the contour is followed.

    Raises
    ------
    PlotError
        If heights are not known there, or the ground is level.
    """
    frame = field.frame()
    area = frame.geometry_m(field.drivable())
    inside = shapely.point_on_surface(area)
    middle = area.centroid if shapely.contains(area, area.centroid) else inside
    start = np.array([middle.x, middle.y])

    def at(xy_m: Float) -> Float:
        return height_m(frame.lonlat(xy_m))

    level = float(at(start[None])[0])
    reach = shapely.buffer(area.envelope, step_m)
    halves = [_followed(at, (start, level), way * step_m, reach) for way in (1.0, -1.0)]
    line = np.concatenate([halves[1][::-1], start[None], halves[0]])
    if not np.isfinite(level) or len(line) < 3:
        raise PlotError(
            worded(
                "Rows along contours need heights that differ, but about the "
                "middle of plot {name!r} the raster shows {value}. Choose "
                "another raster, or give the row bearing.",
                name=field.name,
                value="none" if not np.isfinite(level) else "no slope",
            )
        )
    return MultiLineString(
        [frame.lonlat(shapely.get_coordinates(shapely.simplify(shapely.linestrings(line), 0.02)))]
    )


def falls_along(
    field: Field,
    row: MultiLineString,
    row_spacing_m: float,
    height_m: Callable[[Float], Float],
) -> Float:
    """Return how steeply a row and its copies over a plot rise or fall, metres a metre, ``(k,)``.

    Over ten metres each. Copies keep their distance: where contours come nearer to each other or
    part, they cannot be contours.
    """
    frame = field.frame()
    area = frame.geometry_m(field.drivable())
    line_m = shapely.get_coordinates(frame.geometry_m(row))
    rows = Polylines.each(copies(line_m, area, row_spacing_m))
    line, place_m = sampled(rows, _FALL_M / 2)
    rise_m = height_m(frame.lonlat(rows.points(line, place_m)))
    same = line[2:] == line[:-2]
    falls: Float = np.abs(rise_m[2:] - rise_m[:-2])[same] / (place_m[2:] - place_m[:-2])[same]
    return falls[np.isfinite(falls)]


def _followed(
    at: Callable[[Float], Float], start: tuple[Float, float], step_m: float, reach: shapely.Geometry
) -> Float:
    """Return the points of a contour one way from its start until it leaves what it may reach."""
    here, level = start
    shapely.prepare(reach)
    ahead = None
    points: list[Float] = []
    for _ in range(_MOST_STEPS):
        up = _uphill(at, here, abs(step_m))
        if up is None:
            break
        along = np.array([-up[1], up[0]]) / np.hypot(*up) * step_m
        if ahead is not None and along @ ahead < 0:
            break  # over a ridge or through a hollow
        there = here + along
        up = _uphill(at, there, abs(step_m))
        if up is None:
            break
        # back to the level, but no farther than half a step
        off = up * (level - float(at(there[None])[0])) / (up @ up)
        there = there + off * min(1.0, abs(step_m) / 2 / max(float(np.hypot(*off)), 1e-12))
        here, ahead = there, along
        points.append(here)
        if not shapely.contains_xy(reach, *here):
            break
        if len(points) > 10 and np.hypot(*(here - start[0])) < abs(step_m):
            break  # once round a hill
    return np.array(points).reshape(-1, 2)


def _uphill(at: Callable[[Float], Float], here: Float, by_m: float) -> Float | None:
    """Return the slope at a place, metres a metre; None where there is none."""
    around = here + by_m * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    east, west, north, south = at(around)
    up = np.array([east - west, north - south]) / (2 * by_m)
    return up if np.isfinite(up).all() and np.hypot(*up) > 1e-4 else None
