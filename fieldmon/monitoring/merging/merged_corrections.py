"""One inspection that each of two copies corrected otherwise: what was corrected last holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.monitoring.changes.outside_changes import OutsideChange, in_words
from fieldmon.monitoring.merging.merged_batches import CHANGE_KNOWN_BY
from fieldmon.monitoring.merging.merged_rows import key_of

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator

    from fieldmon.monitoring.file.rows_that_count import Corrected
    from fieldmon.monitoring.merging.merged_rows import TableRows
    from fieldmon.monitoring.treating.treatments import Row
    from fieldmon.plot.grid import PlantGrid


class CorrectedTwice(NamedTuple):
    """The last correction of one inspection that each copy alone has, and the one that holds."""

    here: Row
    there: Row
    holds: Row


def corrected_twice(copies: list[TableRows], corrected: Corrected) -> tuple[CorrectedTwice, ...]:
    """Return the inspections that both corrected, unknown to each other, otherwise.

    What was taken back in either is not among them.
    """
    known = [
        {key_of(row, CHANGE_KNOWN_BY) for row in copied["outside_changes"]} for copied in copies
    ]
    found = []
    for rows in corrected.of_one:
        here, there = (
            [row for row in rows if key_of(row, CHANGE_KNOWN_BY) not in others]
            for others in reversed(known)
        )
        if here and there and here[-1]["now"] != there[-1]["now"]:
            found.append(CorrectedTwice(here[-1], there[-1], rows[-1]))
    return tuple(found)


def sentences(
    db: sqlite3.Connection, twice: tuple[CorrectedTwice, ...], grid: PlantGrid
) -> Iterator[str]:
    """Yield what each copy made of an inspection, which holds, and how the other one would."""
    for one in twice:
        here, there = (_made(db, row, grid) for row in one[:2])
        row = _row(db, one.holds)
        what = (
            worded("batch {n}", n=one.holds["batch"])
            if row is None
            else worded("inspection {n}", n=row)
        )
        if one.holds == one.here:
            yield worded(
                "Both copies corrected one inspection: {here} here; {there} there. What was "
                "corrected last counts: the one here. If the other is right, undo {what}.",
                here=here, there=there, what=what,
            )  # fmt: skip
        else:
            yield worded(
                "Both copies corrected one inspection: {here} here; {there} there. What was "
                "corrected last counts: the one there. If the other is right, undo {what}.",
                here=here, there=there, what=what,
            )  # fmt: skip


def _made(db: sqlite3.Connection, one: Row, grid: PlantGrid) -> str:
    """Return what a correction made of an inspection, in words."""
    row, what = _row(db, one), one["what"]
    if row is None:
        row, what = -1, "delete"
    change = OutsideChange(one["layer"], row, what, one["was"] or "", one["before"])
    return in_words(db, change, grid)


def _row(db: sqlite3.Connection, one: Row) -> int | None:
    """Return the number of the inspection that a correction made; None: it made none."""
    made = "SELECT min(fid) FROM inspections WHERE digest = ? AND batch = ?"
    (row,) = db.execute(made, (one["now"], one["batch"])).fetchone()
    return None if row is None else int(row)
