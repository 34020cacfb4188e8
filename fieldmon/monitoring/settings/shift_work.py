"""The work of a shift, day by day: when it began, what was inspected in it, how much of it is gone.

Work that goes past midnight is that of the day on which it began.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import timedelta
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.inspections import SKIPPED
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.pests.weather import DAY_S
from fieldmon.planning.members import person_key
from fieldmon.plot.travel import driven_s, robot_clock
from fieldmon.samplers.base import resting_place

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.day_arguments import TimeOfDay
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.local_clock import LocalClock
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

#: who begins later than this after the day's start, or sooner before it, has hours of their own
BEGINS_OTHERWISE_S = 300.0
# who begins no sooner than this before a day's start works on that day
_BEGINS_EARLY_S = 3600.0
# of each plot the ways from other gates: to find them takes long
_FROM_GATES: WeakKeyDictionary[Plot, dict[tuple[float, float], Aisles]] = WeakKeyDictionary()


class Besides(NamedTuple):
    """Whoever works beside some others: what is not theirs is of this one.

    Parameters
    ----------
    others
        Their names.
    """

    others: tuple[str, ...]


class ScoutCrew(NamedTuple):
    """Scouts who are no team's, and share the same plants on a day.

    Parameters
    ----------
    names
        Their names.
    left_s
        The seconds left of their hours, of those who said so themselves.
    kept_as
        The names by which their routes are kept; None: their own.
    """

    names: tuple[str, ...]
    left_s: dict[str, float] | None = None
    kept_as: tuple[str, ...] | None = None


@dataclass(frozen=True, eq=False)
class Shift:
    """Who works on a plot, and from when on.

    Parameters
    ----------
    aisles
        The plot: plants and the ways between them.
    robot
        Who inspects.
    starts_s
        Seconds since midnight at which the work starts.
    streams
        For samplers that draw.
    """

    aisles: Aisles
    robot: Robot
    starts_s: float = 6 * 3600.0
    streams: RandomStreams = RandomStreams(1)  # noqa: RUF009 - a seed, not a call with effects

    def charged_s(self, plants: NDArray[np.int32], resting: int) -> float:
        """Return what driving to plants in turn, from where it rests, and inspecting them costs."""
        robot = self.aisles.worked_by(self.robot)
        clock = robot_clock(robot, robot.day_s)
        travel = self.aisles.for_robot(robot).travel
        drive_s = driven_s(travel, clock, np.append(np.int64(resting), plants))
        return drive_s + robot.visit_s * len(plants)


@dataclass(frozen=True, eq=False)
class ShiftWork:
    """What was inspected in somebody's shift, day by day.

    Parameters
    ----------
    shift
        Who works, where, and from when on.
    who
        Whose inspections are theirs, of a team or beside others; None: everybody's.
    begins, clock
        The first day, from which days are counted, from 0; and the plot's clock.
    inspections, days
        What was inspected by anybody in the order of its days, and the number of the day of each,
        ``(k,)``.
    """

    shift: Shift
    who: str | Besides | None
    begins: date
    clock: LocalClock
    inspections: Inspections
    days: NDArray[np.int32]

    def own(self, day: int) -> Inspections:
        """Return what they inspected from when the work of a day began until it ends.

        Inspections after midnight are dated the next day; here their seconds go on from 86 400.
        """
        rows = (self._work_days == day) & self._is_own
        done, late = self.inspections.take(rows), self.days[rows] > day
        return replace(done, second=done.second + np.where(late, DAY_S, 0.0))

    def past_midnight(self, day: int) -> NDArray[np.signedinteger]:
        """Return which inspections of the next day were made in the hours of a day's work."""
        return np.flatnonzero((self._work_days == day) & (self.days > day))

    def trail(self, day: int) -> NDArray[np.int32]:
        """Return the plants ``(k,)`` of their last work before `day` that had any."""
        return self._last_worked(self._work_days, day)

    def resting(self, day: int) -> int:
        """Return where the work of a day begins."""
        return resting_place(self.shift.robot, self.trail(day))

    def begun_s(self, day: int) -> float:
        """Return the second of a day at which their work began.

        It is the shift's, unless the first inspection shows that it was more than
        `BEGINS_OTHERWISE_S` off: then it began with the way to that one.
        """
        return self._begun_s(self.own(day), self.resting(day))

    def until_s(self, day: int) -> float:
        """Return until which second of a day what they inspect is of its work; see `begun_s`.

        Past midnight it is 86 400 and more.
        """
        return self._ends_s(day, self.begun_s(day)) + DAY_S

    def gone_s(self, day: int, now_s: float | None = None) -> float:
        """Return how many seconds of their working day are gone.

        `now_s` are seconds since midnight, of the next day where work goes past it and had not
        begun then; None: when the last inspection recorded was done, by its own time or, where none
        was noted, by what driving and looking cost.
        """
        today, resting = self.own(day), self.resting(day)
        if now_s is None and len(today) and np.isfinite(today.second[-1]):
            now_s = float(today.second[-1])
        if now_s is None:
            return self.shift.charged_s(today.plant, resting) if len(today) else 0.0
        begun_s = self._begun_s(today, resting)
        if now_s < min(begun_s, self._ends_s(day, begun_s)):  # past midnight
            now_s += DAY_S
        return max(0.0, self.clock.seconds_between(self._date_of(day), begun_s, now_s))

    def _begun_s(self, today: Inspections, resting: int) -> float:
        """Return the second of the day at which inspections of one day, in their order, began."""
        starts_s = self.shift.starts_s
        if not len(today) or not np.isfinite(today.second[0]):
            return starts_s
        way_s = self.shift.charged_s(today.plant[:1], resting)
        begun_s = max(0.0, float(today.second[0]) - way_s)
        return begun_s if abs(begun_s - starts_s) > BEGINS_OTHERWISE_S else starts_s

    def _ends_s(self, day: int, begun_s: float) -> float:
        """Return the second of the next day at which work's hours end or the next work begins."""
        hours_s = self.shift.robot.day_s + BEGINS_OTHERWISE_S
        ends_s = self.clock.second_after(self._date_of(day), begun_s, hours_s)
        return min(ends_s - DAY_S, self.shift.starts_s - BEGINS_OTHERWISE_S)

    def _date_of(self, day: int) -> date:
        return self.begins + timedelta(days=day)

    @cached_property
    def _is_own(self) -> NDArray[np.bool_]:
        return _are_by(self.inspections, self.who)

    @cached_property
    def _work_days(self) -> NDArray[np.int32]:
        """The day on which the work began in whose hours each inspection was made, ``(k,)``.

        That is its own day, or the one before where their work went past midnight: until an hour
        before their next work begins.
        """
        starts_s, seconds = self.shift.starts_s, self.inspections.second
        nights = np.unique(self.days[seconds < starts_s - BEGINS_OTHERWISE_S]) - 1
        work = self.days.copy()
        for day in nights[nights >= 0].tolist():
            mine = np.arange(*np.searchsorted(self.days, [day, day + 1]))
            mine = mine[self._is_own[mine] & (work[mine] == day)]
            early = np.arange(*np.searchsorted(self.days, [day + 1, day + 2]))
            # work begins when its first inspection is made, at the latest
            latest_s = np.fmax(starts_s, seconds[mine[:1]].sum())
            if not (seconds[early] < self._ends_s(day, latest_s)).any():
                continue
            resting = resting_place(self.shift.robot, self._last_worked(work, day))
            begun_s = self._begun_s(self.inspections.take(mine[:1]), resting)
            if (seconds[early] < self._ends_s(day, begun_s)).any():
                # it went past midnight, and may run over: until the next is about to begin
                work[early[seconds[early] < starts_s - _BEGINS_EARLY_S]] = day
        return work

    def _last_worked(self, work: NDArray[np.int32], day: int) -> NDArray[np.int32]:
        """Return the plants of their last `work` before a day, where skipping plants is none."""
        earlier = self._is_own & (self.inspections.result != SKIPPED) & (work < day)
        last = work[earlier].max(initial=-1)
        plants: NDArray[np.int32] = self.inspections.plant[earlier & (work == last)]
        return plants


