"""What other programs changed of what was recorded: refused by name, or taken as a correction.

The file notes it by itself (`fieldmon.monitoring.schema.watch`), whoever the other program is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import Worded, joined, worded
from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.infestation.inspections import RESULT_NAMES, Inspections
from fieldmon.monitoring import batches, inspection_lots, inspection_table
from fieldmon.monitoring.schema import INSPECTIONS

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, RowLabel

_MOST_NAMED = 5
_DONE = {
    "update": worded("was changed"),
    "delete": worded("was deleted"),
    "insert": worded("was added"),
}
_CODES = {name: code for code, name in RESULT_NAMES.items()}
#: columns that say what was seen
SEEN = ("plant", "date", "time", "result", "count", "who", "notes")


@dataclass(frozen=True)
class OutsideChange:
    """One row that another program changed, deleted or added.

    Parameters
    ----------
    layer, row
        Where, and the row's number (fid).
    what
        ``"update"``, ``"delete"`` or ``"insert"``; of a row changed twice, what it came to.
    was
        What stood there first, for people.
    """

    layer: str
    row: int
    what: str
    was: str

    def at_row(self, row: int) -> OutsideChange:
        """Return the same change of another row, as of another copy."""
        return replace(self, row=row)

    def __str__(self) -> str:
        """Return what was done to which row."""
        return self.sentence()

    def sentence(self) -> Worded:
        """Return what was done to which row."""
        stood = f" ({self.was})" if self.was else ""
        return worded(
            "row {row} of the layer {layer}{stood} {done}",
            row=self.row,
            layer=self.layer,
            stood=stood,
            done=_DONE[self.what],
        )


def waiting(db: sqlite3.Connection) -> tuple[OutsideChange, ...]:
    """Return what other programs changed and nobody has taken yet, one for each row."""
    seen: dict[tuple[str, int], OutsideChange | None] = {}
    rows = db.execute(
        "SELECT layer, row, what, was FROM outside_changes WHERE batch IS NULL ORDER BY fid"
    )
    for layer, row, what, was in rows:
        key = layer, row
        first = seen.get(key)
        if what == "delete" and first is not None and first.what == "insert":
            seen[key] = None  # added and taken away again
        elif first is None:
            seen[key] = OutsideChange(layer, row, what, was or "")
        elif first.what == "delete" or what == "delete":  # replaced, or changed and then deleted
            ends = "update" if what == "insert" else what
            seen[key] = OutsideChange(layer, row, ends, first.was)
    return tuple(change for change in seen.values() if change is not None)


def refuse(db: sqlite3.Connection) -> None:
    """Raise `FileProblem` if other programs changed what was recorded, with the rows by name."""
    found = waiting(db)
    if not found:
        return
    more = ["..."] if len(found) > _MOST_NAMED else []
    named = joined("; ", [*(change.sentence() for change in found[:_MOST_NAMED]), *more])
    if all(change.layer == INSPECTIONS.name for change in found):
        remedy = worded(
            "Take it as a correction with: fieldmon correct SEASON --who NAME; or go back to a "
            "copy from before."
        )
    else:
        remedy = worded(
            "Only inspections can be corrected so: change the rest with fieldmon, and go back to a "
            "copy from before."
        )
    raise FileProblem(
        worded(
            "What was recorded must be as fieldmon left it, but another program changed "
            "it: {named}. {remedy}",
            named=named,
            remedy=remedy,
        )
    )


def refuse_more(db: sqlite3.Connection) -> None:
    """Raise `FileProblem` if more was changed than inspections, which alone can be corrected."""
    if any(change.layer != INSPECTIONS.name for change in waiting(db)):
        refuse(db)


def correct(
    db: sqlite3.Connection,
    plot: tuple[PlantGrid, RowLabel],
    settings: MonitoringSettings,
    who: str,
) -> int:
    """Take what other programs changed of inspections as a batch of its own; return how many.

    Place, row and number in the row follow the plant's number. A row added with a digest is a copy
    of another, and counts once it has its own.

    Raises
    ------
    FileProblem
        If a changed row makes no sense: which one.
    """
    found = waiting(db)
    if not found:
        return 0
    batch = batches.begin(db, "corrections", "changed by another program", who)
    for change in found:
        if change.what != "delete":
            take_row(db, change, plot, settings, batch)
    batches.count_findings(db)
    db.execute("UPDATE batches SET rows = ? WHERE fid = ?", (len(found), batch))
    db.execute("UPDATE outside_changes SET batch = ? WHERE batch IS NULL", (batch,))
    return len(found)


def take_row(
    db: sqlite3.Connection,
    change: OutsideChange,
    plot: tuple[PlantGrid, RowLabel],
    settings: MonitoringSettings,
    batch: int,
) -> None:
    """Make one row of inspections what it says now, in every column."""
    row = db.execute(
        f"SELECT {', '.join(SEEN)} FROM inspections WHERE fid = ?",  # noqa: S608 - names of ours
        (change.row,),
    ).fetchone()
    try:
        (made,) = inspection_table.rows(_inspection(row), *plot, settings, (batch, ""))
    except (FieldmonError, ValueError, TypeError, KeyError) as error:
        raise FileProblem(
            worded(
                "A changed inspection must say plant, date and result as the others do, but "
                "{change} and does not ({error}). Mend it with the program that changed it; "
                "nothing was taken.",
                change=change.sentence(),
                error=error,
            )
        ) from error
    values = dict(zip(INSPECTIONS.names, made, strict=True))
    del values["undone"]
    twice = db.execute(
        "SELECT fid FROM inspections WHERE digest = ? AND undone = 0 AND fid <> ?",
        (values["digest"], change.row),
    ).fetchone()
    if twice is not None:
        raise FileProblem(
            worded(
                "No inspection may stand there twice, but {change} and says what row {twice} "
                "says. Delete one of them with the program that changed it; nothing was taken.",
                change=change.sentence(),
                twice=twice[0],
            )
        )
    names = ", ".join(f"{name} = ?" for name in values)
    db.execute(
        f"UPDATE inspections SET {names} WHERE fid = ?",  # noqa: S608 - names of ours
        (*values.values(), change.row),
    )


def _inspection(row: tuple[object, ...]) -> Inspections:
    """Return one inspection from what its row says; raise where it makes no sense."""
    said = dict(zip(SEEN, row, strict=True))
    on = date.fromisoformat(str(said["date"])[:10])
    second = np.nan if said["time"] is None else inspection_lots.second_of(str(said["time"]))
    count = np.nan if said["count"] is None else float(str(said["count"]))
    return Inspections.of(
        np.array([int(str(said["plant"]))]),
        np.array([_CODES[str(said["result"])]]),
        np.datetime64(on, "D"),
        second=np.array([second]),
        count=np.array([count]),
        who=np.array([str(said["who"] or "")], object),
        notes=np.array([str(said["notes"] or "")], object),
    )
