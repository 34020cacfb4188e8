"""Tables of dataclasses as CSV, one row an entry."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import fields
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence


def csv_text(rows: Sequence[Any]) -> str:
    """Return dataclasses of one kind as CSV, a column a field; empty where there is no value."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    if rows:
        names = [column.name for column in fields(rows[0])]
        writer.writerow(names)
        writer.writerows([_plain(getattr(row, name)) for name in names] for row in rows)
    return text.getvalue()


def _plain(value: object) -> object:
    """Return six digits of a number, and nothing for NaN."""
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return value
