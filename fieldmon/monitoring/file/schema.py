"""The tables of a season's file. How an older file comes to them: `migrations`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.infestation import inspection_columns
from fieldmon.monitoring.file import phone_tables
from fieldmon.monitoring.file.geopackage import GeoPackageTable, announce, create, found
from fieldmon.monitoring.file.qgis_styles import add_asked_styles, add_photo_styles, add_styles

if TYPE_CHECKING:
    import sqlite3

VERSION = 16
#: files of this version and later have a log
LOGS_SINCE = 7
#: the first fieldmon that reads files of this version
NEEDS = "0.2"
#: what the settings say of a team where there is none
NO_TEAM = '{"members": []}'

META = GeoPackageTable(
    "fieldmon", ("key TEXT NOT NULL UNIQUE", "value TEXT"), None, "What this file is."
)
SETTINGS = GeoPackageTable(
    "settings",
    ("name TEXT NOT NULL", "value TEXT NOT NULL", "changed TEXT NOT NULL", "undoes TEXT"),
    None,
    "Settings of the season as JSON; the last of a name counts.",
)
IMPORTS = GeoPackageTable(
    "import_findings",
    ("source TEXT", "severity TEXT", "feature TEXT", "sentence TEXT", "remedy TEXT", "at TEXT"),
    None,
    "What was seen, repaired, guessed or dropped when files were read.",
)
ARRAYS = GeoPackageTable(
    "arrays",
    ("name TEXT NOT NULL UNIQUE", "dtype TEXT", "shape TEXT", "data BLOB"),
    None,
    "The plant grid as it was laid, compressed: plant numbers never move.",
)
BATCHES = GeoPackageTable(
    "batches",
    (
        "at TEXT NOT NULL",
        "kind TEXT NOT NULL",
        "source TEXT",
        "who TEXT",
        "rows INTEGER NOT NULL",
        "undone INTEGER NOT NULL DEFAULT 0",
    ),
    None,
    "Everything recorded, in order; what was undone is marked, never deleted.",
)
DAYS = GeoPackageTable(
    "days",
    (
        "day INTEGER NOT NULL UNIQUE",
        "date DATE",
        "inspected INTEGER",
        "found INTEGER",
        "expected_left REAL",
        "low INTEGER",
        "high INTEGER",
        "chance_clean REAL",
        "digest TEXT",
        "causes TEXT",
    ),
    None,
    "Each day's figures after its work, the digest of its morning's chance map, and of the last "
    "day that of all from which its figures follow.",
)
PLANT_STATE = GeoPackageTable(
    "plant_state",
    ("chance REAL", "state TEXT", "last_inspected DATE", "hot_spot INTEGER"),
    None,
    "The latest state of each plant (fid as in plants); see the layer chance.",
)
PLOTS = GeoPackageTable(
    "plots",
    ("name TEXT", "area_ha REAL", "plants INTEGER"),
    "MULTIPOLYGON",
    "Boundary of the plot.",
)
PLACES = GeoPackageTable(
    "places", ("kind TEXT NOT NULL",), "GEOMETRY", "Gate, paths, no-go areas and blocks."
)
ROWS = GeoPackageTable("rows", ("line INTEGER", "plants INTEGER"), "LINESTRING", "Rows of plants.")
PLANTS = GeoPackageTable(
    "plants",
    ("plant INTEGER NOT NULL", "line INTEGER", "number INTEGER"),
    "POINT",
    "Plants: number in this file, row and place in the row as people count.",
)
# called so by files and projects of all versions
RECORDS = GeoPackageTable(
    "observations",
    (
        "present INTEGER",
        "date DATE",
        "count REAL",
        "accuracy_m REAL",
        "species TEXT",
        "stage TEXT",
        "leaves REAL",
    ),
    "POINT",
    "Pest records from before the season: 1 present, 0 looked and saw nothing, -1 undecided.",
)
#: of an inspection's columns, those that a file of an earlier version lacks
LATER = tuple(column for column in inspection_columns.COLUMNS if column.since)
_PLANT, *_FIRST = (one.sql for one in inspection_columns.COLUMNS if one not in LATER)
INSPECTIONS = GeoPackageTable(
    "inspections",
    (
        _PLANT,
        *("line INTEGER", "number INTEGER", "day INTEGER"),
        *_FIRST,
        *("batch INTEGER", "digest TEXT", "undone INTEGER DEFAULT 0"),
        *(column.sql for column in LATER),
    ),
    "POINT",
    "What was found at which plant: clean, found or skipped.",
)
#: what is kept of an application since version 7; by_label, since version 12: which of these a
#: label filled in, as "waiting_days+irac_groups" (nothing: nobody knows, or there is nothing to)
APPLIED = (
    "dose REAL",
    "unit TEXT",
    "water_l_ha REAL",
    "area_ha REAL",
    "operator TEXT",
    "reason TEXT",
    "waiting_days INTEGER",
    "reentry_hours REAL",
    "irac_groups TEXT",
    "began TEXT",
    "ended TEXT",
    "zone TEXT",
    "machinery TEXT",
    "crop TEXT",
    "pest TEXT",
    "authorised_by TEXT",
    "of_plants BLOB",
    "active_ingredient TEXT",
    "weather TEXT",
    "by_label TEXT",
)
TREATMENTS = GeoPackageTable(
    "treatments",
    (
        "day INTEGER",
        "date DATE",
        "efficacy REAL",
        "product TEXT",
        "plants INTEGER",
        "batch INTEGER",
        "digest TEXT",
        "undone INTEGER NOT NULL DEFAULT 0",
        *APPLIED,
    ),
    "MULTIPOLYGON",
    "Areas treated: with what, how, by whom and why, and how well it works.",
)
LABELS = GeoPackageTable(
    "labels",
    (
        "product TEXT NOT NULL",
        "crop TEXT",
        "pest TEXT",
        "max_dose REAL",
        "unit TEXT",
        "waiting_days INTEGER",
        "reentry_hours REAL",
        "irac_groups TEXT",
        "max_uses INTEGER",
        "source TEXT",
    ),
    None,
    "What the labels of products allow, as the user's own table says.",
)
LOG = GeoPackageTable(
    "log",
    ("entry TEXT NOT NULL", "digest TEXT NOT NULL"),
    None,
    "What was seen, planned, advised and treated, in order; each digest is of the entry and of "
    "the digest before it.",
)
ROUTES = GeoPackageTable(
    "routes",
    (
        "day INTEGER NOT NULL",
        "date DATE",
        "revision INTEGER NOT NULL",
        "sampler TEXT",
        "starts TEXT",
        "seconds REAL",
        "drive_m REAL",
        "stops INTEGER",
        "expected REAL",
        "at_plant INTEGER",
        "seconds_left REAL",
        "digest TEXT",
        "who TEXT NOT NULL DEFAULT ''",
    ),
    "LINESTRING",
    "The line to drive on each day, for each of a team; the highest revision of a day counts.",
)
STOPS = GeoPackageTable(
    "stops",
    (
        "route INTEGER NOT NULL",
        "stop INTEGER NOT NULL",
        "plant INTEGER NOT NULL",
        "line INTEGER",
        "number INTEGER",
        "arrive_s REAL",
        "arrive TEXT",
        "chance REAL",
    ),
    "POINT",
    "The plants of each route in order.",
)
HOT_SPOTS = GeoPackageTable(
    "hot_spots",
    (
        "spot INTEGER",
        "found INTEGER",
        "inspected INTEGER",
        "plants INTEGER",
        "expected REAL",
        "p REAL",
        "q REAL",
    ),
    "MULTIPOLYGON",
    "Where finds cluster more than chance allows, as of now.",
)
LEARNT = GeoPackageTable(
    "learnt",
    ("name TEXT NOT NULL UNIQUE", "value REAL", "low REAL", "high REAL"),
    None,
    "What the inspections so far tell of the insects: best guess and interval of 90 %.",
)
MORNINGS = GeoPackageTable(
    "mornings",
    (
        "day INTEGER NOT NULL UNIQUE",
        "causes TEXT NOT NULL",
        "content TEXT NOT NULL",
        "chances BLOB NOT NULL",
    ),
    None,
    "Late mornings as they were worked out, so that they need not be again.",
)
INSPECTION_LOTS = GeoPackageTable(
    "inspection_lots",
    (
        "lot INTEGER NOT NULL UNIQUE",
        "content TEXT NOT NULL",
        "columns BLOB NOT NULL",
    ),
    None,
    "Inspections once more, many in a piece, so that those of a long season are read at once.",
)
#: of a changed inspection, since version 11: the row as it was, the digest of what a correction
#: made of it (none: it was deleted), and whether that was taken back
CORRECTED = ("before TEXT", "now TEXT", "undone INTEGER NOT NULL DEFAULT 0")
OUTSIDE_CHANGES = GeoPackageTable(
    "outside_changes",
    (
        "at TEXT",
        "layer TEXT NOT NULL",
        "row INTEGER NOT NULL",
        "what TEXT NOT NULL",
        "was TEXT",
        "batch INTEGER",
        *CORRECTED,
    ),
    None,
    "What other programs changed of what was recorded; batch: the correction that took it.",
)
CHANCE = GeoPackageTable(
    "chance",
    (),
    "POINT",
    "Plants with their chance of infestation, state, and day of the last inspection.",
)

TABLES = (
    *(META, SETTINGS, IMPORTS, ARRAYS, BATCHES, DAYS, PLANT_STATE),
    *(PLOTS, PLACES, ROWS, PLANTS, RECORDS, INSPECTIONS, TREATMENTS),
    *(ROUTES, STOPS, HOT_SPOTS, OUTSIDE_CHANGES, LEARNT, LABELS, LOG, MORNINGS, INSPECTION_LOTS),
    *phone_tables.TABLES,
)
#: layers from which everything else follows: what must be saved from a damaged file
CAUSES = (
    *(META, SETTINGS, IMPORTS, ARRAYS, BATCHES, PLOTS, PLACES, ROWS, PLANTS),
    *(RECORDS, INSPECTIONS, TREATMENTS, ROUTES, STOPS, OUTSIDE_CHANGES, LABELS, LOG),
    *phone_tables.TABLES,
)
#: what an inspection says, for people; of a trigger's row `old`
INSPECTED = (
    "coalesce(old.result, '') || ' at row ' || coalesce(old.line, '') || ', plant ' "
    "|| coalesce(old.number, '') || ' on ' || coalesce(old.date, '')"
)
#: layers that nobody may change unnoticed: what is shown or known of each row, and those of its
#: columns that make no difference
_WATCHED: dict[str, tuple[str, tuple[str, ...]]] = {
    "inspections": (
        INSPECTED,
        tuple(column.kept for column in inspection_columns.COLUMNS if not column.watched),
    ),
    "treatments": ("coalesce(old.product, '') || ' on ' || coalesce(old.date, '')", ()),
    "settings": ("old.name || ' = ' || old.value", ()),
    "batches": ("coalesce(old.source, '')", ()),
    "plots": ("coalesce(old.name, '')", ()),
    "places": ("old.kind", ()),
    "observations": ("coalesce(old.date, '')", ()),
    "arrays": ("old.name", ()),
    "routes": ("'day ' || old.day", ()),
    "stops": ("'route ' || old.route || ', stop ' || old.stop", ()),
    "labels": ("old.product", ()),
    "log": ("'entry ' || old.fid", ()),
}
#: in `fieldmon`: "1" while we write ourselves
OPEN = "open"
#: in `fieldmon`: a random name of what we wrote last, and of what is being written
WRITTEN, COMES = "written", "comes"
#: in `fieldmon`: a mark of where on which disk we wrote it last
LIES = "lies"
#: in `fieldmon`: how often a row of the inspections was added, changed or deleted, by whomever
INSPECTIONS_CHANGED = "inspections"
#: rows of inspections are kept once more in lots: a row's lot is its number without so many bits
LOT_BITS = 12

_CHANCE_VIEW = """
CREATE VIEW chance AS
  SELECT p.fid AS fid, p.geom AS geom, p.plant AS plant, p.line AS line, p.number AS number,
         s.chance AS chance, s.state AS state, s.last_inspected AS last_inspected,
         s.hot_spot AS hot_spot
  FROM plants p JOIN plant_state s ON s.fid = p.fid
