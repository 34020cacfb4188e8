"""Inspections exported from a season that come back changed: of which ones, and what they say now.

A file may hold the layer `inspections` of a season's file alone, as QGIS exports it, or the table
of `fieldmon export`: each of its inspections has the digest by which the season knows it. Whether
somebody corrected it there, or inspected again and wrote that over it, no file says: it is a
correction only where it is brought as one (`fieldmon correct`). What a spreadsheet writes in its
own way is no change.
"""

from __future__ import annotations

from collections import Counter
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem, ObservationError
from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS, COUNT, IDENTIFYING
from fieldmon.infestation.records import PRESENT
from fieldmon.io.import_report import UnsureCells
from fieldmon.io.options import source_name
from fieldmon.io.readers.inspection_file.inspection_rows import is_mark
from fieldmon.monitoring.changes.transactions import copy_season
from fieldmon.monitoring.file.connections import connect
from fieldmon.monitoring.file.rows_that_count import COUNTS
from fieldmon.monitoring.inspecting import inspection_table, repeated_recordings
from fieldmon.monitoring.merging.other_seasons import own_names

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.monitoring import Season
    from fieldmon.plot.grid import PlantGrid

# anybody may change the others; `record` takes what they say
_WATCHED = tuple(column for column in COLUMNS if column.watched)
(_PLANT,) = (column for column in COLUMNS if column.name == "plant")
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
    n_seconds
        How many are of another second in a file that may not show seconds: no corrections.
    n_alike
        How many say now what another inspection that counts says.
    """

    changed: list[ChangedInspection]
    unknown: list[str]
    twice: set[str]
    unsure: dict[int, str]
    n_notes: int
    n_seconds: int
    n_alike: int


def read_exported(
    season: Season, source: Source, options: InspectionOptions
) -> Imported[InspectionRows]:
    """Read a file of inspections; dates of exported ones in the order that gives the season's.

    So where 4/6/2026 could be either, and no order was told.
    """
    return _read_by_days(season, source, options)[0]


def _read_by_days(
    season: Season, source: Source, options: InspectionOptions
) -> tuple[Imported[InspectionRows], bool]:
    """Return what `read_exported` does, and whether the season's days leave the order open."""
    from fieldmon.io.read import read_inspection_rows  # noqa: PLC0415 - half a second to import

    read = read_inspection_rows(source, options)
    rows = read.value
    if options.date_order is not None or not rows.exported.any():
        return read, False
    with season.store.reading() as db:
        days = dict(db.execute("SELECT digest, date FROM inspections WHERE digest NOTNULL"))
    off = _n_of_other_days(rows, days)
    if not off:
        return read, False
    other = read_inspection_rows(source, replace(options, date_order="mdy"))
    other_off = _n_of_other_days(other.value, days)
    is_open = off == other_off and not np.array_equal(rows.day, other.value.day, equal_nan=True)
    return (other if other_off < off else read), is_open


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

    edits = Edits([], [], set(), {}, 0, 0, 0)
    if rows.mark is None or not rows.exported.any():
        return edits
    lacked = _lacked(rows)
    with season.store.reading() as db:
        held = _held(db)
    strange = rows.exported & ~np.isin(rows.mark, np.array([*held], np.str_))
    edits.unknown.extend(rows.mark[strange].tolist())
    told, marks, why = exported(rows.take(~strange), season.plot.grid, options)
    edits.unsure.update(why)
    counting = {_key(one.says) for one in held.values() if one.undone == COUNTS}
    says_now = {one.row: _visit(one.says) for one in held.values() if one.undone == COUNTS}
    now_said = inspection_table.kept_columns(told)
    now_said[_PLANT.kept] = _of_held_faces(season.plot.grid, rows, told, marks, held, edits.unsure)
    in_minutes = all(at is None or at.endswith(_WHOLE_MINUTE) for at in now_said[_SECOND.kept])
    none_found = _none_found(rows)
    said_of: dict[str, tuple[Any, ...]] = {}
    n_notes = n_seconds = 0
    for mark, notes, *now in zip(
        marks, now_said[_NOTES.kept], *(now_said[one.kept] for one in _WATCHED), strict=True
    ):
        one = held[mark]
        n_notes += bool(notes) and all(not _is_same(was, notes) for was in one.notes)
        was_at, is_at = (said[_WATCHED.index(_SECOND)] for said in (one.says, now))
        n_seconds += in_minutes and was_at != is_at and _is_same(was_at, is_at, in_minutes=True)
        if mark in none_found and one.says[_WATCHED.index(COUNT)]:
            edits.unsure[none_found[mark]] = worded(
                "its result is found, but its count is 0 (write clean, or empty the count if "
                "nobody counted)"
            )
        says = {
            column.kept: new
            for column, was, with_others, new in zip(
                _WATCHED, one.says, one.with_others, now, strict=True
            )
            if column.kept not in lacked
            and not _is_same(was, new, in_minutes=in_minutes and column is _SECOND)
            and not _is_same(with_others, new)
        }
        whole = _key(
            says.get(column.kept, was) for column, was in zip(_WATCHED, one.says, strict=True)
        )
        if said_of.setdefault(mark, whole) != whole:
            edits.twice.add(mark)
        if not says:
            continue
        if one.undone == COUNTS:
            edits.changed.append(ChangedInspection(one.row, says))
            says_now[one.row] = _visit(whole)
        elif whole not in counting:  # else it was taken already
            edits.unknown.append(mark)
    said_by = Counter(says_now.values())
    n_alike = sum(said_by[says_now[one.row]] > 1 for one in edits.changed)
    return edits._replace(n_notes=n_notes, n_seconds=n_seconds, n_alike=n_alike)


