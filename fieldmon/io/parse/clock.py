"""Times of day as people write them, and the zones they are in."""

from __future__ import annotations

import re
from contextlib import suppress
from datetime import UTC, datetime, timedelta, timezone, tzinfo
from typing import NamedTuple
from zoneinfo import ZoneInfo

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.parse.columns import plain

_CLOCK = re.compile(
    r"(?:^|[T\s,])(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,]\d+)?)?\s*([AaPp]\.?[Mm]\.?)?\s*"
    r"(Z|UTC|GMT|[-+]\d{2}(?::?\d{2})?)?$"
)
_SERIAL = re.compile(r"^\d{5}(\.\d+)?$")
_HOURS = frozenset({"hour", "hora", "heure", "ora", "שעה"})
_HOUR = re.compile(r"[01]?\d|2[0-3]")
_OFFSET = re.compile(r"^([-+])(\d{1,2}):?(\d{2})?$")
_FARTHEST_ZONE = timedelta(hours=14)


def zone_of(name: str) -> tzinfo:
    """Return a time zone by its name or its offset; raise `SettingError` where there is none."""
    offset = _OFFSET.match(name.strip())
    if offset:
        sign, hours, minutes = offset.groups()
        ahead = timedelta(hours=int(hours), minutes=int(minutes or 0))
        if ahead <= _FARTHEST_ZONE:
            return timezone(-ahead if sign == "-" else ahead)
    else:
        with suppress(KeyError, ValueError, OSError):
            return ZoneInfo(name.strip())
    raise SettingError(
        worded(
            "A time zone must be named as Asia/Jerusalem or +02:00, but it is {name!r}.", name=name
        )
    )


#: 24:00, in seconds since midnight
DAY_END_S = 86_400


class ClockTime(NamedTuple):
    """A time of day: seconds since midnight, and how far ahead of UTC its zone is if it says.

    24:00 is the midnight at the end of a day.
    """

    seconds: int
    offset: timedelta | None


def clock_time(cell: str) -> ClockTime | None:
    """Return the time of day that a cell holds beside its date, and its zone if it names one."""
    if _SERIAL.match(cell) and "." in cell:
        return ClockTime(round(float(cell) % 1 * 86_400), None)
    found = _CLOCK.search(cell)
    if not found:
        return None
    hour, minute, second = (int(part or 0) for part in found.groups()[:3])
    half = (found.group(4) or "").replace(".", "").casefold()
    hour = hour % 12 + 12 * (half == "pm") if half else hour
    if minute > 59 or second > 60 or hour > 24 - bool(half or minute or second):
        return None
    zone = found.group(5)
    if zone is None:
        return ClockTime(3600 * hour + 60 * minute + second, None)
    try:
        ahead = (zone_of(zone) if zone[0] in "+-" else UTC).utcoffset(None)
    except SettingError:
        return None
    return ClockTime(3600 * hour + 60 * minute + second, ahead)


def as_clocks(name: str, cells: list[str]) -> list[str]:
    """Return the cells of a column of times; whole hours of one called so become times of day."""
    if plain(name) not in _HOURS:
        return cells
    return [f"{cell}:00" if _HOUR.fullmatch(cell) else cell for cell in cells]


def without_midnights(cells: list[str]) -> list[str]:
    """Return the cells of a column of times, midnights as days alone where `are_days` says so.

    Programs store a day as its midnight, here or in UTC.
    """
    clocks = {cell: clock for cell in set(cells) if (clock := clock_time(cell)) is not None}
    timed = [cell for cell in cells if cell in clocks]
    n_midnights = sum(clocks[cell].seconds == 0 for cell in timed)
    if n_midnights < len(timed):  # a clock beside a day's own column is what somebody wrote
        timed = [cell for cell in timed if not is_clock_alone(cell)]
        n_midnights = sum(clocks[cell].seconds == 0 for cell in timed)
    if not are_days(n_midnights, len(timed)):
        return cells
    days = {cell: _day_alone(cell) for cell in timed if clocks[cell].seconds == 0}
    return [days.get(cell, cell) for cell in cells]


def n_midnights_left_out(cells: list[str], without: list[str]) -> int:
    """Return how many midnights `without_midnights` left out beside times; 0: there were none."""
    if not any(clock_time(cell) for cell in set(without)):
        return 0
    return sum(was != now for was, now in zip(cells, without, strict=True))


def are_days(n_midnights: int, n_times: int) -> bool:
    """Return whether the midnights among the times of a column are days without a time.

    They are where all times are midnight, or half of them and at least two. Fewer are times.
    """
    return n_midnights == n_times or (n_midnights >= 2 and 2 * n_midnights >= n_times)


def _day_alone(cell: str) -> str:
    """Return what stands before the clock in a cell."""
    if (found := _CLOCK.search(cell)) is not None:
        return cell[: found.start()]
    return cell.partition(".")[0]


def local_time(day: np.datetime64, clock: ClockTime, zone: tzinfo | None) -> np.datetime64:
    """Return the local time, datetime64[s], of a time of day on a day; in `zone` if it is told."""
    here = day.astype("datetime64[s]") + np.timedelta64(clock.seconds, "s")
    if clock.offset is None or zone is None:
        return np.datetime64(here, "s")
    stated = here.astype(datetime).replace(tzinfo=timezone(clock.offset))
    return np.datetime64(stated.astimezone(zone).replace(tzinfo=None), "s")


def is_skipped(when: np.datetime64, zone: tzinfo) -> bool:
    """Return whether no clock of a zone ever shows a local time: clocks are put forward then."""
    here = when.astype("datetime64[s]").astype(datetime)
    there = here.replace(tzinfo=zone).astimezone(UTC).astimezone(zone)
    return bool(there.replace(tzinfo=None) != here)


def is_clock_alone(cell: str) -> bool:
    """Return whether a cell holds a time of day and no date, or nothing."""
    found = _CLOCK.search(cell)
    return not cell or (found is not None and found.start() == 0)