"""
# the same finding twice is one, unless the first was undone
#: what is looked for, and what may be there once only, by name
INDEXES = {
    "inspections_once": "UNIQUE INDEX {} ON inspections (digest) WHERE undone = 0",
    "treatments_once": "UNIQUE INDEX {} ON treatments (digest) WHERE undone = 0",
    "routes_revision": "UNIQUE INDEX {} ON routes (day, who, revision)",
    "stops_route": "INDEX {} ON stops (route, stop)",
    "inspections_batch": "INDEX {} ON inspections (batch)",
    "inspections_beside": "INDEX {} ON inspections (digest) WHERE undone = 2",
}


def lay_out(db: sqlite3.Connection) -> None:
    """Make an empty database the file of a season, without content."""
    found(db)
    for table in TABLES:
        if table not in phone_tables.TABLES:
            create(db, table)
    db.execute(_CHANCE_VIEW)
    announce(db, CHANCE)
    for name in INDEXES:
        add_index(db, name)
    count_inspections(db)
    watch(db)
    add_styles(db)
    add_phones(db)
    add_photos_asked(db)


def add_index(db: sqlite3.Connection, name: str) -> None:
    """Add one of the `INDEXES`, where it is not there."""
    db.execute(f"CREATE {INDEXES[name].format(f'IF NOT EXISTS {name}')}")


def add_phones(db: sqlite3.Connection) -> None:
    """Make room for what phones bring; version 5 knew of none."""
    phone_tables.phones_come(db)
    add_photo_styles(db)


def add_photos_asked(db: sqlite3.Connection) -> None:
    """Make room for requests for photos; version 7 did not know of which plants one is wanted."""
    create(db, phone_tables.PHOTOS_ASKED)
    add_asked_styles(db)


def watch(db: sqlite3.Connection) -> None:
    """Let the file note by itself what other programs change of what was recorded.

    Inspections that they add are drafts, until they are recorded; they have no digest.
    """
    theirs = f"(SELECT value FROM fieldmon WHERE key = '{OPEN}') = '0'"  # noqa: S608 - as below
    for name, (was, free) in _WATCHED.items():
        columns = [row[1] for row in db.execute(f"PRAGMA table_info({name})")]
        changed = " OR ".join(f"old.{c} IS NOT new.{c}" for c in columns if c not in free)
        added = "new.digest IS NOT NULL" if name == "inspections" else "1"
        before = _as_json(INSPECTIONS) if name == "inspections" else "NULL"
        for event, row, said, held, when in (
            ("update", "old", was, before, f"({changed})"),
            ("delete", "old", was, before, "1"),
            ("insert", "new", "NULL", "NULL", added),
        ):
            db.execute(f"DROP TRIGGER IF EXISTS {name}_{event}_outside")
            db.execute(
                f"CREATE TRIGGER {name}_{event}_outside AFTER {event} ON {name} "  # noqa: S608 - names of ours
                f"WHEN {theirs} AND {when} BEGIN "
                "INSERT INTO outside_changes (at, layer, row, what, was, before) "
                f"VALUES (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'), '{name}', {row}.fid, "
                f"'{event}', {said}, {held}); END"
            )


def is_watched(db: sqlite3.Connection) -> bool:
    """Tell whether the file still notes by itself what other programs change: see `watch`."""
    names = "SELECT count(*) FROM sqlite_master WHERE type = 'trigger' AND name LIKE '%_outside'"
    return bool(db.execute(names).fetchone()[0] == 3 * len(_WATCHED))


def _as_json(table: GeoPackageTable) -> str:
    """Return in SQL all that a trigger's row `old` says but its place, as JSON.

    Other programs may refuse SQLite's own functions of JSON in a trigger. Control characters in a
    text stay as they are: it is read with ``strict=False``.
    """
    said = [
        f"""'"{c}": ' || CASE typeof(old.{c}) WHEN 'integer' THEN old.{c} """
        f"""WHEN 'real' THEN printf('%!.17g', old.{c}) WHEN 'text' THEN """
        rf"""'"' || replace(replace(old.{c}, '\', '\\'), '"', '\"') || '"' ELSE 'null' END"""
        for c in table.names
        if c != "geom"
    ]
    return "'{' || " + " || ', ' || ".join(said) + " || '}'"


def count_inspections(db: sqlite3.Connection) -> None:
    """Let the file count by itself what is done to inspections, and drop lots that are so no more.

    Of a row that another one replaces (SQL's REPLACE) SQLite tells nobody afterwards.
    """
    db.execute(
        "INSERT OR IGNORE INTO fieldmon (key, value) VALUES (?, '0')", (INSPECTIONS_CHANGED,)
    )
    count = f"UPDATE fieldmon SET value = value + 1 WHERE key = '{INSPECTIONS_CHANGED}'"  # noqa: S608 - ours
    for event, rows in (("insert", ("new",)), ("update", ("old", "new")), ("delete", ("old",))):
        lots = ", ".join(f"{row}.fid >> {LOT_BITS}" for row in rows)
        drop = f"DELETE FROM inspection_lots WHERE lot IN ({lots})"  # noqa: S608 - names of ours
        db.execute(
            f"CREATE TRIGGER inspections_{event}_counted AFTER {event} ON inspections "
            f"BEGIN {count}; {drop}; END"
        )
        if event != "delete":
            db.execute(
                f"CREATE TRIGGER inspections_{event}_replacing BEFORE {event} ON inspections "  # noqa: S608 - ours
                f"BEGIN DELETE FROM inspection_lots WHERE lot IN (SELECT fid >> {LOT_BITS} "
                "FROM inspections WHERE digest = new.digest AND undone = 0); END"
            )
