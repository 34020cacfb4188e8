"""A team as its table states it, and the table that states a team."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from fieldmon.compute.day_arguments import clock_of
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.readers.team import StatedMember
from fieldmon.planning.members import TeamMember, must_differ, refuse_too_many
from fieldmon.plot.robot import SAID_IN, Robot, scout

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from datetime import time

_Made = TypeVar("_Made")


def usual_kind(who: str) -> Robot:
    """Return what the one is of whom a table says no more than this ``who``."""
    return scout() if who == "scout" else Robot()


def team_stated(
    stated: Sequence[StatedMember], usual: time, kind: Callable[[str], Robot] = usual_kind
) -> tuple[tuple[TeamMember, ...], time]:
    r"""Return the team that a table states, and the local time at which the first of it starts.

    Parameters
    ----------
    stated
        Its lines.
    usual
        When those start of whom it does not say it.
    kind
        What the one is of whom it says no more than ``who``, which may be empty.

    Raises
    ------
    SettingError
        If there are too many, two share a name, or one cannot be; with file and line.

    Examples
    --------
    >>> from fieldmon.io.readers.team import team_of_table
    >>> stated = team_of_table(b"name,start\nAnn,07:30\nBo,\n", "team.csv")
    >>> (ann, bo), first = team_stated(stated, time(6))
    >>> first, ann.starts_s, bo.starts_s
    (datetime.time(6, 0), 5400.0, 0.0)
    """
    refuse_too_many(len(stated))
    must_differ([one.name for one in stated], [one.where for one in stated])
    starts = [
        usual if one.start is None else _told_at(one, clock_of, "start", one.start)
        for one in stated
    ]
    first = min(starts)

    def member(one: StatedMember, start: time) -> TeamMember:
        late_s = 60.0 * (60 * (start.hour - first.hour) + start.minute - first.minute)
        own = replace(kind(one.who), **one.settings)  # type: ignore[arg-type]
        return TeamMember(one.name, own, one.gate, late_s)

    each = zip(stated, starts, strict=True)
    return tuple(_told_at(one, member, one, start) for one, start in each), first


def stated_team(team: Iterable[TeamMember], starts: time) -> tuple[StatedMember, ...]:
    """Return the lines of the table that states a team whose day begins at `starts`, local time.

    Where the chance to find goes by the seconds at a plant otherwise than usual, it states that of
    its own.

    Raises
    ------
    SettingError
        If a table cannot say all of somebody: who need not be back in its hours, or does not start
        at a minute of the same day.

    Examples
    --------
    >>> import fieldmon as fm
    >>> (line,) = stated_team([fm.TeamMember("Ann", fm.scout(), starts_s=5400.0)], time(6))
    >>> line.who, line.start, line.settings["hours"]
    ('scout', '07:30', 4.0)
    """
    return tuple(_stated(member, starts) for member in team)


def _stated(member: TeamMember, starts: time) -> StatedMember:
    robot = member.robot
    if robot.viewpoints != Robot().viewpoints:
        robot = replace(robot, viewpoints=Robot().viewpoints, detection=robot.detects)
    who = "scout" if robot.on_foot else "robot"
    told = {name: getattr(robot, name) for name in SAID_IN}
    settings = {name: float(value) for name, value in told.items() if value is not None}
    start_s = 3600 * starts.hour + 60 * starts.minute + starts.second + member.starts_s
    day, minute = divmod(start_s, 24 * 3600)[0], start_s % 60
    if day or minute or replace(usual_kind(who), **settings) != robot:  # type: ignore[arg-type]
        raise SettingError(
            worded(
                "A team's table cannot say all of {name}: it has no column for who need not be "
                "back in its hours, or does not start at a minute of the same day.",
                name=member.name,
            )
        )
    start = f"{int(start_s // 3600):02d}:{int(start_s // 60 % 60):02d}"
    return StatedMember(member.name, who, settings, start, member.gate, member.name)


def _told_at(one: StatedMember, make: Callable[..., _Made], *told: object) -> _Made:
    """Return what is made of a line of a table; what is wrong with it is said with file and line.

    Raises
    ------
    SettingError
        If it cannot be made.
    """
    try:
        return make(*told)
    except SettingError as error:
        problem = error.args[0]
        raise SettingError(
            worded("{where}: {problem}", where=one.where, problem=problem)
        ) from error
