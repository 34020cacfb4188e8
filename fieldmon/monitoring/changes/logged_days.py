"""What the log says of days: which were planned, given out and recorded, and by which settings.

Entries of copies that were merged are among them; what was undone was not worked.
"""

from __future__ import annotations

import json
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.settings import settings_log

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator, Sequence
    from datetime import date

    from fieldmon.monitoring.settings.settings_log import Marks
    from fieldmon.plot.local_clock import LocalClock


class PlannedOrSeen(NamedTuple):
    """What the log says of some days: that they were planned, or recorded.

    Parameters
    ----------
    kind
        ``"planned"`` or ``"seen"``.
    at
        When, UTC.
    low, high
        The first and the last of the days (ISO).
    by
        By which settings; None: an earlier version did not say.
    """

    kind: str
    at: str
    low: str
    high: str
    by: Marks | None

    def chosen(self, db: sqlite3.Connection) -> Marks:
        """Return by which settings it was done."""
        return settings_log.marks(db, self.at) if self.by is None else self.by


# entries of other copies that were merged are among them; what was undone was not worked
_PLANNED_AND_SEEN = (
    "WITH said (entry, own) AS (SELECT entry, 1 FROM log UNION ALL "
    "SELECT json_extract(value, '$.entry'), 0 FROM log, json_each(log.entry, '$.what.theirs')) "
    "SELECT json_extract(entry, '$.kind') AS kind, json_extract(entry, '$.at') AS at,"
    " coalesce(json_extract(entry, '$.what.date'), json_extract(entry, '$.what.from')) AS low,"
    " coalesce(json_extract(entry, '$.what.date'), json_extract(entry, '$.what.to')) AS high,"
    " json_extract(entry, '$.what.by'), own, json_extract(entry, '$.entry'),"
    " json_extract(entry, '$.what.batch'), json_extract(entry, '$.what.source')"
    " FROM said WHERE kind IN ('planned', 'seen') AND low <= coalesce(?1, low)"
    " AND high >= coalesce(?1, high)"
)


def planned_and_seen(db: sqlite3.Connection, on: date | None = None) -> list[PlannedOrSeen]:
    """Return what was planned and recorded and not undone, in order; of one day, or of all."""
    undone = {*db.execute("SELECT fid, source FROM batches WHERE undone = 1")}
    anew = season_log.numbered_anew(db) if undone else {}
    last = {0: "", 1: ""}
    said = []
    rows = db.execute(_PLANNED_AND_SEEN, (on and str(on),))
    for kind, at, low, high, by, own, entry, batch, source in rows:
        if own and (anew.get(entry, {}).get(batch, batch), source) in undone:
            continue
        last[own] = max(last[own], at)  # a clock may be set back: what stands below is later
        marks = None if by is None else json.loads(by)
        said.append((last[own], PlannedOrSeen(kind, at, low, high, marks)))
    return [one for _, one in sorted(said, key=lambda each: each[0])]


# what was recorded before an older season's file had a log
_SEEN_BEFORE = (
    "SELECT at FROM batches WHERE at < (SELECT json_extract(entry, '$.at') FROM log ORDER BY fid "
    "LIMIT 1) AND EXISTS (SELECT 1 FROM inspections WHERE batch = batches.fid AND date = ? "
    "AND undone = 0 AND digest NOTNULL) ORDER BY at LIMIT 1"
)


def worked_by(db: sqlite3.Connection, on: date, clock: LocalClock) -> Marks | None:
    """Return by which settings a day was worked; None: the file says nothing of it.

    Those of its last plan before the last of it was recorded on the day itself, by the plot's
    clock, or, if nothing was, before the first of it. A day that was not planned before was worked
    by what counted when it was first recorded. If nothing was recorded, it is the last plan.
    """
    of_day = planned_and_seen(db, on)
    seen = [k for k, one in enumerate(of_day) if one.kind == "seen"]
    that_day = [k for k in seen if clock.at(datetime.fromisoformat(of_day[k].at)).date() == on]
    if not that_day and (before := db.execute(_SEEN_BEFORE, (str(on),)).fetchone()):
        return settings_log.marks(db, before[0])
    if not seen:
        return of_day[-1].chosen(db) if of_day else None
    plans = [one for one in of_day[: (that_day or seen[:1])[-1]] if one.kind == "planned"]
    return (plans[-1] if plans else of_day[seen[0]]).chosen(db)


def to_be_worked(
    db: sqlite3.Connection, days: Sequence[date], clock: LocalClock
) -> tuple[date, ...]:
    """Return the days of some planned ones that were planned to be worked, as far as is known.

    The others were planned afterwards, or to look ahead: the last plan was made days before, and
    more was recorded since of which it knew nothing. Where an earlier version planned a day before
    the file had a log, nothing is known.
    """
    said = planned_and_seen(db)

    def is_for(one: PlannedOrSeen, on: date) -> bool:
        made = clock.at(datetime.fromisoformat(one.at)).date()
        if made >= on - timedelta(days=1):
            return made <= on
        return not any(
            other.kind == "seen" and other.at > one.at and other.low < str(on) for other in said
        )

    plans: dict[str, list[PlannedOrSeen]] = {}
    for one in said:
        if one.kind == "planned":
            plans.setdefault(one.low, []).append(one)
    return tuple(
        on for on in days if str(on) not in plans or any(is_for(one, on) for one in plans[str(on)])
    )


class GivenOut(NamedTuple):
    """What a log says of a route that was kept: when (UTC), for whom, of which day (ISO)."""

    at: str
    who: str
    date: str
    digest: str


def given_out(db: sqlite3.Connection) -> Iterator[GivenOut]:
    """Yield what is told of routes that were kept, here or in a copy that was taken in."""
    for _, content in season_log.with_those_taken_in(db):
        if '"kind":"planned"' in content:
            said = json.loads(content)
            what = said["what"]
            yield GivenOut(said["at"], said["who"], what["date"], what["digest"])


def holds_still(db: sqlite3.Connection, on: date, plan: str) -> bool:
    """Return whether nothing is told since a day's plan was kept, by its digest, but what is clean.

    Other plans, and plants of that day on which nothing was found, change none.
    """
    for (content,) in db.execute("SELECT entry FROM log ORDER BY fid DESC"):
        said = json.loads(content)
        kind, what = said["kind"], said["what"]
        if kind == "planned":
            if (what.get("date"), what.get("digest")) == (str(on), plan):
                return True
        elif kind == "seen":
            if what.get("found") or {what.get("from"), what.get("to")} != {str(on)}:
                return False
        elif kind != "advised":
            return False
    return False
