"""How a season writes people's names: who was written once is written so from then on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.planning.members import person_key

if TYPE_CHECKING:
    import sqlite3

# the last code first
_WRITTEN = ("SELECT name FROM scouts ORDER BY fid DESC", "SELECT who FROM routes ORDER BY fid")
# who recorded stands there with others of the same file
_RECORDED = "SELECT who FROM batches ORDER BY fid"


def names_written(db: sqlite3.Connection) -> dict[str, str]:
    """Return how a season writes its people, by `person_key`: its team, codes, routes, records."""
    known: dict[str, str] = {}
    for one in settings_of(db).team:
        as_written(known, one.name)
    for wanted in _WRITTEN:
        for (name,) in db.execute(wanted):
            as_written(known, str(name or ""))
    for (names,) in db.execute(_RECORDED):
        together = str(names or "")
        for name in (together, *together.split(", ")):
            as_written(known, name)
    return known


def written_in(db: sqlite3.Connection, name: str) -> str:
    """Return a name as a season writes it, or as it is."""
    return as_written(names_written(db), name)


def as_written(known: dict[str, str], name: str) -> str:
    """Return a name as it is known; one that is not is known as it is from now on."""
    return known.setdefault(person_key(name), name.strip())
