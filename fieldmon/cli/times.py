"""Days and times of the day as they are written on the command line."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime, time
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.plot.field import Field


def day(text: str | None, flag: str = "--date") -> date | None:
    """Return the day that was told; None: none was."""
    try:
        return None if text is None else date.fromisoformat(text)
    except ValueError as error:
        raise SettingError(f"{flag} must be a day as YYYY-MM-DD, but it is {text!r}.") from error


def day_on(field: Field, told: date | None) -> date:
    """Return the day that was told; else today, in the time zone in which the plot lies."""
    from fieldmon.plot.local_clock import local_clock

    return local_clock(field).today() if told is None else told


@dataclass(frozen=True)
class WorkStart:
    """When work starts: on which day (None: today), and at which local time."""

    on: date | None
    at: time

    def on_plot(self, field: Field) -> datetime:
        """Return the local date and time at which the work on a plot starts."""
        return datetime.combine(day_on(field, self.on), self.at)


def clock(text: str, flag: str = "--start") -> time:
    """Return the local time of the day that is meant."""
    from fieldmon.compute.day_arguments import clock_of

    return clock_of(flag, text)
