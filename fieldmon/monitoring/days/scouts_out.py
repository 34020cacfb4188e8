"""Who is out on a day: codes and the team, what each recorded, and what to look after."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.inspections import FOUND, RESULT_NAMES
from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.days.day_ahead import DayAhead, WorkPart
from fieldmon.monitoring.phones.scouts import overlapping, scouts_on
from fieldmon.monitoring.phones.sent_findings import CLOCK_IS_WRONG
from fieldmon.monitoring.settings.shift_work import made_by
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from datetime import date

    from fieldmon.monitoring.season.season_file import Season

    #: when it was recorded, the plant, the day, and by whom
    Find = tuple[str, int, int, str]

# the last finding of each, and the last photo; the newest is the last of a person
_LAST_SENT = "SELECT scout, max(received), sent_phone FROM tellings GROUP BY scout ORDER BY 2"
_LAST_PHOTO = "SELECT scout, max(received) FROM photos GROUP BY scout ORDER BY 2"


@dataclass(frozen=True)
class ScoutOut:
    """Somebody with a code, or of the team, on a day.

    Parameters
    ----------
    name, rows
        Who, and first and last row of a part; None: no rows were given.
    made, heard
        When the code was made, and when the phone last sent something; None: never.
    fast
        How far the phone's clock was ahead then.
    done, ahead
        Plants that this person recorded on the day, and those left of the plan given last.
    plan
        Which plan of the day was given last, see `DayAhead.plan_of`; None: none.
    shares
        Who else has a code for the same rows.
    has_route
        Whether there is a route for this person: beside the team rows are needed for it.
    holds
        Whether this person has a code that holds now.
    overlaps
        Others whose codes are for some of the same rows, but not for the same: of merged copies.
    newer
        Plants at which others found something since the route was given out, or this person did on
        an earlier day, as far as it came in since then. Of a day that is over nobody asks.
    """

    name: str
    rows: tuple[int, int] | None
    made: datetime | None
    heard: datetime | None
    fast: timedelta
    done: int
    ahead: int
    plan: int | None
    shares: tuple[str, ...]
    has_route: bool
    holds: bool
    overlaps: tuple[str, ...] = ()
    newer: int = 0

    @property
    def clock_is_wrong(self) -> bool:
        """Return whether the phone's clock is so far off that its times are put right."""
        return abs(self.fast) > CLOCK_IS_WRONG


def scouts_out(season: Season, on: date) -> tuple[ScoutOut, ...]:
    """Return who is out on the day `on`: who has a code, and then who of the team has none.

    Of a day that is over it is who was out then.
    """
    ahead, done = DayAhead.of(season, on), season.history.inspections.on(on)
    holding = {person_key(one.name): one for one in ahead.scouts}
    is_earlier, day = season.work(on).is_earlier, ahead.settings.day(on)
    with season.store.reading() as db:
        if is_earlier:  # as its plan is counted, see `Season.planned_and_done`
            then = scouts_on(db, local_clock(season.plot.field), on)
            ahead = replace(ahead, scouts=then, settings=season.planned_by(on))
        sent = {person_key(who): (at, clock) for who, at, clock in db.execute(_LAST_SENT)}
        photos = {person_key(who): at for who, at in db.execute(_LAST_PHOTO)}
        given = {one.digest: one.at for one in logged_days.given_out(db) if one.date == str(on)}
        finds = _finds_since(db, min(given.values(), default=""), day) if given else []
    codes = ahead.scouts, ahead.settings, int(season.plant_numbers.line.max())
    coded = {person_key(one.name): one for one in ahead.scouts}
    team = {person_key(one.name): one.name for one in ahead.settings.team}
    out = []
    for who in dict.fromkeys([*coded, *team]):
        code = coded.get(who, holding.get(who))  # of a day that is over: one made since
        part = WorkPart(None, team[who]) if code is None else WorkPart(code.rows, code.name)
        heard = max(filter(None, (sent.get(who, ("",))[0], photos.get(who, ""))), default="")
        out.append(
            ScoutOut(
                part.name, ahead.rows(part),
                None if code is None else _moment(code.made), _moment(heard),
                _phone_ahead(*sent[who]) if who in sent else timedelta(),
                len(np.unique(made_by(done, who).plant)),
                len(np.setdiff1d(ahead.given(part), done.plant)),
                ahead.plan_of(part), () if ahead.member(part) else ahead.others(part),
                ahead.has_route(part), who in holding,
                () if code is None else tuple(one.name for one in overlapping(code, *codes)),
                0 if is_earlier else _n_newer(finds, given.get(ahead.mark(part)), who, day),
            )
        )  # fmt: skip
    return tuple(out)


def _finds_since(db: sqlite3.Connection, since: str, day: int) -> list[Find]:
    wanted = (
        "SELECT at, plant, day, coalesce(i.who, b.who, '') FROM inspections i JOIN batches b "
        "ON b.fid = batch WHERE i.undone = 0 AND result = ? AND day <= ? AND at > ?"
    )
    return db.execute(wanted, (RESULT_NAMES[FOUND], day, since)).fetchall()


def _n_newer(finds: list[Find], given: str | None, who: str, day: int) -> int:
    """Return at how many plants something was found that a route given out then knows nothing of.

    What somebody finds on the way the phone knows itself.
    """
    if given is None:
        return 0
    return len({plant for at, plant, of, by in finds
                if at > given and (of < day or person_key(by) != who)})  # fmt: skip


def _moment(text: str) -> datetime | None:
    return datetime.fromisoformat(text) if text else None


def _phone_ahead(received: str, sent: str) -> timedelta:
    return datetime.fromisoformat(sent) - datetime.fromisoformat(received)
