"""Batches of two copies and what became of them: each once, numbered as they were recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.file import rows_that_count, schema
from fieldmon.monitoring.merging import merged_rows
from fieldmon.monitoring.merging.merged_rows import key_of

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Hashable

    from fieldmon.monitoring.file.rows_that_count import Corrected
    from fieldmon.monitoring.merging.merged_rows import Numbers, TableRows
    from fieldmon.monitoring.treating.treatments import Row

#: what a batch is known by in every copy
_KNOWN_BY = ("at", "source", "who", "kind")
#: and what another program changed, or a correction
CHANGE_KNOWN_BY = tuple(name for name in schema.OUTSIDE_CHANGES.names if name != "undone")


def of_both(copies: list[TableRows]) -> dict[Hashable, Row]:
    """Return the batches of both by what they are known by, numbered as they were recorded.

    One that need not make room keeps its number. Of corrections it is known how many they were and
    whether they were taken back; others are counted (`_count`).
    """
    found: dict[Hashable, Row] = {}
    place = merged_rows.as_recorded(copies, "batches", _KNOWN_BY, "at")
    for copied in copies:
        for row in copied["batches"]:
            known = found.setdefault(key_of(row, _KNOWN_BY), {**row, "rows": 0, "undone": 0})
            if row["kind"] == "corrections":
                known["rows"] = max(known["rows"], row["rows"])
                known["undone"] = max(known["undone"], row["undone"])
            known["fid"] = min(known["fid"], row["fid"])
    ordered = sorted(found.items(), key=lambda item: place[item[0]])
    number = 0
    for _, row in ordered:
        number = row["fid"] = max(number + 1, row["fid"])
    return dict(ordered)


def numbers_now(copied: TableRows, batches: dict[Hashable, Row]) -> Numbers:
    """Return what the batches of a copy are numbered now, by their numbers in it."""
    return {row["fid"]: batches[key_of(row, _KNOWN_BY)]["fid"] for row in copied["batches"]}


def write(db: sqlite3.Connection, batches: dict[Hashable, Row]) -> None:
    """Let these be the batches, each with how many rows it has now."""
    _count(db, batches)
    numbered = [row["fid"] for row in batches.values()]
    merged_rows.write(db, schema.BATCHES, list(batches.values()), numbers=numbered)


def _count(db: sqlite3.Connection, batches: dict[Hashable, Row]) -> None:
    """Note in the batches how many rows they have; one that was all taken back is undone."""
    by_number = {row["fid"]: row for row in batches.values()}
    for name in ("inspections", "treatments"):
        counted = f"SELECT batch, count(*), min(undone = 1) FROM {name} GROUP BY batch"  # noqa: S608 - ours
        for number, n, undone in db.execute(counted):
            if number is not None and by_number[number]["kind"] != "corrections":
                by_number[number]["rows"] += n
                by_number[number]["undone"] = int(undone)


def merge_changes(
    both: tuple[sqlite3.Connection, sqlite3.Connection],
    copies: list[TableRows],
    numbers: list[Numbers],
) -> Corrected:
    """Let the first have what other programs changed in either copy; return what was corrected.

    `numbers` says how the batches of each copy are numbered now.
    """
    for copied, batch_of in zip(copies, numbers, strict=True):
        for row in copied["outside_changes"]:
            row["batch"] = batch_of.get(row["batch"])
    changes = _changes_of_both(copies)
    merged_rows.write(both[0], schema.OUTSIDE_CHANGES, changes)
    held = "SELECT batch FROM inspections WHERE digest = ? AND batch NOTNULL"
    return rows_that_count.corrected(
        [row for row in changes if row["batch"] is not None],
        lambda mark: [
            batch_of.get(batch, batch)
            for one, batch_of in zip(both, numbers, strict=True)
            for (batch,) in one.execute(held, (mark,))
        ],
    )


def _changes_of_both(copies: list[TableRows]) -> list[Row]:
    """Return what other programs changed in either copy; what one of them took back is so."""
    merged = merged_rows.once(copies, "outside_changes", CHANGE_KNOWN_BY, "at")
    undone = {key_of(row, CHANGE_KNOWN_BY) for one in copies for row in one["outside_changes"]
              if row["undone"]}  # fmt: skip
    return [{**row, "undone": int(key_of(row, CHANGE_KNOWN_BY) in undone)} for row in merged]
