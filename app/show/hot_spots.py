"""Where hot spots are and what they mean, in words. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.plot.grid import row_label

from ..words import texts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.plot.grid import PlantGrid

_MOST = 8


def meanings(grid: PlantGrid, spots: HotSpots) -> list[str]:
    """Return where each hot spot is and what it means, a sentence each; of eight at most."""
    if not len(spots):
        return [texts.HOT_NONE]
    said = []
    for k in range(min(len(spots), _MOST)):
        p = float(spots.p[k])
        chance = texts.CHANCE_P_SMALL if p < 1e-4 else texts.CHANCE_P.format(n=max(round(1 / p), 1))
        said.append(
            texts.HOT_MEANS.format(
                rows=_place(grid, np.flatnonzero(spots.of_plant == k)),
                found=spots.found[k], inspected=spots.inspected[k], plants=spots.plants[k],
                expected=spots.expected[k], p=chance,
            )
        )  # fmt: skip
    return said


def _place(grid: PlantGrid, plants: NDArray[np.intp]) -> str:
    """Return which rows and which of their plants these are, in words."""
    label = row_label(grid, plants)
    first, last = int(label.line.min()), int(label.line.max())
    said = texts.HOT_ROW if first == last else texts.HOT_ROWS
    low, high = int(label.number.min()), int(label.number.max())
    return said.format(first=first, last=last, low=low, high=high)
