"""What a season knows already of inspections that are brought, and of those that it holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.monitoring.inspecting import batches, inspection_table
from fieldmon.monitoring.inspecting.contradictions import known_before
from fieldmon.pests.weather import DAY_S

if TYPE_CHECKING:
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.season.open_season import OpenSeason


def count_new(season: OpenSeason, inspections: Inspections) -> int:
    """Return how many `inspections` say more than what is recorded."""
    return int(np.count_nonzero(~known_before(inspections, season.inspections)))


def count_never_recorded(season: OpenSeason, inspections: Inspections) -> int:
    """Return how many `inspections` are of a plant, day and result that were never recorded.

    What was recorded and taken back since was recorded.
    """
    with season.store.reading() as db:
        known = inspection_table.ever_recorded(db)
    dates = inspections.date.astype(str).tolist()
    told = zip(inspections.plant.tolist(), dates, inspections.result.tolist(), strict=True)
    return sum(one not in known for one in told)


def number_of(season: OpenSeason, inspections: Inspections) -> int:
    """Return the number (fid) in the file of the last of some inspections with times."""
    last = inspections.take(slice(len(inspections) - 1, len(inspections)))
    at = inspection_table.time_text(float(last.second[0]) % DAY_S)
    said = int(last.plant[0]), str(last.date[0]), at
    with season.store.reading() as db:
        (number,) = db.execute(
            "SELECT fid FROM inspections WHERE plant = ? AND date >= ? AND undone = 0 "
            "ORDER BY time = ? DESC, date, fid DESC",
            said,
        ).fetchone()
    return int(number)


def corrected_by(season: OpenSeason) -> dict[tuple[object, ...], str]:
    """Return who corrected inspections that count, by plant, day (ISO), result and count."""
    with season.store.reading() as db:
        return batches.corrected_by(db)
