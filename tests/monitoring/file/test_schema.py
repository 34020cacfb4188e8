"""The tables of a season's file: a GeoPackage by its own rules, whatever version it was made by."""

import sqlite3
from contextlib import closing

import numpy as np
import pyogrio
import pytest

from fieldmon.monitoring import Season
from fieldmon.monitoring.file import schema
from tests.monitoring.seasons import BEGINS


def test_every_table_is_laid_out_with_its_columns_and_told_of(db):
    told = {name for (name,) in db.execute("SELECT table_name FROM gpkg_contents")}
    for table in (*schema.TABLES, schema.CHANCE):
        assert table.name in told
        there = [name for _, name, *_ in db.execute(f"PRAGMA table_info({table.name})")]
        assert set(table.names) <= set(there)
        assert there[0] == table.key


def test_what_must_be_saved_is_all_but_what_follows_from_it():
    derived = {schema.DAYS, schema.PLANT_STATE, schema.HOT_SPOTS, schema.LEARNT}
    derived |= {schema.MORNINGS, schema.INSPECTION_LOTS}
    assert set(schema.TABLES) - set(schema.CAUSES) == derived


def test_the_same_finding_counts_once_unless_the_first_was_undone(db):
    add = "INSERT INTO inspections (digest, undone) VALUES ('abc', ?)"
    db.execute(add, (1,))
    db.execute(add, (1,))
    db.execute(add, (0,))
    with pytest.raises(sqlite3.IntegrityError):
        db.execute(add, (0,))


def test_gdal_opens_every_layer_where_it_is(path):
    season = Season(path)
    layers = dict(pyogrio.list_layers(path))
    shown = {table.name for table in (*schema.TABLES, schema.CHANCE) if table.shape}
    assert shown <= set(layers)
    plants = pyogrio.read_dataframe(path, layer="plants")
    assert np.abs(plants.get_coordinates().to_numpy() - season.plot.grid.lonlat()).max() < 1e-12
    assert plants.crs.to_epsg() == 4326
    chance = pyogrio.read_dataframe(path, layer="chance")
    assert chance["chance"].to_numpy() == pytest.approx(season.evening(BEGINS), abs=1e-6)
    assert set(chance["state"]) == {"never inspected", "looked clean", "found infested"}
    inspections = pyogrio.read_dataframe(path, layer="inspections")
    assert (inspections["result"] == "found").sum() == 3
    line = pyogrio.read_dataframe(path, layer="routes").geometry.iloc[0]
    route = season.plan(BEGINS, keep=False)
    assert line.length > 0
    assert route.scene.day == 0
    assert pyogrio.read_dataframe(path, layer="plots")["name"].iloc[0] == "מטע Paran"


def test_the_file_is_a_geopackage_by_its_own_rules(path):
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA application_id").fetchone() == (0x47504B47,)
        assert db.execute("PRAGMA user_version").fetchone()[0] >= 10200
        assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert db.execute("PRAGMA foreign_key_check").fetchall() == []
        named = {name for (name,) in db.execute("SELECT table_name FROM gpkg_contents")}
        there = {name for (name,) in db.execute("SELECT name FROM sqlite_master")}
        assert named <= there
        for table, kind in db.execute(
            "SELECT table_name, geometry_type_name FROM gpkg_geometry_columns"
        ):
            for (blob,) in db.execute(f"SELECT geom FROM {table} WHERE geom NOTNULL"):  # noqa: S608
                assert blob[:3] == b"GP\x00"
                assert int.from_bytes(blob[4:8], "little") == 4326
                assert kind
