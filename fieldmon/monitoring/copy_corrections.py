"""What another program corrected or deleted in a copy of a season, for the season itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.monitoring import batches, outside_changes
from fieldmon.monitoring.geopackage import touch
from fieldmon.monitoring.schema import INSPECTED, INSPECTIONS

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.outside_changes import OutsideChange
    from fieldmon.monitoring.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, RowLabel


def waiting(theirs: sqlite3.Connection) -> tuple[OutsideChange, ...]:
    """Return what another program changed of a copy's inspections."""
    return tuple(
        one
        for one in outside_changes.waiting(theirs)
        if one.layer == INSPECTIONS.name and one.what in {"update", "delete"}
    )


def take(
    db: sqlite3.Connection,
    theirs: sqlite3.Connection,
    plot: tuple[PlantGrid, RowLabel],
    settings: MonitoringSettings,
    said: tuple[str, str],
) -> int:
    """Take a copy's corrections as a batch of their own; return how many were new.

    What was deleted there is marked as undone here. `said` is the copy's name, and whose
    corrections these are. Taken twice they change nothing.

    Raises
    ------
    FileProblem
        If a changed row is not in the season, or makes no sense: which one.
    """
    changes = [one for one in waiting(theirs) if not _is_taken(db, theirs, one)]
    if not changes:
        return 0
    name, who = said
    batch = batches.begin(db, "corrections", f"changed in {name}", who)
    for one in changes:
        if one.what == "delete":
            _undo(db, one)
        else:
            _rewrite(db, theirs, one, (plot, settings, batch))
    batches.count_findings(db)
    batches.end(db, batch, len(changes))
    touch(db, INSPECTIONS.name)
    return len(changes)


def _is_taken(db: sqlite3.Connection, theirs: sqlite3.Connection, one: OutsideChange) -> bool:
    if one.what == "delete":
        gone = "SELECT 1 FROM inspections WHERE fid = ? AND undone <> 0"
        return db.execute(gone, (one.row,)).fetchone() is not None
    names = ", ".join(outside_changes.SEEN)
    row = theirs.execute(f"SELECT {names} FROM inspections WHERE fid = ?", (one.row,)).fetchone()  # noqa: S608 - ours
    same = " AND ".join(f"coalesce({name}, '') = coalesce(?, '')" for name in outside_changes.SEEN)
    held = db.execute(f"SELECT 1 FROM inspections WHERE undone = 0 AND {same}", row)  # noqa: S608 - ours
    return held.fetchone() is not None


def _undo(db: sqlite3.Connection, one: OutsideChange) -> None:
    row = db.execute(f"SELECT {INSPECTED}, batch FROM inspections AS old WHERE fid = ?", (one.row,))  # noqa: S608 - ours
    held = row.fetchone()
    if held is None or held[0] != one.was:
        raise _not_here(one)
    db.execute("UPDATE inspections SET undone = 1 WHERE fid = ?", (one.row,))
    batches.close_if_empty(db, held[1])


def _rewrite(
    db: sqlite3.Connection,
    theirs: sqlite3.Connection,
    one: OutsideChange,
    how: tuple[tuple[PlantGrid, RowLabel], MonitoringSettings, int],
) -> None:
    names = ", ".join(outside_changes.SEEN)
    digest, *values = theirs.execute(
        f"SELECT digest, {names} FROM inspections WHERE fid = ?",  # noqa: S608 - ours
        (one.row,),
    ).fetchone()
    held = db.execute(
        "SELECT fid FROM inspections WHERE digest = ? AND undone = 0", (digest,)
    ).fetchone()
    if held is None:
        raise _not_here(one)
    sets = ", ".join(f"{name} = ?" for name in outside_changes.SEEN)
    db.execute(f"UPDATE inspections SET {sets} WHERE fid = ?", (*values, held[0]))  # noqa: S608 - ours
    outside_changes.take_row(db, one.at_row(held[0]), *how)


def _not_here(one: OutsideChange) -> FileProblem:
    return FileProblem(
        worded(
            "What was corrected in a copy must stand in the season, but {change} there, and the "
            "season does not hold it, or no longer. Record it anew; nothing was taken.",
            change=str(one),
        )
    )
