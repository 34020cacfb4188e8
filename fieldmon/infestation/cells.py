"""Plants in cells of a plot: who stands so far along and across from whom, on any plot."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

# a plot whose parts lie far apart gets larger cells
_MOST_A_PLANT = 8


class Cells(NamedTuple):
    """Cells of a plot, one a plant where rows are even: a table of rows across the plot.

    Parameters
    ----------
    of_plant
        ``(n,)`` the cell of each plant, counted row of cells by row of cells.
    start, plant
        CSR lists of the plants of each cell: ``plant[start[c]:start[c + 1]]``.
    shape
        ``(2,)`` how many cells there are across the rows, and along them.
    size_m
        ``(2,)`` how far a cell reaches across the rows, and along them.
    """

    of_plant: NDArray[np.int64]
    start: NDArray[np.int64]
    plant: NDArray[np.int64]
    shape: NDArray[np.int64]
    size_m: NDArray[np.float64]

    def __repr__(self) -> str:
        return f"<Cells: {self.shape[0]} across, {self.shape[1]} along>"

    @classmethod
    def of(cls, grid: PlantGrid) -> Cells:
        """Return the cells of a plot."""
        yx_m = grid.xy_m[:, ::-1]
        size_m = np.array([grid.row_spacing_m, grid.plant_spacing_m], np.float64)
        low_m = yx_m.min(axis=0)
        room = (np.ptp(yx_m, axis=0) / size_m + 1.0).prod() / (_MOST_A_PLANT * len(grid))
        size_m *= max(1.0, float(np.sqrt(room)))
        place = np.rint((yx_m - low_m) / size_m).astype(np.int64)
        shape = place.max(axis=0) + 1
        of_plant = place[:, 0] * shape[1] + place[:, 1]
        count = np.bincount(of_plant, minlength=int(shape.prod()))
        start = np.concatenate([[0], np.cumsum(count)])
        return cls(of_plant, start, np.argsort(of_plant, kind="stable"), shape, size_m)

    @classmethod
    def none(cls) -> Cells:
        """Return no cells, for who needs none."""
        nothing = np.zeros(0, np.int64)
        return cls(nothing, nothing, nothing, np.zeros(2, np.int64), np.ones(2))

    def summed(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the sum of ``values (n,)`` in each cell, in the cells' shape."""
        sums = np.bincount(self.of_plant, values, int(self.shape.prod())).astype(np.float64)
        return sums.reshape(self.shape)


@inner_loop
def cell_of(cells: Cells, plant: int) -> tuple[int, int]:
    """Return in which cell a plant stands, across and along."""
    cell, along = cells.of_plant[plant], cells.shape[1]
    return cell // along, cell % along


@inner_loop
def in_one_cell(cells: Cells, plant: int) -> int:
    """Return how many plants stand in the cell of one."""
    cell = cells.of_plant[plant]
    return int(cells.start[cell + 1] - cells.start[cell])
