"""The tables of a season's file: a GeoPackage by its own rules, whatever version it was made by."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pyogrio
import pytest

from fieldmon.monitoring import Season, schema
from fieldmon.planning.members import team_of
from tests.monitoring.phone import without_phones
from tests.monitoring.seasons import BEGINS, state


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


def test_every_older_version_has_a_way_to_the_next():
    assert sorted(schema.MIGRATIONS) == list(range(1, schema.VERSION))


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


def as_of_version_2(db):
    """Take away what version 2 did not know: changes from outside, who drives, and teams."""
    triggers = db.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall()
    for (name,) in triggers:
        db.execute(f"DROP TRIGGER {name}")
    db.execute("DROP TABLE outside_changes")
    db.execute("DELETE FROM gpkg_contents WHERE table_name = 'outside_changes'")
    db.execute("DROP TABLE learnt")
    db.execute("DELETE FROM gpkg_contents WHERE table_name = 'learnt'")
    db.execute("DROP INDEX routes_revision")
    db.execute("ALTER TABLE routes DROP COLUMN who")
    db.execute("CREATE UNIQUE INDEX routes_revision ON routes (day, revision)")
    db.execute("DELETE FROM settings WHERE name = 'team'")
    db.execute("UPDATE fieldmon SET value = '2' WHERE key = 'version'")


def test_a_file_of_version_2_becomes_one_of_today_and_can_have_a_team(path):
    without_phones(path)
    with closing(sqlite3.connect(path)) as db:
        as_of_version_2(db)
        db.commit()
    season = Season(path)
    alone = season.settings
    assert alone.team == ()
    assert len(season.kept_route(BEGINS))
    season.change(replace(alone, team=team_of(2, alone.robot)), alone)
    first, second = season.plan_each(BEGINS + timedelta(days=1))
    assert not set(first.route.plant) & set(second.route.plant)
    assert season.undo_change().team == ()
    assert state(path) == 12


def test_a_file_of_version_1_becomes_one_of_today(path):
    without_phones(path)
    with closing(sqlite3.connect(path)) as db:  # made by hand: it was never released
        as_of_version_2(db)
        db.execute("DROP TABLE treatments")
        db.execute("DELETE FROM gpkg_geometry_columns WHERE table_name = 'treatments'")
        db.execute("DELETE FROM gpkg_contents WHERE table_name = 'treatments'")
        db.execute("ALTER TABLE routes DROP COLUMN at_plant")
        db.execute("ALTER TABLE routes DROP COLUMN seconds_left")
        db.execute("UPDATE fieldmon SET value = '1' WHERE key = 'version'")
        db.commit()
    season = Season(path)
    assert season.status(BEGINS).found == 3
    season.treat(BEGINS, 0.5)
    season.plan(BEGINS)
    assert state(path) == 12
