"""How the file of an older season becomes one of today, version by version."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring import schema
from fieldmon.monitoring.geopackage import create

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable


def _treatments_come(db: sqlite3.Connection) -> None:
    """Version 1 knew neither treatments nor routes planned half-way."""
    create(db, schema.TREATMENTS)
    db.execute(schema.INDEXES[1])
    db.execute("ALTER TABLE routes ADD COLUMN at_plant INTEGER")
    db.execute("ALTER TABLE routes ADD COLUMN seconds_left REAL")


def _changes_are_noticed(db: sqlite3.Connection) -> None:
    """Version 2 did not notice what other programs changed."""
    create(db, schema.OUTSIDE_CHANGES)


def _teams_come(db: sqlite3.Connection) -> None:
    """Version 3 knew one who works: routes were nobody's, and settings said nothing of a team."""
    db.execute("ALTER TABLE routes ADD COLUMN who TEXT NOT NULL DEFAULT ''")
    db.execute("DROP INDEX routes_revision")
    db.execute(schema.INDEXES[2])
    # as if said when the season began, so that a team chosen later can be taken back
    db.execute(
        "INSERT OR IGNORE INTO settings (fid, name, value, changed) "
        "SELECT 0, 'team', ?, changed FROM settings ORDER BY fid LIMIT 1",
        (schema.NO_TEAM,),
    )


def _estimates_come(db: sqlite3.Connection) -> None:
    """Version 4 did not keep what inspections tell of the insects."""
    create(db, schema.LEARNT)


def _long_seasons_come(db: sqlite3.Connection) -> None:
    """Version 9 kept inspections once, and of a day's figures not what they follow from."""
    create(db, schema.INSPECTION_LOTS)
    db.execute("ALTER TABLE days ADD COLUMN causes TEXT")
    schema.count_inspections(db)


def _corrections_keep_what_was(db: sqlite3.Connection) -> None:
    """Version 10 did not keep what stood there before a correction."""
    there = {row[1] for row in db.execute("PRAGMA table_info(outside_changes)")}
    for column in schema.CORRECTED:
        if column.split()[0] not in there:  # as in a file in which that layer came just now
            db.execute(f"ALTER TABLE outside_changes ADD COLUMN {column}")


def _records_come(db: sqlite3.Connection) -> None:
    """Version 6 knew of treatments only where, when, how well and the product; it had no log."""
    _applications_say_all(db)
    create(db, schema.LABELS)
    create(db, schema.LOG)
    create(db, schema.MORNINGS)
    db.execute(schema.INDEXES[4])


def _applications_say_all(db: sqlite3.Connection) -> None:
    """Version 8 did not ask for the active ingredient and the weather of a treatment."""
    there = {row[1] for row in db.execute("PRAGMA table_info(treatments)")}
    for column in schema.APPLIED:
        if column.split()[0] not in there:
            db.execute(f"ALTER TABLE treatments ADD COLUMN {column}")


#: what makes a file of version k one of version k + 1; `watch` follows the last
MIGRATIONS: dict[int, Callable[[sqlite3.Connection], None]] = {
    1: _treatments_come,
    2: _changes_are_noticed,
    3: _teams_come,
    4: _estimates_come,
    5: schema.add_phones,
    6: _records_come,
    7: schema.add_photos_asked,
    8: _applications_say_all,
    9: _long_seasons_come,
    10: _corrections_keep_what_was,
}
