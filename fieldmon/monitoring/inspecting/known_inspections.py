"""What a season knows already of inspections that are brought, and of those that it holds."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.inspections import SKIPPED
from fieldmon.monitoring.inspecting import (
    batches,
    inspection_lots,
    inspection_table,
    repeated_recordings,
)
from fieldmon.monitoring.inspecting.contradictions import known_before
from fieldmon.pests.weather import DAY_S
from fieldmon.planning.members import person_key

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


def seen_by_others(season: OpenSeason) -> dict[str, Counter[str]]:
    """Return by whom else plants were inspected that somebody's inspection counts for.

    By day (ISO), with how many. Nobody is counted twice of one inspection.
    """
    with season.store.one_moment():
        done = season.inspections
        with season.store.reading() as db:
            marks, others = inspection_lots.digests(db), repeated_recordings.of_others(db)
    if not others:
        return {}
    found: dict[str, Counter[str]] = {}
    told = zip(marks, done.who.tolist(), done.result.tolist(), done.date.tolist(), strict=True)
    for mark, who, result, day in told:
        if mark in others and result != SKIPPED:
            also = {person_key(name): name for one in others[mark] if (name := one["who"])}
            also.pop(person_key(who), None)
            found.setdefault(str(day), Counter()).update(also.values())
    return found
