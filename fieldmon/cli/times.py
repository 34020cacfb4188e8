"""Days and times of the day as they are written on the command line."""

from __future__ import annotations

from datetime import date, datetime, time

from fieldmon.errors import SettingError


def day(text: str | None, flag: str = "--date") -> date:
    """Return the day that is meant; today if none was told."""
    try:
        return date.today() if text is None else date.fromisoformat(text)  # noqa: DTZ011 - local
    except ValueError as error:
        raise SettingError(f"{flag} must be a day as YYYY-MM-DD, but it is {text!r}.") from error


def clock(text: str, flag: str = "--start") -> time:
    """Return the local time of the day that is meant."""
    try:
        return datetime.strptime(text, "%H:%M").time()  # noqa: DTZ007 - local time
    except ValueError as error:
        raise SettingError(f"{flag} must be a time as HH:MM, but it is {text!r}.") from error
