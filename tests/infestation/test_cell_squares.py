"""Who stands near a plant: by squares of cells as one by one."""

import numpy as np
import pytest

from fieldmon.compute.jit import routine
from fieldmon.infestation.cell_squares import (
    AFTER,
    CELL,
    NOBODY,
    by_cells_apart,
    empty_squares,
    leave,
    stand,
    within,
)
from fieldmon.infestation.cells import Cells, cell_of
from fieldmon.plot.layout import rectangle

CELLS = Cells.of(rectangle(20, 31))


@routine
def near_after(cells, plants, gone, plant, kernel):
    """Return by how much each place counts near a plant after all stood at plants and some left."""
    reach, counts = kernel.shape[0] // 2, np.zeros(plants.size)
    squares = empty_squares(cells, plants.size, reach)
    for place in range(plants.size):
        stand(squares, cells, plants[place], place)
    for place in gone:
        leave(squares, place)
    table = np.zeros(squares.width**2)
    by_cells_apart(squares, kernel, table)
    y, x = cell_of(cells, plant)
    middle = y * squares.width + x + table.size // 2
    begin_y, end_y, begin_x, end_x = within(squares, y, x, reach)
    for square_y in range(begin_y, end_y):
        for square_x in range(begin_x, end_x):
            place = squares.first[square_y, square_x]
            while place != NOBODY:
                counts[place] += table[middle - squares.places[place, CELL]]
                place = squares.places[place, AFTER]
    return counts


@pytest.mark.parametrize("cell", [(0, 0), (10, 15), (19, 30), (3, 29)])
def test_those_near_count_by_the_kernel_and_others_do_not(cell):
    rng = np.random.default_rng(cell[0])
    plants, kernel = rng.integers(0, 620, 200), rng.random((15, 15))
    gone = rng.choice(200, 80, replace=False)
    y, x = np.divmod(CELLS.of_plant[plants], 31)
    across, along = cell[0] - y + 7, cell[1] - x + 7
    near = (across >= 0) & (across < 15) & (along >= 0) & (along < 15)
    near[gone] = False
    assert near.any()
    wanted = np.where(near, kernel[across % 15, along % 15], 0.0)
    (plant,) = np.flatnonzero(CELLS.of_plant == cell[0] * 31 + cell[1])
    np.testing.assert_array_equal(near_after(CELLS, plants, gone, plant, kernel), wanted)


def test_blocks_that_all_have_left_are_empty():
    plants, gone = np.arange(50), np.arange(49, -1, -1)
    assert not near_after(CELLS, plants, gone, 20, np.ones((81, 81))).any()
    assert repr(empty_squares(CELLS, 3, 2)) == "<Squares: 4 by 6>"
