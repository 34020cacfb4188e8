"""Where two of a team would be in one aisle at once, read off their driven lines alone."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.plot.passing import legs_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.route import Route

    Float = NDArray[np.float64]

_ON_LANE_M = 0.001
# at an aisle's very end one may pass another in the headland
_INSIDE_M = 0.01


class Meeting(NamedTuple):
    """Two members in one aisle: who, which aisle, from when to when (s of the team's day)."""

    who: tuple[int, int]
    aisle: int
    since_s: float
    until_s: float


class _Presence(NamedTuple):
    """When one is in an aisle."""

    aisle: int
    since_s: float
    until_s: float


def meetings(routes: Sequence[Route], starts_s: Float) -> list[Meeting]:
    """Return every time that two are in one aisle at once, the earliest first.

    Parameters
    ----------
    routes
        A route each; their seconds count from `starts_s` ``(m,)``.
    """
    there = [_presences(route, float(start)) for route, start in zip(routes, starts_s, strict=True)]
    found = []
    for a, b in combinations(range(len(routes)), 2):
        by_aisle: dict[int, list[_Presence]] = {}
        for one in there[b]:
            by_aisle.setdefault(one.aisle, []).append(one)
        for one in there[a]:
            for other in by_aisle.get(one.aisle, []):
                since, until = max(one.since_s, other.since_s), min(one.until_s, other.until_s)
                if since < until:
                    last = min(one.until_s, other.until_s)
                    found.append(Meeting((a, b), one.aisle, since, last))
    return sorted(found, key=lambda met: met.since_s)


def _presences(route: Route, start_s: float) -> list[_Presence]:
    """Return when a route is in which aisle, stops included."""
    if not len(route):
        return []
    if route.aisles.grid.aisles_m is not None:
        return _of_stops(route, start_s)
    grid, line = route.aisles.grid, route.line_m
    depart_s = route.line_s.copy()
    np.maximum.at(depart_s, route.line_stop, route.leave_s)
    found: list[_Presence] = []
    for v in range(len(line) - 1):
        (x, y), (to_x, to_y) = line[v], line[v + 1]
        if abs(y - to_y) > _ON_LANE_M:
            continue
        low, high = min(x, to_x), max(x, to_x)
        for row in np.flatnonzero(np.abs(grid.lane_y_m - y) <= _ON_LANE_M).tolist():
            first, last = grid.lane_x_m[row]
            if low < last - _INSIDE_M and high > first + _INSIDE_M:
                found.append(
                    _Presence(
                        int(grid.corridor[row]),
                        start_s + float(depart_s[v] if v else route.line_s[0]),
                        start_s + float(route.line_s[v + 1]),
                    )
                )
    return _with_stops(route, found, start_s)


def _of_stops(route: Route, start_s: float) -> list[_Presence]:
    """Return presences where rows bend, seen from the stops: each with the ways before and after.

    Aisles that are driven through between two count for all of that way: more than is true.
    """
    grid, legs = route.aisles.grid, legs_of(route.aisles)
    row = grid.row[route.plant]
    aisle, stretch = grid.corridor[row].tolist(), grid.stretches[row].tolist()
    plants = route.plant.tolist()
    begins = [float(route.line_s[0]), *route.leave_s[:-1].tolist()]
    ends = [*route.arrive_s[1:].tolist(), route.end_s]
    found = []
    for k, one in enumerate(aisle):
        found.append(_Presence(one, start_s + begins[k], start_s + ends[k]))
        if k and stretch[k - 1] != stretch[k]:
            through = legs.leg(plants[k - 1], plants[k]).through
            way = start_s + begins[k], start_s + float(route.arrive_s[k])
            found += [_Presence(passed, *way) for passed in through]
    return _joined(found)


def _with_stops(route: Route, found: list[_Presence], start_s: float) -> list[_Presence]:
    """Return presences with the stops."""
    grid = route.aisles.grid
    aisle = grid.corridor[grid.row[route.plant]]
    stops = zip(aisle.tolist(), route.arrive_s, route.leave_s, strict=True)
    found += [_Presence(k, start_s + float(a), start_s + float(b)) for k, a, b in stops]
    return _joined(found)


def _joined(found: list[_Presence]) -> list[_Presence]:
    """Return presences in order, those that follow each other in one aisle taken together."""
    found.sort(key=lambda one: one.since_s)
    joined: list[_Presence] = []
    for one in found:
        if joined and joined[-1].aisle == one.aisle and one.since_s <= joined[-1].until_s + 1e-6:
            until = max(one.until_s, joined[-1].until_s)
            joined[-1] = joined[-1]._replace(until_s=until)
        else:
            joined.append(one)
    return joined
