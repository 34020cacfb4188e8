"""What phones tell, for tests."""

import sqlite3
import uuid
from contextlib import closing
from datetime import UTC, datetime, timedelta

import numpy as np

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring.file import phone_tables, schema
from fieldmon.monitoring.phones.sent_findings import Finding
from tests.monitoring.seasons import BEGINS

#: 09:00 on the plot (Israel, summer time)
NOW = datetime(2026, 4, 6, 6, 0, tzinfo=UTC)
JPEG = b"\xff\xd8\xff\xe0" + bytes(range(256)) * 8


def a_finding(plant=0, result=CLEAN, **more):
    return Finding(
        **({"id": str(uuid.uuid4()), "at": NOW, "plant": plant, "result": result} | more)
    )


def a_days_findings(season, n=12, seed=0):
    """Return what a phone tells of the first plants of a day's route, a minute each."""
    rng = np.random.default_rng(seed)
    plants = season.plan(BEGINS, keep=False).route.plant[:n].tolist()
    return [
        a_finding(plant, FOUND if rng.random() < 0.2 else CLEAN, at=NOW - timedelta(minutes=n - k))
        for k, plant in enumerate(plants)
    ]


def told(season):
    """Return the ids told, and the inspections that count, from the season's file."""
    with season.store.reading() as db:
        ids = [one for (one,) in db.execute("SELECT id FROM tellings ORDER BY fid")]
        rows = db.execute(
            "SELECT t.id, i.plant, i.result FROM tellings t JOIN inspections i "
            "ON i.fid = t.inspection WHERE i.undone = 0"
        ).fetchall()
    return ids, rows


def without_records(path):
    """Make a file one of version 6: without labels, a log, and what was said of applications."""
    with closing(sqlite3.connect(path)) as db:
        triggers = db.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall()
        for (name,) in triggers:
            db.execute(f"DROP TRIGGER {name}")
        for name in ("labels", "log", "mornings", "photos_asked", "inspection_lots"):
            db.execute(f"DROP TABLE {name}")
            db.execute("DELETE FROM gpkg_geometry_columns WHERE table_name = ?", (name,))
            db.execute("DELETE FROM gpkg_contents WHERE table_name = ?", (name,))
        db.execute("DROP INDEX inspections_batch")
        older = {row[1] for row in db.execute("PRAGMA table_info(treatments)")}
        for name in older & {column.split()[0] for column in schema.APPLIED}:
            db.execute(f"ALTER TABLE treatments DROP COLUMN {name}")
        db.execute("ALTER TABLE days DROP COLUMN causes")
        db.execute("DELETE FROM fieldmon WHERE key IN ('log', 'inspections')")
        db.execute("UPDATE fieldmon SET value = '6' WHERE key = 'version'")
        db.commit()


def without_phones(path):
    """Make a file one of version 5."""
    without_records(path)
    ours = [table.name for table in phone_tables.TABLES]
    views = ["inspections_photos", "photo_places"]
    with closing(sqlite3.connect(path)) as db:
        for view in views:
            db.execute(f"DROP VIEW {view}")
        for table in (*ours, "gpkgext_relations", "gpkg_extensions"):
            db.execute(f"DROP TABLE IF EXISTS {table}")
        for name in (*ours, *views):
            db.execute("DELETE FROM gpkg_geometry_columns WHERE table_name = ?", (name,))
            db.execute("DELETE FROM gpkg_contents WHERE table_name = ?", (name,))
            db.execute("DELETE FROM layer_styles WHERE f_table_name = ?", (name,))
        db.execute("UPDATE fieldmon SET value = '5' WHERE key = 'version'")
        db.commit()
