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
    """

    number: int
    on: date
    second: float
    result: int
    who: str


def of_day(db: sqlite3.Connection, on: date) -> tuple[int, ...]:
    """Return the numbers of the inspections of a day that count, in order."""
    wanted = (
        "SELECT fid FROM inspections WHERE date = ? AND undone = 0 AND digest IS NOT NULL "
        "ORDER BY fid"
    )
    return tuple(fid for (fid,) in db.execute(wanted, (str(on),)))


def of_plant(db: sqlite3.Connection, plant: int) -> tuple[NumberedInspection, ...]:
    """Return the inspections of a plant that count, in their order; those without a time last."""
    wanted = (
        "SELECT fid, date, time, result, who FROM inspections WHERE plant = ? AND undone = 0 "
        "AND digest IS NOT NULL ORDER BY date, time IS NULL, time, fid"
    )
    return tuple(
        NumberedInspection(
            fid, date.fromisoformat(str(day)[:10]), second_of(at), RESULT_CODES[result], who or ""
        )
        for fid, day, at, result, who in db.execute(wanted, (plant,))
    )
