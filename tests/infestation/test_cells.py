"""Plants in cells: on any plot, each plant once, and cells lie as the plants do."""

import numpy as np
from hypothesis import given

from fieldmon.infestation.cells import Cells
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from tests.crooked import crooked_grids


@given(crooked_grids())
def test_every_plant_stands_in_one_cell_and_cells_lie_as_plants_do(grid):
    cells = Cells.of(grid)
    assert sorted(cells.plant) == list(range(len(grid)))
    for cell in np.unique(cells.of_plant):
        inside = cells.plant[cells.start[cell] : cells.start[cell + 1]]
        assert (cells.of_plant[inside] == cell).all()
    place = np.column_stack([cells.of_plant // cells.shape[1], cells.of_plant % cells.shape[1]])
    yx_m = grid.xy_m[:, ::-1] - grid.xy_m[:, ::-1].min(axis=0)
    assert (np.abs(place * cells.size_m - yx_m) <= 0.5 * cells.size_m + 1e-9).all()


def test_where_rows_are_even_a_cell_is_a_plant():
    cells = Cells.of(rectangle(5, 7))
    assert cells.of_plant.tolist() == list(range(35))
    assert cells.summed(np.arange(35.0)).tolist() == np.arange(35.0).reshape(5, 7).tolist()


def test_distances_given_as_whole_numbers_make_the_same_cells_as_others():
    whole, same = (
        Cells.of(rectangle(5, 7, Planting(row_spacing_m=row_m, plant_spacing_m=plant_m)))
        for row_m, plant_m in ((6, 2), (6.0, 2.0))
    )
    assert whole.of_plant.tolist() == same.of_plant.tolist()
    assert whole.size_m.tolist() == same.size_m.tolist()
