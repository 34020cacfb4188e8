"""What each inspection was told to find of what is there: by what counted when it was made.

A day's inspections are read by what it was planned with last before they were recorded, or by what
counted when the day was first recorded. So another robot, look or team changes nothing of before.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.monitoring import inspection_lots, season_log, settings_log
from fieldmon.monitoring.pest_json import pest_of_json
from fieldmon.monitoring.settings import told_to_detect
from fieldmon.planning.members import person

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.settings_log import Parts

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


class ToldDetection(NamedTuple):
    """What inspections were told to find of what is there, from some moment on.

    Parameters
    ----------
    usual
        By whoever is in no team.
    of
        By those of a team, by `person`.
    """

    usual: float
    of: dict[str, float]

    @classmethod
    def in_parts(cls, parts: Parts, now: Parts) -> ToldDetection:
        """Return what some settings told; of a pest that was named only later, as it is seen."""
        pest = None
        if parts.get("pest", "null") != now.get("pest", "null"):
            pest = pest_of_json(json.loads(now.get("pest", "null")))
        members = json.loads(parts.get("team", "{}")).get("members", ())
        return cls(
            told_to_detect(json.loads(parts["robot"]), pest),
            {person(one["name"]): told_to_detect(one["robot"], pest) for one in members},
        )

    def by(self, who: NDArray[np.object_]) -> Floats:
        """Return it of inspections by these people, ``(k,)``."""
        if not self.of:
            return np.full(len(who), self.usual)
        known = {name: self.of.get(person(str(name)), self.usual) for name in set(who)}
        return np.array([known[name] for name in who], np.float64)


class _Changes(NamedTuple):
    """When it was told otherwise (UTC), and what; the first counts of all before, too."""

    since: list[str]
    told: list[ToldDetection]

    def at(self, moment: str) -> int:
        """Return which counted at a moment."""
        return max(bisect_right(self.since, moment) - 1, 0)


def told_detection(db: sqlite3.Connection, inspections: Inspections, begins: date) -> Floats:
    """Return what each inspection of a season was told to find of what is there, ``(k,)``."""
    changes = _changes(db)
    if len(changes.told) == 1:
        return changes.told[0].by(inspections.who)
    which = _which(db, inspections, begins, changes)
    told = np.empty(len(which))
    for k in set(which.tolist()):
        told[which == k] = changes.told[k].by(inspections.who[which == k])
    return told


def told_at_first(db: sqlite3.Connection) -> float:
    """Return what inspections were told to find when the season began."""
    return _changes(db).told[0].usual


def _changes(db: sqlite3.Connection) -> _Changes:
    now, changes = settings_log.now(db), _Changes([], [])
    for moment in settings_log.all_moments(db):
        told = ToldDetection.in_parts(settings_log.at(db, moment), now)
        if changes.told[-1:] != [told]:
            changes.since.append(moment)
            changes.told.append(told)
    return changes


def _which(
    db: sqlite3.Connection, inspections: Inspections, begins: date, changes: _Changes
) -> Ints:
    """Return which of the changes counted for each inspection."""
    said = season_log.planned_and_seen(db)
    dates, first = np.unique(inspections.date, return_index=True)
    which = np.zeros(len(inspections), np.int64)
    unclear: dict[int, tuple[slice, list[str], list[str]]] = {}
    ends = pairwise([*first.tolist(), len(inspections)])
    for on, (low, high) in zip(dates, ends, strict=True):
        planned, seen = _of(str(on), said)
        counted = {*_counted(seen, planned, min(seen, default=""), changes)}
        if len(counted) == 1:
            which[low:high] = counted.pop()
        else:
            number = int((on - np.datetime64(begins, "D")).astype(int))
            unclear[number] = slice(low, high), planned, seen
    for number, recorded in _recorded(db, unclear).items():
        rows, planned, seen = unclear[number]
        which[rows] = _counted(recorded, planned, min((*seen, *recorded)), changes)
    return which


def _of(on: str, said: Iterable[tuple[str, str, str, str]]) -> tuple[list[str], list[str]]:
    """Return when a day was planned, in order, and when it was recorded."""
    of_day = [(kind, at) for kind, at, low, high in said if low <= on <= high]
    planned, seen = ([at for kind, at in of_day if kind == one] for one in ("planned", "seen"))
    return sorted(planned), seen


def _counted(
    recorded: Iterable[str], planned: list[str], first: str, changes: _Changes
) -> list[int]:
    """Return which of the changes counted for what was recorded of a day at some moments.

    `planned` is when it was planned, `first` when anything was first recorded of it.
    """
    before = [bisect_right(planned, at) for at in recorded]
    return [changes.at(planned[k - 1] if k else first) for k in before]


def _recorded(db: sqlite3.Connection, days: Iterable[int]) -> dict[int, list[str]]:
    """Return when each inspection of some days that counts was recorded, in their order."""
    wanted = tuple(days)
    if not wanted:
        return {}
    rows = db.execute(
        "SELECT inspections.day, inspections.time, inspections.fid, batches.at FROM inspections "  # noqa: S608 - ours
        "LEFT JOIN batches ON batches.fid = inspections.batch "
        f"WHERE inspections.day IN ({', '.join('?' * len(wanted))}) "
        "AND inspections.undone = 0 AND inspections.digest IS NOT NULL",
        wanted,
    )
    in_order = sorted(
        (day, np.inf if time is None else inspection_lots.second_of(time), fid, at or "")
        for day, time, fid, at in rows
    )
    recorded: dict[int, list[str]] = {}
    for day, _, _, at in in_order:
        recorded.setdefault(day, []).append(at)
    return recorded
