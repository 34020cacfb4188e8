"""Inspections of a plant or a day by their numbers in the season's file, to correct one of them."""

from __future__ import annotations

from datetime import date
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.infestation.inspections import RESULT_CODES
from fieldmon.monitoring.inspecting.inspection_lots import second_of

if TYPE_CHECKING:
    import sqlite3


class NumberedInspection(NamedTuple):
    """An inspection that counts, by its number (fid) in the season's file.

    Parameters
    ----------
    number
        Its number.
    on, second
        When it was made: the day, and seconds since its midnight; NaN: no time is known.
    result, who
        What it found, and who inspected.
    plant
        Number of the plant in the grid.
    """

    number: int
    on: date
    second: float
    result: int
    who: str
    plant: int


def numbered_inspections(
    db: sqlite3.Connection, on: date | None = None, plant: int | None = None
) -> tuple[NumberedInspection, ...]:
    """Return the inspections of a day, a plant, or both that count; None: all.

    Those of a plant are in their order, and those without a time last; others in that of numbers.
    """
    asked = {"date": on and str(on), "plant": plant}
    told = {name: value for name, value in asked.items() if value is not None}
    wanted = (
        "SELECT fid, date, time, result, who, plant FROM inspections WHERE undone = 0 "  # noqa: S608 - ours
        f"AND digest IS NOT NULL {''.join(f'AND {name} = ? ' for name in told)}"
        f"ORDER BY {'fid' if plant is None else 'date, time IS NULL, time, fid'}"
    )
    return tuple(
        NumberedInspection(
            fid, date.fromisoformat(str(day)[:10]), second_of(at), RESULT_CODES[result], who or "",
            of,
        )
        for fid, day, at, result, who, of in db.execute(wanted, (*told.values(),))
    )  # fmt: skip
