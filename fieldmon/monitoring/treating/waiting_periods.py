"""When a treated place may be entered and harvested: never earlier than was entered.

A waiting period is counted twice, by elapsed time and by the clock on the wall, and the later end
counts; both are rounded up to what a person reads on a clock or a calendar. So neither summer time
nor a moved date line makes it shorter. Where the end of a treatment is not known it is the end of
its day, as GLOBALG.A.P. has it (IFA, Crops Base 7.3.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fieldmon.plot.local_clock import LocalClock

_DAY = timedelta(days=1)


@dataclass(frozen=True)
class WaitingPeriod:
    """What has to be waited for after a treatment of one place.

    Parameters
    ----------
    ended
        When the treatment ended; names its zone.
    days
        Whole days until harvest; None: nobody said.
    hours
        Hours until people may enter; None: nobody said.
    clock
        Of the place.
    """

    ended: datetime
    days: int | None
    hours: float | None
    clock: LocalClock

    @property
    def harvest_from(self) -> date | None:
        """Return the first whole day on which harvest is allowed; None: nobody said how long."""
        if self.days is None:
            return None
        wall = self.clock.at(self.ended) + self.days * _DAY
        ends = max(self.ended.astimezone(UTC) + self.days * _DAY, self.clock.latest(wall))
        local = self.clock.passed(ends)
        return local.date() if local.time() == time() else local.date() + _DAY

    @property
    def entry_from(self) -> datetime | None:
        """Return the local time from which on people may enter; None: nobody said how long."""
        if self.hours is None:
            return None
        wait = timedelta(hours=self.hours)
        ends = max(
            self.ended.astimezone(UTC) + wait, self.clock.latest(self.clock.at(self.ended) + wait)
        )
        return self.clock.passed(ends)


def end_of(clock: LocalClock, on: date, at: time | None) -> datetime:
    """Return the moment at which a treatment ended, from what was said of it in local time.

    `at` is None where only its day is known: then it is the end of that day.
    """
    local = datetime.combine(on, at) if at is not None else datetime.combine(on + _DAY, time())
    return clock.latest(local)
