"""One day on the plots of an estate that are due: who works where and when, and what is closed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted, worded
from fieldmon.monitoring.days.kept_wishes import wishes_kept
from fieldmon.monitoring.treating.closures import closed_plants, open_to_people
from fieldmon.planning.plan import plan_in
from fieldmon.planning.shared_day import MOVE_S, PlotNeed, share_day
from fieldmon.planning.wishes import Wishes
from fieldmon.plot.local_clock import grid_clock

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.treating.closures import Closure
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.shared_day import PlotTurn
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler, Scene

#: a plot is due so many days after it was seen
DUE_DAYS = 3
# share of a day's work with which a plot is seen (our choice)
_SEEN = 0.5


@dataclass(frozen=True, eq=False)
class EstatePlot:
    """A plot that shares the day with others.

    Parameters
    ----------
    on
        Its day.
    scene
        What is believed of it then, before anybody works there; nothing is closed in it. What is
        not wanted on that day seems inspected.
    decides
        Who decides which plants come next.
    season
        It tells what is closed to people; None: nothing is.
    """

    on: date
    scene: Scene
    decides: Sampler
    season: Season | None = None

    @classmethod
    def of(cls, season: Season, on: date) -> EstatePlot:
        """Return the plot of a season, as its day begins."""
        with season.entering_treated():
            unwanted = wishes_kept(season, on).unwanted
            scene = Wishes(unwanted=unwanted).applied_to(season.scene(on))
        return cls(on, scene, season.settings.decides(), season)

    def closed(self, begins: datetime, ends: datetime) -> tuple[Closure, ...]:
        """Return what is closed to work between two local times of its day."""
        if self.season is None:
            return ()
        midnight = datetime.combine(self.on, time())
        begins_s, ends_s = ((one - midnight).total_seconds() for one in (begins, ends))
        return self.season.closed(self.on, between=(begins_s, ends_s))


@dataclass(frozen=True, eq=False)
class EstateTurn:
    """One works on one plot.

    Parameters
    ----------
    plot, who
        Numbers of the plot and of the member, from 0.
    begins
        Local time.
    scene
        The plot as it then is for them: with their hours, and without what is closed.
    decides
        Who decides which plants come next.
    closed
        What is closed to people in those hours.
    """

    plot: int
    who: int
    begins: datetime
    scene: Scene
    decides: Sampler
    closed: tuple[Closure, ...] = ()

    def plan(self) -> DayPlan:
        """Return the day's plan of these hours."""
        return plan_in(self.scene, self.decides)


@dataclass(frozen=True, eq=False)
class SharedEstate:
    """Who works where, in the order of the members.

    Parameters
    ----------
    turns
        A plot is among them once or, as it waits or is closed, not at all.
    closed
        Of each plot that does not wait, what is closed to people and so left off.
    waiting
        Numbers of the plots for which there is no time, though people may be there.
    """

    turns: tuple[EstateTurn, ...]
    closed: tuple[tuple[Closure, ...], ...]
    waiting: tuple[int, ...]


def days_since(season: Season, on: date) -> int | None:
    """Return how many days before a day a season's plot was last seen; None: never.

    It was on a day of which half of the kept plan was done, half of the hours are gone as its plan
    reckons them, or half of the plants were inspected. Any other had only begun.
    """
    dates = season.inspections.date
    for day in np.unique(dates[dates <= np.datetime64(on)])[::-1].tolist():
        if _was_seen(season, day):
            return int((on - day).days)
    return None


def _was_seen(season: Season, on: date) -> bool:
    kept = season.planned_and_done(on)
    if kept is not None and kept.planned and kept.done >= kept.planned * _SEEN:
        return True
    plants = np.unique(season.inspections.on(on).plant)
    if len(plants) >= len(season.plot.grid) * _SEEN:
        return True
    settings = season.planned_by(on)
    hours_s = sum(one.day_s for one in _robots(settings))
    left_s = sum(season.work(on, who).left_s() for who in _names(settings))
    return hours_s - left_s >= hours_s * _SEEN


def _names(settings: MonitoringSettings) -> list[str]:
    return [one.name for one in settings.team] or [""]


def _robots(settings: MonitoringSettings) -> list[Robot]:
    return [one.robot for one in settings.team] or [settings.robot]


def robots_of(season: Season) -> list[Robot]:
    """Return the robots with which a season works: each of its team, or its only one."""
    return _robots(season.settings)


def one_robot(seasons: Iterable[Season]) -> Robot | None:
    """Return the robot with which all of these seasons work; None: they have several, or none.

    Hours are not compared: they are those of the first.
    """
    robots = [robot for season in seasons for robot in robots_of(season)]
    kinds = {replace(robot, hours=1.0) for robot in robots}
    return robots[0] if len(kinds) == 1 else None


