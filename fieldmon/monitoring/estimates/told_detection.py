"""What each inspection was told to find of what is there: as was said with it, or as it was made.

What a route's file or a phone says of it holds. Where nothing is said, a day's inspections are read
by what it was planned with last before they were recorded, or by what counted when the day was
first recorded. So another robot, look or team changes nothing of before. What is planned again of
an earlier day is planned by what counted then, and the log says so.

A pest that is named later, and says itself how it is seen, was looked for from the first day on:
then what was said before it is not held to.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import chance_figure, worded
from fieldmon.infestation.inspections import SKIPPED
from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.inspecting import inspection_lots
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.pest_json import pest_of_json
from fieldmon.monitoring.settings.settings import told_to_detect
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.changes.logged_days import PlannedOrSeen
    from fieldmon.monitoring.settings.settings_log import Parts
    from fieldmon.pests.pest import Pest

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

# files round what they say
_SAME = 1e-6


class ToldDetection(NamedTuple):
    """What inspections were told to find of what is there, from some moment on.

    Parameters
    ----------
    usual
        By whoever is in no team.
    of
        By those of a team, by `person_key`.
    """

    usual: float
    of: dict[str, float]

    @classmethod
    def in_parts(cls, parts: Parts, now: Parts) -> ToldDetection:
        """Return what some settings told; of a pest that was named only later, as it is seen."""
        pest = _named_later(parts, now)
        members = json.loads(parts.get("team", "{}")).get("members", ())
        return cls(
            told_to_detect(json.loads(parts["robot"]), pest),
            {person_key(one["name"]): told_to_detect(one["robot"], pest) for one in members},
        )

    def by(self, who: NDArray[np.object_]) -> Floats:
        """Return it of inspections by these people, ``(k,)``."""
        if not self.of:
            return np.full(len(who), self.usual)
        known = {name: self.of.get(person_key(str(name)), self.usual) for name in set(who)}
        return np.array([known[name] for name in who], np.float64)


class ToldOtherwise(NamedTuple):
    """Inspections with which another chance to see what is there was said than the season's own.

    None of plants that could not be inspected.

    Parameters
    ----------
    who
        Who made them; "" where nobody is named.
    detects
        What was said.
    own
        What the season itself would have read them by.
    first, last
        Their days.
    n
        How many they are.
    """

    who: str
    detects: float
    own: float
    first: date
    last: date
    n: int

    def sentence(self) -> Worded:
        """Return in words whose inspections they are, what was said with them, and the own."""
        days = worded("{first} to {last}", first=self.first, last=self.last)
        return worded(
            "{who}, {on}: {n} {n:inspection finds|inspections find} {detects} of what is there, as "
            "was said with {n:it|them}; the season's own is {own}.",
            who=self.who or worded("nobody named"),
            on=days if self.first < self.last else self.first,
            n=self.n, detects=chance_figure(self.detects), own=chance_figure(self.own),
        )  # fmt: skip


def _named_later(parts: Parts, now: Parts) -> Pest | None:
    """Return the pest that is looked for now, if it was not named yet in some settings."""
    if parts.get("pest", "null") == now.get("pest", "null"):
        return None
    return pest_of_json(json.loads(now.get("pest", "null")))


class _Told(NamedTuple):
    """All that was ever told, and which of it counted since when.

    And whether a pest was named only later that says itself how it is seen.
    """

    since: list[str]
    which: list[int]
    all: list[ToldDetection]
    before_pest: list[bool]

    def add(self, told: ToldDetection) -> int:
        """Return which it is."""
        if told not in self.all:
            self.all.append(told)
        return self.all.index(told)

    def at(self, moment: str) -> int:
        """Return which counted at a moment (UTC); before the first, the first."""
        return self.which[self._last(moment)]

    def is_before_pest(self, moment: str) -> bool:
        """Return whether the pest of now was named only after a moment."""
        return self.before_pest[self._last(moment)]

    def _last(self, moment: str) -> int:
        # a clock may be set back, as in `settings_log.at`
        last = (k for k in reversed(range(len(self.since))) if self.since[k] <= moment)
        return next(last, 0)


class _OfDay(NamedTuple):
    """When a day was planned, in order, and which of what was told that was by.

    And when it was recorded, and by which it was at first.
    """

    planned: list[str]
    by: list[int]
    seen: list[str]
    first: int | None

    def counted(self, recorded: Iterable[str], told: _Told) -> list[int]:
        """Return which counted for what was recorded of it at some moments."""
        if (first := self.first) is None:
            first = told.at(min(recorded, default=""))
        before = [bisect_right(self.planned, at) for at in recorded]
        return [self.by[k - 1] if k else first for k in before]


def told_detection(db: sqlite3.Connection, inspections: Inspections, begins: date) -> Floats:
    """Return what each inspection of a season was told to find of what is there, ``(k,)``."""
    told = _told(db)
    return _held(db, inspections, begins, (told, _own(db, inspections, begins, told)))


def _held(
    db: sqlite3.Connection, inspections: Inspections, begins: date, read: tuple[_Told, Floats]
) -> Floats:
    """Return the same by all that was told, and by what a season reads them of itself, ``(k,)``."""
    told, own = read
    said = _said_otherwise(inspections, own)
    if len(said) and any(told.before_pest):
        recorded = _moments(db, inspections, begins, said)
        said = said[[not told.is_before_pest(at) for at in recorded]]
    if not len(said):
        return own
    held = own.copy()
    held[said] = inspections.detects[said]
    return held


def other_detections(
    db: sqlite3.Connection, inspections: Inspections, begins: date
) -> tuple[ToldOtherwise, ...]:
    """Return which inspections are read by what was said with them, and not by the season's own."""
    if np.isnan(inspections.detects).all():
        return ()
    told = _told(db)
    own = _own(db, inspections, begins, told)
    held = _held(db, inspections, begins, (told, own))
    apart = (held != own) & (inspections.result != SKIPPED)
    done, held, own = inspections.take(apart), held[apart], own[apart]
    people = {name: person_key(name) for name in dict.fromkeys(done.who.tolist())}
    numbers = {person: k for k, person in enumerate(dict.fromkeys(people.values()))}
    person = [numbers[people[name]] for name in done.who]
    _, first, group, n = np.unique(
        np.stack([person, held, own], axis=1), axis=0,
        return_index=True, return_inverse=True, return_counts=True,
    )  # fmt: skip
    last = np.zeros(len(first), np.int64)
    last[group.ravel()] = np.arange(len(done))  # they are by day
    return tuple(
        ToldOtherwise(
            str(done.who[first[k]]),
            float(held[first[k]]),
            float(own[first[k]]),
            done.date[first[k]].item(),
            done.date[last[k]].item(),
            int(n[k]),
        )
        for k in np.argsort(first).tolist()
    )


