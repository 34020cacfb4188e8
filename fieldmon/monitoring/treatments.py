"""Treatments as the season's file keeps them: areas, and how well it works there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.monitoring import schema
from fieldmon.monitoring.geopackage import blob, geometry, touch
from fieldmon.monitoring.history import Treatment

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable

    import shapely
    from numpy.typing import NDArray
    from shapely import MultiPolygon


def store(
    db: sqlite3.Connection,
    treatment: Treatment,
    said: tuple[MultiPolygon, str, str],
    batch: int,
) -> int:
    """Keep a treatment that is not there yet; return how many were new, 1 or 0.

    `said` is its area (lon/lat), its date and the product.
    """
    area, on, product = said
    n_plants = int(np.count_nonzero(treatment.plants))
    values = (treatment.day, on, treatment.efficacy, product, n_plants)
    mark = digest((values, blob(area)), length=24, end=b"")
    names = schema.TREATMENTS.names
    cursor = db.execute(
        f"INSERT OR IGNORE INTO treatments ({', '.join(names)}) "  # noqa: S608 - names of ours
        f"VALUES ({', '.join('?' * len(names))})",
        (blob(area), *values, batch, mark, 0),
    )
    touch(db, schema.TREATMENTS.name, area.bounds)
    return cursor.rowcount


def load(
    db: sqlite3.Connection, inside: Callable[[shapely.Geometry], NDArray[np.bool_]]
) -> tuple[Treatment, ...]:
    """Return the treatments that count; `inside` tells which plants stand in an area."""
    kept = db.execute("SELECT day, geom, efficacy FROM treatments WHERE undone = 0 ORDER BY fid")
    return tuple(Treatment(day, inside(geometry(geom)), share) for day, geom, share in kept)
