"""What is left of a day for somebody who leaves now: the route given out, or one of their rows."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.monitoring.settings import seconds
from fieldmon.planning.route import route_of
from fieldmon.planning.wishes import Wishes
from fieldmon.planning.workday import Workday
from fieldmon.plot.travel import GATE, driven_s

if TYPE_CHECKING:
    from datetime import date, time

    from numpy.typing import NDArray

    from fieldmon.monitoring.season_file import Season
    from fieldmon.planning.route import Route
    from fieldmon.samplers.base import Scene

    Plants = NDArray[np.int32]


def route_ahead(season: Season, on: date, rows: tuple[int, int] | None = None) -> Route:
    """Return what is left of the route given out for a day; give one out if there is none.

    Parameters
    ----------
    season
        The season.
    on
        The day.
    rows
        First and last row of somebody's part, from 1: of a part the stops given out, or where
        there are none, a route of its own.
    """
    kept = season.kept_route(on)
    if not len(kept) and rows is None:
        return season.plan(on).route
    scene = season.scene(on)
    left = kept[(scene.last_inspected[kept] != scene.day) & inside(season, rows)[kept]]
    return _through(scene, left) if len(left) else planned_again(season, on, rows)


def planned_again(
    season: Season,
    on: date,
    rows: tuple[int, int] | None = None,
    seconds_left: float | None = None,
) -> Route:
    """Plan what is left of a day with all that is known now.

    Where it is for the whole plot, it is kept as the route given out.
    """
    others = np.flatnonzero(~inside(season, rows))
    now = None if seconds_left is None else _time(season, seconds_left)
    wishes = Wishes(unwanted=tuple(others.tolist()))
    return season.plan(on, now, keep=rows is None, wishes=wishes).route


def inside(season: Season, rows: tuple[int, int] | None) -> NDArray[np.bool_]:
    """Return ``(n,)`` which plants are in a part."""
    line = season.label.line
    if rows is None:
        return np.ones(len(line), np.bool_)
    part: NDArray[np.bool_] = (line >= rows[0]) & (line <= rows[1])
    return part


def _time(season: Season, seconds_left: float) -> time:
    """Return the local time at which so much of the working day is left."""
    settings = season.settings
    left_s = min(max(seconds_left, 0.0), settings.robot.day_s)
    gone = timedelta(seconds=round(settings.robot.day_s - left_s))
    begin = datetime.combine(settings.begins, settings.starts)
    midnight = 86_399 - seconds(settings.starts)
    return (begin + min(gone, timedelta(seconds=midnight))).time()


def _through(scene: Scene, plants: Plants) -> Route:
    """Return the way through plants in their order, from where the scene stands."""
    robot = scene.robot
    places = np.concatenate([[scene.at], plants, [GATE] if robot.returns else []]).astype(np.int64)
    legs = [places[k : k + 2] for k in range(len(places) - 1)]
    drive_s = np.array([driven_s(scene.aisles.travel, scene.clock, leg) for leg in legs])
    k = len(plants)
    arrive_s = np.cumsum(drive_s[:k] + robot.visit_s) - robot.visit_s
    work = Workday(
        plant=plants,
        arrive_s=arrive_s,
        found=np.zeros(k, np.bool_),
        stop_s=np.full(k, robot.visit_s),
        detects=np.full(k, robot.detects),
        end_s=float(arrive_s[-1] + robot.visit_s + drive_s[k:].sum()),
    )
    return route_of(scene, work)
