"""Everything recorded, batch by batch, and how it is taken back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import counted, joined, worded
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import RESULT_NAMES, SKIPPED
from fieldmon.io.parse.result_words import GONE, says_gone
from fieldmon.io.writers.day_file import with_face
from fieldmon.monitoring.file import rows_that_count, schema
from fieldmon.monitoring.file.geopackage import touch
from fieldmon.monitoring.inspecting.inspection_table import number_of
from fieldmon.monitoring.treating import treatments
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Mapping, Sequence

    from fieldmon.monitoring.inspecting.drafts import Draft
    from fieldmon.monitoring.inspecting.repeated_recordings import Addition
    from fieldmon.plot.grid import PlantGrid

_TABLE_OF = {
    "findings": "inspections",
    "corrections": "inspections",
    "treatment": "treatments",
}
_RESULTS = {
    "found": worded("found"),
    "clean": worded("clean"),
    "skipped": worded("skipped"),
    GONE: worded("gone"),
}


@dataclass(frozen=True)
class Batch:
    """One recording: a file of findings, a tap in scout mode, a treatment.

    Parameters
    ----------
    number
        For undoing.
    at
        When it was recorded, UTC.
    kind
        ``"findings"``, ``"treatment"``, or ``"corrections"`` of what another program changed.
    source, who
        File or screen it came from, and the person.
    rows
        Inspections or treatments it added.
    undone
        Whether it was undone; it is kept nevertheless.
    """

    number: int
    at: str
    kind: str
    source: str
    who: str
    rows: int
    undone: bool

    def by(self, said: BatchContents | None) -> str:
        """Return who inspected, as its inspections say, or else who recorded it."""
        named = "" if said is None or self.kind != "findings" else said.who
        return named or self.who

    def stands_back(self, said: BatchContents | None) -> bool:
        """Return whether it was not undone, and all that it says counts in another batch."""
        return said is not None and not self.undone and not said.counting


@dataclass(frozen=True)
class BatchContents:
    """What the inspections or the treatment of a batch say: those that count, or else all.

    Parameters
    ----------
    n, found
        How many inspections there are, and how many found something; plants treated, and 0.
    counting
        How many of them count: all or none.
    first, last
        The days of the first and the last of them, as ``2026-11-18``.
    row, plant, result, count
        Of the only inspection: where it was, ``"found"``, ``"clean"`` or ``"skipped"``, and how
        many were counted (None: nobody counted). Of several and of a treatment they say nothing.
    note
        Of the only inspection.
    at
        Its plant, by the number in the season's file.
    who
        Everybody who inspected, by name.
    efficacy
        Of a treatment: the chance that an infested plant is clean afterwards.
    """

    n: int
    found: int
    counting: int
    first: str
    last: str
    row: int
    plant: int
    result: str
    count: float | None = None
    note: str = ""
    at: int = -1
    who: str = ""
    efficacy: float | None = None

    @property
    def is_gone(self) -> bool:
        """Whether the only inspection says that the plant does not stand there any more."""
        return called(self.result, self.note) == GONE

    def number_on(self, grid: PlantGrid) -> str:
        """Return the plant's number in its row, with the face where it has two, for a sentence."""
        return with_face(grid, self.at, self.plant) if self.at >= 0 else str(self.plant)

    @property
    def called(self) -> str:
        """The result of the only inspection as people say it: that, or ``"gone"``."""
        return called(self.result, self.note)


def called(result: str, note: str | None) -> str:
    """Return a result of a season's file as people say it: that, or ``"gone"`` as its note says."""
    return GONE if result == RESULT_NAMES[SKIPPED] and says_gone(note or "") else result


class Undone(NamedTuple):
    """What an undo did: a sentence that says it, and the batch to redo; None: it is for good.

    `first` must be redone before that, if it is not None.
    """

    said: str
    batch: int | None
    first: int | None = None


@dataclass(frozen=True)
class Recorded:
    """What recording did.

    Parameters
    ----------
    batch
        Its number, for undoing; None if nothing was new.
    new, known
        Inspections or treatments that were added, and those that the season held already.
    corrected
        Those that hold in place of what was recorded before.
    noted, filled
        Of those known, how many got a note, and how many others got what was left open: a name, a
        chance to see what is there.
    seen_by_another
        How many others of those known somebody else recorded before: they count once, and still
        when one of the two batches is undone.
    """

    batch: int | None
    new: int
    known: int
    corrected: int = 0
    noted: int = 0
    filled: int = 0
    seen_by_another: int = 0

    @property
    def more(self) -> str:
        """What was added to those known, in words; empty: nothing."""
        return more_in_words(self.noted, self.filled, self.seen_by_another)


