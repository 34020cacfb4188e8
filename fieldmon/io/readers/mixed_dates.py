"""What to say of a column in which dates stand in both orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, doubtful

if TYPE_CHECKING:
    from fieldmon.io.parse.values import DatedColumn


def mixed_dates(read: DatedColumn, where: str | None = None) -> list[ImportMessage]:
    """Return a doubt where a column has dates that are certain in one order, and in the other."""
    if not read.n_mixed:
        return []
    said = worded(
        "Dates stand day first and month first in one column: {n} that could be either were read "
        "day first. Write them all as 2026-11-18.",
        n=read.n_mixed,
    )
    return [doubtful(said, where)]
