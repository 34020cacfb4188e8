"""Who stands near a plant: by squares of cells as one by one."""

import numpy as np
import pytest

from fieldmon.compute.jit import routine
from fieldmon.infestation.cell_squares import empty_squares, gather, leave, stand
from fieldmon.infestation.cells import Cells
from fieldmon.plot.layout import rectangle

CELLS = Cells.of(rectangle(20, 31))


@routine
def near_after(cells, plants, gone, cell, reach):
    """Return who is near a cell after all stood at plants and some left."""
    squares = empty_squares(cells, plants.size)
    for place in range(plants.size):
        stand(squares, cells, plants[place], place)
    for place in gone:
        leave(squares, place)
    many = gather(squares, cell[0], cell[1], reach)
    return squares.near[:many].copy()


@pytest.mark.parametrize("cell", [(0, 0), (10, 15), (19, 30), (3, 29)])
def test_those_near_are_found(cell):
    rng = np.random.default_rng(cell[0])
    plants = rng.integers(0, 620, 200)
    gone = rng.choice(200, 80, replace=False)
    y, x = np.divmod(CELLS.of_plant[plants], 31)
    near = (abs(y - cell[0]) <= 7) & (abs(x - cell[1]) <= 7)
    near[gone] = False
    assert near.any()
    assert sorted(near_after(CELLS, plants, gone, cell, 7)) == np.flatnonzero(near).tolist()


def test_blocks_that_all_have_left_are_empty():
    plants = np.arange(50)
    assert near_after(CELLS, plants, np.arange(50)[::-1], (1, 20), 40).size == 0
    assert repr(empty_squares(CELLS, 3)) == "<Squares: 4 by 6>"
