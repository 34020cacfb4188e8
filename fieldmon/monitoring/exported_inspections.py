"""Inspections exported from a season that come back changed: of which ones, and what they say now.

A file may hold the layer `inspections` of a season's file alone, as QGIS exports it, or the table
of `fieldmon export`: each of its inspections has the digest by which the season knows it. Whether
somebody corrected it there, or inspected again and wrote that over it, no file says: it is a
correction only where it is brought as one (`fieldmon correct`). What a spreadsheet writes in its
own way is no change.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem, ObservationError
from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS, IDENTIFYING
from fieldmon.io.options import source_name
from fieldmon.monitoring import inspection_table, repeated_recordings
from fieldmon.monitoring.rows_that_count import COUNTS
from fieldmon.monitoring.transactions import connect, copy_season

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable
    from pathlib import Path

    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.monitoring import Season

# anybody may change the others; `record` takes what they say
_WATCHED = tuple(column for column in COLUMNS if column.watched)
(_NOTES,) = (column for column in COLUMNS if column.name == "notes")
(_SECOND,) = (column for column in COLUMNS if column.name == "second")
_WHOLE_MINUTE = ":00"
_SEEN = {column.kept for column in IDENTIFYING}
_SAME_VISIT = {"plant", "date"}


class ChangedInspection(NamedTuple):
    """An inspection of the season that a file exported from it says otherwise.

    Its number (fid), and by the names of the season's file what it says now.
    """

    row: int
    says: dict[str, Any]

    @property
    def is_seen_otherwise(self) -> bool:
        """Whether it says of its plant and day that something else was found, or at another time.

        With another day it may be one made anew.
        """
        said = self.says.keys()
        return not _SAME_VISIT & said and bool(_SEEN & said)


class Edits(NamedTuple):
    """What a file exported from a season says otherwise.

    Parameters
    ----------
    changed
        Inspections that count in the season, with what they say now.
    unknown
        Digests of those that do not.
    twice
        Digests that stand twice in the file, with something else each time.
    unsure
        Why records cannot be told, by their number in the file.
    n_notes
        How many have other notes, which are no corrections.
    """

    changed: list[ChangedInspection]
    unknown: list[str]
    twice: set[str]
    unsure: dict[int, str]
    n_notes: int


def read_exported(
    season: Season, source: Source, options: InspectionOptions
) -> Imported[InspectionRows]:
    """Read a file of inspections; dates of exported ones in the order that gives the season's.

    So where 4/6/2026 could be either, and no order was told.
    """
    from fieldmon.io.read import read_inspection_rows  # noqa: PLC0415 - half a second to import

    read = read_inspection_rows(source, options)
    rows = read.value
    if options.date_order is not None or not _n_exported(rows):
        return read
    with season.store.reading() as db:
        days = dict(db.execute("SELECT digest, date FROM inspections WHERE digest NOTNULL"))
    if off := _n_of_other_days(rows, days):
        other = read_inspection_rows(source, replace(options, date_order="mdy"))
        if _n_of_other_days(other.value, days) < off:
            return other
    return read


def _n_of_other_days(rows: InspectionRows, days: dict[str, str]) -> int:
    """Return how many exported inspections are of another day than by their digests."""
    marks = [] if rows.mark is None else rows.mark.tolist()
    told = zip(marks, rows.day.astype(str).tolist(), strict=True)
    return sum(days.get(mark, day) != day for mark, day in told)


def edits_in(season: Season, rows: InspectionRows, options: InspectionOptions) -> Edits:
    """Return what a file exported from a season says otherwise; of columns it lacks, nothing.

    What was changed so already is no change.
    """
    from fieldmon.io.readers.inspections import exported  # noqa: PLC0415 - half a second to import

    edits = Edits([], [], set(), {}, 0)
    if rows.mark is None or not _n_exported(rows):
        return edits
    lacked = _lacked(rows)
    watched = [one for one in _WATCHED if one.kept not in lacked]
    with season.store.reading() as db:
        held = _held(db, [one.kept for one in watched])
    strange = (rows.mark != "") & ~np.isin(rows.mark, np.array([*held], np.str_))
    edits.unknown.extend(rows.mark[strange].tolist())
    told, marks, why = exported(rows.take(~strange), season.plot.grid, options)
    edits.unsure.update(why)
    counting = {_key(one.says) for one in held.values() if one.undone == COUNTS}
    now_said = inspection_table.kept_columns(told)
    in_minutes = all(at is None or at.endswith(_WHOLE_MINUTE) for at in now_said[_SECOND.kept])
    said_of: dict[str, tuple[Any, ...]] = {}
    n_notes = 0
    for mark, notes, *now in zip(
        marks, now_said[_NOTES.kept], *(now_said[one.kept] for one in watched), strict=True
    ):
        if said_of.setdefault(mark, _key(now)) != _key(now):
            edits.twice.add(mark)
        one = held[mark]
        n_notes += bool(notes) and all(not _is_same(was, notes) for was in one.notes)
        says = {
            column.kept: new
            for column, was, with_others, new in zip(
                watched, one.says, one.with_others, now, strict=True
            )
            if not _is_same(was, new, in_minutes=in_minutes and column is _SECOND)
            and not _is_same(with_others, new)
        }
        if not says or _key(now) in counting:
            continue
        if one.undone == COUNTS:
            edits.changed.append(ChangedInspection(one.row, says))
        else:
            edits.unknown.append(mark)
    return edits._replace(n_notes=n_notes)


class _Held(NamedTuple):
    """An inspection that the season holds: its number, whether it counts, and what it says.

    By watched columns what it says itself, and with what others said of the same, as tables have
    it; its notes both ways.
    """

    row: int
    undone: int
    says: tuple[Any, ...]
    with_others: tuple[Any, ...]
    notes: tuple[str, str]


def _held(db: sqlite3.Connection, watched: list[str]) -> dict[str, _Held]:
    """Return what the season holds, by digests: of those that stand back, that which counts."""
    names = tuple(one.kept for one in COLUMNS)
    others, held = repeated_recordings.of_others(db), {}
    for row, undone, mark, *values in db.execute(
        f"SELECT fid, undone, digest, {', '.join(names)} FROM inspections "  # noqa: S608 - ours
        "WHERE digest NOTNULL ORDER BY undone = 0, fid"
    ):
        own = whole = dict(zip(names, values, strict=True))
        if mark in others and undone == COUNTS:
            beside = {one.kept: own[one.kept] for one in BESIDE}
            whole = own | repeated_recordings.together(beside, others[mark])
        says, said = ([one[name] for name in watched] for one in (own, whole))
        notes = own[_NOTES.kept] or "", whole[_NOTES.kept] or ""
        held[mark] = _Held(row, undone, tuple(says), tuple(said), notes)
    return held


def _is_same(was: Any, now: Any, *, in_minutes: bool = False) -> bool:  # noqa: ANN401 - any column's
    """Return whether a cell says what is held, as far as the program that wrote it could.

    An old code page has ``?`` for letters that it lacks; where all times are `in_minutes`, seconds
    were not shown.
    """
    if _key((was,)) == _key((now,)):
        return True
    if not isinstance(was, str) or not isinstance(now, str) or len(was) != len(now):
        return False
    if in_minutes and was[:-2] == now[:-2]:
        return True
    return all(
        old == new or (new == "?" and not old.isascii()) for old, new in zip(was, now, strict=True)
    )


class EditedCopy(NamedTuple):
    """A copy of a season, changed as a file exported from it; and how many the file has more.

    Inspections and notes that were added or changed there, which `record` takes.
    """

    path: Path
    n_added: int
    n_notes: int


def edited_copy(
    season: Season, source: Source, options: InspectionOptions, folder: Path
) -> EditedCopy:
    """Return a copy of a season changed as a file exported from it.

    `SeasonCorrections.take_corrections` takes what was changed. What is missing in the file was not
    deleted: a selection may be exported, of rows and of columns. What was added is no correction.

    Raises
    ------
    ObservationError
        If the file holds no inspections exported from a season, or what cannot be read for certain.
    FileProblem
        If some are of another season, or count no longer in this one.
    """
    rows, name = _exported_rows(season, source, options), source_name(source)
    edits = edits_in(season, rows, options)
    _refuse_uncertain(edits, name)
    copy = folder / "export.gpkg"
    copy_season(season.path, copy)
    with closing(connect(copy)) as db:
        db.execute("BEGIN")
        for row, says in edits.changed:
            sets = ", ".join(f"{column} = ?" for column in says)
            db.execute(f"UPDATE inspections SET {sets} WHERE fid = ?", (*says.values(), row))  # noqa: S608 - ours
        db.execute("COMMIT")
    return EditedCopy(copy, len(rows) - _n_exported(rows), edits.n_notes)


def _exported_rows(season: Season, source: Source, options: InspectionOptions) -> InspectionRows:
    """Return the rows of a file that holds inspections exported from a season; refuse others."""
    read, name = read_exported(season, source, options), source_name(source)
    rows = read.value
    n_exported = _n_exported(rows)
    doubts = [one.sentence for one in read.messages if one.severity.is_loss]
    if doubts and (n_exported or not len(rows)):
        raise ObservationError(
            worded(
                "What was corrected in an export must be read for certain, but of {name}: {doubts} "
                "Mend it there, or change it in the season's own file; nothing was taken.",
                name=name, doubts=joined(" ", doubts),
            )
        )  # fmt: skip
    if not n_exported or "result" in _lacked(rows):
        raise ObservationError(
            worded(
                "A file of corrections must hold inspections exported from the season, with their "
                "columns result and digest (of a layer: undone, too), but {name} holds none. "
                "Export them anew (fieldmon export --of inspections, or QGIS) and correct that. "
                "What is new comes with: fieldmon record",
                name=name,
            )
        )
    return rows


def _n_exported(rows: InspectionRows) -> int:
    """Return how many rows of a file a season has exported."""
    return 0 if rows.mark is None else int((rows.mark != "").sum())


def _refuse_uncertain(edits: Edits, name: str) -> None:
    """Refuse corrections of a file that cannot be told for certain, or count no longer."""
    if edits.unknown:
        raise FileProblem(
            worded(
                "What was corrected in an export must count in the season, but {n} "
                "{n:inspection|inspections} of {name} {n:is|are} not in it, or "
                "{n:was|were} corrected or taken back there since. Export this season alone, and "
                "anew, and correct that; nothing was taken.",
                n=len(edits.unknown), name=name,
            )
        )  # fmt: skip
    if edits.unsure:
        record, doubt = next(iter(edits.unsure.items()))
        raise ObservationError(
            worded(
                "An exported inspection must say plant, date and result as the season does, but "
                "of record {record} of {name}: {doubt}. Mend it there, or change it in the "
                "season's own file; nothing was taken.",
                record=record, name=name, doubt=doubt,
            )
        )  # fmt: skip
    if edits.twice:
        raise ObservationError(
            worded(
                "Each exported inspection must stand once in a file of corrections, but {n} of "
                "{name} {n:stands|stand} there twice and {n:says|say} something else each time, "
                "as a copied feature does. Empty the digest of the new ones; nothing was taken.",
                n=len(edits.twice), name=name,
            )
        )  # fmt: skip


def _lacked(rows: InspectionRows) -> set[str]:
    """Return which columns of a season's inspections a file does not have."""
    said = [] if rows.lacks is None else rows.lacks[:1].tolist()  # each record says the same
    return {name for one in said for name in one.split(",")}


def _key(values: Iterable[Any]) -> tuple[Any, ...]:
    """Return what a row says; nothing, and a count of 0, are nothing."""
    return tuple(value or None for value in values)
