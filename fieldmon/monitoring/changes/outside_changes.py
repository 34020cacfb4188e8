"""What other programs changed of what was recorded: refused by name, or taken as a correction.

The file notes it by itself (`fieldmon.monitoring.file.schema.watch`), whoever the other program is.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from shapely.errors import ShapelyError

from fieldmon.compute.wording import Worded, day_said, joined, worded
from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS, COUNT
from fieldmon.infestation.inspections import (
    CLEAN,
    FOUND,
    RESULT_CODES,
    RESULT_NAMES,
    SKIPPED,
    Inspections,
)
from fieldmon.io.parse.result_words import GONE, begins_gone, gone_note
from fieldmon.io.writers.day_file import with_face
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.file import rows_that_count
from fieldmon.monitoring.file.geopackage import beside_plot, geometry, point_blobs
from fieldmon.monitoring.file.schema import INSPECTED, INSPECTIONS
from fieldmon.monitoring.inspecting import (
    batches,
    drafts,
    inspection_lots,
    inspection_table,
    repeated_recordings,
)
from fieldmon.monitoring.treating import treatments

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, PlantNumbers

_MOST_NAMED = 5
# what `INSPECTED` says, and where it has the number in the row
_TOLD = re.compile(r"(.*) at row (.*), plant (\d+) on (.*)")
_NUMBER = re.compile(r", plant (\d+) on ")
# columns of inspections, in words
_CALLED = {
    "date": worded("date"), "time": worded("time"), "result": worded("result"),
    "count": worded("count"), "who": worded("who"), "notes": worded("notes"),
    "detects": worded("detects"),
}  # fmt: skip
_DONE = {
    "update": worded("was changed"),
    "delete": worded("was deleted"),
    "insert": worded("was added"),
}
_COUNTLESS = (RESULT_NAMES[CLEAN], RESULT_NAMES[SKIPPED], GONE)
# nearer to its plant a point was written anew, not moved
_MOVED_M = 0.01
_UNDONE = "SELECT undone FROM inspections WHERE fid = ?"
_FORGET = "DELETE FROM outside_changes WHERE batch IS NULL AND layer = ? AND row = ?"
#: columns that say what was seen
SEEN = tuple(column.kept for column in COLUMNS)


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
    before
        The whole row as it stood there first, as JSON; empty: there was none, or nobody kept it.
    """

    layer: str
    row: int
    what: str
    was: str
    before: str = ""

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
        "SELECT layer, row, what, was, before FROM outside_changes WHERE batch IS NULL ORDER BY fid"
    )
    for layer, row, what, was, before in rows:
        key = layer, row
        first = seen.get(key)
        if what == "delete" and first is not None and first.what == "insert":
            seen[key] = None  # added and taken away again
        elif first is None:
            seen[key] = OutsideChange(layer, row, what, was or "", before or "")
        elif first.what == "delete" or what == "delete":  # replaced, or changed and then deleted
            ends = "update" if what == "insert" else what
            seen[key] = replace(first, what=ends)
    return tuple(change for change in seen.values() if change is not None)


