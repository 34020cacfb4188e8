"""The label table as the season's file keeps it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel, irac_groups
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert, touch

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable


def write(db: sqlite3.Connection, labels: Iterable[ProductLabel]) -> None:
    """Let these be the labels, instead of those before."""
    rows = [
        (
            *(one.product, one.crop or None, one.pest or None),
            None if one.max_dose is None else float(one.max_dose.value),
            None if one.max_dose is None else one.max_dose.unit,
            *(one.waiting_days, one.reentry_hours, "+".join(one.irac_groups) or None),
            *(one.max_uses, one.source or None),
        )
        for one in labels
    ]
    db.execute("DELETE FROM labels")
    insert(db, schema.LABELS, rows)
    touch(db, schema.LABELS.name)


def read(db: sqlite3.Connection) -> tuple[ProductLabel, ...]:
    """Return the labels."""
    names = schema.LABELS.names
    made = []
    for values in db.execute(f"SELECT {', '.join(names)} FROM labels ORDER BY fid"):  # noqa: S608
        row = dict(zip(names, values, strict=True))
        dose, unit = row.pop("max_dose"), row.pop("unit")
        row["irac_groups"] = irac_groups(row["irac_groups"] or "")
        for name in ("crop", "pest", "source"):
            row[name] = row[name] or ""
        made.append(ProductLabel(**row, max_dose=None if dose is None else Dose(dose, unit)))
    return tuple(made)
