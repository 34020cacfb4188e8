"""Where two of a team would meet head-on in a headland too narrow to pass, off their lines."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.plot.obstacles import row_lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid

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


class Steps(NamedTuple):
    """Straight steps of a line outside aisles.

    Parameters
    ----------
    from_m, to_m
        ``(k, 2)`` metres of the plot's frame.
    since_s, until_s
        ``(k,)`` seconds of the team's day.
    """

    from_m: Float
    to_m: Float
    since_s: Float
    until_s: Float

    def __repr__(self) -> str:
        return f"<Steps: {len(self.since_s)}>"


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
    headlands = [headlands_of(route.aisles.grid) for route in routes]
    steps = [
        own.steps(route.line_m, (route.line_s + at, _leaves_s(route) + at))
        for own, route, at in zip(headlands, routes, starts_s, strict=True)
    ]
    found = []
    for a, b in combinations(range(len(routes)), 2):
        when = headlands[a].meet(steps[a], steps[b], passing_m)
        found += [HeadOn((a, b), float(t), (float(x), float(y))) for t, x, y in when]
    return sorted(found, key=lambda met: met.at_s)


def _leaves_s(route: Route) -> Float:
    """Return when each vertex of a route's line is left."""
    leave_s = route.line_s.copy()
    np.maximum.at(leave_s, route.line_stop, route.leave_s)
    return leave_s


@lru_cache(maxsize=8)
def headlands_of(grid: PlantGrid) -> Headlands:
    """Return the headlands of a plot; what measures them is kept for its next day."""
    return Headlands(grid)


class Headlands:
    """What lies outside the aisles of a plot, and how wide it is at a place."""

    def __init__(self, grid: PlantGrid) -> None:
        self._lane_m, self._end_m = grid.lane_y_m, grid.lane_x_m
        self._rows = shapely.STRtree(row_lines(grid))
        self._edge = shapely.boundary(grid.drivable_m)

    def __repr__(self) -> str:
        return f"<Headlands of {len(self._lane_m)} rows>"

    def steps(self, line_m: Float, times_s: tuple[Float, Float]) -> Steps:
        """Return the steps of a line ``(m, 2)`` that lie in no aisle.

        `times_s` are the seconds ``(m,)`` at which it comes to each vertex and leaves it.
        """
        from_m, to_m, since_s, until_s = self._cut(line_m, times_s)
        middle = (from_m + to_m) / 2
        on_lane = np.abs(middle[:, 1, None] - self._lane_m) <= _ON_LANE_M
        on_lane &= (self._end_m[:, 0] < middle[:, 0, None]) & (
            middle[:, 0, None] < self._end_m[:, 1]
        )
        along = np.abs(to_m[:, 1] - from_m[:, 1]) <= _ON_LANE_M
        moves = np.hypot(*(to_m - from_m).T) > _STILL_M
        keep = moves & ~(along & on_lane.any(axis=1))
        return Steps(from_m[keep], to_m[keep], since_s[keep], until_s[keep])

    def _cut(self, line_m: Float, times_s: tuple[Float, Float]) -> Steps:
        """Return all steps of a line, cut where one drives into an aisle or out of it."""
        arrive_s, leave_s = times_s
        x, low, high = line_m[:, 0], *np.sort([line_m[:-1, 0], line_m[1:, 0]], axis=0)
        level = (np.abs(line_m[:, 1, None] - self._lane_m) <= _ON_LANE_M)[:, :, None]
        ends = self._end_m[None]
        cuts = (low[:, None, None] + _STILL_M < ends) & (ends < high[:, None, None] - _STILL_M)
        step, row, end = np.nonzero(cuts & level[:-1] & level[1:])
        share = (self._end_m[row, end] - x[step]) / (x[step + 1] - x[step])
        at_s = leave_s[step] + share * (arrive_s[step + 1] - leave_s[step])
        order = np.lexsort((share, step))
        step, share, at_s = step[order], share[order], at_s[order]
        cut_m = line_m[step] + share[:, None] * (line_m[step + 1] - line_m[step])
        line_m = np.insert(line_m, step + 1, cut_m, axis=0)
        arrive_s, leave_s = (np.insert(one, step + 1, at_s) for one in times_s)
        return Steps(line_m[:-1], line_m[1:], leave_s[:-1], arrive_s[1:])

    def meet(self, one: Steps, other: Steps, passing_m: float) -> Float:
        """Return when and where ``(k, 3)`` two meet head-on with less room than they need."""
        when = _nearest(one, other, passing_m / 2)
        return when[self._width_m(when[:, 1:]) < passing_m] if len(when) else when

    def _width_m(self, places: Float) -> Float:
        """Return how wide it is at places ``(k, 2)``: from the nearest row to the plot's edge."""
        points = shapely.points(places)
        near = self._rows.query_nearest(points, return_distance=True, all_matches=False)[1]
        edge = shapely.distance(points, self._edge)
        return np.asarray(near, np.float64) + np.asarray(edge, np.float64)


def _nearest(one: Steps, other: Steps, within_m: float) -> Float:
    """Return when and where ``(k, 3)`` two come nearer than that while driving to each other."""
    i, j = np.nonzero(
        (one.since_s[:, None] < other.until_s) & (other.since_s < one.until_s[:, None])
    )
    if not len(i):
        return np.empty((0, 3))
    speed = [(s.to_m - s.from_m) / (s.until_s - s.since_s)[:, None] for s in (one, other)]
    against = (speed[0][i] * speed[1][j]).sum(axis=1) < 0.0
    i, j = i[against], j[against]
    begin = np.maximum(one.since_s[i], other.since_s[j])
    end = np.minimum(one.until_s[i], other.until_s[j])
    here = one.from_m[i] + speed[0][i] * (begin - one.since_s[i])[:, None]
    there = other.from_m[j] + speed[1][j] * (begin - other.since_s[j])[:, None]
    gap, closing = here - there, speed[0][i] - speed[1][j]
    # who drive away from each other have met before, or not at all
    nearer = (gap * closing).sum(axis=1) < 0.0
    begin, end, here, gap, closing = (v[nearer] for v in (begin, end, here, gap, closing))
    # the moment at which the gap, which changes evenly, is least
    fast = np.maximum((closing**2).sum(axis=1), _STILL_M**2)
    later = np.clip(-(gap * closing).sum(axis=1) / fast, 0.0, end - begin)
    least = np.hypot(*(gap + closing * later[:, None]).T)
    near = least < within_m
    place = here + speed[0][i][nearer] * later[:, None]
    when: Float = np.column_stack([begin + later, place])[near]
    return when
