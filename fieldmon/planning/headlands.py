"""Where two of a team would meet head-on in a headland too narrow to pass, off their lines."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.plot.road_network import row_lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.route import Route

    Float = NDArray[np.float64]

_STILL_M, _ON_LANE_M = 1e-6, 0.001


class HeadOn(NamedTuple):
    """Two members who drive towards each other in a headland that does not hold both abreast.

    Parameters
    ----------
    who
        The two, by their numbers.
    at_s
        When they are nearest to each other, seconds of the team's day.
    place_m
        Where the first one is then, metres of the plot's frame.
    """

    who: tuple[int, int]
    at_s: float
    place_m: tuple[float, float]


class _Steps(NamedTuple):
    """Straight steps of a line outside aisles: from, to ``(k, 2)``, and when ``(k,)``."""

    from_m: Float
    to_m: Float
    since_s: Float
    until_s: Float


def head_on(routes: Sequence[Route], starts_s: Float, passing_m: float) -> list[HeadOn]:
    """Return every time that two meet head-on where a headland is too narrow, the earliest first.

    Parameters
    ----------
    routes
        A route each; their seconds count from `starts_s` ``(m,)``.
    passing_m
        Metres of headland that two need to pass each other. How wide one is at a place is measured
        there: from the nearest row to the plot's edge. They meet where their lines come
        nearer to each other than half of `passing_m`.
    """
    steps = [_outside(route, float(at)) for route, at in zip(routes, starts_s, strict=True)]
    found = []
    for a, b in combinations(range(len(routes)), 2):
        when = _nearest(steps[a], steps[b], passing_m / 2)
        narrow = _width_m(routes[a], when[:, 1:]) < passing_m if len(when) else ()
        found += [HeadOn((a, b), float(t), (float(x), float(y))) for t, x, y in when[narrow]]
    return sorted(found, key=lambda met: met.at_s)


def _outside(route: Route, start_s: float) -> _Steps:
    """Return the steps of a route that lie in no aisle."""
    line, grid = route.line_m, route.aisles.grid
    if len(line) < 2:
        return _Steps(np.empty((0, 2)), np.empty((0, 2)), np.empty(0), np.empty(0))
    leave_s = route.line_s.copy()
    np.maximum.at(leave_s, route.line_stop, route.leave_s)
    from_m, to_m = line[:-1], line[1:]
    middle = (from_m + to_m) / 2
    on_lane = np.abs(middle[:, 1, None] - grid.lane_y_m) <= _ON_LANE_M
    low_m, high_m = grid.lane_x_m[:, 0], grid.lane_x_m[:, 1]
    on_lane &= (low_m < middle[:, 0, None]) & (middle[:, 0, None] < high_m)
    along = np.abs(to_m[:, 1] - from_m[:, 1]) <= _ON_LANE_M
    moves = np.hypot(*(to_m - from_m).T) > _STILL_M
    keep = moves & ~(along & on_lane.any(axis=1))
    since_s, until_s = leave_s[:-1] + start_s, route.line_s[1:] + start_s
    return _Steps(from_m[keep], to_m[keep], since_s[keep], until_s[keep])


def _nearest(one: _Steps, other: _Steps, within_m: float) -> Float:
    """Return when and where ``(k, 3)`` two come nearer than that while driving to each other."""
    i, j = np.nonzero(
        (one.since_s[:, None] < other.until_s) & (other.since_s < one.until_s[:, None])
    )
    if not len(i):
        return np.empty((0, 3))
    speed = [(s.to_m - s.from_m) / (s.until_s - s.since_s)[:, None] for s in (one, other)]
    towards = (speed[0][i] * speed[1][j]).sum(axis=1) < 0.0
    i, j = i[towards], j[towards]
    begin = np.maximum(one.since_s[i], other.since_s[j])
    end = np.minimum(one.until_s[i], other.until_s[j])
    here = one.from_m[i] + speed[0][i] * (begin - one.since_s[i])[:, None]
    there = other.from_m[j] + speed[1][j] * (begin - other.since_s[j])[:, None]
    gap, closing = here - there, speed[0][i] - speed[1][j]
    # the moment at which the gap, which changes evenly, is least
    fast = np.maximum((closing**2).sum(axis=1), _STILL_M**2)
    later = np.clip(-(gap * closing).sum(axis=1) / fast, 0.0, end - begin)
    least = np.hypot(*(gap + closing * later[:, None]).T)
    near = least < within_m
    place = here + speed[0][i] * later[:, None]
    when: Float = np.column_stack([begin + later, place])[near]
    return when


def _width_m(route: Route, places: Float) -> Float:
    """Return how wide the headland is at places ``(k, 2)``: from the nearest row to the edge."""
    grid = route.aisles.grid
    points = shapely.points(places)
    rows = shapely.STRtree(row_lines(grid))
    near = rows.query_nearest(points, return_distance=True, all_matches=False)[1]
    edge = shapely.distance(points, shapely.boundary(grid.drivable_m))
    return np.asarray(near, np.float64) + np.asarray(edge, np.float64)
