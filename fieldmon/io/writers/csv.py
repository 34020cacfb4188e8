"""The stops as CSV, to be filled in by hand in any spreadsheet."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

from fieldmon.io.writers.day_file import DECIMALS, plain_text

if TYPE_CHECKING:
    from fieldmon.io.writers.day_file import HandoffPlan, Stop

#: columns that are left empty for whoever inspects; of one of a team ``who`` is its name
TO_FILL_IN = ("found", "count", "who", "notes")
_BEFORE = ("row", "number")
_AFTER = ("plant", "lon", "lat", "arrive", "arrive_s", "inspect_s", "chance", "detects", "plot")
_FORMULA = ("=", "+", "-", "@")


def route_csv(plan: HandoffPlan) -> bytes:
    """Return the stops as CSV (RFC 4180): commas, decimal points, CRLF, one line of names.

    It begins with a byte order mark: without one, Excel takes UTF-8 for the machine's old code
    page and mangles Hebrew and umlauts. The columns to fill in stand right after the row and the
    number in it, since that is what fits on a phone's screen. A text that a spreadsheet would run
    as a formula gets an apostrophe before it.
    """
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\r\n")
    face = ("face",) if plan.has_faces else ()
    block = ("block",) if plan.has_blocks else ()
    before = _BEFORE if plan.in_rows else _BEFORE[1:]
    before = (before[0], "row_name", *before[1:]) if plan.has_row_names else before
    table.writerow(("stop", *block, *before, *face, *TO_FILL_IN, *_AFTER))
    table.writerows(_cells(stop, plan) for stop in plan.stops)
    return text.getvalue().encode("utf-8-sig")


def _cells(stop: Stop, plan: HandoffPlan) -> tuple[object, ...]:
    return (
        stop.order,
        *((stop.block,) if plan.has_blocks else ()),
        *((stop.row,) if plan.in_rows else ()),
        *((safe_cell(stop.row_name),) if plan.has_row_names else ()),
        stop.number,
        *((stop.face,) if plan.has_faces else ()),
        *(safe_cell(plan.notes.who or "") if name == "who" else "" for name in TO_FILL_IN),
        stop.plant,
        f"{stop.lon:.{DECIMALS}f}",
        f"{stop.lat:.{DECIMALS}f}",
        *(stop.arrive, stop.arrive_s, stop.inspect_s, f"{stop.chance:.6f}", stop.detects),
        safe_cell(plan.notes.plot),
    )


def safe_cell(text: str) -> str:
    """Return a text that no spreadsheet runs as a formula."""
    plain = plain_text(text)
    return f"'{plain}" if plain.lstrip().startswith(_FORMULA) else plain


def said_cell(text: str) -> str:
    """Return a text that `safe_cell` wrote, as it was said.

    Examples
    --------
    >>> said_cell(safe_cell("=Ann")), said_cell("'Ann'")
    ('=Ann', "'Ann'")
    """
    bare = text.removeprefix("'")
    return bare if bare.lstrip().startswith(_FORMULA) else text
