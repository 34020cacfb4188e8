"""Rows of plants that were measured, as they run: straight, or bent and in blocks."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.plot.bent_layout import RowLines, bent_grid
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_tracing import TracedRows, trace

if TYPE_CHECKING:
    import shapely
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.layout import Planting
    from fieldmon.plot.projection import Frame

    Float = NDArray[np.float64]

# rows are straight if straight ones hold the same plants, but for this share...
_SAME_ROWS = 0.98
# ... and traced ones stray from straight ones by less than this part of their spacing
_BENT = 0.12
# what strays by more from the rows traced is in no rows
_NO_ROWS = 0.2


def bent_rows(xy_m: Float, line: NDArray[np.integer]) -> TracedRows | None:
    """Return the rows of plants where they bend or blocks turn; None where straight lines do.

    Parameters
    ----------
    xy_m
        ``(n, 2)`` plants, x along the straight lines.
    line
        ``(n,)`` the straight line of each.
    """
    traced = trace(xy_m)
    if traced is None or not np.isfinite(traced.row_spacing_m) or blur(traced) > _NO_ROWS:
        return None
    row = np.empty(len(xy_m), np.int64)
    row[traced.plant] = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    if _shared(row, line) < _SAME_ROWS:
        return traced if _shared(line, row) < _SAME_ROWS or _strays(traced) else None
    return traced if _strays(traced) else None


def blur(traced: TracedRows) -> float:
    """Return how far plants stray from the rows traced, in row spacings; see `_Lines.blur`."""
    n, r = len(traced.plant), len(traced.block)
    if r >= n:
        return np.inf
    off_m = float(np.sqrt(np.mean(traced.off_m**2)))
    return off_m / traced.row_spacing_m / (1 - r / n)


def measured_grid(
    frame: Frame,
    xy_m: Float,
    traced: TracedRows,
    ground: tuple[MultiPolygon | None, shapely.Geometry],
    planting: Planting,
) -> PlantGrid:
    """Return measured plants ``(n, 2)`` in the rows traced; `ground` as in `bent_grid`."""
    row = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    found = replace(
        planting,
        row_spacing_m=traced.row_spacing_m,
        plant_spacing_m=traced.plant_spacing_m,
    )
    return bent_grid(frame, lines_of(traced), (xy_m[traced.plant], row), ground, found)


def _shared(found: NDArray[np.integer], known: NDArray[np.integer]) -> float:
    """Return the share of plants that are with most of their found row in one known row."""
    pairs = found.astype(np.int64) * (int(known.max()) + 1) + known
    pair, times = np.unique(pairs, return_counts=True)
    most = np.zeros(int(found.max()) + 1, np.int64)
    np.maximum.at(most, pair // (int(known.max()) + 1), times)
    return float(most.sum()) / len(found)


def _strays(traced: TracedRows) -> bool:
    """Tell whether traced rows bend: stray from straight lines more than a little."""
    row = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    n = np.bincount(row)
    x, y = (v - (np.bincount(row, v) / n)[row] for v in traced.line_m.T)
    # all rows together have one direction
    slope = float(np.sum(x * y) / max(np.sum(x * x), 1e-9))
    off_m = np.abs(y - slope * x) / np.hypot(1.0, slope)
    return float(np.sqrt(np.mean(off_m**2))) > _BENT * traced.row_spacing_m


def lines_of(traced: TracedRows) -> RowLines:
    """Return the lines of traced rows, with two corners at least."""
    start, line_m = traced.row_start, traced.line_m
    alone = np.flatnonzero(np.diff(start) == 1)
    if len(alone):
        # a row of one plant points as the block's rows do: here, along x
        spots = line_m[start[alone]] + [0.01, 0.0]
        line_m = np.insert(line_m, start[alone] + 1, spots, axis=0)
        start = start + np.searchsorted(alone, np.arange(len(start)))
    return RowLines(Polylines.of(start, line_m), traced.block)

