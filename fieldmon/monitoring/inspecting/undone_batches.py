"""What was recorded taken back, by the batch or one by one, and counting again; said in words."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import counted, joined, worded
from fieldmon.errors import SettingError
from fieldmon.io.parse.result_words import GONE
from fieldmon.monitoring.file import rows_that_count, schema
from fieldmon.monitoring.file.geopackage import touch
from fieldmon.monitoring.inspecting.batches import (
    TABLE_OF,
    all_of,
    called,
    close_if_empty,
    contents,
    date_or_text,
)
from fieldmon.monitoring.inspecting.inspection_table import number_of
from fieldmon.monitoring.treating import treatments

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Mapping, Sequence

    from fieldmon.monitoring.inspecting.batches import Batch, BatchContents

_RESULTS = {
    "found": worded("found"),
    "clean": worded("clean"),
    "skipped": worded("skipped"),
    GONE: worded("gone"),
}


class Undone(NamedTuple):
    """What an undo did: a sentence that says it, and the batch to redo; None: it is for good.

    `first` must be redone before that, if it is not None.
    """

    said: str
    batch: int | None
    first: int | None = None


def undo(
    db: sqlite3.Connection, number: int | None, signs: Mapping[int, str] | None = None
) -> tuple[set[int], str]:
    """Mark a batch (None: the last one that counts) as undone; say what was done.

    What another batch says, too, counts there. `signs` is how rows are shown, by their numbers.
    Return the batches that changed.
    """
    batch = _waiting(db, number)
    table, stay = TABLE_OF[batch.kind], 0
    if batch.kind == "findings":
        stay = rows_that_count.n_corrected(db, batch.number)
    db.execute(f"UPDATE {table} SET undone = 1 WHERE batch = ?", (batch.number,))  # noqa: S608 - ours
    db.execute("UPDATE batches SET undone = 1 WHERE fid = ?", (batch.number,))
    rows_that_count.undo_corrections(db, batch.number)
    rows = treatments if batch.kind == "treatment" else rows_that_count
    again = rows.count_again(db)
    touch(db, table)
    said = contents(db, [batch.number]).get(batch.number)
    told = _undone(batch, said, (signs or {}, _plant_of(db, said)), stay)
    return {batch.number, *again}, _still(told, rows.n_elsewhere(db, batch.number))


def to_undo(db: sqlite3.Connection, number: int | None) -> tuple[int, list[str]]:
    """Return which batch is undone by `undo`, and the digests of what was taken back of it before.

    Raise `SettingError` as that does.
    """
    batch = _waiting(db, number)
    rows = db.execute(
        "SELECT digest FROM inspections WHERE undone = ? AND digest NOTNULL AND batch = ? "
        "ORDER BY digest",
        (rows_that_count.TAKEN_BACK, batch.number),
    )
    return batch.number, [mark for (mark,) in rows]


def _waiting(db: sqlite3.Connection, number: int | None) -> Batch:
    """Return a batch that counts (None: the last one), or raise `SettingError`."""
    waiting = [batch for batch in all_of(db) if not batch.undone]
    if number is not None:
        waiting = [batch for batch in waiting if batch.number == number]
    if not waiting:
        what = "to undo" if number is None else f"called batch {number} that still counts"
        raise SettingError(
            worded(
                "There must be something {what}, but there is nothing. See "
                "what was recorded with: fieldmon status --batches",
                what=what,
            )
        )
    return waiting[0]


def to_redo(db: sqlite3.Connection, changed: set[int]) -> int | None:
    """Return which of the batches that an undo changed can be redone; None: none of them."""
    numbers = (one.number for one in all_of(db) if one.number in changed and one.undone)
    return next(numbers, None)


def to_redo_first(db: sqlite3.Connection, number: int, but: Sequence[str] = ()) -> int | None:
    """Return which undone batch must count again before one of corrections can; None: none must.

    `but` as in `redo`.
    """
    held = (
        "SELECT min(batch) FROM inspections JOIN batches ON batches.fid = batch "
        "WHERE digest = ? AND batches.undone = 1 AND batch <> ?"
    )
    for mark in rows_that_count.not_as_before(db, number, but):
        (first,) = db.execute(held, (mark, number)).fetchone()
        if first is not None:
            return int(first)
    return None


def redo(
    db: sqlite3.Connection, number: int, but: Sequence[str] = (),
    signs: Mapping[int, str] | None = None,
) -> tuple[set[int], str]:  # fmt: skip
    """Let a batch that was undone count again, `but` for inspections with these digests.

    `signs` as in `undo`. Return the batches that changed, and what was done.
    """
    batch = next((one for one in all_of(db) if one.number == number and one.undone), None)
    if batch is None:
        raise SettingError(
            worded(
                "A batch that is to count again must have been undone, but batch {batch} was not. "
                "See what was recorded with: fieldmon status --batches",
                batch=number,
            )
        )
    before = _corrections_again(db, number, but)
    table = TABLE_OF[batch.kind]
    stays = ", ".join("?" * len(but))
    of = f"batch = ? AND undone = ? AND coalesce(digest, '') NOT IN ({stays})"
    db.execute(
        f"UPDATE {table} SET undone = ? WHERE {of}",  # noqa: S608 - ours
        (rows_that_count.STANDS_BACK, number, rows_that_count.TAKEN_BACK, *but),
    )
    db.execute("UPDATE batches SET undone = 0 WHERE fid = ?", (number,))
    rows = treatments if batch.kind == "treatment" else rows_that_count
    again = rows.count_again(db)
    touch(db, table)
    elsewhere = rows.n_elsewhere(db, number, rows_that_count.STANDS_BACK)
    said = contents(db, [number]).get(number)
    n = batch.rows - len(but) - elsewhere
    if batch.kind == "findings":
        n -= rows_that_count.n_corrected(db, number)
    place = signs or {}, _plant_of(db, said)
    return {number, *before, *again}, _counts_again(batch, said, (n, elsewhere), place)


def _corrections_again(db: sqlite3.Connection, number: int, but: Sequence[str]) -> set[int]:
    """Let a batch's corrections hold again; return the batches that they change.

    Raise `SettingError` where what they corrected does not stand there as it did before.
    """
    before = rows_that_count.redo_corrections(db, number, but)
    if before is not None:
        return before
    first = to_redo_first(db, number, but)
    if first is not None:
        raise SettingError(
            worded(
                "What batch {batch} corrected must count before the correction can, but batch "
                "{first} was undone. Let that count again first: --redo {first}",
                batch=number,
                first=first,
            )
        )
    raise SettingError(
        worded(
            "What batch {batch} corrected must stand there as it did before, but it was "
            "corrected anew or taken back since. Undo that first, or correct it anew.",
            batch=number,
        )
    )


def _plant_of(db: sqlite3.Connection, said: BatchContents | None) -> str:
    """Return which plant of its row the only inspection of a batch is of, as people say it."""
    return "" if said is None or said.n != 1 else number_of(db, said.at, said.plant)


def _rows_of(batch: Batch, n: int) -> str:
    """Return in words so many rows of a batch."""
    return {
        "findings": counted(n, "inspection"),
        "corrections": counted(n, "correction"),
        "treatment": counted(n, "treatment"),
    }[batch.kind]


def _counts_again(
    batch: Batch,
    said: BatchContents | None,
    rows: tuple[int, int],
    place: tuple[Mapping[int, str], str],
) -> str:
    """Return in words how many rows of a batch count again, and how many count in another one."""
    (n, elsewhere), (signs, plant) = rows, place
    if elsewhere and n <= 0:
        return worded(
            "Nothing of batch {batch} counts again: it counts in another already.",
            batch=batch.number,
        )
    if batch.kind == "findings" and said is not None and batch.rows == n == 1:
        return worded(
            "Counts again: row {row}, plant {plant} on {date} ({result}).",
            row=signs.get(said.row, said.row), plant=plant, date=date_or_text(said.first),
            result=_RESULTS.get(said.called, said.called),
        )  # fmt: skip
    what = _rows_of(batch, n)
    again = worded("Batch {batch} counts again: {what}.", batch=batch.number, what=what)
    if not elsewhere:
        return again
    more = worded("{n:,} more {n:counts|count} in another batch already.", n=elsewhere)
    return joined(" ", (again, more))


def _undone(
    batch: Batch, said: BatchContents | None, place: tuple[Mapping[int, str], str], stay: int
) -> str:
    """Return what was taken back, in words; so many of its inspections `stay` as corrected.

    `place` is how rows are shown, by their numbers, and the plant of the only inspection.
    """
    if stay:
        one = _undone(replace(batch, rows=batch.rows - stay), None, place, 0)
        more = worded(
            "{n:,} {n:inspection stays|inspections stay} as {n:it was|they were} corrected since.",
            n=stay,
        )
        return joined(" ", (one, more))
    if batch.kind == "findings" and said is not None and said.n == 1:
        signs, plant = place
        return _undone_one(signs.get(said.row, said.row), plant, said.first, said.called)
    what = _rows_of(batch, batch.rows)
    if batch.kind == "treatment" and batch.source:
        return worded(
            "Batch {batch} was undone: {what} with {product}.",
            batch=batch.number,
            what=what,
            product=batch.source,
        )
    if batch.source:
        return worded(
            "Batch {batch} was undone: {what} from {source}.",
            batch=batch.number,
            what=what,
            source=batch.source,
        )
    return worded("Batch {batch} was undone: {what}.", batch=batch.number, what=what)


def _still(said: str, n: int) -> str:
    """Return what was taken back, and how many of it count all the same."""
    if not n:
        return said
    still = worded(
        "{n} of the same {n:results counts|results count} still: another recording holds "
        "{n:it|them}, too.",
        n=n,
    )
    return joined(" ", (said, still))


def _undone_one(row: int | str, plant: str, on: str, result: str) -> str:
    return worded(
        "Undone: row {row}, plant {plant} on {date} ({result}).",
        row=row,
        plant=plant,
        date=date_or_text(on),
        result=_RESULTS.get(result, result),
    )


def _undone_correction(row: int | str, plant: str, on: str, result: str) -> str:
    return worded(
        "Undone: the correction of row {row}, plant {plant} on {date}. As it was recorded before, "
        "it counts again ({result}): undo it once more to take that back, too.",
        row=row,
        plant=plant,
        date=date_or_text(on),
        result=_RESULTS.get(result, result),
    )


def undo_one(
    db: sqlite3.Connection, inspection: int, signs: Mapping[int, str] | None = None
) -> tuple[set[int], str]:
    """Mark one inspection as undone; return the batches that changed, and what was done."""
    row = counting(db, inspection)
    db.execute("UPDATE inspections SET undone = 1 WHERE fid = ?", (inspection,))
    before = rows_that_count.undo_corrections(db, *row[4:])
    again = rows_that_count.count_again(db)
    close_if_empty(db, row[4])
    touch(db, schema.INSPECTIONS.name)
    sign = (signs or {}).get(row[0], row[0])
    of = "SELECT plant, result, notes FROM inspections WHERE fid = ?"
    at, *seen = db.execute(of, (inspection,)).fetchone()
    plant, result = number_of(db, at, row[1]), called(*seen)
    if counts := [one for mark in before if (one := _result_of(db, mark))]:
        return {row[4], *again}, _undone_correction(sign, plant, row[2], counts[0])
    return {row[4], *again}, _still(
        _undone_one(sign, plant, row[2], result), rows_that_count.n_counting(db, row[5])
    )


def _result_of(db: sqlite3.Connection, mark: str) -> str:
    """Return the result of the inspection with a digest that counts; empty: none does."""
    of = "SELECT result, notes FROM inspections WHERE digest = ? AND undone = 0"
    row = db.execute(of, (mark,)).fetchone()
    return "" if row is None else called(*row)


def counting(db: sqlite3.Connection, inspection: int) -> tuple[int, int, str, str, int, str]:
    """Return line, number, date, result, batch and digest of one inspection that still counts."""
    row: tuple[int, int, str, str, int, str] | None = db.execute(
        "SELECT line, number, date, result, batch, digest FROM inspections "
        "WHERE fid = ? AND undone = 0",
        (inspection,),
    ).fetchone()
    if row is None:
        raise SettingError(
            worded(
                "There must be an inspection {inspection} that still counts, "
                "but there is none. The layer inspections of the season's "
                "file shows their numbers (fid).",
                inspection=inspection,
            )
        )
    return row
