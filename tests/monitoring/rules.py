"""What the GeoPackage standard asks of a file, checked with nothing but SQLite and GDAL.

OGC 12-128r18 clauses 1.1.1 to 2.1 and 2.3.2, and OGC 18-000 (related tables).
"""

import sqlite3
from contextlib import closing

import pyogrio
import shapely


def keeps_the_rules(path):
    """Hold a season's file to the standard; every layer and photo is read by GDAL too."""
    with closing(sqlite3.connect(path)) as db:
        _is_whole(db)
        _contents_are_there(db)
        _geometries_are_what_they_say(db)
        _relations_lead_somewhere(db)
        layers = [name for (name,) in db.execute("SELECT table_name FROM gpkg_geometry_columns")]
    assert set(layers) <= {name for name, _ in pyogrio.list_layers(path)}
    for name in layers:
        pyogrio.read_dataframe(path, layer=name)


def _is_whole(db):
    assert db.execute("PRAGMA application_id").fetchone() == (0x47504B47,)
    assert db.execute("PRAGMA user_version").fetchone()[0] >= 10200
    assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert db.execute("PRAGMA foreign_key_check").fetchall() == []


def _columns(db, table):
    return {row[1]: row for row in db.execute(f"PRAGMA table_info({table})")}


def _contents_are_there(db):
    there = {name for (name,) in db.execute("SELECT name FROM sqlite_master")}
    kinds = db.execute("SELECT table_name, data_type, srs_id FROM gpkg_contents").fetchall()
    for name, kind, system in kinds:
        assert name in there
        assert kind in {"features", "attributes"}
        known = "SELECT 1 FROM gpkg_spatial_ref_sys WHERE srs_id = ?"
        assert system is None or db.execute(known, (system,)).fetchone()
        tables = db.execute(
            "SELECT 1 FROM sqlite_master WHERE name = ? AND type = 'table'", (name,)
        )
        if tables.fetchone():  # requirement 29, 119: one integer primary key
            keys = [row for row in _columns(db, name).values() if row[5]]
            assert [row[2].upper() for row in keys] == ["INTEGER"]


def _geometries_are_what_they_say(db):
    kinds = dict(db.execute("SELECT table_name, data_type FROM gpkg_contents"))
    rows = "SELECT table_name, column_name, geometry_type_name, srs_id FROM gpkg_geometry_columns"
    for table, column, kind, system in db.execute(rows).fetchall():
        assert kinds[table] == "features"
        assert column in _columns(db, table)
        for (blob,) in db.execute(f"SELECT {column} FROM {table} WHERE {column} NOTNULL"):  # noqa: S608
            assert blob[:3] == b"GP\x00"
            assert int.from_bytes(blob[4:8], "little") == system
            made = shapely.from_wkb(blob[8:])
            assert kind in {"GEOMETRY", made.geom_type.upper()}


def _relations_lead_somewhere(db):
    for base, base_key, related, related_key, kind, mapping in db.execute(
        "SELECT base_table_name, base_primary_column, related_table_name, related_primary_column, "
        "relation_name, mapping_table_name FROM gpkgext_relations"
    ).fetchall():
        assert base_key in _columns(db, base)
        assert {related_key, "data", "content_type"} <= set(_columns(db, related))
        assert kind == "media"
        assert {"base_id", "related_id"} <= set(_columns(db, mapping))
        told = "SELECT 1 FROM gpkg_extensions WHERE table_name = ? AND column_name IS NULL"
        for name in ("gpkgext_relations", mapping):
            assert db.execute(told, (name,)).fetchone()
        lost = (
            f"SELECT count(*) FROM {mapping} WHERE base_id NOT IN (SELECT {base_key} FROM {base}) "  # noqa: S608
            f"OR related_id NOT IN (SELECT {related_key} FROM {related})"
        )
        assert db.execute(lost).fetchone() == (0,)
