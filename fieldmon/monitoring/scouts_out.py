"""Who is out on a day: codes and the team, what each recorded, and what to look after."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.monitoring.day_ahead import Part, crew_of, given, plan_of
from fieldmon.monitoring.findings import CLOCK_IS_WRONG
from fieldmon.monitoring.history import made_by
from fieldmon.monitoring.scouts import scouts_of

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.monitoring.season_file import Season

# the last finding of each, and the last photo
_LAST_SENT = "SELECT scout, max(received), sent_phone FROM tellings GROUP BY scout"
_LAST_PHOTO = "SELECT scout, max(received) FROM photos GROUP BY scout"


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
        Plants that this person recorded on the day, and those of the route that are left.
    plan
        Which plan of the day was given last, see `day_ahead.plan_of`; None: none.
    shares
        Who else has a code for the same rows.
    has_route
        Whether there is a route for this person: beside the team rows are needed for it.
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

    @property
    def clock_is_wrong(self) -> bool:
        """Return whether the phone's clock is so far off that its times are put right."""
        return abs(self.fast) > CLOCK_IS_WRONG


def scouts_out(season: Season, on: date) -> tuple[ScoutOut, ...]:
    """Return who is out on the day `on`: who has a code, and then who of the team has none."""
    settings, coded = season.settings, {one.name: one for one in scouts_of(season)}
    with season.store.reading() as db:
        sent = {who: (at, clock) for who, at, clock in db.execute(_LAST_SENT)}
        photos = dict(db.execute(_LAST_PHOTO).fetchall())
    done = season.history.inspections.on(on)
    out = []
    for name in dict.fromkeys([*coded, *(member.name for member in settings.team)]):
        code = coded.get(name)
        part = Part(None if code is None else code.rows, name)
        member, route = part.member(season), given(season, on, part)
        heard = max(filter(None, (sent.get(name, ("",))[0], photos.get(name, ""))), default="")
        out.append(
            ScoutOut(
                name, part.rows, None if code is None else _at(code.made), _at(heard),
                _fast(*sent[name]) if name in sent else timedelta(),
                len(np.unique(made_by(done, name).plant)), int((~np.isin(route, done.plant)).sum()),
                plan_of(season, on, part),
                () if member else tuple(one for one in crew_of(season, part) if one != name),
                not settings.team or member is not None or part.rows is not None,
            )
        )  # fmt: skip
    return tuple(out)


def _at(text: str) -> datetime | None:
    return datetime.fromisoformat(text) if text else None


def _fast(received: str, sent: str) -> timedelta:
    return datetime.fromisoformat(sent) - datetime.fromisoformat(received)
