"""Seasons that another program has open, and what it leaves beside them."""

import shutil
import sqlite3
from contextlib import closing


def as_qgis(path):
    """Open a season as QGIS does: changes stand in a file beside it until it is closed."""
    db = sqlite3.connect(path, isolation_level=None)
    assert db.execute("PRAGMA journal_mode = WAL").fetchone() == ("wal",)
    db.execute("PRAGMA wal_autocheckpoint = 0")
    return db


def beside(path):
    return sorted(file.name for file in path.parent.iterdir() if file.name.startswith(path.name))


def left_by_a_crash(path, folder):
    """Return a copy of a season as another program leaves it that ends in the midst of its work."""
    with closing(as_qgis(path)) as db:
        db.execute("UPDATE inspections SET notes = 'from QGIS' WHERE fid = 5")
        db.execute("UPDATE gpkg_contents SET description = 'QGIS was here'")
        folder.mkdir()
        for name in (path.name, f"{path.name}-wal"):
            shutil.copy(path.with_name(name), folder)
    return folder / path.name
