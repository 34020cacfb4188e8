"""Rows of two copies: known again by what they say, and put in the order of their recording.

A clock may be set back, so that no moment alone says what was later.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any

from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import touch

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Hashable, Iterable

    from fieldmon.monitoring.file.geopackage import GeoPackageTable
    from fieldmon.monitoring.treating.treatments import Row

#: rows of a copy by the names of their tables
TableRows = dict[str, list["Row"]]
#: what the batches of a copy are numbered now, by their numbers in it
Numbers = dict[int, int]

#: what is taken row by row, each as the module of its name says
TAKEN = (
    *(schema.BATCHES, schema.INSPECTIONS, schema.TREATMENTS, schema.SETTINGS),
    *(schema.ROUTES, schema.STOPS, schema.IMPORTS, schema.OUTSIDE_CHANGES, schema.LABELS),
)


def read(db: sqlite3.Connection) -> TableRows:
    """Return the rows of what is taken row by row, by their table; inspections are read later."""
    return {table.name: rows_of(db, table) for table in TAKEN if table is not schema.INSPECTIONS}


def rows_of(db: sqlite3.Connection, table: GeoPackageTable, after: int = 0) -> list[Row]:
    """Return the rows of a table after its first ones."""
    names = ("fid", *table.names)
    rows = db.execute(
        f"SELECT {', '.join(names)} FROM {table.name} ORDER BY fid LIMIT -1 OFFSET ?",  # noqa: S608 - ours
        (after,),
    )
    return [dict(zip(names, row, strict=True)) for row in rows]


def write(
    db: sqlite3.Connection,
    table: GeoPackageTable,
    rows: list[Row],
    after: int = 0,
    numbers: Iterable[int] | None = None,
) -> None:
    """Let these be the rows of a table after number `after`, numbered in their order.

    Or as `numbers` says.
    """
    names = ("fid", *table.names)
    db.execute(f"DELETE FROM {table.name} WHERE fid > ? OR fid < 1", (after,))  # noqa: S608 - names of ours
    db.executemany(
        f"INSERT INTO {table.name} ({', '.join(names)}) VALUES ({', '.join('?' * len(names))})",  # noqa: S608 - ours
        [
            (number, *(row[name] for name in table.names))
            for number, row in zip(numbers or count(after + 1), rows, strict=False)
        ],
    )
    touch(db, table.name)


def key_of(row: Row, names: Iterable[str]) -> tuple[Any, ...]:
    """Return what a row says in some columns."""
    return tuple(row[name] for name in names)


def alike_at_first(
    copies: list[TableRows], name: str, known_by: tuple[str, ...]
) -> dict[tuple[Any, ...], None]:
    """Return the keys of the rows with which both copies begin, in order."""
    ours, theirs = ([key_of(row, known_by) for row in copied[name]] for copied in copies)
    alike = [one == other for one, other in zip(ours, theirs, strict=False)]
    return dict.fromkeys(ours[: (*alike, False).index(False)])


def as_recorded(
    copies: list[TableRows], name: str, known_by: tuple[str, ...], at: str
) -> dict[Hashable, tuple[str, int, str]]:
    """Return the place of each row among those of both copies: when it was recorded.

    A clock may be set back: what stands below is later, whatever it says.
    """
    places: dict[Hashable, tuple[str, int, str]] = {}
    for copied in copies:
        latest, n, before = "", 0, None
        for row in copied[name]:
            moment = str(row[at] or "")
            n = 0 if moment > latest else n + (moment != before)
            latest, before = max(latest, moment), moment
            key = key_of(row, known_by)
            place = latest, n, repr((moment, key))
            places[key] = max(places.get(key, place), place)
    return places


def once(copies: list[TableRows], name: str, known_by: tuple[str, ...], at: str) -> list[Row]:
    """Return the rows of both copies, once each, in an order that both would give.

    What both begin with stays where it is: a copy that brings nothing changes nothing.
    """
    found = {key_of(row, known_by): row for copied in copies for row in copied[name]}
    begin = alike_at_first(copies, name, known_by)
    place = as_recorded(copies, name, known_by, at)
    rest = sorted((key for key in found if key not in begin), key=place.__getitem__)
    return [found[key] for key in (*begin, *rest)]
