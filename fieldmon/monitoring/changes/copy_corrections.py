"""What another program corrected or deleted in a copy of a season, for the season itself."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.monitoring.changes import outside_changes
from fieldmon.monitoring.file import rows_that_count
from fieldmon.monitoring.file.geopackage import insert, touch
from fieldmon.monitoring.file.schema import INSPECTED, INSPECTIONS, OUTSIDE_CHANGES
from fieldmon.monitoring.inspecting import batches
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.changes.outside_changes import OutsideChange
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, PlantNumbers

# what tells corrections that were taken from others, whatever their numbers are in a copy
_TAKEN = (
    "SELECT at, before, now FROM outside_changes WHERE layer = 'inspections' AND before NOTNULL "
    "AND batch NOTNULL"
)


def waiting(theirs: sqlite3.Connection) -> tuple[OutsideChange, ...]:
    """Return what another program changed of a copy's inspections."""
    return tuple(
        one
        for one in outside_changes.waiting(theirs)
        if one.layer == INSPECTIONS.name and one.what in {"update", "delete"}
    )


def n_alone(db: sqlite3.Connection, theirs: sqlite3.Connection) -> int:
    """Return how many inspections that count here a copy alone has corrected to others, or deleted.

    What other programs changed there, and nobody took yet, is `waiting`.
    """
    known = set(db.execute(_TAKEN))
    counts = "SELECT 1 FROM inspections WHERE digest = ? AND undone = 0"
    n = 0
    for one in theirs.execute(f"{_TAKEN} AND undone = 0"):
        _, before, now = one
        was = rows_that_count.as_it_was(before)["digest"]
        if one not in known and was is not None and was != now:
            n += db.execute(counts, (was,)).fetchone() is not None
    return n


def take(
    db: sqlite3.Connection,
    theirs: sqlite3.Connection,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    said: tuple[str, str],
) -> tuple[str, ...]:
    """Take a copy's corrections as a batch of their own; say those that were new, one by one.

    What stood here before stands back, until they are taken back. `said` is the copy's name, and
    whose corrections these are. Taken twice they change nothing.

    Raises
    ------
    FileProblem
        If a changed row is not in the season, or makes no sense: which one.
    """
    found = (_as_here(db, one) for one in waiting(theirs))
    changes = [one for one in found if not _is_taken(db, theirs, one, plot[0])]
    if not changes:
        return ()
    name, who = said
    batch = batches.begin(db, "corrections", f"changed in {name}", who)
    taken = []
    for one in changes:
        if one.what == "delete":
            stand_back(db, one, batch)
            taken.append(one)
        else:
            taken.append(_rewrite(db, theirs, one, (plot, settings, batch)))
    batches.count_inspections(db)
    batches.end(db, batch, len(changes))
    touch(db, INSPECTIONS.name)
    return tuple(outside_changes.in_words(db, one, plot[0]) for one in taken)


def _as_here(db: sqlite3.Connection, one: OutsideChange) -> OutsideChange:
    """Return a deletion of the row that it has here: a season that was merged has other numbers."""
    mark = rows_that_count.as_it_was(one.before)["digest"]
    if one.what != "delete" or mark is None:
        return one
    same = "SELECT fid FROM inspections WHERE digest = ? ORDER BY undone <> 0, fid LIMIT 1"
    (row,) = db.execute(same, (mark,)).fetchone() or (-1,)
    return replace(one, row=row)


def _is_taken(
    db: sqlite3.Connection, theirs: sqlite3.Connection, one: OutsideChange, grid: PlantGrid
) -> bool:
    if one.what == "delete":
        gone = "SELECT 1 FROM inspections WHERE fid = ? AND undone <> 0"
        return db.execute(gone, (one.row,)).fetchone() is not None
    row = outside_changes.said_in(theirs, one, grid)
    same = " AND ".join(f"coalesce({name}, '') = coalesce(?, '')" for name in outside_changes.SEEN)
    says = outside_changes.as_kept(row)
    held = db.execute(f"SELECT 1 FROM inspections WHERE undone = 0 AND {same}", says)  # noqa: S608 - ours
    return held.fetchone() is not None


def stand_back(db: sqlite3.Connection, one: OutsideChange, batch: int) -> None:
    """Let an inspection stand back for nothing, as a correction of a batch."""
    row = db.execute(f"SELECT {INSPECTED}, batch FROM inspections AS old WHERE fid = ?", (one.row,))  # noqa: S608 - ours
    held = row.fetchone()
    if held is None or held[0] != one.was:
        raise _not_here(one)
    note(db, replace(one, before=as_it_is(db, one.row)), batch, None)
    stands_back = "UPDATE inspections SET undone = ? WHERE fid = ? AND undone = 0"
    db.execute(stands_back, (rows_that_count.STANDS_BACK, one.row))


def as_it_is(db: sqlite3.Connection, row: int) -> str:
    """Return an inspection as it is kept where it is corrected, see `OutsideChange`."""
    names = [name for name in INSPECTIONS.names if name != "geom"]
    said = db.execute(f"SELECT {', '.join(names)} FROM inspections WHERE fid = ?", (row,))  # noqa: S608 - ours
    return json.dumps(dict(zip(names, said.fetchone(), strict=True)), ensure_ascii=False)


def note(db: sqlite3.Connection, one: OutsideChange, batch: int, now: str | None) -> None:
    """Note a correction as those of other programs are, with the digest it came to."""
    change = {
        "at": utc_text(),
        "layer": one.layer,
        "row": one.row,
        "what": one.what,
        "was": one.was,
    }
    values = {**change, "batch": batch, "before": one.before, "now": now, "undone": 0}
    insert(db, OUTSIDE_CHANGES, [tuple(values[name] for name in OUTSIDE_CHANGES.names)])


def _rewrite(
    db: sqlite3.Connection,
    theirs: sqlite3.Connection,
    one: OutsideChange,
    how: tuple[tuple[PlantGrid, PlantNumbers], MonitoringSettings, int],
) -> OutsideChange:
    """Correct what a row says, and return what was done to which one of ours."""
    (digest,) = theirs.execute(
        "SELECT digest FROM inspections WHERE fid = ?", (one.row,)
    ).fetchone()
    values = outside_changes.said_in(theirs, one, how[0][0])
    held = db.execute(
        "SELECT fid FROM inspections WHERE digest = ? AND undone = 0", (digest,)
    ).fetchone()
    if held is None:
        raise _not_here(one)
    before = as_it_is(db, held[0])
    sets = ", ".join(f"{name} = ?" for name in outside_changes.SEEN)
    db.execute(f"UPDATE inspections SET {sets} WHERE fid = ?", (*values, held[0]))  # noqa: S608 - ours
    here = replace(one, row=held[0], before=before)
    now = outside_changes.take_row(db, here, *how)
    outside_changes.keep_before(db, here, how[0][0])
    note(db, here, how[2], now)
    return here


def _not_here(one: OutsideChange) -> FileProblem:
    return FileProblem(
        worded(
            "What was corrected in a copy must stand in the season, but {change} there, and the "
            "season does not hold it, or no longer. Record it anew; nothing was taken.",
            change=str(one),
        )
    )
