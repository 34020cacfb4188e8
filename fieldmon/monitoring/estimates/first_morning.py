"""The chance map of a season's first morning: worked out once, and kept in the file.

It follows from the plot, which never changes, from the records from before and from what is chosen.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import shapely

import fieldmon.compute
import fieldmon.infestation
import fieldmon.plot
from fieldmon.compute.digest import digest
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert

if TYPE_CHECKING:
    import sqlite3
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.prior.prior_settings import PriorSettings

# the mornings that follow have the numbers of their days
_DAY = 0


def causes(db: sqlite3.Connection, begins: date, settings: PriorSettings) -> str:
    """Return a name for all from which the first morning follows, our own rules among it."""
    said = [
        value
        for table in (schema.ARRAYS, schema.PLACES, schema.RECORDS)
        for row in db.execute(f"SELECT * FROM {table.name} ORDER BY fid")  # noqa: S608 - ours
        for value in row
    ]
    return digest(_rules(), begins, settings, *said)


def take(db: sqlite3.Connection, follows_from: str) -> NDArray[np.float64] | None:
    """Return the chances ``(n,)`` that the file keeps; None: they are not those that follow."""
    row = db.execute(
        "SELECT content, chances FROM mornings WHERE day = ? AND causes = ?", (_DAY, follows_from)
    ).fetchone()
    if row is None or row[0] != digest(row[1]):
        return None
    return np.frombuffer(row[1], "<f8").astype(np.float64)


def keep(db: sqlite3.Connection, follows_from: str, chance: NDArray[np.float64]) -> None:
    """Keep the chances ``(n,)`` in the file, within the transaction that changes it."""
    if take(db, follows_from) is None:
        kept = np.asarray(chance, "<f8").tobytes()
        db.execute("DELETE FROM mornings WHERE day = ?", (_DAY,))
        insert(db, schema.MORNINGS, [(_DAY, follows_from, digest(kept), kept)])


@cache
def _rules() -> str:
    """Return a name for the programs that work it out: others do so anew."""
    rooms = (fieldmon.compute, fieldmon.infestation, fieldmon.plot)
    folders = [Path(str(room.__file__)).parent for room in rooms]
    files = [file.read_bytes() for folder in folders for file in sorted(folder.rglob("*.py"))]
    return digest(shapely.__version__, np.__version__, *files)