def refuse(db: sqlite3.Connection) -> None:
    """Raise `FileProblem` if other programs changed what was recorded, with the rows by name."""
    found = waiting(db)
    if not found:
        return
    more = ["..."] if len(found) > _MOST_NAMED else []
    named = joined("; ", [*(_faced(db, one).sentence() for one in found[:_MOST_NAMED]), *more])
    if all(change.layer == INSPECTIONS.name for change in found):
        remedy = worded(
            "Take it as a correction with: fieldmon correct {file} --who NAME; or go back to a "
            "copy from before.",
            file=_name(db),
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


def _faced(db: sqlite3.Connection, change: OutsideChange) -> OutsideChange:
    """Return a change of an inspection with the face of its plant in what stood there."""
    if not change.before:
        return change
    plant = rows_that_count.as_it_was(change.before).get("plant")

    def of(number: re.Match[str]) -> str:
        return f", plant {inspection_table.number_of(db, plant, int(number[1]))} on "

    return replace(change, was=_NUMBER.sub(of, change.was, 1))


def _name(db: sqlite3.Connection) -> str:
    """Return what a season's file is called: of two that are merged either may be meant."""
    (path,) = db.execute("SELECT file FROM pragma_database_list WHERE name = 'main'").fetchone()
    return Path(path).name or "SEASON"


def not_as_logged(db: sqlite3.Connection) -> tuple[str, ...]:
    """Return a sentence for each thing that the file says otherwise than its log."""
    wrong = {
        "inspections": inspection_table.not_what_they_say(db),
        "treatments": treatments.not_what_they_say(db),
    }
    return (
        *season_log.differing(db),
        *(
            worded("Row {row} of the layer {layer} is not what was recorded.", row=row, layer=layer)
            for layer, rows in wrong.items()
            for row in rows
        ),
    )


def refuse_unlike_log(wrong: tuple[str, ...]) -> None:
    """Raise `FileProblem` if there is anything that the file says otherwise than its log."""
    if wrong:
        raise FileProblem(
            worded(
                "The file must say what its log says, but it does not: {wrong} Go back to a copy "
                "from before.",
                wrong=joined(" ", wrong),
            )
        )


def refuse_more(db: sqlite3.Connection) -> None:
    """Raise `FileProblem` if more was changed than inspections, which alone can be corrected."""
    if any(change.layer != INSPECTIONS.name for change in waiting(db)):
        refuse(db)


def refuse_days_to_come(db: sqlite3.Connection, today: date) -> None:
    """Raise `FileProblem` if an inspection was given a day after `today`, beside days before."""
    # readers take a tenth of a second to import
    from fieldmon.io.readers.date_doubts import amid_past  # noqa: PLC0415

    for change in waiting(db):
        if change.layer != INSPECTIONS.name or change.what == "delete":
            continue
        before = rows_that_count.as_it_was(change.before).get("date") if change.before else None
        first = "SELECT min(date) FROM inspections WHERE undone = 0 AND fid <> ?"
        told = "SELECT date FROM inspections WHERE fid = ?"
        days = [before, *(db.execute(one, (change.row,)).fetchone()[0] for one in (first, told))]
        try:
            known = np.array([str(day or "")[:10] for day in days], "datetime64[D]")
        except ValueError:  # what is no day is refused by its name
            continue
        if known[2] != known[0] and (why := amid_past(known, today).get(2)):
            raise _senseless(db, change, why)


def correct(
    db: sqlite3.Connection,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    who: str,
) -> tuple[str, ...]:
    """Take what other programs changed of inspections as a batch of its own; say what, one by one.

    What stood there before stands back, until the correction is taken back. Where a row says what
    it said, it is put back as it was. A row that was moved is
    of the plant there; else place, row and number in the row follow the plant's number. A row added
    with a digest is a copy of another, and counts once it has its own.

    Raises
    ------
    FileProblem
        If a changed row makes no sense: which one.
    """
    found = [one for one in waiting(db) if not _put_back(db, one, plot, settings)]
    if not found:
        return ()
    batch = batches.begin(db, "corrections", "changed by another program", who)
    first = (
        "SELECT min(fid) FROM outside_changes WHERE batch IS NULL AND layer = ? AND row = ? "
        "AND before NOTNULL"
    )
    kept, said = [], []
    for change in found:
        now = None
        if change.what != "delete":
            now = take_row(db, change, plot, settings, batch)
        if is_kept(change):
            keep_before(db, change, plot[0])
            kept += [(now, *db.execute(first, (change.layer, change.row)).fetchone())]
        said.append(in_words(db, change, plot[0]))
    # of a row changed several times, what it was first is what comes back
    spare = f"fid NOT IN ({', '.join('?' * len(kept))})"
    db.execute(
        f"UPDATE outside_changes SET before = NULL WHERE batch IS NULL AND {spare}",  # noqa: S608 - ours
        [fid for _, fid in kept],
    )
    db.executemany("UPDATE outside_changes SET now = ? WHERE fid = ?", kept)
    batches.count_inspections(db)
    db.execute("UPDATE batches SET rows = ? WHERE fid = ?", (len(found), batch))
    db.execute("UPDATE outside_changes SET batch = ? WHERE batch IS NULL", (batch,))
    return tuple(said)


def _put_back(
    db: sqlite3.Connection,
    change: OutsideChange,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
) -> bool:
    """Put a changed row back as it was, where it says nothing else; return whether it was that."""
    if change.what != "update" or not is_kept(change):
        return False
    before = rows_that_count.as_it_was(change.before)
    (undone,) = db.execute(_UNDONE, (change.row,)).fetchone()
    says = _made_anew(db, change, plot, settings, before.get("batch", 0))
    told, was = (
        [None if of.get(name) == "" else of.get(name) for name in (*SEEN, "digest")]
        for of in (says, before)
    )
    if told != was or undone != before.get("undone"):
        return False
    stood = {**before, "geom": says["geom"]}
    names = [name for name in INSPECTIONS.names if name in stood]
    sets = ", ".join(f"{name} = ?" for name in names)
    row = (*(stood[name] for name in names), change.row)
    db.execute(f"UPDATE inspections SET {sets} WHERE fid = ?", row)  # noqa: S608 - names of ours
    db.execute(_FORGET, (change.layer, change.row))
    return True


def is_kept(change: OutsideChange) -> bool:
    """Tell whether it is known what stood there before, and that it was recorded."""
    return bool(change.before) and rows_that_count.as_it_was(change.before)["digest"] is not None


def keep_before(db: sqlite3.Connection, change: OutsideChange, grid: PlantGrid) -> None:
    """Keep what stood there before a change, until the correction is taken back."""
    before = rows_that_count.as_it_was(change.before)
    (geom,) = point_blobs(grid.lonlat(np.array([before["plant"]])))
    before["geom"] = beside_plot(db, geom)
    if before["undone"] == rows_that_count.COUNTS:
        before["undone"] = rows_that_count.STANDS_BACK
    # what was deleted leaves its number free
    before["fid"] = change.row if change.what == "delete" else None
    names = ("fid", *INSPECTIONS.names)
    db.execute(
        f"INSERT INTO inspections ({', '.join(names)}) VALUES ({', '.join('?' * len(names))})",  # noqa: S608 - ours
        tuple(before.get(name) for name in names),  # an earlier version kept less
    )


def in_words(db: sqlite3.Connection, change: OutsideChange, grid: PlantGrid) -> str:
    """Return what a correction made of a row, for the log and for people."""
    names = f"{INSPECTED}, line, number, digest, {', '.join(SEEN)}"
    row = db.execute(f"SELECT {names} FROM inspections AS old WHERE fid = ?", (change.row,))  # noqa: S608 - ours
    says, line, number, mark, *values = row.fetchone() or ("", 0, 0, "", *(None for _ in SEEN))
    now: dict[str, Any] = dict(zip(SEEN, values, strict=True))
    before = rows_that_count.as_it_was(change.before) if change.before else {}
    now = _with_others(db, now, before, mark)
    was = _with_face(change.was, grid, before.get("plant", now["plant"]))
    if change.what == "delete":
        return worded("{was} was deleted", was=was)
    says = _with_face(str(says), grid, now["plant"])
    if change.what == "insert":
        return worded("{says} was added", says=says)
    is_gone = now["result"] == RESULT_NAMES[SKIPPED] and begins_gone(now["notes"] or "")
    is_gone &= any(before.get(name) != now[name] for name in ("result", "notes"))
    parts = [now["notes"]] if is_gone else []
    parts += [
        worded("at row {row}, plant {plant}", row=line,
               plant=with_face(grid, value, int(number or 0))) if name == "plant"
        else worded("{name} {value}", name=_CALLED.get(name, name), value=_told(value))
        for name, value in now.items()
        if name in before and before[name] != value
        and not (is_gone and name in {"result", "count", "notes"})
    ]  # fmt: skip
    return worded("{was} is now {now}", was=was, now=joined(", ", parts) if parts else says)


def _with_others(
    db: sqlite3.Connection, now: dict[str, Any], before: dict[str, Any], mark: str
) -> dict[str, Any]:
    """Return what a row says now; what was emptied in it, as others said it of the same."""
    emptied = [
        one.kept
        for one in BESIDE
        if one.role != "noted" and before.get(one.kept) and now[one.kept] in {None, ""}
    ]
    if not emptied:
        return now
    said = repeated_recordings.of(db, mark, repeated_recordings.of_others(db)) or now
    return now | {name: said[name] for name in emptied}


def _told(value: object) -> str:
    """Return what a column of an inspection says, in words."""
    if isinstance(value, float):
        return f"{value:g}"
    text = str(value or "")
    return worded(text) if text in RESULT_CODES else text or worded("none")


def _with_face(said: str, grid: PlantGrid, plant: object) -> str:
    """Return what `INSPECTED` says of an inspection, with the face where its plant has two."""
    told = _TOLD.fullmatch(said)
    if told is None:
        return said
    result, row, number, day = told.groups()
    return worded(
        "{result} at row {row}, plant {plant} on {day}",
        result=worded(result) if result in RESULT_CODES else result,
        row=row,
        plant=with_face(grid, plant, int(number))
        if isinstance(plant, int) and 0 <= plant < len(grid)
        else number,
        day=day_said(day),
    )


def take_row(
    db: sqlite3.Connection,
    change: OutsideChange,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    batch: int,
) -> str:
    """Make one row of inspections what it says now, in every column; return its digest."""
    values = _made_anew(db, change, plot, settings, batch)
    was = rows_that_count.as_it_was(change.before)["digest"] if change.before else None
    if was != values["digest"]:  # others stay with what it was: what they say goes along
        values |= repeated_recordings.with_others(db, was, values)
    _refuse_twice(db, change, values["digest"])
    names = ", ".join(f"{name} = ?" for name in values)
    db.execute(
        f"UPDATE inspections SET {names} WHERE fid = ?",  # noqa: S608 - names of ours
        (*values.values(), change.row),
    )
    return str(values["digest"])


def _made_anew(
    db: sqlite3.Connection,
    change: OutsideChange,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    batch: int,
) -> dict[str, Any]:
    """Return what every column of a row must say by what those say now that people fill in."""
    row = said_in(db, change, plot[0])
    try:
        (made,) = inspection_table.rows(_inspection(row), *plot, settings, (batch, ""))
    except (FieldmonError, ValueError, TypeError, KeyError) as error:
        raise _senseless(db, change, error) from error
    values = dict(zip(INSPECTIONS.names, made, strict=True))
    values["geom"] = beside_plot(db, values["geom"])
    del values["undone"]
    return values


def _senseless(db: sqlite3.Connection, change: OutsideChange, why: object) -> FileProblem:
    return FileProblem(
        worded(
            "A changed inspection must say plant, date and result as the others do, but "
            "{change} and does not ({error}). Mend it with the program that changed it; "
            "nothing was taken.",
            change=_faced(db, change).sentence(),
            error=why,
        )
    )


def _refuse_twice(db: sqlite3.Connection, change: OutsideChange, mark: object) -> None:
    """Refuse a row that says now what another one that counts says."""
    twice = db.execute(
        "SELECT fid FROM inspections WHERE digest = ? AND undone = 0 AND fid <> ?",
        (mark, change.row),
    ).fetchone()
    if twice is not None:
        raise FileProblem(
            worded(
                "No inspection may stand there twice, but {change} and says what row {twice} "
                "says. Delete one of them with the program that changed it; nothing was taken.",
                change=_faced(db, change).sentence(),
                twice=twice[0],
            )
        )


def as_kept(row: tuple[object, ...]) -> tuple[object, ...]:
    """Return what a row of another program says, in the order of `SEEN`, as seasons keep it.

    A plant that it calls gone was skipped, and its note says so.
    """
    said = dict(zip(SEEN, row, strict=True))
    if said["result"] == GONE:
        said |= {"result": RESULT_NAMES[SKIPPED], "notes": gone_note(str(said["notes"] or ""))}
    return tuple(said.values())


def said_in(db: sqlite3.Connection, change: OutsideChange, grid: PlantGrid) -> tuple[object, ...]:
    """Return what a changed row says now, in the order of `SEEN`.

    Where its point was moved, it is of the plant there. The count of a find that is none any more
    is left out.

    Raises
    ------
    FileProblem
        If it was moved to where no plant is, or to another plant than it names.
    """
    row = db.execute(
        f"SELECT geom, {', '.join(SEEN)} FROM inspections WHERE fid = ?",  # noqa: S608 - names of ours
        (change.row,),
    ).fetchone()
    said = dict(zip(SEEN, row[1:], strict=True))
    before = rows_that_count.as_it_was(change.before) if change.before else {}
    if said["result"] in _COUNTLESS and before.get("result") == RESULT_NAMES[FOUND]:
        said["count"] = None if said["count"] == before.get("count") else said["count"]
    stood = before.get("plant")
    if isinstance(row[0], bytes) and isinstance(stood, int) and 0 <= stood < len(grid):
        said["plant"] = _plant_there(db, (row[0], said["plant"], stood), change, grid)
    return tuple(said.values())


def _plant_there(
    db: sqlite3.Connection, row: tuple[bytes, object, int], change: OutsideChange, grid: PlantGrid
) -> object:
    """Return the plant of a row; by its place if it was moved.

    `row` is its place, the plant that it names, and the one at which it stood.
    """
    place, named, stood = row
    try:
        point = geometry(place)
        moved = np.array([[point.x, point.y]]), grid.lonlat(np.array([stood]))
        if np.hypot(*np.subtract(*map(grid.frame.xy_m, moved)).T)[0] < _MOVED_M:
            return named
        plant = drafts.plant_at(place, None if named == stood else named, grid)
    except (FieldmonError, ValueError, TypeError, AttributeError, ShapelyError) as error:
        raise FileProblem(
            worded(
                "A finding that is moved must come to stand at a plant, but {change} and does "
                "not: {error} Move it there with the program that changed it; nothing was taken.",
                change=_faced(db, change).sentence(),
                error=error,
            )
        ) from error
    is_second = grid.vine[stood] != stood and grid.twin[plant] >= 0 and named == stood
    return int(grid.twin[plant]) if is_second else plant


def _inspection(row: tuple[object, ...]) -> Inspections:
    """Return one inspection from what its row says; raise where it makes no sense."""
    said = dict(zip(SEEN, as_kept(row), strict=True))
    on = date.fromisoformat(str(said["date"])[:10])
    second = np.nan if said["time"] is None else inspection_lots.second_of(str(said["time"]))
    return Inspections.of(
        np.array([int(str(said["plant"]))]),
        np.array([RESULT_CODES[str(said["result"])]]),
        np.datetime64(on, "D"),
        second=np.array([second]),
        **{
            one.name: np.array([one.from_file(said[one.kept])], one.dtype)
            for one in (COUNT, *BESIDE)
        },
    )