def said_now(db: sqlite3.Connection, inspections: Inspections, who: str) -> list[float]:
    """Return what is said with inspections that are recorded now, other than the season's own.

    They are by `who` where they name nobody.
    """
    if np.isnan(inspections.detects).all():
        return []
    named = np.where(inspections.who == "", who, inspections.who).astype(object)
    told = _told(db)
    own = told.all[0].by(named)
    if len(told.all) > 1:
        said = _said(db, told)
        for on in np.unique(inspections.date):
            of_day = inspections.date == on
            own[of_day] = _now_of(str(on), said, told).by(named[of_day])
    found: list[float] = np.unique(inspections.detects[_said_otherwise(inspections, own)]).tolist()
    return found


def read_now(db: sqlite3.Connection, on: date, who: str) -> float:
    """Return by what a season reads what somebody inspects on a day and is recorded now."""
    told = _told(db)
    of_day = told.all[0] if len(told.all) == 1 else _now_of(str(on), _said(db, told), told)
    return of_day.of.get(person_key(who), of_day.usual)


def _now_of(on: str, said: Iterable[tuple[PlannedOrSeen, int]], told: _Told) -> ToldDetection:
    """Return what is told of inspections of a day that are recorded now."""
    (which,) = _told_of(on, said).counted([utc_text()], told)
    return told.all[which]


