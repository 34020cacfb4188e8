"""A file of an older version becomes one of today, whichever it was."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import timedelta

import numpy as np

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.file import geopackage, migrations, schema
from fieldmon.monitoring.inspecting import inspection_lots
from fieldmon.planning.members import team_of
from tests.monitoring.phone import without_phones
from tests.monitoring.seasons import BEGINS, a_season, state


def test_every_older_version_has_a_way_to_the_next():
    assert sorted(migrations.MIGRATIONS) == list(range(1, schema.VERSION))


def test_a_column_that_comes_later_comes_to_a_table_that_was_made_with_it_too():
    with closing(sqlite3.connect(":memory:")) as db:
        geopackage.found(db)
        geopackage.create(db, schema.TREATMENTS)
        for column in (*schema.APPLIED, "later TEXT", "later TEXT"):
            geopackage.add_column(db, "treatments", column)
        named = [row[1] for row in db.execute("PRAGMA table_info(treatments)")]
    assert named == ["fid", *schema.TREATMENTS.names, "later"]


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


def test_lots_of_a_file_of_version_12_are_made_anew(tmp_path, monkeypatch):
    season = a_season(tmp_path / "season.gpkg")
    monkeypatch.setattr(schema, "LOT_BITS", 2)
    plants = np.arange(8)
    season.record(Inspections.of(plants, plants % 2, np.datetime64(BEGINS)))
    with closing(sqlite3.connect(season.path)) as db:
        assert db.execute("SELECT count(*) FROM inspection_lots").fetchone() != (0,)
        triggers = db.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall()
        for (name,) in triggers:
            if name.endswith("_outside"):
                db.execute(f"DROP TRIGGER {name}")
        db.execute("ALTER TABLE inspections DROP COLUMN detects")
        db.execute("UPDATE fieldmon SET value = '12' WHERE key = 'version'")
        db.commit()
    with Season(season.path).store.reading() as db:
        assert db.execute("SELECT count(*) FROM inspection_lots").fetchone() == (0,)
        assert inspection_lots.load(db, BEGINS).plant.tolist() == plants.tolist()
