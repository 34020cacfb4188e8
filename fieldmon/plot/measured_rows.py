"""Rows of plants that were measured, as they run: straight, or bent and in blocks."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arrays import offsets
from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.names_on_ground import Stray, strays
from fieldmon.plot.row_curves import row_lines_of
from fieldmon.plot.row_detection import NO_ROWS, frame_around, rows_from_plants, split_lines
from fieldmon.plot.row_lines import Ground, RowLines
from fieldmon.plot.row_tracing import TracedRows, trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plant_names import PlantNames
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.projection import Frame

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# lines this straight need no other
_STRAIGHT_M = 0.005
# rows bend if straight lines stray by so many times what the rows traced do, and a little more,
# in row spacings
_BETTER, _LITTLE = 1.3, 0.04
_LEAST_FREE = 6.0
_NONSENSE = 0.5
# so much nearer to a plant of another row than to those of its own, a plant may be of a row that
# runs another way; from such a share on, of plants in exact lines, rows are traced
_NEARER, _CROSSED = 0.75, 0.1
# so many plants are asked for the nearest one of another row, among so many about them
_ASKED, _NEAR = 5000, 6
# blocks that change within more rows than this, without a gap, are a trial's
_MOST_CUT = 0.3
#: rows of fewer plants are not traced: two stand in one row, whatever they name
LEAST_TRACED = 3


class SaidRows(NamedTuple):
    """What is said of the rows of measured plants.

    ``label (n,)`` numbers the row of each, None where they have no names; ``bearing`` tells
    whether somebody said that rows run about along x. ``misnamed`` is the share of plants that
    stand in another row than their name says, None where that was not looked at. ``block (n,)``
    numbers the block of each, None where these are not known; ``of_trial`` tells whether the
    blocks named were none. ``strays`` are plants amid another row than they name.
    """

    label: NDArray[np.int64] | None
    bearing: bool
    misnamed: float | None = None
    block: NDArray[np.int64] | None = None
    of_trial: bool = False
    strays: tuple[Stray, ...] = ()

    def __repr__(self) -> str:
        return f"<SaidRows: {0 if self.label is None else len(self.label)} names>"

    def checked(self, lonlat: Float) -> SaidRows:
        """Return the same with the share of plants that rows found besides put elsewhere.

        Names that fit less than half of the plants are no rows' names, and decide nothing; nor do
        blocks that change within rows without a gap (those of a trial).
        """
        if self.label is None and self.block is None:
            return self
        xy_m = frame_around(lonlat).xy_m(lonlat)
        traced = trace(xy_m)
        if traced is None:
            apart = self.label is not None and self.label.any() and len(lonlat) < LEAST_TRACED
            return self._replace(misnamed=_NONSENSE) if apart else self
        if self.block is not None and _cut_rows(traced, self.block) > _MOST_CUT:
            self = self._replace(block=None, of_trial=True)  # noqa: PLW0642 - what is left of it
        if self.label is None:
            return self
        row = np.empty(len(lonlat), np.int64)
        row[traced.plant] = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
        # every block may count its rows from 1
        named = self.label * (int(traced.block[-1]) + 1) + traced.block[row]
        misnamed = 1.0 - min(_shared(row, named), _shared(named, row))
        if misnamed > _NONSENSE:
            return self._replace(label=None, misnamed=misnamed)
        # amid which row a plant stands is only seen where plants keep to theirs
        gone = strays(xy_m, traced, self.label) if blur(traced) <= NO_ROWS else ()
        return self._replace(misnamed=misnamed, strays=gone)


def said_rows(plants: Float, names: PlantNames, field: Field | None, *, bearing: bool) -> SaidRows:
    """Return what is said of the rows and blocks of plants ``(n, 2)`` lon/lat.

    Blocks are as plants are named, else as they were drawn on the field.
    """
    block = name_numbers(names.block)
    if block is None and field is not None and field.blocks:
        areas = shapely.STRtree([block.area for block in field.blocks])
        block = np.asarray(areas.nearest(shapely.points(plants)), np.int64)
        block = np.unique(block, return_inverse=True)[1]
    label = name_numbers(names.row)
    if label is not None and block is not None:  # every block may count its rows from 1
        both = block * (int(label.max()) + 1) + label
        label = np.unique(both, return_inverse=True)[1]
    return SaidRows(label, bearing, None, block)


def name_numbers(names: NDArray[np.str_] | None) -> NDArray[np.int64] | None:
    """Return a number for each name ``(n,)``, where all plants have one."""
    if names is None or (names == "").any():
        return None
    return np.unique(names, return_inverse=True)[1].astype(np.int64)


def rows_in_blocks(lonlat: Float, frame: Frame, said: SaidRows) -> tuple[TracedRows, Int]:
    """Return the rows of plants ``(n, 2)`` whose blocks are known, and the block of each row."""
    if said.block is None:
        raise TypeError("blocks are not known")  # pragma: no cover - a mistake of ours
    found, called = [], []
    for block in range(int(said.block.max()) + 1):
        mine = np.flatnonzero(said.block == block)
        label = None
        if said.label is not None:
            label = np.unique(said.label[mine], return_inverse=True)[1].astype(np.int64)
        traced = _rows_of_block(lonlat[mine], frame, label)
        found.append(traced._replace(plant=mine[traced.plant]))
        called.append(np.full(len(traced.block), block))
    return together(found), np.concatenate(called)


def _rows_of_block(lonlat: Float, frame: Frame, label: Int | None) -> TracedRows:
    """Return the rows of the plants of one block, which may be straight, in metres of a frame."""
    if len(lonlat) < LEAST_TRACED:
        return _one_row(frame.xy_m(lonlat))
    found = rows_from_plants(lonlat)
    own = frame.turned(found.bearing_deg)
    xy_m = own.xy_m(lonlat)
    spacing_m = found.row_spacing_m or 2 * (found.plant_spacing_m or 1.0)
    line = split_lines(xy_m[:, 1], spacing_m)
    traced = bent_rows(xy_m, line, spacing_m, SaidRows(label, bearing=False)) or trace(xy_m, line)
    if traced is None:
        return _one_row(frame.xy_m(lonlat))
    return traced._replace(line_m=frame.xy_m(own.lonlat(traced.line_m)))


def _one_row(xy_m: Float) -> TracedRows:
    """Return the row of a plant or two."""
    n = len(xy_m)
    apart_m = float(np.hypot(*(xy_m[-1] - xy_m[0])))
    nothing, start = np.zeros(n), np.array([0, n])
    order = np.argsort(xy_m[:, 0], kind="stable")
    usual_m = apart_m if n > 1 else np.nan
    return TracedRows(order, start, np.zeros(1, np.int64), xy_m[order], nothing, np.nan, usual_m)


def together(found: list[TracedRows]) -> TracedRows:
    """Return the rows of several blocks as those of one plot; what they lack is as in others."""
    n_plants = offsets(np.array([len(one.plant) for one in found]))
    n_blocks = offsets(np.array([int(one.block[-1]) + 1 for one in found]))
    starts = [one.row_start[1:] + n for one, n in zip(found, n_plants[:-1], strict=True)]
    rows_m, plants_m = (
        np.array([getattr(one, name) for one in found])
        for name in ("row_spacing_m", "plant_spacing_m")
    )
    return TracedRows(
        np.concatenate([one.plant for one in found]),
        np.concatenate([[0], *starts]),
        np.concatenate([one.block + n for one, n in zip(found, n_blocks[:-1], strict=True)]),
        np.concatenate([one.line_m for one in found]),
        np.concatenate([one.off_m for one in found]),
        *(float(np.median(v[np.isfinite(v)])) if np.isfinite(v).any() else np.nan
          for v in (rows_m, plants_m)),
    )  # fmt: skip


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
    exact = off_m <= _STRAIGHT_M
    crossed = 0.0 if not exact or said.bearing else nearer_share(xy_m, line)
    if exact and crossed < _CROSSED:
        return None
    traced = trace(xy_m)
    if traced is None or not np.isfinite(traced.row_spacing_m) or blur(traced) > NO_ROWS:
        return None
    if exact:  # lines laid out by a program may be straight the other way, too
        row = np.empty(n, np.int64)
        row[traced.plant] = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
        return traced if nearer_share(xy_m, row) < crossed / 2 else None
    own = off_m / np.sqrt(1 - r / n) if r < n else np.inf
    if _along_x(traced):
        spacing_m = min(row_spacing_m, traced.row_spacing_m)
        bent = own / spacing_m > _BETTER * blur(traced) + _LITTLE
    else:  # of two directions that with the straighter and denser rows, as `rows_from_plants`
        bent = not said.bearing and own / row_spacing_m**2 > blur(traced) / traced.row_spacing_m
    return traced if bent else None


def nearer_share(xy_m: Float, row: NDArray[np.integer]) -> float:
    """Return the share of plants that stand much nearer to another row's than to their own's."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    if len(xy_m) <= _NEAR:
        return 0.0
    some = np.arange(0, len(xy_m), max(len(xy_m) // _ASKED, 1))
    far_m, near = cKDTree(xy_m).query(xy_m[some], k=_NEAR)
    other = row[near] != row[some][:, None]
    own_m, other_m = (
        np.where(among, far_m, np.inf)[:, 1:].min(axis=1) for among in (~other, other)
    )
    return float(np.mean(other_m < _NEARER * own_m))


def _cut_rows(traced: TracedRows, block: Int) -> float:
    """Return the share of rows traced in which the block changes without a gap."""
    row = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    step = np.hypot(*np.diff(traced.line_m, axis=0).T)
    here = block[traced.plant]
    cuts = (np.diff(row) == 0) & (np.diff(here) != 0) & (step < 1.5 * traced.plant_spacing_m)
    return len(np.unique(row[1:][cuts])) / len(traced.block)


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
    rows: tuple[TracedRows, Int | None],
    ground: Ground,
    planting: Planting,
) -> PlantGrid:
    """Return measured plants ``(n, 2)`` in the rows traced; `ground` as in `bent_grid`.

    With the rows comes the block of each as people call it; None: as it was traced.
    """
    traced, called = rows
    row = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    known = {
        name: value
        for name in ("row_spacing_m", "plant_spacing_m")
        if np.isfinite(value := getattr(traced, name))
    }
    found = replace(planting, **known)
    lines = RowLines(row_lines_of(traced), traced.block, _spacings(traced, found), called)
    return bent_grid(frame, lines, (xy_m[traced.plant], row), ground, found)


def _spacings(traced: TracedRows, planting: Planting) -> Float:
    """Return ``(r, 2)`` from each row to the next and from plant to plant, as in its block."""
    usual = np.array([planting.row_spacing_m, planting.plant_spacing_m])
    n_blocks = int(traced.block[-1]) + 1
    if n_blocks == 1:
        return np.tile(usual, (len(traced.block), 1))
    lines = row_lines_of(traced)
    row = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    has_next = np.append(np.diff(traced.block) == 0, False)
    asked = np.flatnonzero(has_next[row])
    place, left = lines.project(traced.line_m[asked], row[asked] + 1)
    beside = (place >= 0) & (place <= lines.length_m[row[asked] + 1])
    step = np.hypot(*np.diff(traced.line_m, axis=0).T)
    inner = np.flatnonzero(np.diff(row) == 0)
    times = np.maximum(np.round(step[inner] / usual[1]), 1.0)
    known = (
        (traced.block[row[asked[beside]]], np.abs(left[beside])),
        (traced.block[row[inner]], step[inner] / times),
    )
    each = np.tile(usual, (n_blocks, 1))
    for column, (of, metres) in enumerate(known):
        for block in range(n_blocks):
            mine = metres[of == block]
            if len(mine) >= LEAST_TRACED:
                each[block, column] = np.median(mine)
    return each[traced.block]
