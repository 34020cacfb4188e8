"""The columns of inspections, once: how each is held, kept in a season's file, and told apart.

Whatever carries inspections (files, seasons, corrections, drafts, merging, the log, exports) takes
its columns from here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

#: what makes an inspection the same as another; what is said beside it; that of which both are
#: kept where two say something else
Role = Literal["identifies", "free", "noted"]


@dataclass(frozen=True)
class InspectionColumn:
    """A column of inspections.

    Parameters
    ----------
    name
        As `Inspections` has it.
    dtype
        As numpy holds it.
    given
        Letters of what a caller's array may be to numpy, and how a sentence calls it.
    sql
        Its definition in the season's file.
    role
        ``"identifies"``: part of what makes one the same as another. ``"free"``: said beside it,
        once. ``"noted"``: said beside it; where two differ, both are kept.
    empty
        What stands where nothing is said; None: something must be.
    since
        Version of the season's file from which on it is there; 0: from the first.
    watched
        Whether a change by another program is one of what was recorded. Else anybody may.
    decimals
        Of a number, how many are kept; None: all.
    """

    name: str
    dtype: Any
    given: tuple[str, str]
    sql: str
    role: Role
    empty: Any = None
    since: int = 0
    watched: bool = True
    decimals: int | None = None

    @property
    def kept(self) -> str:
        """Its name in the season's file."""
        return self.sql.split()[0]

    @property
    def is_text(self) -> bool:
        """Whether it holds texts."""
        return self.dtype is object

    def says(self, values: Any) -> Any:  # noqa: ANN401 - an array of any of them
        """Return ``(k,)`` where anything is said; texts or numbers."""
        return values != "" if self.is_text else ~np.isnan(values)

    def to_file(self, values: Any) -> list[Any]:  # noqa: ANN401 - an array of any of them
        """Return texts or numbers ``(k,)`` as the season's file keeps them."""
        if self.is_text:
            return list(values.tolist())
        known = [None if np.isnan(one) else one for one in values.tolist()]
        if self.decimals is None:
            return known
        return [None if one is None else round(one, self.decimals) for one in known]

    def from_file(self, kept: Any) -> Any:  # noqa: ANN401 - text or number
        """Return a text or a number that the season's file keeps, as inspections hold it."""
        if self.is_text:
            return str(kept or "")
        return np.nan if kept is None else float(str(kept))


_NUMBERS, _TEXTS = ("iufO", "numbers"), ("UO", "texts")

#: in the order of the season's file; what identifies stands in its digest in this order
COLUMNS = (
    InspectionColumn("plant", "int32", ("iuf", "whole numbers"), "plant INTEGER", "identifies"),
    InspectionColumn("date", "datetime64[D]", ("M", "dates"), "date DATE", "identifies"),
    InspectionColumn(
        "second",
        "float64",
        ("iufO", "seconds since local midnight"),
        "time TEXT",
        "identifies",
        np.nan,
    ),
    InspectionColumn(
        "result",
        "int8",
        ("biuf", "0 (clean), 1 (found) or 2 (skipped)"),
        "result TEXT",
        "identifies",
    ),
    InspectionColumn("count", "float64", _NUMBERS, "count REAL", "identifies", np.nan),
    InspectionColumn("who", object, _TEXTS, "who TEXT", "free", ""),
    InspectionColumn("notes", object, _TEXTS, "notes TEXT", "noted", "", watched=False),
    InspectionColumn(
        "detects", "float64", _NUMBERS, "detects REAL", "free", np.nan, since=13, decimals=6
    ),
)
#: what makes an inspection the same as another
IDENTIFYING = tuple(column for column in COLUMNS if column.role == "identifies")
(COUNT,) = (column for column in COLUMNS if column.name == "count")
#: what is said beside it
BESIDE = tuple(column for column in COLUMNS if column.role != "identifies")
