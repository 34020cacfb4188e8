"""Rows that a person names, as 3-5,8, and the plants in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.plot.grid import row_label

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid


def plants_in_rows(grid: PlantGrid, rows: str) -> NDArray[np.bool_]:
    """Return which plants ``(n,)`` stand in rows as people count them.

    Raises
    ------
    SettingError
        If they are not so written, or the plot has no such row.
    """
    there, wanted = set((grid.row_line + 1).tolist()), set[int]()
    for part in rows.split(","):
        first, dash, last = part.strip().partition("-")
        if not first.strip().isdecimal() or (dash and not last.strip().isdecimal()):
            raise SettingError(
                worded("Rows must be such as 3-5,8, but they are {rows}.", rows=rows)
            )
        ends = sorted({int(first), int(last if dash else first)})
        # of a range that ends beyond the plot only what matters is counted out
        within = range(max(ends[0], min(there)), min(ends[-1], max(there)) + 1)
        if missing := [row for row in (*ends, *within) if row not in there]:
            raise SettingError(
                worded(
                    "Rows of this plot are {first} to {last}, but row {row} is named.",
                    first=min(there),
                    last=max(there),
                    row=missing[0],
                )
            )
        wanted.update(within)
    plants: NDArray[np.bool_] = np.isin(row_label(grid).line, sorted(wanted))
    return plants
