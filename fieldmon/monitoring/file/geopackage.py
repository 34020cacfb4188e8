"""GeoPackage tables in SQLite: what the standard asks for, and geometries in and out.

Written through SQLite itself, not through GDAL: only so is a day's work one transaction.
Source: OGC 12-128r18, GeoPackage Encoding Standard 1.3.1, clauses 1.1, 2.1 and annex C.
"""

from __future__ import annotations

import sqlite3
import zlib
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from fieldmon.plot.projection import turned_to

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

APPLICATION_ID = 0x47504B47  # "GPKG"
_USER_VERSION = 10301
WGS84 = 4326
_POINT_BYTES = 29
# what is known of the plot stays as it was given, to the bit
_AS_GIVEN = {"plots", "places", "observations"}
_HEADER = b"GP\x00\x01" + WGS84.to_bytes(4, "little")  # little endian, no envelope

_WGS84_WKT = (
    'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,'
    'AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,'
    'AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],'
    'AUTHORITY["EPSG","4326"]]'
)
_TABLES = """
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
"""
_SYSTEMS = (
    ("Undefined Cartesian SRS", -1, "NONE", -1, "undefined", "undefined Cartesian system"),
    ("Undefined geographic SRS", 0, "NONE", 0, "undefined", "undefined geographic system"),
    ("WGS 84 geodetic", WGS84, "EPSG", WGS84, _WGS84_WKT, "longitude/latitude, degrees"),
)


@dataclass(frozen=True)
class GeoPackageTable:
    """A table of a GeoPackage.

    Parameters
    ----------
    name
        As programs see it.
    columns
        SQL definitions of its columns, after ``fid`` and ``geom``.
    shape
        Geometry type (``"POINT"``...), or None for a table without geometry.
    about
        A sentence for whoever opens the file.
    key
        Name of the column that numbers the rows.
    """

    name: str
    columns: tuple[str, ...]
    shape: str | None
    about: str
    key: str = "fid"

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Return the names of the columns but the key, geometry first where there is one."""
        own = tuple(column.split()[0] for column in self.columns)
        return ("geom", *own) if self.shape else own


def found(db: sqlite3.Connection) -> None:
    """Make an empty database a GeoPackage in WGS84 degrees."""
    db.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    db.execute(f"PRAGMA user_version = {_USER_VERSION}")
    for statement in _TABLES.split(";\n"):  # executescript() would end the transaction
        db.execute(statement)
    db.executemany("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?)", _SYSTEMS)


def create(db: sqlite3.Connection, table: GeoPackageTable) -> None:
    """Add a table, and tell the GeoPackage's contents of it."""
    geom = (f"geom {table.shape}",) if table.shape else ()
    key = f"{table.key} INTEGER PRIMARY KEY AUTOINCREMENT"
    body = ", ".join((key, *geom, *table.columns))
    db.execute(f"CREATE TABLE {table.name} ({body})")
    announce(db, table)


def add_column(db: sqlite3.Connection, table: str, column: str) -> None:
    """Add a column by its SQL definition, unless the table has it: it may be made as of today."""
    there = {row[1] for row in db.execute(f"PRAGMA table_info({table})")}
    if column.split(maxsplit=1)[0] not in there:
        db.execute(f"ALTER TABLE {table} ADD COLUMN {column}")


def announce(db: sqlite3.Connection, table: GeoPackageTable) -> None:
    """Tell the GeoPackage's contents of a table or view that exists."""
    kind, srs = ("features", WGS84) if table.shape else ("attributes", None)
    db.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, srs_id) "
        "VALUES (?, ?, ?, ?, ?)",
        (table.name, kind, table.name, table.about, srs),
    )
    if table.shape:
        db.execute(
            "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, 0, 0)",
            (table.name, table.shape, WGS84),
        )


def insert(
    db: sqlite3.Connection, table: GeoPackageTable, rows: Sequence[tuple[object, ...]]
) -> None:
    """Add rows, each with a value for every one of the table's `names`."""
    if table.shape and table.name not in _AS_GIVEN and rows:
        rows = [(beside_plot(db, row[0]), *row[1:]) for row in rows] if _across(db) else rows
    marks = ", ".join("?" * len(table.names))
    into = f"INSERT INTO {table.name} ({', '.join(table.names)}) VALUES ({marks})"  # noqa: S608 - names of ours
    db.executemany(into, rows)


