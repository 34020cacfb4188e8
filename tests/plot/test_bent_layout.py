"""Plants in rows that bend and blocks that turn: lanes, neighbours, ways."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.missing_plants import without
from fieldmon.plot.planting import Planting
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_lines import Ground, RowLines
from fieldmon.plot.travel import Aisles
from tests.bent import FRAME, bent_grids
from tests.crossing import crosses_rows


def length_m(line):
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


def check_paths(grid, seed):
    aisles = Aisles.of(grid)
    stops = np.concatenate([aisles.stop_m, [aisles.gate_m]])
    plants = np.random.default_rng(seed).integers(-1, len(grid), 15)
    for i, j in pairwise(plants):
        line = aisles.path(i, j)
        assert len(line) >= 2
        assert line[[0, -1]] == pytest.approx(stops[[i, j]])
        assert length_m(line) == pytest.approx(aisles.distance_m(i, j), abs=1e-6)
        assert not crosses_rows(grid, line)


@given(bent_grids(), st.integers(0, 1000))
def test_paths_are_as_long_as_said_and_cross_no_row(grid, seed):
    check_paths(grid, seed)


def check_lanes(grid):
    aisles, own = grid.aisles_m, grid.aisle.astype(int)
    stop_m = grid.stop_m
    # a plant is inspected from beside it, within its aisle
    beside_m = np.hypot(*(stop_m - grid.xy_m).T)
    assert beside_m.max() < 1.1 * grid.row_spacing_m
    low, high = grid.lane_x_m.T
    assert (low[grid.row] < grid.along_m).all()
    assert (grid.along_m < high[grid.row]).all()
    rows = shapely.multipoints(grid.xy_m)
    for k in range(grid.n_rows):
        ends = aisles.points(np.full(2, own[k]), grid.lane_x_m[k])
        inner = aisles.corners_between(own[k], *grid.lane_x_m[k])
        lane = shapely.linestrings(np.concatenate([ends[:1], inner, ends[1:]]))
        assert shapely.distance(lane, rows) > 0.2 * grid.row_spacing_m
        assert shapely.covers(shapely.buffer(grid.drivable_m, 0.02), lane)


@given(bent_grids())
def test_lanes_meet_no_plant_and_stay_where_driving_is_allowed(grid):
    check_lanes(grid)


def test_a_lane_goes_straight_on_before_its_aisle_turns_to_a_row_far_off():
    # three short rows of one block, one after the other rather than beside each other
    ends = [[8.57, -4.57], [11.57, -4.57]], [[14.52, -2.06], [17.35, -3.04]], [[0, -1], [2.7, 0.2]]
    rows = RowLines(Polylines.each([np.array(line, float) for line in ends]), np.zeros(3, int))
    plants = np.array([[11.6, -4.86], [14.42, -1.89], [17.23, -3.07]]), np.array([0, 1, 1])
    planting = Planting(row_spacing_m=3.0, plant_spacing_m=3.0, headland_m=1.0)
    check_lanes(bent_grid(FRAME, rows, plants, Ground(None, shapely.MultiPolygon()), planting))


def test_a_row_is_cut_where_a_pond_reaches_by_centimetres_into_its_bent_aisle():
    # found by the property: the plants of the outer row that a pond leaves, and an inner row whole
    turn = np.arange(-9, 10) * 2.0 / 33.0
    inner, outer = (r * np.stack([np.sin(turn), np.cos(turn)], axis=1) for r in (30.0, 33.0))
    aisle_m, at = 31.5, np.deg2rad(-3.0)
    pond = shapely.buffer(shapely.Point((aisle_m + 2.95) * np.array([np.sin(at), np.cos(at)])), 3.0)
    dry = ~shapely.contains_xy(shapely.buffer(pond, 3.0), outer)
    rows = RowLines(Polylines.each([inner, outer]), np.zeros(2, int))
    plants = np.concatenate([inner, outer[dry]]), np.repeat([0, 1], [19, dry.sum()])
    for faces in (1, 2):
        planting = Planting(row_spacing_m=3.0, plant_spacing_m=2.0, headland_m=1.0, faces=faces)
        grid = bent_grid(FRAME, rows, plants, Ground(None, pond), planting)
        check_lanes(grid)
        ends = grid.lane_x_m[grid.row_line == 0]
        assert len(ends) == 2 * faces  # the inner row, on either side of the pond


def test_a_pond_that_took_all_but_a_plant_of_a_measured_row_cuts_the_next_one():
    # found by the property, its pond found again
    plants = np.array([[2.66313063, -22.91438111], [2.41662116, -19.62005056],
                       [3.07992533, -2.09725196], [5.14523714, 4.64422381],
                       [6.09204402, 8.04159754], [7.69324891, 10.97480571],
                       [10.6662094, 17.18542862], [0.13801428, -19.33443149]])  # fmt: skip
    middle, radius_m = np.array([62.1397, -13.9763]), 60.0879
    lines = []
    for at_m, first, n in ((radius_m, -2.99015, 13), (radius_m + 2.1875, -3.05341, 4)):
        turn = first - np.arange(n) * 3.5 / at_m
        lines.append(middle + at_m * np.stack([np.cos(turn), np.sin(turn)], axis=1))
    pond = shapely.buffer(shapely.Point(-0.67423203, -11.08635208), 1.789964, quad_segs=3)
    rows = RowLines(Polylines.each(lines), np.zeros(2, int))
    planting = Planting(row_spacing_m=2.1875, plant_spacing_m=3.5, headland_m=5.285681)
    measured = plants, np.array([0, 0, 0, 0, 0, 0, 0, 1])
    check_lanes(bent_grid(FRAME, rows, measured, Ground(None, pond), planting))


@given(bent_grids())
def test_places_ascend_along_each_row_and_are_metres_driven(grid):
    step_m = np.diff(grid.along_m)
    same = np.diff(grid.row) == 0
    assert (step_m[same] >= 0).all()
    # on a lane beside a bend places differ from the plants' own distance by little
    apart_m = np.hypot(*np.diff(grid.xy_m, axis=0).T)
    assert step_m[same].sum() == pytest.approx(apart_m[same].sum(), rel=0.35)


@given(bent_grids(faces=(1,)))
def test_neighbours_across_are_near_in_metres_and_mutual(grid):
    one = np.repeat(np.arange(len(grid)), np.diff(grid.across_start))
    other = grid.across_plant
    pairs = set(zip(one.tolist(), other.tolist(), strict=True))
    assert pairs == {(b, a) for a, b in pairs}
    apart_m = np.hypot(*(grid.xy_m[one] - grid.xy_m[other]).T)
    reach_m = np.hypot(1.5 * grid.row_spacing_m, grid.plant_spacing_m)
    assert (apart_m <= reach_m + 1e-6).all()
    assert (np.abs(grid.row_line[grid.row[one]] - grid.row_line[grid.row[other]]) == 1).all()
    assert (grid.block[grid.row[one]] == grid.block[grid.row[other]]).all()


@given(bent_grids(faces=(2,)))
def test_both_faces_of_a_plant_stand_in_one_place_and_are_inspected_from_two_aisles(grid):
    faced = np.flatnonzero(grid.twin >= 0)
    twin = grid.twin[faced]
    assert (grid.twin[twin] == faced).all()
    assert grid.xy_m[twin] == pytest.approx(grid.xy_m[faced])
    assert (np.abs(grid.aisle[grid.row[twin]] - grid.aisle[grid.row[faced]]) == 1).all()
    assert (grid.side[grid.row[twin]] == -grid.side[grid.row[faced]]).all()


def concentric(n_rows=10, n_plants=40, radius_m=60.0):
    k, j = np.divmod(np.arange(n_rows * n_plants), n_plants)
    at = radius_m + 2.5 * k
    turn = (j - (n_plants - 1) / 2) * 1.4 / radius_m
    return np.stack([at * np.sin(turn), at * np.cos(turn)], axis=1), turn, k


def test_a_row_bends_on_where_many_of_its_plants_are_missing():
    xy_m, _, row = concentric(3, 30, 12.0)
    left = (row != 1) | (np.arange(90) % 30 < 2) | (np.arange(90) % 30 > 20)
    rows = RowLines(Polylines.each([xy_m[row == k] for k in range(3)]), np.zeros(3, int))
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.4)
    ground = Ground(None, shapely.MultiPolygon())
    grid = bent_grid(FRAME, rows, (xy_m[left], row[left]), ground, planting)
    for seed in range(20):
        check_paths(grid, seed)


def test_neighbours_of_radial_rows_stand_on_one_radius():
    xy_m, turn, row = concentric()
    rows = RowLines(Polylines.each([xy_m[row == k] for k in range(10)]), np.zeros(10, int))
    ground = Ground(None, shapely.MultiPolygon())
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.4)
    grid = bent_grid(FRAME, rows, (xy_m, row), ground, planting)
    assert grid.n_rows == 10
    assert np.diff(grid.across_start).tolist() == [1] * 40 + [2] * 320 + [1] * 40
    one = np.repeat(np.arange(400), np.diff(grid.across_start))
    assert turn[one] == pytest.approx(turn[grid.across_plant], abs=1e-9)


def test_a_pond_cuts_bent_rows_and_missing_plants_do_not():
    xy_m, _, row = concentric()
    rows = RowLines(Polylines.each([xy_m[row == k] for k in range(10)]), np.zeros(10, int))
    pond = shapely.box(-3.0, 66.0, 3.0, 72.0)
    dry = ~shapely.contains_xy(shapely.buffer(pond, 2.6), xy_m)
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.4)
    plants = (xy_m[dry], row[dry])
    whole = bent_grid(FRAME, rows, plants, Ground(None, shapely.MultiPolygon()), planting)
    assert whole.n_rows == 10
    cut = bent_grid(FRAME, rows, plants, Ground(None, pond), planting)
    assert 12 <= cut.n_rows <= 15
    assert cut.row_line.max() == 9
    aisles = Aisles.of(cut)
    for i, j in np.random.default_rng(1).integers(0, len(cut), (20, 2)):
        assert not shapely.intersects(shapely.linestrings(aisles.path(i, j)), pond)


def test_a_gate_in_an_aisle_far_from_its_ends_is_reached_along_it():
    xy_m, _, row = concentric()
    rows = RowLines(Polylines.each([xy_m[row == k] for k in range(10)]), np.zeros(10, int))
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.4)
    grid = bent_grid(FRAME, rows, (xy_m, row), Ground(None, shapely.MultiPolygon()), planting)
    middle = grid.stop_m[5 * 40 + 20]
    aisles = Aisles.of(grid, tuple(middle + np.array([0.0, 0.3])))
    assert aisles.gate_m == pytest.approx(middle, abs=0.7)
    for plant in (0, 210, 399):
        line = aisles.path(-1, plant)
        assert not crosses_rows(grid, line)
        assert length_m(line) == pytest.approx(float(aisles.distance_m(-1, plant)), abs=1e-6)


def test_without_missing_plants_a_bent_grid_keeps_its_lanes():
    xy_m, _, row = concentric()
    rows = RowLines(Polylines.each([xy_m[row == k] for k in range(10)]), np.zeros(10, int))
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.4)
    grid = bent_grid(FRAME, rows, (xy_m, row), Ground(None, shapely.MultiPolygon()), planting)
    left = without(grid, (row == 3) | (np.arange(400) % 7 == 0))
    assert left.n_rows == 9
    assert left.along_m.tolist() == grid.along_m[(row != 3) & (np.arange(400) % 7 > 0)].tolist()
    check = Aisles.of(left)
    assert not crosses_rows(left, check.path(0, len(left) - 1))
