"""Treatments of two copies: what both recorded counts once, what may be one is said."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from fieldmon.compute.wording import day_said, joined, worded
from fieldmon.decisions.labels import plain_name
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.rows_that_count import COUNTS, NOTHING_CORRECTED, TAKEN_BACK
from fieldmon.monitoring.merging import merged_rows
from fieldmon.monitoring.merging.merged_recordings import recordings_of_both
from fieldmon.monitoring.treating import treatments

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.merging.merged_rows import Numbers, TableRows
    from fieldmon.monitoring.treating.treatments import Row

#: digests and batches of now of the treatments that a copy had
Held = set[tuple[str | None, int | None]]
#: what a label may fill in, in words
_FILLED = dict(
    zip(
        treatments.FILLED,
        (worded("waiting days"), worded("re-entry hours"), worded("group")),
        strict=True,
    )
)
# of two treatments, which copies had each
_EACH_BY_ONE = [True, False], [False, True]


def merge(
    db: sqlite3.Connection, copies: list[TableRows], numbers: list[Numbers]
) -> tuple[list[Row], list[Held]]:
    """Let `db` have the treatments of both; return them, and which each copy had."""
    own = [copied["treatments"] for copied in copies]
    treated = recordings_of_both(own, numbers, set(), NOTHING_CORRECTED)
    treatments.settle(treated)
    merged_rows.write(db, schema.TREATMENTS, treated)
    held = [{(row["digest"], batch_of.get(row["batch"])) for row in rows}
            for rows, batch_of in zip(own, numbers, strict=True)]  # fmt: skip
    return treated, held


def changed(
    db: sqlite3.Connection, applied: list[dict[int, frozenset[str]]]
) -> tuple[tuple[Worded, ...], tuple[set[int], set[int], set[int]]]:
    """Return which treatments are new, in words, and the numbers of those that count no more.

    `applied` is what those that counted in each copy are known by, by their numbers there; what
    counts no more is told apart as in `MergedCopy.gone`.
    """
    rows = treatments.rows_counting(db)
    counting = [treatments.known_by(row) for row in rows]
    known, theirs = (frozenset().union(*one.values()) for one in applied)
    new = (row for row, marks in zip(rows, counting, strict=True) if known.isdisjoint(marks))
    now = frozenset().union(*counting)
    here, there = ({n: marks for n, marks in one.items() if marks.isdisjoint(now)}
                   for one in applied)  # fmt: skip
    twice = {n for n, marks in here.items() if marks & theirs}
    alone = {n for n, marks in there.items() if marks.isdisjoint(known)}
    return tuple(map(_in_words, new)), ({*here} - twice, alone, twice)


def alike_but_for_labels(treated: list[Row], held: list[Held]) -> Iterator[str]:
    """Yield a sentence for each two treatments that say the same but for what a label may add.

    One is of each copy: `held` says which each had. Where people said the same the second stands
    back for the first; else nobody knows, and both count.
    """
    alike: dict[str, list[Row]] = {}
    for row in treated:
        if row["undone"] != TAKEN_BACK and row["digest"] is not None:
            alike.setdefault(treatments.but_for_labels(row), []).append(row)
    for one, other in (pair for rows in alike.values() for pair in combinations(rows, 2)):
        names = [name for name in treatments.FILLED if one[name] != other[name]]
        of = _held_by(one, held), _held_by(other, held)
        if not names or of not in (_EACH_BY_ONE, _EACH_BY_ONE[::-1]):
            continue
        here, there = (one, other) if of == _EACH_BY_ONE else (other, one)
        differ = joined(", ", [
            worded(
                "{what} {here} here, {there} there", what=_FILLED[name],
                here=_or_none(here[name]), there=_or_none(there[name]),
            )
            for name in names
        ])  # fmt: skip
        counting = [row["undone"] for row in (one, other)].count(COUNTS)
        if counting == 1 and treatments.known_by(one) & treatments.known_by(other):
            yield _of_one(one, differ)
        elif counting == 2:
            yield _of_two(one, other, names, differ)


def _held_by(row: Row, held: list[Held]) -> list[bool]:
    """Return which copies had a treatment."""
    return [(row["digest"], row["batch"]) in had for had in held]


def _of_one(row: Row, differ: str) -> str:
    return worded(
        "The treatment with {named} was recorded in both, and labels added different values: "
        "{differ}. It counts once; the longer waits and all groups hold.",
        named=_named(row),
        differ=differ,
    )


def _of_two(one: Row, other: Row, names: list[str], differ: str) -> str:
    old = any(
        row["by_label"] is None and row[name] is not None for row in (one, other) for name in names
    )
    if old:
        differ = worded(
            "{differ} (an earlier version did not note whether a label added that)", differ=differ
        )
    return worded(
        "Treatments with {named}, batches {first} and {second}, say the same but for {differ}. "
        "Both count; if they are one, undo a batch.",
        named=_named(one), first=one["batch"], second=other["batch"], differ=differ,
    )  # fmt: skip


def _in_words(row: Row) -> Worded:
    """Return a treatment by its product, its day and who made it."""
    if not row["operator"]:
        return _named(row)
    return worded("{named} by {who}", named=_named(row), who=row["operator"])


def _named(row: Row) -> Worded:
    """Return a treatment by its product and its day."""
    product = row["product"] or worded("a product that nobody named")
    return worded("{product} on {day}", product=product, day=day_said(row["date"]))


def _or_none(value: object) -> str:
    return (
        worded("none")
        if value is None
        else f"{value:g}"
        if isinstance(value, float)
        else str(value)
    )


def of_one_product(treated: list[Row], held: list[Held]) -> Iterator[tuple[int, int]]:
    """Yield the numbers of each two treatments of one day and product that people may have doubled.

    Both count, and one is of each copy: `held` is as above. What differs in what a label may add
    alone is told there.
    """
    same: dict[tuple[str, str], list[tuple[int, Row, list[bool]]]] = {}
    for number, row in enumerate(treated, 1):
        of = _held_by(row, held)
        if row["undone"] == COUNTS and not all(of):
            product = row["date"], plain_name(row["product"] or "")
            same.setdefault(product, []).append((number, row, of))
    for one, other in (pair for rows in same.values() for pair in combinations(rows, 2)):
        alike = treatments.but_for_labels(one[1]) == treatments.but_for_labels(other[1])
        if one[2] != other[2] and not alike:
            yield one[0], other[0]
