"""Which plants lie near what, against distances worked out one by one."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from pyproj import Geod

from fieldmon.infestation.nearby_plants import (
    PlantRows,
    SearchRows,
    distance_m,
    first_from,
    outside_m,
)
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from tests.bent import bent_grids
from tests.crooked import crooked_grids

GRID = rectangle(21, 25)


@given(crooked_grids(50.0, max_plants=3000), st.floats(1.0, 60.0), st.data())
def test_the_distance_to_lines_is_the_planar_one_as_far_as_asked(grid, farthest_m, data):
    numbers = st.integers(-80, 80)
    ends = data.draw(st.lists(st.tuples(*[numbers] * 4), min_size=1, max_size=5))
    metres = distance_m(PlantRows.of(grid), np.array(ends, float), farthest_m)
    lines = shapely.MultiLineString([((a, b), (c, d)) for a, b, c, d in ends])
    true = shapely.distance(shapely.points(grid.xy_m), lines)
    near = true < farthest_m - 1e-6
    np.testing.assert_allclose(metres[near], true[near], atol=1e-6)
    assert np.isinf(metres[true > farthest_m + 1e-6]).all()


def test_without_lines_every_plant_is_infinitely_far_from_them():
    assert np.isinf(distance_m(PlantRows.of(GRID), np.empty((0, 4)), 50.0)).all()


@given(st.lists(st.floats(-9.0, 9.0), max_size=30), st.floats(-10.0, 10.0))
def test_the_first_plant_from_an_x_on_is_the_one_that_bisection_finds(values, least):
    x_m = np.sort(np.array(values, np.float64))
    assert first_from(x_m, 0, len(x_m), least) == np.searchsorted(x_m, least)


def test_rows_know_their_extent_across():
    rows = PlantRows.of(GRID)
    assert len(rows.start) == len(rows.low_m) + 1
    for r in range(len(rows.low_m)):
        y_m = GRID.xy_m[rows.start[r] : rows.start[r + 1], 1]
        assert (rows.low_m[r], rows.high_m[r]) == (y_m.min(), y_m.max())


@given(st.floats(0.0, 360.0), st.floats(200.0, 5_000.0))
def test_the_distance_outside_a_plot_is_the_geodesic_one(bearing_deg, metres):
    plot = rectangle(1, 1, Planting(row_spacing_m=0.1, plant_spacing_m=0.1, headland_m=0.05))
    geod = Geod(ellps="WGS84")
    lon, lat, _ = geod.fwd(plot.frame.lon, plot.frame.lat, bearing_deg, metres)
    off_m = outside_m(plot, np.array([[lon, lat], [plot.frame.lon, plot.frame.lat]]))
    assert off_m[0] == pytest.approx(metres, abs=0.1)
    assert off_m[1] == 0.0


def test_positions_that_are_no_degrees_are_infinitely_far():
    off_m = outside_m(GRID, np.array([[735_000.0, 3_360_000.0], [np.nan, np.nan]]))
    assert np.isinf(off_m).all()


def test_positions_on_another_continent_are_far_to_the_kilometre():
    off_m = outside_m(GRID, np.array([[-72.0, -41.0]]))
    true_m = Geod(ellps="WGS84").inv(-72.0, -41.0, GRID.frame.lon, GRID.frame.lat)[2]
    assert off_m[0] == pytest.approx(true_m, rel=0.01)


@given(bent_grids(), st.integers(0, 1000))
def test_where_rows_bend_the_same_distances_are_found_in_level_strips(grid, seed):
    rng = np.random.default_rng(seed)
    low, size = grid.xy_m.min(axis=0) - 20, np.ptp(grid.xy_m, axis=0) + 40
    ends = (low + rng.random((6, 2)) * size).reshape(3, 4)
    search = SearchRows.of(grid)
    metres = search.numbered(distance_m(search.rows, ends, 15.0))
    lines = shapely.multilinestrings(list(ends.reshape(3, 2, 2)))
    wanted = shapely.distance(lines, shapely.points(grid.xy_m))
    assert metres == pytest.approx(np.where(wanted <= 15.0, wanted, np.inf))
    back = search.numbered(search.sorted(wanted))
    assert back.tolist() == wanted.tolist()
