"""What phones bring into a season's file: who may tell, what was told, and photos.

Photos are related to inspections as media (OGC 18-000, GeoPackage Related Tables Extension 1.0,
clauses 7.2 to 7.4 and 8.1), so that other programs show them with the plant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fieldmon.monitoring.file import rows_that_count
from fieldmon.monitoring.file.geopackage import GeoPackageTable, announce, create, insert, touch
from fieldmon.planning.members import person_key

if TYPE_CHECKING:
    import sqlite3

SCOUTS = GeoPackageTable(
    "scouts",
    (
        "name TEXT NOT NULL",
        "key_digest TEXT NOT NULL UNIQUE",
        "made TEXT NOT NULL",
        "ended TEXT",
        "first_row INTEGER",
        "last_row INTEGER",
    ),
    None,
    "Who may tell findings from a phone, and of which rows; of keys only digests are kept.",
)
#: its name is that of files that were made before findings were called so
FINDINGS = GeoPackageTable(
    "tellings",
    (
        "id TEXT NOT NULL UNIQUE",
        "scout TEXT NOT NULL",
        "undoes TEXT",
        "at_phone TEXT NOT NULL",
        "sent_phone TEXT NOT NULL",
        "received TEXT NOT NULL",
        "accuracy_m REAL",
        "stage TEXT",
        "leaves REAL",
        "off_route INTEGER NOT NULL DEFAULT 0",
        "inspection INTEGER",
        "problem TEXT",
        "content TEXT NOT NULL",
    ),
    "POINT",
    "What phones and robots told, each once by its own id, with both clocks; the point is where "
    "they stood.",
)
PHOTOS = GeoPackageTable(
    "photos",
    (
        "data BLOB NOT NULL",
        "content_type TEXT NOT NULL",
        "photo TEXT NOT NULL UNIQUE",
        "telling TEXT NOT NULL",
        "scout TEXT NOT NULL",
        "at_phone TEXT NOT NULL",
        "received TEXT NOT NULL",
        "lon REAL",
        "lat REAL",
        "accuracy_m REAL",
        "digest TEXT NOT NULL",
    ),
    None,
    "Photos as phones sent them, byte for byte.",
    key="id",
)
PHOTOS_ASKED = GeoPackageTable(
    "photos_asked",
    (
        "id TEXT NOT NULL UNIQUE",
        "plant INTEGER NOT NULL",
        "line INTEGER",
        "number INTEGER",
        "note TEXT NOT NULL",
        "who TEXT NOT NULL",
        "at TEXT NOT NULL",
        "ended TEXT",
    ),
    "POINT",
    "Photos that somebody asks for, at their plants; ended: nobody does any more.",
)
# a view, so that a photo may come before what it belongs to
PHOTOS_OF = GeoPackageTable(
    "inspections_photos",
    ("base_id INTEGER", "related_id INTEGER"),
    None,
    "Which photo belongs to which inspection.",
)
PHOTO_PLACES = GeoPackageTable(
    "photo_places",
    (),
    "POINT",
    "Photos at the plants that they show.",
)

_FIRST = (SCOUTS, FINDINGS, PHOTOS)
TABLES = (*_FIRST, PHOTOS_ASKED)

_VIEWS = (
    """
CREATE VIEW inspections_photos AS
  SELECT p.id AS fid, t.inspection AS base_id, p.id AS related_id
  FROM photos p JOIN tellings t ON t.id = p.telling WHERE t.inspection NOTNULL
""",
    """
CREATE VIEW photo_places AS
  SELECT p.id AS fid, i.geom AS geom, i.plant AS plant, i.line AS line, i.number AS number,
         i.date AS date, i.result AS result, p.scout AS scout, p.at_phone AS at_phone,
         p.content_type AS content_type, p.data AS data
  FROM photos p JOIN tellings t ON t.id = p.telling JOIN inspections i ON i.fid = t.inspection
  WHERE i.undone = 0
