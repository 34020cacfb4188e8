"""Rows that turn sharply, or have plants of a row across: blocks may be mixed there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import offsets
from fieldmon.compute.wording import first_few, worded

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]
    Mask = NDArray[np.bool_]

# a plant is in a gap, or a step beyond an end, so many steps off at most
_OFF = 0.2
# rows of fewer plants have no direction; gaps of more missing ones say nothing
_LEAST, _MOST_MISSING = 3, 2
# rows run across each other from here on; next to each other are plants within so many steps
_ACROSS_DEG, _NEXT = 30.0, 1.3
# which way a row runs is seen over so many steps; none turns so far between two such stretches
_REACH, _SHARP_DEG = 4, 60.0


class CrossedRows(NamedTuple):
    """How many plants stand in line with a row that runs across theirs, and where rows turn.

    ``pairs`` are lines of the grid: that in whose line they stand, and their own; ``turned`` those
    that turn sharply.
    """

    n_plants: int = 0
    pairs: tuple[tuple[int, int], ...] = ()
    turned: tuple[int, ...] = ()

    @property
    def doubts(self) -> tuple[str, ...]:
        """Return a sentence for each; rows count from 1."""
        said: list[str] = []
        if self.n_plants:
            some = [
                worded("{row} and {other}", row=one + 1, other=other + 1)
                for one, other in self.pairs
            ]
            said.append(
                worded(
                    "{n} {n:plant stands|plants stand} in line with a row that runs across "
                    "{n:its|their} own, at rows {some}: blocks may be mixed there. Look at these "
                    "rows, and give blocks or name each plant's row if they are wrong.",
                    n=self.n_plants,
                    some=first_few(some),
                )
            )
        if self.turned:
            said.append(
                worded(
                    "{n} {n:row turns|rows turn} sharply: {some}. A row and one across its end may "
                    "be taken for one. Look at {n:it|them}, and give blocks or name each plant's "
                    "row if {n:it is|they are} wrong.",
                    n=len(self.turned),
                    some=first_few([f"{line + 1}" for line in self.turned]),
                )
            )
        return tuple(said)


class _Slots(NamedTuple):
    """Places where a row lacks a plant, or would go on.

    Positions ``(k, 2)``, the row and the direction of each, and whether it is beyond an end.
    """

    xy_m: Float
    row: Int
    ahead: Float
    is_end: Mask


def crossed_rows(xy_m: Float, row: NDArray[np.integer]) -> CrossedRows:
    """Return what plants ``(n, 2)``, row by row along each, are in line with rows across theirs."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    own = np.unique(row, return_inverse=True)[1].astype(np.int64)
    start = offsets(np.bincount(own))
    if not (np.diff(start) >= _LEAST).any():
        return CrossedRows()
    step = np.diff(xy_m, axis=0)
    step_m = np.where(np.diff(own) == 0, np.hypot(*step.T), np.inf)
    usual_m = _of_whole_rows(_usual_m(step_m, own, start), own)
    ahead = _ahead(xy_m, own)
    slots = _slots(xy_m, own, start, (step_m, usual_m))
    off_m, plant = cKDTree(xy_m).query(slots.xy_m)
    cos = np.abs((slots.ahead * ahead[plant]).sum(axis=1))
    found = (off_m <= _OFF * usual_m[slots.row]) & (own[plant] != slots.row)
    found &= cos < np.cos(np.deg2rad(_ACROSS_DEG))
    found &= ~slots.is_end | ~_between_two(step_m, usual_m[own])[plant]
    pairs = dict.fromkeys(zip(slots.row[found].tolist(), own[plant[found]].tolist(), strict=True))
    return CrossedRows(len(np.unique(plant[found])), tuple(pairs), _turned(xy_m, own))


def _turned(xy_m: Float, row: Int) -> tuple[int, ...]:
    """Return which rows turn sharply anywhere."""
    whole = row[2 * _REACH :] == row[: -2 * _REACH]
    middle = np.flatnonzero(whole) + _REACH
    before, after = (xy_m[b] - xy_m[a] for a, b in (
        (middle - _REACH, middle), (middle, middle + _REACH)))  # fmt: skip
    far = np.hypot(*before.T) * np.hypot(*after.T)
    sharp = (before * after).sum(axis=1) < np.cos(np.deg2rad(_SHARP_DEG)) * far
    return tuple(np.unique(row[middle[sharp]]).tolist())


def _usual_m(step_m: Float, row: Int, start: Int) -> Float:
    """Return the usual step of each row; infinite of one plant."""
    own = row[:-1]
    order = np.lexsort((step_m, own))
    n_steps = np.maximum(np.diff(start) - 1, 0)
    first = np.searchsorted(own[order], np.arange(len(n_steps)))
    middle = np.minimum(first + np.maximum(n_steps - 1, 0) // 2, len(order) - 1)
    usual_m: Float = np.where(n_steps > 0, step_m[order[middle]], np.inf)
    return usual_m


def _of_whole_rows(usual_m: Float, row: Int) -> Float:
    """Return the usual step of each row as if it missed no plant: of every other one twice that."""
    common_m = np.median(usual_m[row])
    times = np.divide(usual_m, common_m, out=np.ones(len(usual_m)), where=np.isfinite(usual_m))
    missing = np.round(times) - 1
    lacks = (np.abs(times - missing - 1) < _OFF) & (missing > 0) & (missing <= _MOST_MISSING)
    whole_m: Float = np.where(lacks, usual_m / (missing + 1), usual_m)
    return whole_m


def _ahead(xy_m: Float, row: Int) -> Float:
    """Return which way the row of each plant runs about it, ``(n, 2)``; 0, 0 of one plant."""
    n, start = np.arange(len(row)), offsets(np.bincount(row))
    before = np.maximum(n - _REACH, start[row])
    after = np.minimum(n + _REACH, start[row + 1] - 1)
    way = xy_m[after] - xy_m[before]
    ahead: Float = way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    return ahead


def _slots(xy_m: Float, row: Int, start: Int, steps: tuple[Float, Float]) -> _Slots:
    """Return where plants lack in rows, and where these would go on."""
    step_m, usual_m = steps
    own = row[:-1]
    times = np.divide(step_m, usual_m[own], out=np.zeros(len(own)), where=np.isfinite(step_m))
    made = []
    for missing in range(1, _MOST_MISSING + 1):
        gap = np.flatnonzero(np.abs(times - missing - 1) < 2 * _OFF)
        way = xy_m[gap + 1] - xy_m[gap]
        ahead = way / step_m[gap][:, None]
        made += [
            (xy_m[gap] + k / (missing + 1) * way, own[gap], ahead, np.zeros(len(gap), np.bool_))
            for k in range(1, missing + 1)
        ]
    long = np.flatnonzero(np.diff(start) >= _LEAST)
    for end, inner in ((start[long], 1), (start[long + 1] - 1, -1)):
        way = xy_m[end] - xy_m[end + inner]
        ahead = way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
        on_m = usual_m[long][:, None] * ahead
        made.append((xy_m[end] + on_m, long, ahead, np.ones(len(long), np.bool_)))
    xy, of, ahead, is_end = (np.concatenate(one) for one in zip(*made, strict=True))
    return _Slots(xy, of, ahead, is_end)


def _between_two(step_m: Float, usual_m: Float) -> Mask:
    """Return which plants have one of their row next to them on either side."""
    close = step_m < _NEXT * usual_m[:-1]
    between = np.zeros(len(usual_m), np.bool_)
    between[1:-1] = close[:-1] & close[1:]
    return between
