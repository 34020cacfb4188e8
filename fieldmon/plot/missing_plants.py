"""Plants that are not there: a grid without them, its rows and aisles as they were."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from fieldmon.compute.arrays import offsets
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Lists = tuple[NDArray[np.int32], NDArray[np.int32]]

_T = TypeVar("_T", bound=np.generic)


def without(grid: PlantGrid, missing: NDArray[np.bool_]) -> PlantGrid:
    """Return a grid without the plants marked ``(n,)``, in the same order.

    A gap does not cut a row, and lanes and headlands stay where they are: nobody drives through a
    row because plants died in it. Plants beside a gap lose that neighbour. A row of which no plant
    is left goes, and lines that are counted from 1 are so anew where a whole line goes. Where
    both faces of a plant are inspected, both go. Raise `PlotError` if none is left.
    """
    kept = ~_gone(grid, missing)
    new = np.where(kept, np.cumsum(kept) - 1, -1).astype(np.int32)
    n_plants = np.add.reduceat(kept.astype(np.int64), grid.row_start[:-1])
    rows = np.flatnonzero(n_plants)
    lines = np.unique(grid.row_line[rows])
    twin = grid.twin[kept]
    along = _among(grid.along_start, grid.along_plant, new)
    across = _among(grid.across_start, grid.across_plant, new)
    return replace(
        grid,
        xy_m=grid.xy_m[kept],
        row_start=offsets(n_plants[rows]),
        row_line=_counted(grid.row_line[rows]),
        lane_y_m=grid.lane_y_m[rows],
        lane_x_m=grid.lane_x_m[rows],
        corridor=_counted(grid.corridor[rows]),
        side=grid.side[rows],
        along_start=along[0],
        along_plant=along[1],
        across_start=across[0],
        across_plant=across[1],
        twin=np.where(twin >= 0, new[twin], -1).astype(np.int32),
        block=None if grid.block is None else _counted(grid.block[rows]),
        stretch=None if grid.stretch is None else _counted(grid.stretch[rows]),
        whole=None if grid.whole is None else _counted(grid.whole[rows]),
        cut=_picked(grid.cut, rows),
        aisle=_picked(grid.aisle, rows),
        place_m=_picked(grid.place_m, kept),
        block_named=_picked(
            grid.block_named, np.arange(1) if grid.block is None else np.unique(grid.block[rows])
        ),
        line_called=_picked(grid.line_called, lines),
        line_named=_picked(grid.line_named, lines),
        plant_called=_picked(grid.plant_called, kept),
        plant_named=_picked(grid.plant_named, kept),
    )


def _gone(grid: PlantGrid, missing: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which plants ``(n,)`` go: those missing, and their other faces; never all."""
    if len(missing) != len(grid):
        raise PlotError(
            worded(
                "Missing plants must be marked for each of {n} plants, "
                "but {given} marks were given.",
                n=len(grid),
                given=len(missing),
            )
        )
    gone = missing | (missing[grid.twin] & (grid.twin >= 0))
    if gone.all():
        raise PlotError(
            worded(
                "One plant at least must be there, but all were marked as "
                "missing. Check the canopy raster and the value below which a "
                "plant is missing."
            )
        )
    return gone


def _picked(values: NDArray[_T] | None, which: NDArray[Any]) -> NDArray[_T] | None:
    """Return some of the values of a grid that may have none."""
    return None if values is None else values[which]


def _counted(numbers: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return numbers without gaps in them, in the same order."""
    return np.unique(numbers, return_inverse=True)[1].astype(np.int32)


def _among(start: NDArray[np.int32], plant: NDArray[np.int32], new: NDArray[np.int32]) -> Lists:
    """Return lists of neighbours among the plants that have a new number."""
    owner = np.repeat(np.arange(len(new)), np.diff(start))
    stays = (new[owner] >= 0) & (new[plant] >= 0)
    n_neighbours = np.bincount(new[owner[stays]], minlength=int(new.max()) + 1)
    starts = offsets(n_neighbours).astype(np.int32)
    return starts, new[plant[stays]]
