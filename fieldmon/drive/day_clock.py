"""By which clock results of a day are timed: the plot's, or as they were planned."""

from __future__ import annotations

from datetime import date, datetime, time, timedelta
from typing import TYPE_CHECKING, Protocol

from fieldmon.monitoring.settings.shift_work import BEGINS_OTHERWISE_S
from fieldmon.pests.weather import DAY_S
from fieldmon.plot.local_clock import grid_clock, utc_now

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.monitoring.settings.shift_work import Besides
    from fieldmon.plot.local_clock import LocalClock

# a last result may be so much ahead of the clock: files hold whole seconds
_AHEAD_S = 2.0
_MIDNIGHT = datetime.combine(date(2000, 1, 1), time())


class TimedDay(Protocol):
    """A day of a season that is driven; its seconds count from one of the day, `begun_s`."""

    @property
    def on(self) -> date:
        """Return the day."""
        ...

    @property
    def begun_s(self) -> float:
        """Return the second of the day from which its seconds count."""
        ...

    @property
    def gone_s(self) -> float:
        """Return the seconds of it that are gone."""
        ...

    @property
    def left_s(self) -> float:
        """Return the seconds of its hours that are left."""
        ...

    def now_s(self) -> tuple[float, str]:
        """Return what `second_now` does."""
        ...

    def begin_at(self, now_s: float) -> None:
        """Begin now, or go on, seconds since the day's midnight."""
        ...


class TimingRobot(Protocol):
    """A robot that is driven live."""

    #: seconds of the day that are gone by the plot's clock; None: by the robot's own, or as planned
    clock: Callable[[], float] | None

    def is_faster(self) -> bool:
        """Wait until it is heard; tell whether its clock is another than that of the plot."""
        ...


def second_now(season: Season, on: date, who: str | Besides = "") -> tuple[float, str]:
    """Return the second of a day at the plot, and why it is none of the day's work.

    Past midnight it is 86 400 and more; "": results of now are of this day's work, see `until_s` of
    a season. `who` is that of `Season.plan`.
    """
    now, night = grid_clock(season.plot.grid).at(utc_now()), on - timedelta(days=1)
    now_s = (now - datetime.combine(on, time())).total_seconds()
    if 0 <= now_s < DAY_S:
        begins = season.settings.begins
        is_night = on > begins and now_s + DAY_S < season.work(night, who).until_s
        return now_s, f"the work of {night} is not over" if is_night else ""
    if DAY_S <= now_s < season.work(on, who).until_s:
        return now_s, ""
    return now_s, f"it is {now.date()} at the plot"


def time_of(second: float) -> time:
    """Return the time of a second of a day, which may be past its midnight.

    Examples
    --------
    >>> from fieldmon.drive.day_clock import time_of
    >>> str(time_of(88_200.0))
    '00:30:00'
    """
    return (_MIDNIGHT + timedelta(seconds=second % DAY_S)).time()


def time_results(day: TimedDay, clock: LocalClock, robot: TimingRobot | None = None) -> str:
    """Let results of a robot have the time at which they come, where they can.

    That is where it is live, by the clock, and driven on the day itself. What is said of it, in a
    sentence: whether times are planned ones, or the day begins otherwise than planned; or "".

    Parameters
    ----------
    day
        What is driven.
    clock
        The plot's.
    robot
        Who drives it live; None: it is simulated.
    """
    at_s = clock.second_after(day.on, day.begun_s, day.gone_s)
    why = "the robot is simulated" if robot is None else _why_planned(day, at_s, robot)
    if robot is None or why:
        return f"Results are timed from {time_of(at_s):%H:%M} as planned, as {why}."
    now_s, is_fresh = day.now_s()[0], not day.gone_s
    day.begin_at(now_s)
    gone_s, since = clock.seconds_between(day.on, day.begun_s, now_s), utc_now()
    robot.clock = lambda: gone_s + (utc_now() - since).total_seconds()
    if abs(now_s - at_s) <= BEGINS_OTHERWISE_S:
        return ""
    now = f"{time_of(now_s):%H:%M}"
    if is_fresh:
        return (
            f"The day was planned from {time_of(at_s):%H:%M} and begins at {now}: results get the "
            "times at which they come."
        )
    return (
        f"The day goes on at {now} after its last result, of {time_of(at_s):%H:%M}: the time "
        f"between counts as worked, and {day.left_s / 3600:.1f} h are left."
    )


def _why_planned(day: TimedDay, at_s: float, robot: TimingRobot) -> str:
    """Return why results cannot have the time at which they come; "": they can."""
    now_s, why = day.now_s()
    if why:
        return why
    if robot.is_faster():
        return "the robot says that its clock is faster"
    now_s, why = day.now_s()
    if not why and day.gone_s and now_s < at_s - _AHEAD_S:
        return f"the last result is later than now, {time_of(now_s):%H:%M}"
    return why