@checked
@dataclass(frozen=True, eq=False)
class DayWork:
    """Somebody's work of one day, as far as it was recorded; see `Season.work`.

    Work that goes past midnight is that of the day on which it began.

    Parameters
    ----------
    shifts
        Their work of all days.
    day
        Number of the day, from 0.
    is_earlier
        Whether the day goes by what counted then, see `Season.planned_by`.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> season = fm.Season.create("of_work.gpkg", plot, begins="2026-11-18")
    >>> work = season.work("2026-11-18")
    >>> work.begun_s / 3600, work.left_s() / 3600, len(work.inspections)
    (6.0, 12.0, 0)
    """

    shifts: ShiftWork
    day: int
    is_earlier: bool

    @property
    def begun_s(self) -> float:
        """Return the second of the day at which it began, or will.

        That is as the settings say, unless the first inspection was made minutes before or after.
        """
        return self.shifts.begun_s(self.day)

    @property
    def until_s(self) -> float:
        """Return until which second of the day results are of this work.

        Past midnight it is 86 400 and more.
        """
        return self.shifts.until_s(self.day)

    @property
    def inspections(self) -> Inspections:
        """Return what was inspected in it.

        Also past midnight, where inspections are dated the next day: seconds go on from 86 400.
        """
        return self.shifts.own(self.day)

    def left_s(self, now: TimeOfDay | None = None) -> float:
        """Return the seconds left of the hours at a local time; None: after the last inspection."""
        gone_s = self.shifts.gone_s(self.day, None if now is None else seconds(now))
        return max(0.0, self.shifts.shift.robot.day_s - gone_s)


def shift_of(
    plot: Plot, settings: MonitoringSettings, who: str | Besides
) -> tuple[Shift, str | Besides | None]:
    """Return how somebody works, and whose inspections are theirs; None: everybody's."""
    starts_s, streams = seconds(settings.starts), RandomStreams(settings.seed)
    member = settings.at_work(who) if isinstance(who, str) else None
    if member is None:
        return Shift(plot.aisles, settings.robot, starts_s, streams), who or None
    aisles, starts_s = aisles_from(plot, member.gate), starts_s + member.starts_s
    return Shift(aisles, member.robot, starts_s, streams), member.name


def aisles_from(plot: Plot, gate: tuple[float, float] | None) -> Aisles:
    """Return the ways on a plot with another gate; None: its own."""
    if gate is None:
        return plot.aisles
    known = _FROM_GATES.setdefault(plot, {})
    gate = (gate[0], gate[1])  # a list is none that can be remembered
    if gate not in known:
        known[gate] = plot.with_gate(gate).aisles
    return known[gate]


def made_by(inspections: Inspections, who: str | Besides | None) -> Inspections:
    """Return those that somebody made; None: all."""
    return inspections if who is None else inspections.take(_are_by(inspections, who))


def _are_by(inspections: Inspections, who: str | Besides | None) -> NDArray[np.bool_]:
    """Return ``(k,)`` whether somebody made each; None: all."""
    if who is None:
        return np.ones(len(inspections), np.bool_)
    names = np.array([person_key(str(name)) for name in inspections.who], np.str_)
    if isinstance(who, Besides):
        return ~np.isin(names, [person_key(one) for one in who.others])
    mine: NDArray[np.bool_] = names == person_key(who)
    return mine
