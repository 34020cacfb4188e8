"""Inspections exported from a season that come back changed: of which ones, and what they say now.

A file may hold the layer `inspections` of a season's file alone, as QGIS exports it: each of its
inspections has the digest by which the season knows it. Whether somebody corrected it there, or
inspected again and wrote that over it, no file says: it is a correction only where it is brought
as one (`fieldmon correct`).
"""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, ObservationError
from fieldmon.infestation.inspection_columns import COLUMNS, IDENTIFYING
from fieldmon.io.options import source_name
from fieldmon.monitoring import inspection_table
from fieldmon.monitoring.rows_that_count import COUNTS
from fieldmon.monitoring.transactions import connect, copy_season

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.monitoring import Season

# anybody may change the others; `record` takes what they say
_WATCHED = tuple(column for column in COLUMNS if column.watched)
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


def changed_in(
    season: Season, rows: InspectionRows, options: InspectionOptions
) -> tuple[list[ChangedInspection], list[str], dict[int, str]]:
    """Return which inspections of a season a file exported from it says otherwise.

    And the digests of those that the season does not hold, and why records cannot be told, by
    their number in the file. What was changed so already is no change.
    """
    from fieldmon.io.readers.inspections import exported  # noqa: PLC0415 - half a second to import

    told, marks, why = exported(rows, season.plot.grid, options)
    if not marks:
        return [], [], why
    names = ", ".join(column.kept for column in _WATCHED)
    with season.store.reading() as db:
        # of those that stand back for one another, that which counts
        held = {
            mark: (fid, undone, values)
            for fid, undone, mark, *values in db.execute(
                f"SELECT fid, undone, digest, {names} FROM inspections "  # noqa: S608 - ours
                "WHERE digest NOTNULL ORDER BY undone = 0, fid"
            )
        }
    counting = {_key(values) for _, undone, values in held.values() if undone == COUNTS}
    now_said = inspection_table.kept_columns(told)
    changed, unknown = [], []
    for mark, *now in zip(marks, *(now_said[one.kept] for one in _WATCHED), strict=True):
        if mark not in held:
            unknown.append(mark)
            continue
        row, undone, was = held[mark]
        pairs = zip(_WATCHED, was, now, strict=True)
        says = {one.kept: new for one, old, new in pairs if _key((old,)) != _key((new,))}
        if not says or _key(now) in counting:
            continue
        if undone == COUNTS:
            changed.append(ChangedInspection(row, says))
        else:
            unknown.append(mark)
    return changed, unknown, why


def edited_copy(
    season: Season, source: Source, options: InspectionOptions, folder: Path
) -> tuple[Path, int]:
    """Return a copy of a season changed as a file exported from it, and how many were added there.

    `SeasonCorrections.take_corrections` takes what was changed. What is missing in the file was not
    deleted: a selection may be exported. What was added is no correction.

    Raises
    ------
    ObservationError
        If the file holds no inspections exported from a season, or one whose plant is not sure.
    FileProblem
        If some are of another season, or count no longer in this one.
    """
    from fieldmon.io.read import read_inspection_rows  # noqa: PLC0415 - as above

    rows, name = read_inspection_rows(source, options).value, source_name(source)
    n_exported = 0 if rows.mark is None else int((rows.mark != "").sum())
    if not n_exported:
        raise ObservationError(
            worded(
                "A file of corrections must hold inspections exported from the season, with their "
                "columns digest and undone, but {name} holds none. What is new comes with: "
                "fieldmon record",
                name=name,
            )
        )
    changed, unknown, why = changed_in(season, rows, options)
    for record, doubt in why.items():
        raise ObservationError(
            worded(
                "An exported inspection must say plant, date and result as the season does, but "
                "of record {record} of {name}: {doubt}. Mend it there, or change it in the "
                "season's own file; nothing was taken.",
                record=record, name=name, doubt=doubt,
            )
        )  # fmt: skip
    if unknown:
        raise FileProblem(
            worded(
                "What was corrected in an export must count in the season, but {n} "
                "{n:inspection|inspections} of {name} {n:is|are} not in it, or "
                "{n:was|were} corrected or taken back there since. Export the layer anew and "
                "correct that; nothing was taken.",
                n=len(unknown), name=name,
            )
        )  # fmt: skip
    copy = folder / "export.gpkg"
    copy_season(season.path, copy)
    with closing(connect(copy)) as db:
        db.execute("BEGIN")
        for row, says in changed:
            sets = ", ".join(f"{column} = ?" for column in says)
            db.execute(f"UPDATE inspections SET {sets} WHERE fid = ?", (*says.values(), row))  # noqa: S608 - ours
        db.execute("COMMIT")
    return copy, len(rows) - n_exported


def _key(values: Iterable[Any]) -> tuple[Any, ...]:
    """Return what a row says; nothing, and a count of 0, are nothing."""
    return tuple(value or None for value in values)
