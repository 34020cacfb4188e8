import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.errors import PlotError
from fieldmon.plot.grid import nearest_plants, plant_at, plant_numbers
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from tests.crooked import crooked_fields, crooked_grids, plantings


@given(crooked_grids(50))
def test_neighbours_are_mutual(grid):
    n = len(grid)
    for start, plant in (
        (grid.along_start, grid.along_plant),
        (grid.across_start, grid.across_plant),
        grid.adjacent,
    ):
        assert start[0] == 0
        assert start[-1] == len(plant)
        one, other = np.repeat(np.arange(n), np.diff(start)), plant.astype(int)
        assert set(zip(one, other, strict=True)) == set(zip(other, one, strict=True))
        assert (one != other).all()
        assert len(set(zip(one, other, strict=True))) == len(plant)


@given(crooked_grids(50))
def test_adjacent_plants_are_those_along_the_row_and_then_those_across(grid):
    for plant in range(0, len(grid), 7):
        along = grid.along_plant[slice(*grid.along_start[plant : plant + 2])]
        across = grid.across_plant[slice(*grid.across_start[plant : plant + 2])]
        adjacent = grid.adjacent.plant[slice(*grid.adjacent.start[plant : plant + 2])]
        assert adjacent.tolist() == [*along, *across]


@given(crooked_grids(50))
def test_linked_entries_are_those_of_the_same_two_plants(grid):
    start, plant, back = grid.linked
    one = np.repeat(np.arange(len(grid)), np.diff(start))
    assert (plant[back] == one).all()
    assert (one[back] == plant).all()


@given(crooked_grids(50))
def test_the_snake_visits_every_plant_once_up_one_line_and_down_the_next(grid):
    assert sorted(grid.snake) == list(range(len(grid)))
    row = grid.row[grid.snake]
    line_face = grid.row_line[row] * 2 + (grid.side[row] == -1)
    passes = np.cumsum(np.diff(line_face, prepend=line_face[0]) != 0)
    assert (np.diff(line_face) >= 0).all()
    onward = np.diff(grid.xy_m[grid.snake, 0]) * np.where(passes[1:] % 2 == 0, 1, -1)
    assert (onward[np.diff(passes) == 0] > 0).all()


@given(crooked_grids(50))
def test_a_label_leads_back_to_its_plant(grid):
    numbered = plant_numbers(grid)
    assert numbered.line.min() == numbered.number.min() == 1
    some = np.arange(0, len(grid), 1 + len(grid) // 20)
    for plant in some:
        first_face = grid.twin[plant] if 0 <= grid.twin[plant] < plant else plant
        assert plant_at(grid, int(numbered.line[plant]), int(numbered.number[plant])) == first_face
    assert plant_numbers(grid, some).number.tolist() == numbered.number[some].tolist()


def test_numbers_count_on_behind_a_hole_and_faces_share_their_label():
    grid = rectangle(3, 5, Planting(faces=2))
    assert plant_numbers(grid).line.tolist() == np.repeat([1, 2, 3], 10).tolist()
    assert plant_numbers(grid).number.tolist() == list(range(1, 6)) * 6
    assert plant_at(grid, 2, 4) == 13


@pytest.mark.parametrize(
    ("line", "number", "sentence"),
    [(0, 1, "1–3"), (4, 1, "1–3"), (2, 0, "1–5"), (2, 6, "1–5"), (3, 6, "1–5")],
)
def test_labels_that_are_none_are_refused(line, number, sentence):
    with pytest.raises(PlotError, match=sentence):
        plant_at(rectangle(3, 5), line, number)


@given(crooked_fields(50), plantings(), st.integers(0, 2**32))
def test_a_record_near_a_plant_belongs_to_it(field, planting, seed):
    try:
        grid = lay(field, planting)
    except PlotError:
        assume(False)
    rng = np.random.default_rng(seed)
    near_m = 0.45 * min(planting.row_spacing_m, planting.plant_spacing_m)
    off_m = rng.uniform(0, near_m, len(grid))
    turn = rng.uniform(0, 2 * np.pi, len(grid))
    places = grid.xy_m + off_m[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    plant, distance_m = nearest_plants(grid, grid.frame.lonlat(places), near_m + 0.001)
    own = np.where(grid.twin >= 0, np.minimum(grid.twin, np.arange(len(grid))), range(len(grid)))
    assert plant.tolist() == own.tolist()
    assert distance_m == pytest.approx(off_m, abs=1e-3)


def test_a_record_far_from_every_plant_belongs_to_none():
    grid = rectangle(4, 4)
    corner = grid.xy_m[-1]
    beyond = grid.frame.lonlat(corner + np.array([[1.999, 0], [2.001, 0], [500, 0]]))
    plant, distance_m = nearest_plants(grid, beyond, 2.0)
    assert plant.tolist() == [15, -1, -1]
    assert distance_m == pytest.approx([1.999, np.inf, np.inf], abs=1e-4)
    assert [len(found) for found in nearest_plants(grid, np.empty((0, 2)), 2.0)] == [0, 0]


def test_arrays_of_a_grid_cannot_be_written():
    grid = rectangle(3, 3)
    for values in (grid.xy_m, grid.row, grid.snake, *grid.adjacent):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0


def test_degrees_of_plants_are_those_of_their_metres():
    grid = rectangle(3, 4, Planting(row_bearing_deg=20.0), centre=(10.0, 50.0))
    frame = Frame(10.0, 50.0, 20.0)
    assert grid.lonlat() == pytest.approx(frame.lonlat(grid.xy_m), abs=1e-12)
    assert grid.lonlat(np.array([5, 2])) == pytest.approx(grid.lonlat()[[5, 2]], abs=1e-12)
    assert grid.along_m.tolist() == grid.xy_m[:, 0].tolist()
