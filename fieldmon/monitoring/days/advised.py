"""What was advised for a day, in the log of a season."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.phones.people import written_in

if TYPE_CHECKING:
    import sqlite3
    from datetime import date

    from fieldmon.monitoring.season.open_season import OpenSeason


def advise(season: OpenSeason, on: date, said: str, who: str = "") -> None:
    """Write into the log what was advised for a day, unless that was written last of it.

    Parameters
    ----------
    season
        The season.
    on
        The day.
    said
        The advice, in a sentence or more.
    who
        Who was advised, or advises.
    """
    with season.store.reading() as db:
        if _advised(db, on)[-1:] == [said]:
            return
    with season.changing() as change:
        if _advised(change.db, on)[-1:] != [said]:  # nor has anybody else written it meanwhile
            season_log.append(
                change.db, "advised", written_in(change.db, who), date=str(on), said=said
            )


def _advised(db: sqlite3.Connection, on: date) -> list[str]:
    """Return what was advised for a day, in order."""
    advised = (one.what for one in season_log.entries(db) if one.kind == "advised")
    return [str(one["said"]) for one in advised if one["date"] == str(on)]
