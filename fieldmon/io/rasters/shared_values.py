"""Doubts about one value that many plants share: a raster of it alone, or no value in disguise."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import label

from fieldmon.compute.wording import share_figure, worded
from fieldmon.io.import_report import Remedy, doubtful

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.rasters.values import Raster
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# of fewer values than this beside it, the raster may hold classes
_OTHERS = 10
# rounded values come again, too, but each about as often as the next
_TIMES = 5


def doubts_of_alike(
    values: Floats, raster: Raster, grid: PlantGrid, least: float, *, zero_is_none: bool = False
) -> list[ImportMessage]:
    """Return what to doubt of a raster by its values at the plants ``(n,)``, NaN where none.

    Of one that says the same of all plants; and of one value that a share of `least` and more of
    them has in a piece that reaches to where the raster ends, 0 aside where it is as good as none.
    """
    known, counts = np.unique(values[~np.isnan(values)], return_counts=True)
    if len(known) == 1:
        said = worded(
            "It has the same value, {value:.6g}, at all plants that it shows, and tells none of "
            "them apart. Check the file and its band.",
            value=known[0],
        )
        return [doubtful(said)]
    n = counts.sum()
    for value in dict.fromkeys((0.0, float(known[0]), float(known[-1]))):
        has, others = counts[known == value].sum(), counts[known != value]
        if (value == 0.0 and zero_is_none) or has < least * n:
            continue
        if len(others) < _OTHERS or has < _TIMES * others.max():
            continue
        outside = _outside(raster, value).of_plants(grid, "nearest")
        share = float(np.count_nonzero((values == value) & (outside == 1.0)) / n)
        if share < least:
            continue
        said = worded(
            "{share} of the plants have exactly {value:.6g} on it, in a piece that reaches to "
            "where it ends: check that this is a value, and does not stand for none.",
            share=share_figure(share),
            value=value,
        )
        remedy = Remedy("nodata", f"{raster.stored(value):.10g}", worded("It stands for no value"))
        return [doubtful(said, remedy=remedy)]
    return []


def _outside(raster: Raster, value: float) -> Raster:
    """Return where a value reaches to the end of a raster: 1 there, 0 elsewhere."""
    alike = np.pad((raster.values == value) | np.isnan(raster.values), 1, constant_values=True)
    pieces, _ = label(alike)
    outside = (pieces == pieces[0, 0])[1:-1, 1:-1] & (raster.values == value)
    return replace(raster, values=outside.astype(np.float32))
