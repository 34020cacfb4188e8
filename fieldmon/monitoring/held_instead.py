"""Results that hold in place of what they contradict: corrections, a batch of their own."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.inspection_columns import BESIDE
from fieldmon.infestation.inspections import RESULT_NAMES, SKIPPED
from fieldmon.monitoring import batches, copy_corrections, outside_changes
from fieldmon.monitoring.geopackage import touch
from fieldmon.monitoring.inspection_table import time_text
from fieldmon.monitoring.outside_changes import OutsideChange
from fieldmon.monitoring.schema import INSPECTED, INSPECTIONS

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, RowLabel

_OTHERWISE = (
    f"SELECT fid, {INSPECTED} FROM inspections AS old WHERE plant = ? AND date = ? "  # noqa: S608 - ours
    "AND undone = 0 AND result NOT IN (?, ?) ORDER BY fid"
)
# when, and what is said beside it, stays where nobody says otherwise
_BESIDE = ", ".join(f"{one.kept} = coalesce(nullif(?, ''), {one.kept})" for one in BESIDE)
_SAYS = (
    f"UPDATE inspections SET result = ?, count = ?, time = coalesce(?, time), {_BESIDE} "  # noqa: S608 - ours
    "WHERE fid = ?"
)


def take(
    db: sqlite3.Connection,
    inspections: Inspections,
    plot: tuple[PlantGrid, RowLabel],
    settings: MonitoringSettings,
    said: tuple[str, str],
) -> tuple[str, ...]:
    """Let results hold in place of those held of their plants and days; say what, one by one.

    Those held stand back, until the corrections are taken back. `said` is where the results come
    from, and whose they are.
    """
    source, who = said
    batch = batches.begin(db, "corrections", source, who)
    taken = []
    for k in range(len(inspections)):
        one = inspections.take(slice(k, k + 1))
        result = RESULT_NAMES[int(one.result[0])]
        key = int(one.plant[0]), str(one.date[0]), result, RESULT_NAMES[SKIPPED]
        (row, was), *others = db.execute(_OTHERWISE, key).fetchall()
        change = OutsideChange(INSPECTIONS.name, row, "update", was)
        change = replace(change, before=copy_corrections.as_it_is(db, row))
        count = None if np.isnan(one.count[0]) else float(one.count[0])
        beside = {each.name: each.to_file(getattr(one, each.name))[0] for each in BESIDE}
        beside["who"] = beside["who"] or who
        told = count, time_text(float(one.second[0])), *beside.values()
        db.execute(_SAYS, (result, *told, row))
        now = outside_changes.take_row(db, change, plot, settings, batch)
        outside_changes.keep_before(db, change, plot[0])
        copy_corrections.note(db, change, batch, now)
        taken.append(change)
        for fid, stood in others:
            other = OutsideChange(INSPECTIONS.name, fid, "delete", stood)
            copy_corrections.stand_back(db, other, batch)
            taken.append(other)
    batches.count_findings(db)
    batches.end(db, batch, len(inspections))
    touch(db, INSPECTIONS.name)
    return tuple(outside_changes.in_words(db, one) for one in taken)