def not_begun(begins: date, on: date) -> Worded | None:
    """Return why a season that begins after a day is left out of it; None: it has begun.

    Examples
    --------
    >>> from datetime import date
    >>> from fieldmon.monitoring.days.estate_day import not_begun
    >>> not_begun(date(2026, 12, 1), date(2026, 11, 30))
    'begins on 2026-12-01'
    >>> not_begun(date(2026, 12, 1), date(2026, 12, 1)) is None
    True
    """
    return worded("begins on {day}", day=begins) if on < begins else None


def due(days_since: Sequence[int | None]) -> list[int]:
    """Return the numbers of the plots that are due, from how long ago each was seen; None: never.

    Examples
    --------
    >>> due([0, 2, 3, None]), due([0, 2])
    ([2, 3], [])
    """
    return [k for k, days in enumerate(days_since) if days is None or days >= DUE_DAYS]


def not_due(days_since: int) -> Worded:
    """Return why a plot that was seen so many days ago is left out of a day.

    Examples
    --------
    >>> not_due(0), not_due(1)
    ('inspected today, not due', 'inspected 1 day ago, not due')
    """
    if days_since == 0:
        return worded("inspected today, not due")
    return worded("inspected {days} ago, not due", days=counted(days_since, "day"))


def share_estate(
    plots: Sequence[EstatePlot],
    members: Sequence[TeamMember],
    starts: time,
    move_s: float = MOVE_S,
) -> SharedEstate:
    """Share a day between plots by what is expected where people may be, see `share_day`.

    What is closed to people in the hours of a plot calls for none: they are shared anew without
    it, until nothing more is closed.

    Parameters
    ----------
    plots
        Those that are due.
    members
        Who works; of each, the hours and the start count, not the gate.
    starts
        When their day does.
    move_s
        What going from one plot to the next takes.
    """
    day_s = max((one.starts_s + one.robot.day_s for one in members), default=0.0)
    closed = [_all_day(plot, starts, day_s) for plot in plots]
    while True:
        is_open = [
            (one.scene.last_inspected != one.scene.day)
            & ~closed_plants(known, len(one.scene.chance))
            for one, known in zip(plots, closed, strict=True)
        ]
        needs = [_need(one.scene, free, members) for one, free in zip(plots, is_open, strict=True)]
        turns = [
            _turn(plots[one.plot], one, members[one.who], starts)
            for one in share_day(needs, members, move_s)
        ]
        more = [one for one in turns if (_closed(one) & is_open[one.plot]).any()]
        if not more:
            break
        for one in more:
            closed[one.plot] += one.closed
    for one in turns:  # what closes other hours is none of theirs
        closed[one.plot] = one.closed
    without = {*range(len(plots))} - {one.plot for one in turns}
    waiting = [k for k in sorted(without) if is_open[k].any() or not closed[k]]
    for k in waiting:
        closed[k] = ()
    return SharedEstate(tuple(turns), tuple(closed), tuple(waiting))


def _all_day(plot: EstatePlot, starts: time, day_s: float) -> tuple[Closure, ...]:
    """Return what is closed when the day starts, and until it is over."""
    begins = datetime.combine(plot.on, starts)
    ends = begins + timedelta(seconds=day_s)
    return tuple(one for one in plot.closed(begins, begins) if one.until >= ends)


def _need(scene: Scene, is_open: NDArray[np.bool_], members: Sequence[TeamMember]) -> PlotNeed:
    """Return what calls for work: about how long all that is open takes, for the slowest."""
    grid, n = scene.grid, int(np.count_nonzero(is_open))
    rows = np.unique(grid.row[is_open])
    lanes_m = float(np.ptp(grid.lane_x_m[rows], axis=1).sum())
    most_s = max(
        (
            n * one.robot.visit_s
            + lanes_m / one.robot.speed_m_s
            + len(rows) * one.robot.row_change_s
            for one in members
        ),
        default=0.0,
    )
    return PlotNeed(float(scene.chance[is_open].sum()), most_s)


def _turn(plot: EstatePlot, turn: PlotTurn, member: TeamMember, starts: time) -> EstateTurn:
    # to the second, so that the same turn is planned once
    robot = replace(member.robot, hours=max(round(turn.seconds), 1) / 3600)
    after_s = round(member.starts_s + turn.starts_s)
    own = datetime.combine(plot.on, starts) + timedelta(seconds=member.starts_s)
    clock = grid_clock(plot.scene.grid)
    begins = clock.after(own, after_s - member.starts_s)
    closed = plot.closed(begins, clock.after(begins, robot.day_s))
    scene = replace(open_to_people(plot.scene, closed), robot=robot, seconds_left=robot.day_s)
    return EstateTurn(turn.plot, turn.who, begins, scene, plot.decides, closed)


def _closed(turn: EstateTurn) -> NDArray[np.bool_]:
    return closed_plants(turn.closed, len(turn.scene.chance))
