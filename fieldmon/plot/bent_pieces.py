"""Rows of plants that bend, cut where they cannot go on; the lane of each piece."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arrays import offsets
from fieldmon.plot.row_lines import LEFT, RIGHT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.aisle_lines import RowAisles
    from fieldmon.plot.planting import Planting
    from fieldmon.plot.row_lines import Blocked, RowLines

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# longer than any row
_FAR_M = 1e6
# a lane ends this far at least from the rows of another block, if there is room
_CLEAR_M = 0.8


class BentPieces(NamedTuple):
    """Unbroken pieces of rows, by row, then along it: r pieces of n plants together.

    What has two columns is of the aisle to the right and of that to the left.
    """

    xy_m: Float
    row_start: Int
    row: Int  # (r,) the row of each piece
    block: Int  # (r,) as people call it
    spacing_m: Float  # (r, 2) as in `RowLines`
    aisle: Int  # (r, 2)
    place_m: Float  # (n, 2)
    off_m: Float  # (n, 2)
    lane_m: Float  # (r, 2, 2): aisle, then low and high end

    def __repr__(self) -> str:
        return f"<BentPieces: {len(self.xy_m)} plants>"


def bent_pieces(
    rows: RowLines,
    aisles: RowAisles,
    plants: tuple[Float, Int],
    blocked: Blocked,
    planting: Planting,
) -> BentPieces:
    """Return the rows of plants, cut where they cannot go on."""
    xy_m, row = plants
    on_row, _ = rows.lines.project(xy_m, row)
    if not (np.diff(_key(row, on_row)) >= 0).all():
        order = np.lexsort((on_row, row))
        xy_m, row, on_row = xy_m[order], row[order], on_row[order]
    cut = np.searchsorted(_key(blocked.row, (blocked.from_m + blocked.to_m) / 2), _key(row, on_row))
    new = (np.diff(row, prepend=row[:1]) > 0) | (np.diff(cut, prepend=cut[:1]) > 0)
    piece = np.cumsum(new.astype(np.int64))
    start = offsets(np.bincount(piece))
    first, last = start[:-1], start[1:] - 1
    of = row[first]
    aisle = np.stack([aisles.right[of], aisles.left[of]], axis=1)
    place, off = np.empty((len(xy_m), 2)), np.empty((len(xy_m), 2))
    for side in (RIGHT, LEFT):
        at, left = aisles.lines.project(xy_m, aisle[piece, side])
        # plants measured side by side keep their order along the row
        place[:, side] = _rising(at, piece)
        off[:, side] = np.abs(left)
    room = _room(on_row, of, (first, last), blocked)
    spacing = rows.spacings(planting)[of]
    clear = np.clip(room / 2, spacing[:, 1:] / 4, planting.headland_m / 2)
    lane = np.stack([place[first] - clear[:, :1], place[last] + clear[:, 1:]], axis=2)
    lane = _off_other_blocks(lane, rows, aisles, (of, aisle), (place[first], place[last]))
    called = rows.block if rows.called is None else rows.called
    return BentPieces(xy_m, start, of, called[of], spacing, aisle, place, off, lane)


def _key(row: Int, place_m: Float) -> Float:
    """Return one ascending axis for all rows."""
    return row * _FAR_M + place_m


def _rising(at_m: Float, piece: Int) -> Float:
    """Return places that never fall within a piece."""
    shift = (float(np.ptp(at_m)) + 1.0) * piece
    rising: Float = np.maximum.accumulate(at_m + shift) - shift
    return rising


def _room(on_row: Float, of: Int, ends: tuple[Int, Int], blocked: Blocked) -> Float:
    """Return how far it is from each piece's ends to where its row is blocked, ``(r, 2)``."""
    low, high = (on_row[end] for end in ends)
    if not len(blocked.row):
        return np.full((len(of), 2), np.inf)
    middle_m = (blocked.from_m + blocked.to_m) / 2
    before = np.searchsorted(_key(blocked.row, middle_m), _key(of, low))
    known = np.append(blocked.row, -1)
    from_m, to_m = np.append(blocked.from_m, 0.0), np.append(blocked.to_m, 0.0)
    room_low = np.where((before > 0) & (known[before - 1] == of), low - to_m[before - 1], np.inf)
    room_high = np.where(known[before] == of, from_m[before] - high, np.inf)
    return np.stack([room_low, room_high], axis=1)


def _off_other_blocks(
    lane_m: Float,
    rows: RowLines,
    aisles: RowAisles,
    of: tuple[Int, Int],
    plants_at: tuple[Float, Float],
) -> Float:
    """Return lanes that end clear of the rows of other blocks, as far as there is room."""
    if rows.block[-1] == 0:
        return lane_m
    row, aisle = of
    lines = rows.lines.simpler(0.05).shapes()
    moved = lane_m.copy()
    for block in np.unique(rows.block):
        others = shapely.union_all(lines[rows.block != block])
        shapely.prepare(others)
        mine = np.flatnonzero(rows.block[row] == block)
        for side in (RIGHT, LEFT):
            for end in range(2):
                plant_m = plants_at[end][mine, side]
                beyond = moved[mine, side, end] - plant_m
                share = np.full(len(mine), 0.25)
                for part in (0.5, 0.75, 1.0):
                    at = aisles.lines.points(aisle[mine, side], plant_m + part * beyond)
                    off = shapely.distance(others, shapely.points(at))
                    good = off >= np.minimum(part * np.abs(beyond), _CLEAR_M)
                    share[good & (share >= part - 0.25)] = part
                moved[mine, side, end] = plant_m + share * beyond
    return moved
