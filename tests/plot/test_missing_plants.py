import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import PlotError
from fieldmon.plot import adjacency
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.layout import rectangle
from fieldmon.plot.missing_plants import without
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import Aisles
from tests.crooked import crooked_grids
from tests.crossing import crosses_rows


def thinned(grid, seed, share):
    missing = np.random.default_rng(seed).random(len(grid)) < share
    missing[seed % len(grid)] = False  # somebody is left
    missing |= missing[grid.twin] & (grid.twin >= 0)
    missing[[seed % len(grid), grid.twin[seed % len(grid)]]] = False
    return missing, without(grid, missing)


SEEDS = st.integers(0, 2**32)
SHARES = st.sampled_from([0.0, 0.05, 0.5, 0.97])


@given(crooked_grids(), SEEDS, SHARES)
def test_those_that_are_left_stand_where_they_stood_in_rows_and_aisles_as_they_were(
    grid, seed, share
):
    missing, left = thinned(grid, seed, share)
    kept = np.flatnonzero(~missing)
    np.testing.assert_array_equal(left.xy_m, grid.xy_m[kept])
    old, new = grid.row[kept], left.row
    np.testing.assert_array_equal(left.lane_y_m[new], grid.lane_y_m[old])
    np.testing.assert_array_equal(left.lane_x_m[new], grid.lane_x_m[old])
    np.testing.assert_array_equal(left.side[new], grid.side[old])
    for numbers in ("row_line", "corridor"):
        was, now = getattr(grid, numbers)[old], getattr(left, numbers)[new]
        # the same number before means the same number now, and the other way about
        pairs = np.unique(np.stack([was, now]), axis=1)
        assert np.unique(pairs[0]).size == np.unique(pairs[1]).size == pairs.shape[1]
        assert np.unique(now).tolist() == list(range(now.max() + 1))
    assert (np.diff(left.row_line) >= 0).all()
    assert (np.diff(left.row_start) > 0).all()


@given(crooked_grids(), SEEDS, SHARES)
def test_neighbours_are_those_that_were_and_are_left(grid, seed, share):
    missing, left = thinned(grid, seed, share)
    kept = np.flatnonzero(~missing)
    for name in ("along", "across"):
        start, plant = (getattr(grid, f"{name}_{part}") for part in ("start", "plant"))
        new_start, new_plant = (getattr(left, f"{name}_{part}") for part in ("start", "plant"))
        assert len(new_start) == len(left) + 1
        for i, old in enumerate(kept):
            wanted = [p for p in plant[start[old] : start[old + 1]] if not missing[p]]
            assert kept[new_plant[new_start[i] : new_start[i + 1]]].tolist() == wanted
    paired = left.twin >= 0
    np.testing.assert_array_equal(kept[left.twin[paired]], grid.twin[kept][paired])
    np.testing.assert_array_equal(paired, grid.twin[kept] >= 0)


def test_a_grid_with_gaps_has_the_neighbours_of_plants_measured_so():
    grid = rectangle(15, 22)
    _, left = thinned(grid, 5, 0.3)
    spacings = (grid.row_spacing_m, grid.plant_spacing_m)
    along = adjacency.along(left.xy_m[:, 0], left.row, grid.plant_spacing_m)
    across = adjacency.across(left.xy_m, left.row_line[left.row], *spacings)
    for ours, anew in zip(
        (left.along_start, left.along_plant, left.across_start, left.across_plant),
        (*along, *across),
        strict=True,
    ):
        np.testing.assert_array_equal(ours, anew)


@given(crooked_grids(), SEEDS, SHARES)
def test_robots_reach_what_is_left_without_crossing_a_row(grid, seed, share):
    _, left = thinned(grid, seed, share)
    aisles = Aisles.of(left)
    rng = np.random.default_rng(seed)
    for i, j in rng.integers(0, len(left), (5, 2)):
        line = aisles.path(int(i), int(j))
        assert not crosses_rows(left, line)
        driven = np.hypot(*np.diff(line, axis=0).T).sum()
        assert driven == pytest.approx(float(aisles.distance_m(i, j)), abs=1e-6)


def test_a_gap_at_a_row_end_shortens_no_lane_and_an_empty_line_is_counted_out():
    grid = rectangle(4, 5)
    missing = np.zeros(20, bool)
    missing[[0, 1]] = True  # the first plants of the first row
    missing[5:10] = True  # the whole second row
    left = without(grid, missing)
    assert left.n_rows == 3
    np.testing.assert_array_equal(left.lane_x_m[0], grid.lane_x_m[0])
    assert plant_numbers(left).line.tolist() == [1] * 3 + [2] * 5 + [3] * 5


def test_both_faces_of_a_missing_vine_go():
    grid = rectangle(3, 4, Planting(faces=2))
    missing = np.zeros(len(grid), bool)
    missing[1] = True
    left = without(grid, missing)
    assert len(left) == len(grid) - 2
    assert not (left.xy_m == grid.xy_m[1]).all(axis=1).any()


def test_no_plant_at_all_and_marks_of_another_plot_are_refused():
    grid = rectangle(2, 3)
    with pytest.raises(PlotError, match="all were marked as missing"):
        without(grid, np.ones(6, bool))
    with pytest.raises(PlotError, match="each of 6 plants"):
        without(grid, np.zeros(5, bool))