def more_in_words(noted: int, filled: int = 0, seen_by_another: int = 0) -> str:
    """Return in words how many notes were added to what was known, and how many gaps filled.

    And how many others somebody else recorded before.
    """
    said = [worded("{n} {n:note|notes} added", n=noted)] if noted else []
    if filled:
        said.append(worded("{n} completed", n=filled))
    if seen_by_another:
        said.append(worded("{n} by a second person added", n=seen_by_another))
    return joined(", ", said)


def n_more(more: Sequence[Addition | Draft]) -> dict[str, int]:
    """Return what `Recorded` counts of those known that say more."""
    noted = sum(one.is_note for one in more)
    filled = sum(one.fills and not one.is_note for one in more)
    return {"noted": noted, "filled": filled, "seen_by_another": len(more) - noted - filled}


def begin(db: sqlite3.Connection, kind: str, source: str, who: str) -> int:
    """Open a batch and return its number: the next one, as one that added nothing has none."""
    cursor = db.execute(
        "INSERT INTO batches (fid, at, kind, source, who, rows) "
        "SELECT coalesce(max(fid), 0) + 1, ?, ?, ?, ?, 0 FROM batches",
        (utc_text(), kind, source, who),
    )
    return int(cursor.lastrowid or 0)


def name(db: sqlite3.Connection, batch: int, who: str) -> None:
    """Say whose a batch is, besides those that it is of already."""
    (said,) = db.execute("SELECT coalesce(who, '') FROM batches WHERE fid = ?", (batch,)).fetchone()
    if said != who:
        both = {*said.split(", "), *who.split(", ")} - {""}
        names = ", ".join(sorted(both)) if said else who
        db.execute("UPDATE batches SET who = ? WHERE fid = ?", (names, batch))


def must_count(db: sqlite3.Connection, batch: int) -> None:
    """Raise `SettingError` unless a batch of inspections is there and was not undone."""
    row = db.execute("SELECT kind, undone FROM batches WHERE fid = ?", (batch,)).fetchone()
    if row is None or row[0] != "findings" or row[1]:
        raise SettingError(
            worded(
                "A batch to add inspections to must still count, but batch {batch} does not. See "
                "what was recorded with: fieldmon status --batches",
                batch=batch,
            )
        )


def end(db: sqlite3.Connection, batch: int, rows: int, *, grows: bool = False) -> None:
    """Note how much a batch added; one that added nothing was none, unless it only `grows`."""
    if grows:
        db.execute("UPDATE batches SET rows = rows + ? WHERE fid = ?", (rows, batch))
    elif rows:
        db.execute("UPDATE batches SET rows = ? WHERE fid = ?", (rows, batch))
    else:
        db.execute("DELETE FROM batches WHERE fid = ?", (batch,))
    touch(db, schema.BATCHES.name)


def count_inspections(db: sqlite3.Connection) -> None:
    """Let batches of inspections have as many rows as are left: some may be corrections."""
    db.execute(
        "UPDATE batches SET rows = (SELECT count(*) FROM inspections WHERE batch = batches.fid) "
        "WHERE kind = 'findings'"
    )


def all_of(db: sqlite3.Connection) -> tuple[Batch, ...]:
    """Return every batch, the last one first."""
    rows = db.execute(
        "SELECT fid, at, kind, source, who, rows, undone FROM batches ORDER BY fid DESC"
    )
    return tuple(
        Batch(number, at, kind, source or "", who or "", added, bool(undone))
        for number, at, kind, source, who, added, undone in rows
    )


def corrected_by(db: sqlite3.Connection) -> dict[tuple[object, ...], str]:
    """Return who corrected inspections that count, by plant, day (ISO), result and count."""
    rows = db.execute(
        "SELECT plant, date, result, count, coalesce(batches.who, '') FROM inspections "
        "JOIN batches ON batches.fid = batch WHERE kind = 'corrections' AND inspections.undone = 0"
    )
    return {(plant, day, result, count): who for plant, day, result, count, who in rows}


