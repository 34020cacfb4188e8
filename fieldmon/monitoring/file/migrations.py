"""How the file of an older season becomes one of today, version by version.

A table that comes is made as of today: what comes to it later comes by `add_column`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import add_column, create

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable


def _treatments_come(db: sqlite3.Connection) -> None:
    """Version 1 knew neither treatments nor routes planned half-way."""
    create(db, schema.TREATMENTS)
    schema.add_index(db, "treatments_once")
    add_column(db, "routes", "at_plant INTEGER")
    add_column(db, "routes", "seconds_left REAL")


def _changes_are_noticed(db: sqlite3.Connection) -> None:
    """Version 2 did not notice what other programs changed."""
    create(db, schema.OUTSIDE_CHANGES)


def _teams_come(db: sqlite3.Connection) -> None:
    """Version 3 knew one who works: routes were nobody's, and settings said nothing of a team."""
    add_column(db, "routes", "who TEXT NOT NULL DEFAULT ''")
    db.execute("DROP INDEX routes_revision")
    schema.add_index(db, "routes_revision")
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
    add_column(db, "days", "causes TEXT")
    schema.count_inspections(db)


def _corrections_keep_what_was(db: sqlite3.Connection) -> None:
    """Version 10 did not keep what stood there before a correction."""
    for column in schema.CORRECTED:
        add_column(db, "outside_changes", column)


def _undone_changes_are_named(db: sqlite3.Connection) -> None:
    """Version 13 did not say of settings which change they take back, if any."""
    add_column(db, "settings", "undoes TEXT")


def _records_come(db: sqlite3.Connection) -> None:
    """Version 6 knew of treatments only where, when, how well and the product; it had no log."""
    _applications_say_all(db)
    create(db, schema.LABELS)
    create(db, schema.LOG)
    create(db, schema.MORNINGS)
    schema.add_index(db, "inspections_batch")


def _applications_say_all(db: sqlite3.Connection) -> None:
    """Version 8 did not ask for active ingredient and weather, 11 not what came from a label."""
    for column in schema.APPLIED:
        add_column(db, "treatments", column)


def _inspections_say_what_they_find(db: sqlite3.Connection) -> None:
    """Version 12 read each inspection by the season's settings alone."""
    _columns_of_inspections_come(db)


def _columns_of_inspections_come(db: sqlite3.Connection) -> None:
    """Add the columns of inspections that came since the first version."""
    for column in schema.LATER:
        add_column(db, "inspections", column.sql)
    # those of before lack the columns, and are made anew as the file is written next
    db.execute("DELETE FROM inspection_lots")


def _others_are_read_too(db: sqlite3.Connection) -> None:
    """Version 14 read of an inspection what one recording says, whatever others of it say."""
    schema.add_index(db, "inspections_beside")
    db.execute("DELETE FROM inspection_lots")


def _who_walks_is_said(_db: sqlite3.Connection) -> None:
    """Version 15 took those for scouts who are charged their times, as it is read where unsaid."""


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
    11: _applications_say_all,
    12: _inspections_say_what_they_find,
    13: _undone_changes_are_named,
    14: _others_are_read_too,
    15: _who_walks_is_said,
}
