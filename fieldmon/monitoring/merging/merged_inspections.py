"""Inspections of two copies: those that both begin with stay untouched, which are nearly all."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.infestation import inspection_columns
from fieldmon.infestation.inspections import FOUND, RESULT_NAMES
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.merging import merged_rows
from fieldmon.monitoring.merging.merged_recordings import recordings_of_both

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.file.rows_that_count import Corrected
    from fieldmon.monitoring.merging.merged_rows import Numbers

#: what rows of the same inspections say, beside what makes them the same; numbers may be none
_BESIDE = tuple(
    one.kept if one.is_text and not one.since else f"coalesce({one.kept}, '')"
    for one in inspection_columns.BESIDE
)
_SAYS = "digest", "undone", *_BESIDE
_SAID = f"SELECT {', '.join(_SAYS)} FROM inspections WHERE batch = ? ORDER BY fid"  # noqa: S608 - ours
# the same in one row: whichever way SQLite finds those of a batch, it is in the order of their fid
_TOGETHER = (
    "SELECT "  # noqa: S608 - names of ours
    + ", ".join([*map("count({})".format, _SAYS), *map("group_concat({})".format, _SAYS)])
    + " FROM inspections WHERE batch = ?"
)


class NewInspections(NamedTuple):
    """What is told of the inspections that count once copies were merged, and did not before.

    Parameters
    ----------
    by
        How many each person made, who made most first; "": nobody was named.
    plants
        Of how many plants they are.
    found
        How many found pests.
    days
        Their days (ISO), in order.
    """

    by: tuple[tuple[str, int], ...] = ()
    plants: int = 0
    found: int = 0
    days: tuple[str, ...] = ()


NOTHING_NEW = NewInspections()


def told_of(db: sqlite3.Connection, new: set[str], stay: int) -> NewInspections:
    """Return what there is to tell of new inspections; none is of the first that `stay`."""
    said = (
        "SELECT digest, coalesce(who, ''), plant, result, date FROM inspections "
        "WHERE undone = 0 AND fid > ?"
    )
    rows = [row for mark, *row in db.execute(said, (stay,)) if mark in new]
    if not rows:
        return NOTHING_NEW
    who, plants, results, days = zip(*rows, strict=True)
    by = sorted(Counter(who).items(), key=lambda one: (-one[1], one[0]))
    found = results.count(RESULT_NAMES[FOUND])
    return NewInspections(tuple(by), len({*plants}), found, tuple(sorted({*days})))


def counting(db: sqlite3.Connection, stay: int = 0) -> set[str]:
    """Return inspections that count by their digests; the first that `stay` are left out."""
    counts = "SELECT digest FROM inspections WHERE undone = 0 AND digest NOTNULL AND fid > ?"
    return {mark for (mark,) in db.execute(counts, (stay,))}


def merge(
    both: tuple[sqlite3.Connection, sqlite3.Connection],
    numbers: list[Numbers],
    gone: Corrected,
    stay: int,
) -> None:
    """Let the first of both have the inspections of both, of which so many `stay`.

    `numbers` says how the batches of each are numbered now, `gone` what was corrected.
    """
    db = both[0]
    copies = [merged_rows.rows_of(one, schema.INSPECTIONS, stay) for one in both]
    counts = "SELECT digest FROM inspections WHERE digest = ? AND undone = 0 AND fid <= ?"
    digests = {row["digest"] for rows in copies for row in rows}
    already = {held for one in digests for (held,) in db.execute(counts, (one, stay))}
    merged = recordings_of_both(copies, numbers, already, gone)
    merged_rows.write(db, schema.INSPECTIONS, merged, stay)


def n_staying(both: tuple[sqlite3.Connection, sqlite3.Connection], numbers: list[Numbers]) -> int:
    """Return how many inspections both copies begin with that come out just as they are in ours.

    They are those of whole batches, which have their numbers already: no other row can be known
    again in one of them, or come between them.
    """
    n, batch = _alike_at_first(both, numbers)
    rest = (
        "SELECT DISTINCT batch FROM (SELECT batch FROM inspections ORDER BY fid LIMIT -1 OFFSET ?)"
    )
    later = [
        batch_of.get(number, batch + 1)
        for one, batch_of in zip(both, numbers, strict=True)
        for (number,) in one.execute(rest, (n,))
    ]
    before = "SELECT count(*) FROM inspections WHERE fid <= ? AND batch < ?"
    (stay,) = both[0].execute(before, (n, min(later, default=batch + 1))).fetchone()
    return int(stay)


def _alike_at_first(
    both: tuple[sqlite3.Connection, sqlite3.Connection], numbers: list[Numbers]
) -> tuple[int, int]:
    """Return how many inspections both begin with in whole batches of one number, and the last."""
    ours, theirs = numbers
    here, there = (_spans(one) for one in both)
    n, batch = 0, 0
    for number in sorted(ours):
        if number not in here and number not in there:
            continue  # of treatments
        first, last, count = span = here.get(number, (0, 0, 0))
        if (ours[number], theirs.get(number)) != (number, number) or span != there.get(number):
            break
        if (first, last) != (n + 1, n + count) or not is_same_batch(both, number, count):
            break
        n, batch = last, number
    return n, batch


def is_same_batch(
    both: tuple[sqlite3.Connection, sqlite3.Connection], number: int, count: int
) -> bool:
    """Tell whether so many inspections of a batch say the same in both, each something else."""
    one, other = (db.execute(_TOGETHER, (number,)).fetchone() for db in both)
    there, said = {*one[: len(_SAYS)]}, one[len(_SAYS) :]
    # where something holds a comma, or nothing, is looked at row by row
    if there == {count} and one == other and {one.count(",") for one in said} == {count - 1}:
        return len({*said[0].split(",")}) == count
    rows, others = (db.execute(_SAID, (number,)).fetchall() for db in both)
    # what was taken back and recorded again stands there twice
    return (
        rows == others
        and not any(None in row for row in rows)
        and len({digest for digest, *_ in rows}) == count
    )


def _spans(db: sqlite3.Connection) -> dict[int, tuple[int, int, int]]:
    """Return of each batch its first and last inspection, and how many there are."""
    spans = "SELECT batch, min(fid), max(fid), count(*) FROM inspections GROUP BY batch"
    return {number: (first, last, count) for number, first, last, count in db.execute(spans)}