def _visit(says: Sequence[Any]) -> tuple[Any, ...]:
    """Return of what watched columns say that by which the season tells inspections apart."""
    return _key(said for one, said in zip(_WATCHED, says, strict=True) if one in IDENTIFYING)


def _none_found(rows: InspectionRows) -> dict[str, int]:
    """Return the numbers in the file of finds that count 0, by digests."""
    if rows.mark is None:
        return {}
    none = (rows.result == PRESENT) & (rows.count == 0)
    return dict(zip(rows.mark[none].tolist(), rows.source_row[none].tolist(), strict=True))


def _of_held_faces(
    grid: PlantGrid,
    rows: InspectionRows,
    told: Inspections,
    marks: list[str],
    held: dict[str, _Held],
    unsure: dict[int, str],
) -> list[int]:
    """Return the plants told: where no face is, that which the season has of the same plant.

    Of another plant with two faces nobody knows which: that is added to what is `unsure`.
    """
    plants: list[int] = told.plant.tolist()
    if rows.mark is None or not grid.has_faces:
        return plants
    bare = (rows.face == 0) & (rows.plant < 0)
    record = dict(zip(rows.mark[bare].tolist(), rows.source_row[bare].tolist(), strict=True))
    at = _WATCHED.index(_PLANT)
    for k, mark in enumerate(marks):
        was = held[mark].says[at]
        if mark not in record or plants[k] == was:
            continue
        if grid.twin[plants[k]] == was:
            plants[k] = was
        elif grid.twin[plants[k]] >= 0:
            unsure[record[mark]] = worded("which face of its plant is meant is not named")
    return plants


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


