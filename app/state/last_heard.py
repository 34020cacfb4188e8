"""When phones and robots last asked something of a season, since the app was started.

What they sent is in the season's file; that they only asked is not worth a place there.
No Streamlit in here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.digest import digest
from fieldmon.plot.local_clock import utc_now

if TYPE_CHECKING:
    from datetime import date, datetime
    from pathlib import Path


class LastHeard(NamedTuple):
    """When somebody last asked anything; which day was asked for last, since when, by which plan.

    The plan is the one that the phone goes by, see `DayAhead.plan_of`.
    """

    at: datetime
    day: date | None = None
    since: datetime | None = None
    plan: int | None = None


# by file and name
_HEARD: dict[tuple[Path, str], LastHeard] = {}
# digests of keys that held, by file
_KEYS: set[tuple[Path, str]] = set()


def note(path: Path, name: str, day: date | None = None, plan: int | None = None) -> None:
    """Note that somebody asks something of a season now; `day`: for this day's route, `plan`."""
    now, before = utc_now(), _HEARD.get((path, name))
    if day is None and before is not None:
        noted = before._replace(at=now)
    elif day is None or before is None or (before.day, before.plan) != (day, plan):
        noted = LastHeard(now, day, None if day is None else now, plan)
    else:
        noted = before._replace(at=now)
    _HEARD[path, name] = noted


def last(path: Path, name: str) -> LastHeard | None:
    """Return when somebody was heard last; None: not since the app was started."""
    return _HEARD.get((path, name))


def note_key(path: Path, key: str) -> None:
    """Note that a key holds on a season."""
    _KEYS.add((path, digest(key)))


def knew_key(path: Path, key: str) -> bool:
    """Tell whether a key held on a season since the app was started."""
    return (path, digest(key)) in _KEYS