def contents(db: sqlite3.Connection, numbers: Sequence[int]) -> dict[int, BatchContents]:
    """Return what batches of inspections and treatments say, by their numbers."""
    asked = ", ".join("?" * len(numbers))
    treated = db.execute(
        "SELECT batch, sum(plants), 0, sum(plants * (undone = 0)), min(date), max(date), 0, 0, '', "  # noqa: S608 - ours
        "NULL, '', -1, '', max(efficacy) "
        f"FROM treatments WHERE batch IN ({asked}) AND date NOTNULL GROUP BY batch",
        tuple(numbers),
    ).fetchall()
    # what was taken back, or another batch says too, is left out where others of the batch count
    rows = db.execute(
        f"WITH own AS (SELECT * FROM inspections WHERE batch IN ({asked}) "  # noqa: S608 - ours
        "AND date NOTNULL AND result NOTNULL), "
        "counting AS (SELECT DISTINCT batch FROM own WHERE undone = 0) "
        "SELECT batch, count(*), sum(result = 'found'), sum(undone = 0), min(date), max(date), "
        "min(line), min(number), min(result), min(count), min(coalesce(notes, '')), "
        "coalesce(min(plant), -1) FROM own "
        "WHERE undone = 0 OR batch NOT IN counting GROUP BY batch",
        tuple(numbers),
    )
    named = db.execute(
        f"SELECT DISTINCT batch, who FROM inspections WHERE batch IN ({asked}) "  # noqa: S608 - ours
        "AND coalesce(who, '') <> '' ORDER BY who",
        tuple(numbers),
    )
    who: dict[int, list[str]] = {}
    for number, name in named:
        who.setdefault(number, []).append(name)
    return {
        number: replace(BatchContents(*said), who=", ".join(who.get(number, ())))
        for number, *said in [*rows, *treated]
    }


def undo(
    db: sqlite3.Connection, number: int | None, signs: Mapping[int, str] | None = None
) -> tuple[set[int], str]:
    """Mark a batch (None: the last one that counts) as undone; say what was done.

    What another batch says, too, counts there. `signs` is how rows are shown, by their numbers.
    Return the batches that changed.
    """
    batch = _waiting(db, number)
    table, stay = _TABLE_OF[batch.kind], 0
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
    before = rows_that_count.redo_corrections(db, number, but)
    first = to_redo_first(db, number, but) if before is None else None
    if first is not None:
        raise SettingError(
            worded(
                "What batch {batch} corrected must count before the correction can, but batch "
                "{first} was undone. Let that count again first: --redo {first}",
                batch=number,
                first=first,
            )
        )
    if before is None:
        raise SettingError(
            worded(
                "What batch {batch} corrected must stand there as it did before, but it was "
                "corrected anew or taken back since. Undo that first, or correct it anew.",
                batch=number,
            )
        )
    table = _TABLE_OF[batch.kind]
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


def _plant_of(db: sqlite3.Connection, said: BatchContents | None) -> str:
    """Return which plant of its row the only inspection of a batch is of, as people say it."""
    return "" if said is None or said.n != 1 else number_of(db, said.at, said.plant)


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
    noun = {"findings": "inspection", "corrections": "correction", "treatment": "treatment"}[
        batch.kind
    ]
    again = worded("Batch {batch} counts again: {what}.", batch=batch.number, what=counted(n, noun))
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
    what = {
        "findings": counted(batch.rows, "inspection"),
        "corrections": counted(batch.rows, "correction"),
        "treatment": counted(batch.rows, "treatment"),
    }[batch.kind]
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


def date_or_text(said: str | None) -> date | str:
    """Return a date of a season's file, which another program may have written."""
    try:
        return date.fromisoformat(said or "")
    except ValueError:
        return said or ""


def first_day(db: sqlite3.Connection, number: int) -> int:
    """Return the first day of the season of which a batch says something."""
    (kind,) = db.execute("SELECT kind FROM batches WHERE fid = ?", (number,)).fetchone()
    table = _TABLE_OF[kind]
    days = f"SELECT min(day) FROM {table} WHERE batch = ?"  # noqa: S608 - ours
    (day,) = db.execute(days, (number,)).fetchone()
    return max(int(day or 0), 0)


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


def close_if_empty(db: sqlite3.Connection, batch: int) -> None:
    """Mark a batch of findings as undone if all of them were taken back."""
    db.execute(
        "UPDATE batches SET undone = 1 WHERE fid = ? AND kind <> 'treatment' AND NOT EXISTS "
        "(SELECT 1 FROM inspections WHERE batch = batches.fid AND undone <> 1) "
        "AND NOT EXISTS (SELECT 1 FROM outside_changes WHERE batch = batches.fid "
        "AND before NOTNULL AND undone = 0)",
        (batch,),
    )
