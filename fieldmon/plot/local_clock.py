"""What time it is on a plot: in the time zone in which it lies, wherever the program runs."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, date, datetime, time
from typing import TYPE_CHECKING
from zoneinfo import ZoneInfo

if TYPE_CHECKING:
    from fieldmon.plot.field import Field


@dataclass(frozen=True)
class LocalClock:
    """The clock of a place; its times have no zone of their own.

    Parameters
    ----------
    zone
        Name of the time zone, as ``"Asia/Jerusalem"``; empty: this machine's, whichever it is.
    """

    zone: str = ""

    def at(self, moment: datetime) -> datetime:
        """Return the local time of a moment that names its zone."""
        zone = ZoneInfo(self.zone) if self.zone else None
        return moment.astimezone(zone).replace(tzinfo=None)

    def now(self) -> datetime:
        """Return the local time, to the second."""
        return self.at(utc_now()).replace(microsecond=0)

    def moment(self, on: date, at: time) -> datetime:
        """Return a local date and time as a moment that names its zone."""
        local = datetime.combine(on, at)
        return local.replace(tzinfo=ZoneInfo(self.zone)) if self.zone else local.astimezone()

    def today(self) -> date:
        """Return the local date."""
        return self.now().date()


def utc_now() -> datetime:
    """Return this moment."""
    return datetime.now(UTC)


def local_clock(field: Field) -> LocalClock:
    """Return the clock of a plot by its position; this machine's where no zone is known there.

    Zones are those of OpenStreetMap, simplified: right up to some hundred metres from a border.

    Examples
    --------
    >>> import fieldmon as fm
    >>> from fieldmon.plot.local_clock import local_clock
    >>> local_clock(fm.read_plot("sample_data/paran_estate.zip", feature="Gate").field)
    LocalClock(zone='Asia/Jerusalem')
    """
    from tzfpy import get_tz  # noqa: PLC0415 - the map of zones takes a tenth of a second

    west, south, east, north = field.boundary.bounds
    with suppress(KeyError, ValueError, OSError):
        name = get_tz((west + east) / 2, (south + north) / 2)
        return LocalClock(ZoneInfo(name).key)
    return LocalClock()
