"""Everything recorded, batch by batch: what a batch says, how it begins and ends."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from typing import TYPE_CHECKING

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import RESULT_NAMES, SKIPPED
from fieldmon.io.parse.result_words import GONE, says_gone
from fieldmon.io.writers.day_file import with_face
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import touch
from fieldmon.monitoring.file.rows_that_count import STANDS_BACK
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence

    from fieldmon.monitoring.inspecting.drafts import Draft
    from fieldmon.monitoring.inspecting.repeated_recordings import Addition
    from fieldmon.plot.grid import PlantGrid

#: where the rows of a batch stand, by its kind
TABLE_OF = {
    "findings": "inspections",
    "corrections": "inspections",
    "treatment": "treatments",
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
        """Return whether it was not undone, and all that it says counts in another batch.

        Or was corrected since: see `BatchContents`.
        """
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
    corrected
        How many inspections stand back for a correction.
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
    corrected: int = 0

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
    # what counts in another batch has the same digest there
    corrected = dict(
        db.execute(
            "SELECT batch, count(*) FROM inspections AS one "  # noqa: S608 - ours
            f"WHERE batch IN ({asked}) AND undone = ? AND NOT EXISTS "
            "(SELECT 1 FROM inspections WHERE digest = one.digest AND undone = 0) GROUP BY batch",
            (*numbers, STANDS_BACK),
        ).fetchall()
    )
    return {
        number: replace(
            BatchContents(*said),
            who=", ".join(who.get(number, ())),
            corrected=corrected.get(number, 0),
        )
        for number, *said in [*rows, *treated]
    }


def date_or_text(said: str | None) -> date | str:
    """Return a date of a season's file, which another program may have written."""
    try:
        return date.fromisoformat(said or "")
    except ValueError:
        return said or ""


def first_day(db: sqlite3.Connection, number: int) -> int:
    """Return the first day of the season of which a batch says something."""
    (kind,) = db.execute("SELECT kind FROM batches WHERE fid = ?", (number,)).fetchone()
    table = TABLE_OF[kind]
    days = f"SELECT min(day) FROM {table} WHERE batch = ?"  # noqa: S608 - ours
    (day,) = db.execute(days, (number,)).fetchone()
    return max(int(day or 0), 0)


def close_if_empty(db: sqlite3.Connection, batch: int) -> None:
    """Mark a batch of findings as undone if all of them were taken back."""
    db.execute(
        "UPDATE batches SET undone = 1 WHERE fid = ? AND kind <> 'treatment' AND NOT EXISTS "
        "(SELECT 1 FROM inspections WHERE batch = batches.fid AND undone <> 1) "
        "AND NOT EXISTS (SELECT 1 FROM outside_changes WHERE batch = batches.fid "
        "AND before NOTNULL AND undone = 0)",
        (batch,),
    )
