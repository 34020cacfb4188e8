"""Rows that stand back for another one, and count again once that one no longer does.

Two people who worked apart may record the same result of the same plant and time: the first of
them counts, the other stands back. It was not taken back: whoever undoes the first one's file
leaves the other's as it was recorded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sqlite3

#: in the column `undone` of inspections and treatments
COUNTS, TAKEN_BACK, STANDS_BACK = 0, 1, 2


def count_again(db: sqlite3.Connection, table: str = "inspections") -> list[int]:
    """Let rows count again where none stands for them any more; return their batches."""
    found = db.execute(
        f"SELECT min(fid), batch FROM {table} AS one WHERE undone = ? AND NOT EXISTS "  # noqa: S608 - ours
        f"(SELECT 1 FROM {table} WHERE digest = one.digest AND undone = 0) GROUP BY digest",
        (STANDS_BACK,),
    ).fetchall()
    db.executemany(f"UPDATE {table} SET undone = 0 WHERE fid = ?", [one[:1] for one in found])  # noqa: S608 - ours
    return sorted({batch for _, batch in found})


def take_back_others(db: sqlite3.Connection, inspection: int) -> list[int]:
    """Take back all that say the same as an inspection that was; return their batches."""
    found = db.execute(
        "SELECT fid, batch FROM inspections WHERE undone <> ? AND digest = "
        "(SELECT digest FROM inspections WHERE fid = ?)",
        (TAKEN_BACK, inspection),
    ).fetchall()
    taken = [(TAKEN_BACK, fid) for fid, _ in found]
    db.executemany("UPDATE inspections SET undone = ? WHERE fid = ?", taken)
    return sorted({batch for _, batch in found})


def n_elsewhere(db: sqlite3.Connection, batch: int, table: str = "inspections") -> int:
    """Return how many rows of a batch do not count, but another one that says the same does."""
    (n,) = db.execute(
        f"SELECT count(*) FROM {table} AS one WHERE batch = ? AND undone <> 0 AND EXISTS "  # noqa: S608 - ours
        f"(SELECT 1 FROM {table} WHERE digest = one.digest AND undone = 0)",
        (batch,),
    ).fetchone()
    return int(n)
