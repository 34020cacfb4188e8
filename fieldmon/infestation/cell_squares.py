"""Places in squares of cells: who stands near a plant, without a look at all others."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import part, routine
from fieldmon.infestation.cells import cell_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.cells import Cells

    Ints = NDArray[np.int64]

NOBODY = -1
# cells along and across a square
_SIDE = 6


class Squares(NamedTuple):
    """Who stands in each square of cells, as lists that go from one place to the next.

    Parameters
    ----------
    first
        ``(b, c)`` the first place of each square, or `NOBODY`.
    after, before
        ``(m,)`` the next place of the same square, and the one before.
    across, along
        ``(m,)`` the cell of each place.
    near
        ``(m,)`` the places found by `gather`.
    """

    first: Ints
    after: Ints
    before: Ints
    across: Ints
    along: Ints
    near: Ints

    def __repr__(self) -> str:
        return f"<Squares: {self.first.shape[0]} by {self.first.shape[1]}>"


@routine
def empty_squares(cells: Cells, places: int) -> Squares:
    """Return squares in which none of so many places stands yet."""
    across, along = (cells.shape + _SIDE - 1) // _SIDE
    lists = np.full((5, places), NOBODY)
    first = np.full((across, along), NOBODY)
    return Squares(first, lists[0], lists[1], lists[2], lists[3], lists[4])


@part
def stand(squares: Squares, cells: Cells, plant: int, place: int) -> None:
    """Let a place stand at a plant."""
    y, x = cell_of(cells, plant)
    squares.across[place], squares.along[place] = y, x
    first = squares.first[y // _SIDE, x // _SIDE]
    squares.after[place], squares.before[place] = first, NOBODY
    if first != NOBODY:
        squares.before[first] = place
    squares.first[y // _SIDE, x // _SIDE] = place


@part
def leave(squares: Squares, place: int) -> None:
    """Let a place stand nowhere."""
    before, after = squares.before[place], squares.after[place]
    if before == NOBODY:
        squares.first[squares.across[place] // _SIDE, squares.along[place] // _SIDE] = after
    else:
        squares.after[before] = after
    if after != NOBODY:
        squares.before[after] = before


@part
def gather(squares: Squares, y: int, x: int, reach: int) -> int:
    """Find who stands within so many cells of one, along and across; return how many."""
    many = 0
    last_y = min((y + reach) // _SIDE, squares.first.shape[0] - 1)
    last_x = min((x + reach) // _SIDE, squares.first.shape[1] - 1)
    for by in range(max(y - reach, 0) // _SIDE, last_y + 1):
        for bx in range(max(x - reach, 0) // _SIDE, last_x + 1):
            place = squares.first[by, bx]
            while place != NOBODY:
                away = abs(squares.across[place] - y), abs(squares.along[place] - x)
                if max(away) <= reach:
                    squares.near[many] = place
                    many += 1
                place = squares.after[place]
    return many
