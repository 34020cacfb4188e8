"""What is left of a day for somebody who leaves now: the route given out, or one of their rows."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.monitoring.photos_asked import photos_asked
from fieldmon.monitoring.settings import seconds
from fieldmon.planning.route import route_of
from fieldmon.planning.wishes import Wishes
from fieldmon.planning.workday import Workday
from fieldmon.plot.travel import GATE, driven_s

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.monitoring.photos_asked import AskedPhoto
    from fieldmon.monitoring.season_file import Season
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.route import Route
    from fieldmon.samplers.base import Scene

    Plants = NDArray[np.int32]

MIDNIGHT = time()


@dataclass(frozen=True)
class Part:
    """Whose part of a day's work it is.

    Parameters
    ----------
    rows
        First and last row, from 1; None: the whole plot, or what the team's plan gives.
    name
        Of one of the season's team; any other name is nobody's.
    """

    rows: tuple[int, int] | None = None
    name: str = ""

    def member(self, season: Season) -> TeamMember | None:
        """Return the one of the team who has this name, or None."""
        named = (one for one in season.settings.team if one.name.casefold() == self.name.casefold())
        return next(named, None)


WHOLE = Part()


def route_ahead(season: Season, on: date, part: Part = WHOLE) -> Route:
    """Return what is left of the route given out for a day; give one out if there is none.

    Somebody of the team has a route of their own. Of a part it is the stops given out in its rows,
    or where there are none, a route of its own.
    """
    member = part.member(season)
    who = "" if member is None else member.name
    kept = season.kept_route(on, who)
    if not len(kept) and part.rows is None:
        return season.plan(on, wishes=Wishes(_wanted(season)), who=who or None).route
    scene = season.scene(on, who=who)
    left = kept[(scene.last_inspected[kept] != scene.day) & inside(season, part.rows)[kept]]
    if len(left):
        return _through(scene, left)
    return planned_again(season, on, part, work_left_s(season, on, part))


def planned_again(
    season: Season, on: date, part: Part = WHOLE, seconds_left: float | None = None
) -> Route:
    """Plan what is left of a day with all that is known now, by the plants to be photographed.

    Where it is for the whole plot, it is kept as the route given out.
    """
    others = np.flatnonzero(~inside(season, part.rows))
    member = part.member(season)
    now = None if seconds_left is None else _time(season, seconds_left, member)
    wishes = Wishes(_wanted(season, part), tuple(others.tolist()))
    who = None if member is None else member.name
    return season.plan(on, now, keep=part.rows is None, wishes=wishes, who=who).route


def work_left_s(season: Season, on: date, part: Part) -> float:
    """Return the seconds left of somebody's working day, which begins with the first inspection.

    Of nobody in particular, and where inspections have no times, it is what the season reckons.
    """
    member = part.member(season)
    done = season.history.inspections.on(on)
    own_s = done.second[done.who == part.name]
    known_s = own_s[~np.isnan(own_s)]
    if not part.name or (len(own_s) and not len(known_s)):
        return float(season.scene(on, who="" if member is None else member.name).seconds_left)
    robot = season.settings.robot if member is None else member.robot
    return max(float(robot.day_s - (np.ptp(known_s) if len(known_s) else 0.0)), 0.0)


def inside(season: Season, rows: tuple[int, int] | None) -> NDArray[np.bool_]:
    """Return ``(n,)`` which plants are in a part."""
    line = season.label.line
    if rows is None:
        return np.ones(len(line), np.bool_)
    part: NDArray[np.bool_] = (line >= rows[0]) & (line <= rows[1])
    return part


def asked_of(season: Season, on: date, part: Part = WHOLE) -> tuple[AskedPhoto, ...]:
    """Return the photos asked for that are somebody's to take: none is taken by two.

    Those in a part's rows; of a team those on one's own route, and the first one's where they are
    on nobody's.
    """
    mine, member = inside(season, part.rows), part.member(season)
    if member is not None:
        routes = {one.name: season.kept_route(on, one.name) for one in season.settings.team}
        own = routes.pop(member.name)
        if member.name != season.settings.team[0].name:
            mine &= np.isin(np.arange(len(mine)), own)
        for others in routes.values():
            mine[others] = False
    return tuple(one for one in photos_asked(season) if mine[one.plant])


def _wanted(season: Season, part: Part = WHOLE) -> tuple[int, ...]:
    """Return the plants of a part of which a photo is asked for."""
    mine = inside(season, part.rows)
    return tuple(sorted({one.plant for one in photos_asked(season) if mine[one.plant]}))


def _time(season: Season, seconds_left: float, member: TeamMember | None) -> time:
    """Return the local time at which so much of the working day is left."""
    settings = season.settings
    robot, later_s = (settings.robot, 0.0) if member is None else (member.robot, member.starts_s)
    left_s = min(max(seconds_left, 0.0), robot.day_s)
    begins_s = seconds(settings.starts) + later_s
    now_s = min(begins_s + robot.day_s - left_s, 86_399.0)
    return (datetime.combine(settings.begins, MIDNIGHT) + timedelta(seconds=round(now_s))).time()


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
