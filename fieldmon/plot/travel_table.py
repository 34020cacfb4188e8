"""What compiled loops are handed of a plot: its plants, its rows and the ways between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import counted

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Float = NDArray[np.float64]


class TravelTable(NamedTuple):
    """What compiled loops need to know of a plot: plants, rows, and the ways between rows.

    Parameters
    ----------
    x_m
        ``(n,)`` place of each plant along its lane.
    row
        ``(n,)`` int32 row of each plant.
    row_start
        ``(r + 1,)`` offsets: plants of row k are ``row_start[k]:row_start[k + 1]``.
    end_x_m
        ``(r, 2)`` places of the ends of each row's lane, low and high.
    between_m
        ``(2r + 1, 2r + 1)`` shortest ways between lane ends: 2k is the low-x end of lane k,
        2k + 1 its high-x end, 2r the gate.
    corridor
        ``(r,)`` rows with the same number are inspected from the same stretch of aisle, see
        `PlantGrid.stretches`.
    side
        ``(r,)`` on which side of its lane the row is: -1 lower y, +1 higher y.
    """

    x_m: Float
    row: NDArray[np.int32]
    row_start: NDArray[np.int64]
    end_x_m: Float
    between_m: Float
    corridor: NDArray[np.int32]
    side: NDArray[np.int8]

    def __repr__(self) -> str:
        plants, rows = counted(len(self.x_m), "plant"), counted(len(self.end_x_m), "row")
        return f"<TravelTable: {plants} in {rows}>"
