"""What is left of a day for somebody who leaves now: the route given out, or one of their rows."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.monitoring.photos_asked import photos_asked
from fieldmon.monitoring.scouts import scouts_of
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
        Of whoever works: one of the season's team or not; empty: nobody in particular.
    """

    rows: tuple[int, int] | None = None
    name: str = ""

    def member(self, season: Season) -> TeamMember | None:
        """Return the one of the team who has this name, or None."""
        return season.settings.named(self.name)


WHOLE = Part()


def route_ahead(season: Season, on: date, part: Part = WHOLE) -> Route:
    """Return what is left of the route given out for a day; give one out if there is none.

    Somebody of the team has a route of their own, and so has whoever has rows, or shares them, see
    `crew_of`. It begins where that person inspected last, or at the gate.
    """
    scene = season.scene(on, who=part.name)
    kept = season.kept_route(on, kept_as(season, on, part))
    kept = kept[scene.last_inspected[kept] != scene.day]
    left = kept[_own(season, part)[kept]]
    if not len(left) or (part.name and _is_others(season, on, part, kept)):
        return planned_again(season, on, part)
    return _through(scene, left)


def planned_again(
    season: Season, on: date, part: Part = WHOLE, seconds_left: float | None = None
) -> Route:
    """Plan what is left of a day with all that is known now, by the plants to be photographed.

    It is kept as the route given out, unless it is a part of the plot and nobody's own.
    """
    own, member = _own(season, part), part.member(season)
    if part.rows is not None and season.settings.team and member is None:
        for one in season.settings.team:
            own[season.kept_route(on, one.name)] = False
    others = tuple(np.flatnonzero(~own).tolist())
    wishes = Wishes(_wanted(season, part), others)
    if part.name and member is None:
        crew = crew_of(season, part)
        told = None if seconds_left is None else {part.name: seconds_left}
        named = (kept_as(season, on, part),) if len(crew) == 1 else None
        days = season.plan_crew(on, crew, told, wishes=wishes, kept_as=named)
        return days[crew.index(part.name)].route
    who = None if member is None else member.name
    now = None if seconds_left is None else _time(season, on, seconds_left, member)
    return season.plan(on, now, keep=part.rows is None, wishes=wishes, who=who).route


def crew_of(season: Season, part: Part) -> tuple[str, ...]:
    """Return who shares a part's plants: all who have a code for these rows, beside the team.

    They have aisles of their own, as a team has.
    """
    lines = 1, int(season.label.line.max())
    names = [
        one.name
        for one in scouts_of(season)
        if (one.rows or lines) == (part.rows or lines) and season.settings.named(one.name) is None
    ]
    return (*names, *({part.name} - {*names}))


def kept_as(season: Season, on: date, part: Part) -> str:
    """Return by which name a part's route of a day is kept.

    The season's own is that of who works alone, unless one of their own was given to them after it.
    """
    if (member := part.member(season)) is not None:
        return member.name
    alone = part.rows is None and not season.settings.team and len(crew_of(season, part)) == 1
    if not alone:
        return part.name
    last = season.kept_last(on)
    return part.name if last.get(part.name, 0) > last.get("", 0) else ""


def plan_of(season: Season, on: date, part: Part) -> int | None:
    """Return the number in the file of the route kept last of a part; None: none is kept."""
    return season.kept_last(on).get(kept_as(season, on, part))


def given(season: Season, on: date, part: Part) -> Plants:
    """Return the plants of the route kept of a part that are in it."""
    kept = season.kept_route(on, kept_as(season, on, part))
    return kept[_own(season, part)[kept]]


def _is_others(season: Season, on: date, part: Part, left: Plants) -> bool:
    """Return whether a route was made for other rows, or others who share them have of it now."""
    if part.member(season) is not None:
        return False
    if not _own(season, part)[left].all():
        return True
    others = [one for one in crew_of(season, part) if one != part.name]
    return any(np.isin(left, season.kept_route(on, one)).any() for one in others)


def _own(season: Season, part: Part) -> NDArray[np.bool_]:
    """Return ``(n,)`` which plants are somebody's to inspect; beside a team none without rows."""
    beside = bool(season.settings.team and part.name) and part.member(season) is None
    if beside and part.rows is None:
        return np.zeros(len(season.label.line), np.bool_)
    return inside(season, part.rows)


def work_left_s(season: Season, on: date, part: Part) -> float:
    """Return the seconds left of somebody's working day, see `Season.begun_s`."""
    return float(season.scene(on, who=part.name).seconds_left)


def inside(season: Season, rows: tuple[int, int] | None) -> NDArray[np.bool_]:
    """Return ``(n,)`` which plants are in a part."""
    line = season.label.line
    if rows is None:
        return np.ones(len(line), np.bool_)
    part: NDArray[np.bool_] = (line >= rows[0]) & (line <= rows[1])
    return part


def asked_of(season: Season, on: date, part: Part = WHOLE) -> tuple[AskedPhoto, ...]:
    """Return the photos asked for that are somebody's to take: none is taken by two.

    Those in a part's rows; of several who share them those on one's own route, and the first one's
    where they are on nobody's.
    """
    mine, member = _own(season, part), part.member(season)
    team = [one.name for one in season.settings.team]
    names = crew_of(season, part) if member is None else team
    if part.name and len(names) > 1:
        who = part.name if member is None else member.name
        routes = {one: season.kept_route(on, one) for one in names}
        own = routes.pop(who)
        if who != names[0]:
            mine &= np.isin(np.arange(len(mine)), own)
        for others in routes.values():
            mine[others] = False
    return tuple(one for one in photos_asked(season) if mine[one.plant])


def _wanted(season: Season, part: Part = WHOLE) -> tuple[int, ...]:
    """Return the plants of a part of which a photo is asked for."""
    mine = _own(season, part)
    return tuple(sorted({one.plant for one in photos_asked(season) if mine[one.plant]}))


def _time(season: Season, on: date, seconds_left: float, member: TeamMember | None) -> time:
    """Return the local time at which so much of the working day is left."""
    robot, who = (season.settings.robot, "") if member is None else (member.robot, member.name)
    left_s = min(max(seconds_left, 0.0), robot.day_s)
    now_s = min(season.begun_s(on, who) + robot.day_s - left_s, 86_399.0)
    return (datetime.combine(on, MIDNIGHT) + timedelta(seconds=round(now_s))).time()


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
