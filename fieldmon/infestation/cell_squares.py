"""Places in squares of cells: who stands near a plant, without a look at all others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop, routine
from fieldmon.infestation.cells import cell_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.cells import Cells

    Floats = NDArray[np.floating[Any]]
    Ints = NDArray[np.int64]

NOBODY = -1
# cells along and across a square
_SIDE = 6
#: what is where in `Squares.places`
AFTER, CELL, SINCE, UNTIL = range(4)


class Squares(NamedTuple):
    """Who stands in each square of cells, as lists that go from one place to the next.

    Parameters
    ----------
    first
        ``(b, c)`` the first place of each square, or `NOBODY`.
    places
        ``(m, 4)`` of each place side by side, as who reads one number has the others at hand: the
        next place of the same square (`AFTER`), its cell by one number (`CELL`), and the mornings
        on which it begins and ceases to count (`SINCE`, `UNTIL`).
    before, across, along
        ``(m,)`` the place before, and the cell of each.
    width
        Cells of one column are so many apart by their number.
    """

    first: NDArray[np.int32]
    places: NDArray[np.int32]
    before: Ints
    across: Ints
    along: Ints
    width: int

    def __repr__(self) -> str:
        return f"<Squares: {self.first.shape[0]} by {self.first.shape[1]}>"


@routine
def empty_squares(cells: Cells, places: int, reach: int) -> Squares:
    """Return squares in which none of so many places stands yet, for a look so far around."""
    across, along = (cells.shape + _SIDE - 1) // _SIDE
    none, lists = np.int32(NOBODY), np.full((3, places), NOBODY)
    return Squares(
        np.full((across, along), none), np.full((places, 4), none),
        lists[0], lists[1], lists[2], 2 * (reach + _SIDE) - 1,
    )  # fmt: skip


@inner_loop
def stand(squares: Squares, cells: Cells, plant: int, place: int) -> None:
    """Let a place stand at a plant."""
    y, x = cell_of(cells, plant)
    squares.across[place], squares.along[place] = y, x
    first = squares.first[y // _SIDE, x // _SIDE]
    squares.places[place, AFTER], squares.before[place] = first, NOBODY
    squares.places[place, CELL] = y * squares.width + x
    if first != NOBODY:
        squares.before[first] = place
    squares.first[y // _SIDE, x // _SIDE] = place


@inner_loop
def leave(squares: Squares, place: int) -> None:
    """Let a place stand nowhere."""
    before, after = squares.before[place], squares.places[place, AFTER]
    if before == NOBODY:
        squares.first[squares.across[place] // _SIDE, squares.along[place] // _SIDE] = after
    else:
        squares.places[before, AFTER] = after
    if after != NOBODY:
        squares.before[after] = before


@inner_loop
def within(squares: Squares, y: int, x: int, reach: int) -> tuple[int, int, int, int]:
    """Return which squares have cells within so many of one: from and to, across and along."""
    across, along = squares.first.shape
    return (
        max(y - reach, 0) // _SIDE, min((y + reach) // _SIDE + 1, across),
        max(x - reach, 0) // _SIDE, min((x + reach) // _SIDE + 1, along),
    )  # fmt: skip


@inner_loop
def by_cells_apart(squares: Squares, kernel: Floats, table: Floats) -> None:
    """Write a kernel ``(d, d)`` to a table by the numbers of two cells, see `apart`."""
    d, half, width = kernel.shape[0], kernel.shape[0] // 2, squares.width
    for y in range(d):
        for x in range(d):
            table[(y - half) * width + x - half + table.size // 2] = kernel[y, x]