def _said_otherwise(inspections: Inspections, own: Floats) -> NDArray[np.intp]:
    """Return with which inspections another chance is said than the season's own ``(k,)``."""
    if np.isnan(inspections.detects).all():
        return np.empty(0, np.intp)
    return np.flatnonzero(np.abs(inspections.detects - own) > _SAME)


def _moments(
    db: sqlite3.Connection, inspections: Inspections, begins: date, which: NDArray[np.intp]
) -> list[str]:
    """Return when some inspections of a season were recorded (UTC)."""
    days = (inspections.date - np.datetime64(begins, "D")).astype(np.int64)
    first = {day: int(np.searchsorted(days, day)) for day in set(days[which].tolist())}
    recorded = _recorded(db, first)
    return [recorded[day][k - first[day]] for k, day in zip(which, days[which], strict=True)]


def _own(db: sqlite3.Connection, inspections: Inspections, begins: date, told: _Told) -> Floats:
    """Return by what a season reads inspections where nothing was said with them, ``(k,)``."""
    if len(told.all) == 1:
        return told.all[0].by(inspections.who)
    which = _which(db, inspections, begins, told)
    found = np.empty(len(which))
    for k in set(which.tolist()):
        found[which == k] = told.all[k].by(inspections.who[which == k])
    return found


def told_at_first(db: sqlite3.Connection) -> float:
    """Return what inspections were told to find when the season began."""
    return _told(db).all[0].usual


def _told(db: sqlite3.Connection) -> _Told:
    now, told = settings_log.now(db), _Told([], [], [], [])
    for moment in settings_log.all_moments(db):
        parts = settings_log.at(db, moment)
        told.since.append(moment)
        told.which.append(told.add(ToldDetection.in_parts(parts, now)))
        told.before_pest.append(_is_before_pest(parts, now))
    return told


def _is_before_pest(parts: Parts, now: Parts) -> bool:
    """Tell whether the pest of now, which says how it is seen, was not looked for in settings."""
    pest = _named_later(parts, now)
    if pest is None or settings_log.pest_in(parts.get("pest", "null")) == pest.name:
        return False
    return pest.detection is not None or pest.viewpoints is not None


def _which(db: sqlite3.Connection, inspections: Inspections, begins: date, told: _Told) -> Ints:
    """Return which of what was told counted for each inspection."""
    said = _said(db, told)
    dates, first = np.unique(inspections.date, return_index=True)
    which = np.zeros(len(inspections), np.int64)
    unclear: dict[int, tuple[slice, _OfDay]] = {}
    ends = pairwise([*first.tolist(), len(inspections)])
    for on, (low, high) in zip(dates, ends, strict=True):
        day = _told_of(str(on), said)
        counted = {*day.counted(day.seen, told)}
        if len(counted) == 1:
            which[low:high] = counted.pop()
        else:
            number = int((on - np.datetime64(begins, "D")).astype(int))
            unclear[number] = slice(low, high), day
    for number, recorded in _recorded(db, unclear).items():
        rows, day = unclear[number]
        which[rows] = day.counted(recorded, told)
    return which


def _said(db: sqlite3.Connection, told: _Told) -> list[tuple[PlannedOrSeen, int]]:
    """Return what was planned and recorded, and by which of what was told."""
    now, said = settings_log.now(db), []
    known: dict[str, int] = {}
    for one in logged_days.planned_and_seen(db):
        if (by := repr(one.by)) not in known and one.by is not None:
            known[by] = told.add(ToldDetection.in_parts(settings_log.of(db, one.by), now))
        said.append((one, told.at(one.at) if one.by is None else known[by]))
    return said


def _told_of(on: str, said: Iterable[tuple[PlannedOrSeen, int]]) -> _OfDay:
    """Return what was said of a day."""
    of_day = [(one, k) for one, k in said if one.low <= on <= one.high]
    planned = [(one.at, k) for one, k in of_day if one.kind == "planned"]
    seen = [(one.at, k) for one, k in of_day if one.kind == "seen"]
    moments = [*accumulate((at for at, _ in planned), max)]  # a clock may be set back
    first = min(seen)[1] if seen else None
    return _OfDay(moments, [k for _, k in planned], [at for at, _ in seen], first)


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
