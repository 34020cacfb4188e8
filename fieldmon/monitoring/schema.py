"""The tables of a season's file, and how an old file becomes a new one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring import phone_tables
from fieldmon.monitoring.geopackage import GeoPackageTable, announce, create, found
from fieldmon.monitoring.qgis_styles import add_photo_styles, add_styles

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable

VERSION = 3

META = GeoPackageTable(
    "fieldmon", ("key TEXT NOT NULL UNIQUE", "value TEXT"), None, "What this file is."
)
SETTINGS = GeoPackageTable(
    "settings",
    ("name TEXT NOT NULL", "value TEXT NOT NULL", "changed TEXT NOT NULL"),
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
    ),
    None,
    "Each day's figures after its work, and the digest of its morning's chance map.",
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
    "places", ("kind TEXT NOT NULL",), "GEOMETRY", "Gate, paths and no-go areas."
)
ROWS = GeoPackageTable("rows", ("line INTEGER", "plants INTEGER"), "LINESTRING", "Rows of plants.")
PLANTS = GeoPackageTable(
    "plants",
    ("plant INTEGER NOT NULL", "line INTEGER", "number INTEGER"),
    "POINT",
    "Plants: number in this file, row and place in the row as people count.",
)
OBSERVATIONS = GeoPackageTable(
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
INSPECTIONS = GeoPackageTable(
    "inspections",
    (
        "plant INTEGER",
        "line INTEGER",
        "number INTEGER",
        "day INTEGER",
        "date DATE",
        "time TEXT",
        "result TEXT",
        "count REAL",
        "who TEXT",
        "notes TEXT",
        "batch INTEGER",
        "digest TEXT",
        "undone INTEGER DEFAULT 0",
    ),
    "POINT",
    "What was found at which plant: clean, found or skipped.",
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
    ),
    "MULTIPOLYGON",
    "Areas treated, and how well it works.",
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
    ),
    "LINESTRING",
    "The line to drive on each day; the highest revision of a day counts.",
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
CHANCE = GeoPackageTable(
    "chance",
    (),
    "POINT",
    "Plants with their chance of infestation, state, and day of the last inspection.",
)

TABLES = (
    *(META, SETTINGS, IMPORTS, ARRAYS, BATCHES, DAYS, PLANT_STATE),
    *(PLOTS, PLACES, ROWS, PLANTS, OBSERVATIONS, INSPECTIONS, TREATMENTS),
    *(ROUTES, STOPS, HOT_SPOTS),
    *phone_tables.TABLES,
)
#: layers from which everything else follows: what must be saved from a damaged file
CAUSES = (
    *(META, SETTINGS, IMPORTS, ARRAYS, BATCHES, PLOTS, PLACES, ROWS, PLANTS),
    *(OBSERVATIONS, INSPECTIONS, TREATMENTS, ROUTES, STOPS),
    *phone_tables.TABLES,
)

_CHANCE_VIEW = """
CREATE VIEW chance AS
  SELECT p.fid AS fid, p.geom AS geom, p.plant AS plant, p.line AS line, p.number AS number,
         s.chance AS chance, s.state AS state, s.last_inspected AS last_inspected,
         s.hot_spot AS hot_spot
  FROM plants p JOIN plant_state s ON s.fid = p.fid
"""
# the same finding twice is one, unless the first was undone
_INDEXES = (
    "CREATE UNIQUE INDEX inspections_once ON inspections (digest) WHERE undone = 0",
    "CREATE UNIQUE INDEX treatments_once ON treatments (digest) WHERE undone = 0",
    "CREATE UNIQUE INDEX routes_revision ON routes (day, revision)",
    "CREATE INDEX stops_route ON stops (route, stop)",
)


def lay_out(db: sqlite3.Connection) -> None:
    """Make an empty database the file of a season, without content."""
    found(db)
    for table in TABLES:
        if table not in phone_tables.TABLES:
            create(db, table)
    db.execute(_CHANCE_VIEW)
    announce(db, CHANCE)
    for index in _INDEXES:
        db.execute(index)
    add_styles(db)
    _phones_come(db)


def _treatments_come(db: sqlite3.Connection) -> None:
    """Version 1 knew neither treatments nor routes planned half-way."""
    create(db, TREATMENTS)
    db.execute(_INDEXES[1])
    db.execute("ALTER TABLE routes ADD COLUMN at_plant INTEGER")
    db.execute("ALTER TABLE routes ADD COLUMN seconds_left REAL")


def _phones_come(db: sqlite3.Connection) -> None:
    """Version 2 knew of no phones."""
    phone_tables.phones_come(db)
    add_photo_styles(db)


#: what makes a file of version k one of version k + 1
MIGRATIONS: dict[int, Callable[[sqlite3.Connection], None]] = {1: _treatments_come, 2: _phones_come}
