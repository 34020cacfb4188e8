"""Inspections or treatments of two copies, once each; what both recorded counts once.

A row is known again by what it says and by the batch it came with, never by its number.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from fieldmon.infestation import inspection_columns
from fieldmon.monitoring.file import rows_that_count
from fieldmon.monitoring.file.rows_that_count import COUNTS, STANDS_BACK, TAKEN_BACK
from fieldmon.monitoring.inspecting import repeated_recordings
from fieldmon.monitoring.merging.merged_rows import key_of

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    from fieldmon.monitoring.file.rows_that_count import Corrected
    from fieldmon.monitoring.merging.merged_rows import Numbers
    from fieldmon.monitoring.treating.treatments import Row


def recordings_of_both(
    copies: list[list[Row]], numbers: list[Numbers], counting: set[str], gone: Corrected
) -> list[Row]:
    """Return inspections or treatments of both copies, once each, in the order of their batches.

    Those `counting` already count once, before them; of those `gone` what stands back stays so.
    """
    found: dict[Hashable, Row] = {}
    for own, batch_of in zip(copies, numbers, strict=True):
        for key, row in _known_by(own, batch_of):
            _add(row, found.setdefault(key, row))
    drafts_last = max((now for batch_of in numbers for now in batch_of.values()), default=0) + 1
    rows = sorted(
        found.values(), key=lambda r: (r["batch"] or drafts_last, r["fid"], repr(r["digest"]))
    )
    _let_first_count(rows, counting, gone)
    return rows


def _known_by(own: list[Row], batch_of: Numbers) -> Iterator[tuple[Hashable, Row]]:
    """Yield the rows of a copy, with the batches of now, behind what they are known by."""
    again: Counter[Hashable] = Counter()  # taken back, and recorded again with the same batch
    for one in own:
        row = {**one, "batch": batch_of.get(one["batch"])}
        said = row["digest"], row["batch"]
        if row["digest"] is None:  # a draft of another program
            yield key_of(row, tuple(name for name in row if name != "fid")), row
        else:
            again[said] += 1
            yield (*said, again[said]), row


def _add(row: Row, known: Row) -> None:
    """Let what is known of a row say all that it says in either copy."""
    known["undone"] = _undone_in_either(known["undone"] or 0, row["undone"] or 0)
    known["fid"] = min(known["fid"], row["fid"])
    for one in inspection_columns.BESIDE:  # what is no part of what makes it the same
        if one.kept in row:
            known[one.kept] = repeated_recordings.either(one, known[one.kept], row[one.kept])


def _undone_in_either(one: int, other: int) -> int:
    """Return what became of a row in either copy: taken back, if it was so in one."""
    return TAKEN_BACK if TAKEN_BACK in (one, other) else max(one, other)


def _let_first_count(rows: list[Row], counting: set[str], gone: Corrected) -> None:
    """Let the first of the rows that say the same count, and the others stand back for it."""
    for row in rows:
        stands_back = row["undone"] == STANDS_BACK
        if stands_back and not rows_that_count.may_count(gone, row["digest"], row["batch"]):
            continue
        if row["undone"] == COUNTS and (row["digest"], row["batch"]) in gone.outdone:
            row["undone"] = STANDS_BACK
            continue
        if row["digest"] is not None and row["undone"] != TAKEN_BACK:
            row["undone"] = STANDS_BACK if row["digest"] in counting else COUNTS
            counting.add(row["digest"])