""",
)
_RELATIONS = """
CREATE TABLE gpkgext_relations (
  id INTEGER PRIMARY KEY AUTOINCREMENT, base_table_name TEXT NOT NULL,
  base_primary_column TEXT NOT NULL DEFAULT 'id', related_table_name TEXT NOT NULL,
  related_primary_column TEXT NOT NULL DEFAULT 'id', relation_name TEXT NOT NULL,
  mapping_table_name TEXT NOT NULL UNIQUE)
"""
_EXTENSIONS = """
CREATE TABLE IF NOT EXISTS gpkg_extensions (
  table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL,
  scope TEXT NOT NULL, CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name))
"""
_STANDARD = "http://docs.opengeospatial.org/is/18-000/18-000.html"


def n_sent(db: sqlite3.Connection, table: GeoPackageTable, who: str, since: str) -> int:
    """Return how many findings or photos somebody sent since a moment."""
    sent = f"SELECT scout, count(*) FROM {table.name} WHERE received > ? GROUP BY scout"  # noqa: S608 - ours
    return sum(n for name, n in db.execute(sent, (since,)) if person_key(name) == person_key(who))


def move_photos(db: sqlite3.Connection, mark: str, told: str) -> None:
    """Let photos of what was taken back belong to the finding `told`, which says the same again.

    `mark` is the digest of its inspection.
    """
    db.execute(
        "UPDATE photos SET telling = ? WHERE telling IN (SELECT t.id FROM tellings t JOIN "
        "inspections i ON i.fid = t.inspection WHERE i.digest = ? AND i.undone = ?)",
        (told, mark, rows_that_count.TAKEN_BACK),
    )


def phones_come(db: sqlite3.Connection) -> None:
    """Add what phones need to a file that knows none of it."""
    for table in _FIRST:
        create(db, table)
    for view in _VIEWS:
        db.execute(view)
    announce(db, PHOTOS_OF)
    announce(db, PHOTO_PLACES)
    db.execute("CREATE INDEX photos_of_telling ON photos (telling)")
    db.execute("CREATE INDEX tellings_undo ON tellings (undoes) WHERE undoes NOTNULL")
    _relate(db)


def _relate(db: sqlite3.Connection) -> None:
    db.execute(_EXTENSIONS)
    db.execute(_RELATIONS)
    db.execute(
        "INSERT INTO gpkgext_relations (base_table_name, base_primary_column, related_table_name, "
        "related_primary_column, relation_name, mapping_table_name) VALUES "
        "('inspections', 'fid', 'photos', 'id', 'media', 'inspections_photos')"
    )
    db.executemany(
        "INSERT INTO gpkg_extensions VALUES (?, NULL, 'gpkg_related_tables', ?, 'read-write')",
        [("gpkgext_relations", _STANDARD), ("inspections_photos", _STANDARD)],
    )


# -- two copies of a season

_INSPECTION = "i.digest, b.at, b.source, b.who"
_OF_FINDING = "FROM inspections i JOIN batches b ON b.fid = i.batch WHERE i."

#: rows of a table by the names of its columns
Rows = list[dict[str, Any]]


def brought(db: sqlite3.Connection) -> dict[str, Rows]:
    """Return what phones brought to a copy; findings by what their inspections say.

    Numbers of inspections change when copies are merged: they are known by digest and batch.
    """
    found = {table.name: _rows(db, table) for table in TABLES}
    wanted = f"SELECT {_INSPECTION} {_OF_FINDING}fid = ?"
    for row in found["tellings"]:
        row["inspection"] = db.execute(wanted, (row["inspection"],)).fetchone()
    return found


def bring_together(db: sqlite3.Connection, copies: list[dict[str, Rows]]) -> list[tuple[int, int]]:
    """Write what phones brought to either copy, once each; what either took back is so.

    Return the batch and the day of each inspection that is taken back.
    """
    ends: dict[str, list[str]] = {}
    for copied in copies:
        for row in (*copied["scouts"], *copied["photos_asked"]):
            known = row["key_digest"] if "key_digest" in row else row["id"]
            ends.setdefault(known, []).extend([row["ended"]] if row["ended"] else [])
    told: dict[str, set[tuple[str, ...]]] = {}
    for row in (row for copied in copies for row in copied["tellings"] if row["inspection"]):
        told.setdefault(row["id"], set()).add(row["inspection"])
    for table, known_by in zip(TABLES, ("key_digest", "id", "photo", "id"), strict=True):
        rows: dict[str, dict[str, Any]] = {}
        for row in sorted((row for copied in copies for row in copied[table.name]), key=_came):
            rows.setdefault(row[known_by], row)
        made = []
        for key, row in sorted(rows.items()):
            if table in {SCOUTS, PHOTOS_ASKED}:
                row["ended"] = min(ends[key], default=None)
            elif table is FINDINGS:
                row["inspection"] = _inspection_of(db, told.get(key, set()))
            made.append(tuple(row[name] for name in table.names))
        db.execute(f"DELETE FROM {table.name}")  # noqa: S608 - names of ours
        insert(db, table, made)
        touch(db, table.name)
    back = undo_as_told(db)
    pointed = [(_inspection_of(db, made), one) for one, made in told.items() if len(made) > 1]
    db.executemany("UPDATE tellings SET inspection = ? WHERE id = ?", pointed)
    return back


def _came(row: dict[str, Any]) -> tuple[str, ...]:
    """Return by what the first of two rows about the same is known: it came first."""
    return tuple(str(row.get(name)) for name in ("received", "content", "digest"))


def _inspection_of(db: sqlite3.Connection, told: set[tuple[str, ...]]) -> int | None:
    """Return which inspection a finding made, given what it is known by in each copy.

    Of several it is the one that counts; if none does but one stands back, the one it stands back
    for.
    """
    wanted = (
        f"SELECT i.undone, i.fid, i.digest {_OF_FINDING}digest = ? AND b.at = ? AND b.source = ? "
        "AND b.who = ?"
    )
    found = sorted(row for one in told for row in db.execute(wanted, one))
    if not found or found[0][0] == rows_that_count.COUNTS:
        return int(found[0][1]) if found else None
    marks = [mark for undone, _, mark in found if undone == rows_that_count.STANDS_BACK]
    counts = "SELECT fid FROM inspections WHERE digest = ? AND undone = 0"
    others = (fid for mark in marks for (fid,) in db.execute(counts, (mark,)))
    return int(next(others, found[0][1]))


def undo_as_told(db: sqlite3.Connection) -> list[tuple[int, int]]:
    """Mark as undone what a finding of the same person takes back, whichever came first.

    A finding that came to two copies of a season is taken back in both. What somebody else recorded
    of the same counts again.
    Return the batch and the day of each.
    """
    rows = db.execute(
        "SELECT i.fid, i.batch, i.day, f.scout, u.scout FROM tellings u JOIN tellings f "
        "ON f.id = u.undoes JOIN inspections i ON i.fid = f.inspection "
        "WHERE u.undoes NOTNULL AND i.undone <> 1"
    ).fetchall()
    rows = [row[:3] for row in rows if person_key(row[3]) == person_key(row[4])]
    db.executemany("UPDATE inspections SET undone = 1 WHERE fid = ?", [row[:1] for row in rows])
    others = [
        (batch, day)
        for inspection, _, day in rows
        for batch in rows_that_count.undo_same(db, inspection)
    ]
    again = rows_that_count.count_again(db) if rows else []
    first = min((day for *_, day in rows), default=0)
    return [
        *others,
        *((batch, first) for batch in again),
        *((batch, day) for _, batch, day in rows),
    ]


def _rows(db: sqlite3.Connection, table: GeoPackageTable) -> Rows:
    found = db.execute(f"SELECT {', '.join(table.names)} FROM {table.name} ORDER BY {table.key}")  # noqa: S608
    return [dict(zip(table.names, row, strict=True)) for row in found]
