"""Rows of plants that were measured, as they run: straight, or bent and in blocks."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.plot.bent_layout import Ground, RowLines, bent_grid
from fieldmon.plot.row_detection import frame_around
from fieldmon.plot.row_tracing import TracedRows, row_lines_of, trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.layout import Planting
    from fieldmon.plot.projection import Frame

    Float = NDArray[np.float64]

# lines this straight need no other
_STRAIGHT_M = 0.005
# rows bend if straight lines stray by so many times what the rows traced do, and a little more,
# in row spacings
_BETTER, _LITTLE = 1.3, 0.04
# what strays by more from the rows traced is in no rows
_NO_ROWS = 0.2
_LEAST_FREE = 6.0
_NONSENSE = 0.5


class SaidRows(NamedTuple):
    """What is said of the rows of measured plants.

    ``label (n,)`` numbers the row of each, None where they have no names; ``bearing`` tells
    whether somebody said that rows run about along x. ``misnamed`` is the share of plants that
    stand in another row than their name says, None where that was not looked at.
    """

    label: NDArray[np.int64] | None
    bearing: bool
    misnamed: float | None = None

    def __repr__(self) -> str:
        return f"<SaidRows: {0 if self.label is None else len(self.label)} names>"

    def checked(self, lonlat: Float) -> SaidRows:
        """Return the same with the share of plants that rows found besides put elsewhere.

        Names that fit less than half of the plants are no rows' names, and decide nothing.
        """
        if self.label is None:
            return self
        traced = trace(frame_around(lonlat).xy_m(lonlat))
        if traced is None:
            return self
        row = np.empty(len(lonlat), np.int64)
        row[traced.plant] = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
        # every block may count its rows from 1
        named = self.label * (int(traced.block[-1]) + 1) + traced.block[row]
        misnamed = 1.0 - min(_shared(row, named), _shared(named, row))
        label = None if misnamed > _NONSENSE else self.label
        return self._replace(label=label, misnamed=misnamed)


def row_numbers(names: NDArray[np.str_] | None) -> NDArray[np.int64] | None:
    """Return a number for each plant's row ``(n,)``, where all of them have a name."""
    if names is None or (names == "").any():
        return None
    return np.unique(names, return_inverse=True)[1].astype(np.int64)


def bent_rows(
    xy_m: Float, line: NDArray[np.integer], row_spacing_m: float, said: SaidRows
) -> TracedRows | None:
    """Return the rows of plants where they bend or blocks turn; None where straight lines do.

    Parameters
    ----------
    xy_m
        ``(n, 2)`` plants, x along the straight lines.
    line
        ``(n,)`` the straight line of each.
    row_spacing_m
        The distance between these.
    said
        What decides: the names of the rows, or a bearing.
    """
    if said.label is not None:
        return None if _same(line, said.label) else trace(xy_m, said.label)
    n, r = len(line), int(line.max()) + 1
    y_m = xy_m[:, 1] - (np.bincount(line, xy_m[:, 1]) / np.bincount(line))[line]
    off_m = float(np.sqrt(np.mean(y_m**2)))
    if off_m <= _STRAIGHT_M:
        return None
    traced = trace(xy_m)
    if traced is None or not np.isfinite(traced.row_spacing_m) or blur(traced) > _NO_ROWS:
        return None
    own = off_m / np.sqrt(1 - r / n) if r < n else np.inf
    if _along_x(traced):
        spacing_m = min(row_spacing_m, traced.row_spacing_m)
        bent = own / spacing_m > _BETTER * blur(traced) + _LITTLE
    else:  # of two directions that with the straighter and denser rows, as `rows_from_plants`
        bent = not said.bearing and own / row_spacing_m**2 > blur(traced) / traced.row_spacing_m
    return traced if bent else None


def _same(one: NDArray[np.integer], other: NDArray[np.integer]) -> bool:
    """Tell whether two numberings part plants alike."""
    both = len(np.unique(one.astype(np.int64) * (int(other.max()) + 1) + other))
    return both == len(np.unique(one)) == len(np.unique(other))


def _shared(found: NDArray[np.int64], named: NDArray[np.int64]) -> float:
    """Return the share of plants that are in the row that most of their found row are in."""
    wide = int(named.max()) + 1
    pair, times = np.unique(found * wide + named, return_counts=True)
    most = np.zeros(int(found.max()) + 1, np.int64)
    np.maximum.at(most, pair // wide, times)
    return float(most.sum()) / len(found)


def _along_x(traced: TracedRows) -> bool:
    """Tell whether most rows traced run about along x."""
    inner = np.delete(np.arange(len(traced.plant)), traced.row_start[1:] - 1)
    step = traced.line_m[inner + 1] - traced.line_m[inner]
    return bool(np.median(np.abs(step[:, 0]) - np.abs(step[:, 1])) > 0)


def blur(traced: TracedRows) -> float:
    """Return how far plants stray from the rows traced, in row spacings; infinite if few tell.

    A line that bends follows few plants of itself: about a fourth of them, and two a row, say
    nothing of how far they stray.
    """
    n_plants = np.diff(traced.row_start)
    free = float(np.maximum(0.75 * n_plants - 2.0, 0.0).sum())
    if free < _LEAST_FREE:
        return np.inf
    return float(np.sqrt(np.sum(traced.off_m**2) / free)) / traced.row_spacing_m


def measured_grid(
    frame: Frame,
    xy_m: Float,
    traced: TracedRows,
    ground: Ground,
    planting: Planting,
) -> PlantGrid:
    """Return measured plants ``(n, 2)`` in the rows traced; `ground` as in `bent_grid`."""
    row = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    rows = RowLines(row_lines_of(traced), traced.block)
    found = replace(
        planting,
        row_spacing_m=traced.row_spacing_m,
        plant_spacing_m=traced.plant_spacing_m,
    )
    return bent_grid(frame, rows, (xy_m[traced.plant], row), ground, found)
