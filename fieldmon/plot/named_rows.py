"""Rows that a person names, as 3-5,8, and the plants in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import runs, worded
from fieldmon.errors import SettingError
from fieldmon.plot.grid import row_label

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid


def plants_in_rows(grid: PlantGrid, rows: str) -> NDArray[np.bool_]:
    """Return which plants ``(n,)`` stand in rows as people count or name them.

    Raises
    ------
    SettingError
        If they are not so written, or the plot has no such row.
    """
    there, wanted = set(grid.line_number.tolist()), set[int]()
    for part in rows.split(","):
        first, dash, last = part.strip().partition("-")
        if not first.strip().isdecimal() or (dash and not last.strip().isdecimal()):
            raise SettingError(
                worded("Rows must be such as 3-5,8, but they are {rows}.", rows=rows)
            )
        ends = sorted({int(first), int(last if dash else first)})
        if missing := [row for row in ends if row not in there]:
            raise SettingError(
                worded(
                    "Rows of this plot are {some}, but row {row} is named.",
                    some=runs(there),
                    row=missing[0],
                )
            )
        wanted.update(row for row in there if ends[0] <= row <= ends[-1])
    plants: NDArray[np.bool_] = np.isin(row_label(grid).line, sorted(wanted))
    return plants
