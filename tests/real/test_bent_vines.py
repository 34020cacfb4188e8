"""Real vines, bent and turned: found in their own rows, and driven without crossing one."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from fieldmon.plot.plot import plot_around
from fieldmon.plot.row_detection import distinct
from tests.bent import FRAME, bent, measured, right_share, side_by_side, surveyed, tiled
from tests.crossing import crosses_rows

TURNS = (5.0, 15.0, 40.0, 90.0)
NOISES = {0.0: 0.99, 0.05: 0.99, 0.3: 0.95}


@pytest.fixture(scope="module")
def survey(shared):
    return surveyed(shared)


def found(vines):
    """Return the vines that stand apart, the plot of them, and the plant in the grid of each."""
    vines = vines.take(distinct(vines.lonlat))
    plot = plot_around("vines", vines.lonlat)
    return vines, plot, cKDTree(plot.grid.xy_m).query(plot.grid.frame.xy_m(vines.lonlat))[1]


def check(vines, least):
    """Check the share in the right row and block, and that nothing driven crosses a row."""
    vines, plot, plant = found(vines)
    grid = plot.grid
    assert sorted(plant) == list(range(len(vines.row)))
    assert plot.rows.in_rows
    right = right_share(grid.row_line[grid.row[plant]], vines.row)
    assert right >= least
    assert grid.n_blocks == len(np.unique(vines.block))
    some = np.random.default_rng(3).integers(-1, len(grid), 12)
    for i, j in pairwise(some):
        line = plot.aisles.path(i, j)
        driven_m = float(np.hypot(*np.diff(line, axis=0).T).sum())
        assert driven_m == pytest.approx(float(plot.aisles.distance_m(i, j)), abs=1e-6)
        assert not crosses_rows(grid, line)


# each radius, and each noise where rows bend little and much
@pytest.mark.parametrize(
    ("radius_m", "noise_m"),
    [(1000.0, 0.3), (400.0, 0.0), (200.0, 0.3), (100.0, 0.05), (60.0, 0.3), (60.0, 0.0)],
)
def test_vines_in_bent_rows_are_found_in_their_own(survey, radius_m, noise_m):
    size = 12, 48 if radius_m < 100 else 96
    check(measured(bent(tiled(survey, *size), radius_m, 20.0), noise_m), NOISES[noise_m])


@pytest.mark.parametrize(
    ("turn_deg", "noise_m"),
    [(5.0, 0.3), (5.0, 0.0), (15.0, 0.05), (40.0, 0.0), (90.0, 0.3), (90.0, 0.05)],
)
def test_vines_of_two_blocks_are_found_in_their_own_rows(survey, turn_deg, noise_m):
    blocks = [bent(tiled(survey, 20, 48), None, turn) for turn in (0.0, turn_deg)]
    check(measured(side_by_side(*blocks), noise_m), NOISES[noise_m])


@pytest.mark.parametrize("turn_deg", TURNS)
def test_vines_of_three_blocks_each_turned_from_the_last_are_found(survey, turn_deg):
    blocks = [bent(tiled(survey, 16, 36), None, k * turn_deg) for k in range(3)]
    check(measured(side_by_side(*blocks), 0.05), NOISES[0.05])


@pytest.mark.parametrize("noise_m", NOISES)
def test_vines_of_four_blocks_some_of_them_bent_are_found(survey, noise_m):
    kinds = ((None, 0.0), (150.0, 30.0), (80.0, 100.0), (None, 60.0))
    blocks = [bent(tiled(survey, 12, 36), radius_m, turn_deg) for radius_m, turn_deg in kinds]
    check(measured(side_by_side(*blocks), noise_m), NOISES[noise_m])


@pytest.mark.parametrize("noise_m", NOISES)
def test_straight_vines_of_one_block_stay_straight(survey, noise_m):
    _, plot, _ = found(measured(bent(tiled(survey, 12, 96), None, 20.0), noise_m))
    assert plot.grid.aisles_m is None
    # with 30 cm of noise some stand more than a quarter of 2.5 m beside their row
    assert len(plot.rows.doubts) == (noise_m == 0.3)


@pytest.mark.parametrize(
    ("radius_m", "noise_m"),
    [(1000.0, 0.05), (400.0, 0.0), (200.0, 0.05), (100.0, 0.0), (60.0, 0.05)],
)
def test_distances_along_a_row_are_those_along_its_lane(survey, radius_m, noise_m):
    vines = measured(bent(tiled(survey, 20, 48), radius_m, 20.0), noise_m, missing=0.1)
    vines, plot, plant = found(vines)
    for row in (0, 9, 18):
        mine = np.flatnonzero(vines.row == row)
        ends = mine[[np.argmin(vines.along_m[mine]), np.argmax(vines.along_m[mine])]]
        driven_m = float(plot.aisles.distance_m(*plant[ends]))
        # the lane runs beside the row, on one side or the other: at another radius
        angle = np.ptp(vines.along_m[ends]) / row_radius_m(row, radius_m)
        by_m = angle * (plot.grid.row_spacing_m / 2)
        along_m = np.ptp(vines.along_m[ends])
        off = min(abs(driven_m - along_m - by_m), abs(driven_m - along_m + by_m))
        assert off < 0.01 * along_m


def row_radius_m(row, radius_m):
    """Return the radius of a row: rows are 2.5 m apart, the middle one of 20 is at the radius."""
    return radius_m + (row - 9.5) * 2.5


def test_the_frame_of_the_made_plots_is_that_of_the_survey():
    assert FRAME.lonlat([[0.0, 0.0]])[0] == pytest.approx([-0.5241, 53.2681])