def beside_plot(db: sqlite3.Connection, geom: Any) -> Any:  # noqa: ANN401 - None where nothing lies
    """Return a geometry where the season's plot lies, which may be drawn on across longitude 180.

    Else a part of a layer lies at the other end of the world.
    """
    own = _across(db)
    if own is None or geom is None:
        return geom
    return blob(turned_to(geometry(geom), (own[0] + own[2]) / 2))


def _across(db: sqlite3.Connection) -> tuple[float, float, float, float] | None:
    """Return how far the season's plot reaches if that is across longitude 180."""
    reach: tuple[Any, ...] | None = db.execute(
        "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'plots'"
    ).fetchone()
    if reach is None or None in reach or (reach[0] >= -180.0 and reach[2] <= 180.0):
        return None
    return reach


def touch(
    db: sqlite3.Connection, name: str, bounds: tuple[float, float, float, float] | None = None
) -> None:
    """Note in the contents that a table changed, and how far it reaches now.

    Views that show something of it have changed with it.
    """
    db.execute(
        "UPDATE gpkg_contents SET last_change = strftime('%Y-%m-%dT%H:%M:%fZ','now') "
        "WHERE table_name = ?1 OR table_name IN (SELECT name FROM sqlite_master "
        "WHERE type = 'view' AND instr(sql, ' ' || ?1 || ' '))",
        (name,),
    )
    if bounds is not None:
        if (own := _across(db)) is not None and name not in _AS_GIVEN:
            bounds = own
        db.execute(
            "UPDATE gpkg_contents SET min_x = ?, min_y = ?, max_x = ?, max_y = ? "
            "WHERE table_name = ?",
            (*bounds, name),
        )


def point_blobs(lonlat: NDArray[np.float64]) -> list[bytes]:
    """Return points ``(n, 2)`` as GeoPackage geometries."""
    blob = np.empty((len(lonlat), _POINT_BYTES), np.uint8)
    blob[:, :8] = np.frombuffer(_HEADER, np.uint8)
    blob[:, 8:13] = np.frombuffer(b"\x01\x01\x00\x00\x00", np.uint8)
    blob[:, 13:] = np.ascontiguousarray(lonlat, "<f8").view(np.uint8).reshape(-1, 16)
    packed = blob.tobytes()
    return [packed[i : i + _POINT_BYTES] for i in range(0, len(packed), _POINT_BYTES)]


def blob(geometry: shapely.Geometry) -> bytes:
    """Return a geometry as a GeoPackage geometry, bit for bit."""
    flags = 0x01 | (0x10 if shapely.is_empty(geometry) else 0)
    wkb: bytes = shapely.to_wkb(geometry, byte_order=1)
    return b"GP\x00" + bytes([flags]) + WGS84.to_bytes(4, "little") + wkb


def unpacked(packed: bytes, most: int) -> bytes:
    """Return what bytes of zlib unpack to.

    Raise `sqlite3.DatabaseError`, as SQLite does of a damaged file, if that is cut short or more
    than `most` bytes: of a stranger's file it may be more than the memory holds.
    """
    unpack = zlib.decompressobj()
    try:
        data = unpack.decompress(packed, max(most, 0) + 1)
    except zlib.error as error:
        raise sqlite3.DatabaseError(f"what is packed is no zlib: {error}") from error
    if len(data) > most or not unpack.eof:
        raise sqlite3.DatabaseError(f"what is packed is cut short, or more than {most} bytes")
    return data


def geometry(blob: bytes) -> Any:  # noqa: ANN401 - whatever geometry it is
    """Return the geometry that a GeoPackage geometry holds, whoever wrote it."""
    envelope = (0, 32, 48, 48, 64)[(blob[3] >> 1) & 0b111]
    return shapely.from_wkb(blob[8 + envelope :])