def _held(db: sqlite3.Connection) -> dict[str, _Held]:
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
        says, said = ([one[column.kept] for column in _WATCHED] for one in (own, whole))
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

    Inspections and notes that were added or changed there, which `record` takes, and times that
    differ in seconds that the file may not show. And what to say of records that name another plot
    or season, and were left out; empty where none do.
    """

    path: Path
    n_added: int
    n_notes: int
    n_seconds: int
    of_others: str


def edited_copy(
    season: Season, source: Source, options: InspectionOptions, folder: Path
) -> EditedCopy:
    """Return a copy of a season changed as a file exported from it.

    `SeasonCorrections.take_corrections` takes what was changed. What is missing in the file was not
    deleted: a selection may be exported, of rows and of columns. What was added is no correction.

    Raises
    ------
    ObservationError
        If the file holds no inspections exported from a season, or names other plots alone, or
        holds what cannot be read for certain.
    FileProblem
        If some are of another season, or count no longer in this one.
    """
    name = source_name(source)
    rows, of_others = _of_this_season(
        season, _exported_rows(season, source, options), options, name
    )
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
    n_added = int((~rows.exported).sum())
    return EditedCopy(copy, n_added, edits.n_notes, edits.n_seconds, of_others)


def own_rows(
    season: Season, rows: InspectionRows, options: InspectionOptions
) -> tuple[InspectionRows, str]:
    """Return the rows that name no other plot or season, and what to say of the others.

    Digests do not tell: those of two seasons that say the same are the same.
    """
    from fieldmon.io.readers.other_plots import left_out, of_this_plot  # noqa: PLC0415 - as above

    here, said = of_this_plot(rows, season.plot.grid, own_names(season), options)
    return here, left_out(said)


def _of_this_season(
    season: Season, rows: InspectionRows, options: InspectionOptions, name: str
) -> tuple[InspectionRows, str]:
    """Return what `own_rows` does; refuse an export of other plots or seasons alone."""
    here, of_others = own_rows(season, rows, options)
    if not here.exported.any():
        raise ObservationError(
            worded(
                "What was corrected in an export must be of this season, {plot} ({file}), but of "
                "{name}: {said} Correct the season that it names; if it is this one, called "
                "otherwise then, empty that column. Nothing was taken.",
                plot=season.plot.field.name, file=season.path.stem, name=name, said=of_others,
            )
        )  # fmt: skip
    return here, of_others


def _exported_rows(season: Season, source: Source, options: InspectionOptions) -> InspectionRows:
    """Return the rows of a file that holds inspections exported from a season; refuse others."""
    (read, is_open), name = _read_by_days(season, source, options), source_name(source)
    rows = read.value
    is_exported = rows.exported.any()
    if is_open:
        raise ObservationError(
            worded(
                "Dates in {name} may be written day or month first, and what was not changed there "
                "does not tell. Write them year first, as 2026-04-06; nothing was taken.",
                name=name,
            )
        )
    _refuse_wrong_digests(rows, name)
    unsure = (one for one in read.messages if one.severity.is_loss or isinstance(one, UnsureCells))
    doubts = [one.sentence for one in unsure]
    if doubts and (is_exported or not len(rows)):
        raise ObservationError(
            worded(
                "What was corrected in an export must be read for certain, but of {name}: {doubts} "
                "Correct it there or in the season's own file; nothing was taken.",
                name=name, doubts=joined(" ", doubts),
            )
        )  # fmt: skip
    if not is_exported or "result" in _lacked(rows):
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


def _refuse_wrong_digests(rows: InspectionRows, name: str) -> None:
    """Refuse a file with something for a digest that no season wrote."""
    called = [] if rows.mark_called is None else rows.mark_called.tolist()
    for record, digest in zip(rows.source_row.tolist(), called, strict=True) if called else ():
        if digest and not is_mark(digest):
            raise ObservationError(
                worded(
                    "The digest of an exported inspection must be as the season wrote it, 24 small "
                    "letters and digits of 0-9 and a-f, in a table with i before, but of record "
                    "{record} of {name} it is {digest!r}. Put it there as it was exported; of what "
                    "is new leave it empty. Nothing was taken.",
                    record=record, name=name, digest=digest,
                )
            )  # fmt: skip


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
                "of record {record} of {name}: {doubt}. Correct it there or in the season's own "
                "file; nothing was taken.",
                record=record, name=name, doubt=doubt,
            )
        )  # fmt: skip
    if edits.n_alike:
        raise ObservationError(
            worded(
                "No inspection may stand there twice, but {n} of {name} {n:says|say} now what "
                "another inspection of the season says. Correct {n:it|them}, or delete one of both "
                "in the season's own file; nothing was taken.",
                n=edits.n_alike, name=name,
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
