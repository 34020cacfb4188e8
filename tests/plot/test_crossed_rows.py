"""Blocks at a right angle in one plot are found, or it is said where they may be mixed."""

import numpy as np
import pytest

from fieldmon.plot.crossed_rows import crossed_rows
from fieldmon.plot.grid import nearest_plants
from fieldmon.plot.plot import plot_around
from fieldmon.plot.projection import Frame
from tests.bent import right_share

FRAME = Frame(8.0, 47.0)


def rows_along(n_rows, n_plants, row_m, plant_m):
    """Return the plants of exact rows along x, row by row, and the row of each."""
    x, y = np.meshgrid(plant_m * np.arange(n_plants), row_m * np.arange(n_rows))
    return np.stack([x.ravel(), y.ravel()], axis=1), np.repeat(np.arange(n_rows), n_plants)


def with_rows_across(n_across, gap_m, *block):
    """Return a block with some rows across its ends on one side, as long as it is wide."""
    xy_m, row = rows_along(*block)
    n_long = int(xy_m[:, 1].max() / block[3]) + 1
    other, own = rows_along(n_across, n_long, *block[2:])
    beside = other[:, ::-1] + (xy_m[:, 0].max() + gap_m, 0.0)
    return np.concatenate([xy_m, beside]), np.concatenate([row, block[0] + own])


def around(xy_m):
    return plot_around("a", FRAME.lonlat(xy_m - xy_m.mean(axis=0)))


def line_of(plot, xy_m):
    lonlat = FRAME.lonlat(xy_m - xy_m.mean(axis=0))
    return plot.grid.row_line[plot.grid.row[nearest_plants(plot.grid, lonlat, 0.05)[0]]]


@pytest.mark.parametrize(("n_across", "gap_m", "block"), [
    (20, 0.8, (20, 20, 2.0, 0.8)),
    (3, 2.2, (8, 40, 2.2, 1.1)), (3, 2.86, (20, 20, 2.2, 1.1)), (1, 3.25, (26, 30, 2.5, 1.0)),
    (20, 1.0, (20, 20, 2.5, 1.0)),
])  # fmt: skip
def test_rows_at_a_right_angle_are_found_or_doubted(n_across, gap_m, block):
    xy_m, row = with_rows_across(n_across, gap_m, *block)
    plot = around(xy_m)
    assert plot.doubts or right_share(line_of(plot, xy_m), row) == 1.0


def test_exact_rows_are_found_though_they_are_in_line_across_too():
    xy_m, row = with_rows_across(8, 8.0, 8, 20, 3.0, 2.0)
    plot = around(xy_m)
    assert right_share(line_of(plot, xy_m), row) == 1.0
    assert plot.grid.n_blocks == 2


def test_an_outline_that_touches_itself_in_degrees_is_no_refusal():
    one, _ = rows_along(8, 13, 4.0, 0.8)
    xy_m = np.concatenate([one, one[:, ::-1] + (one[:, 0].max() + 5.2, 0.0)])
    plot = around(xy_m)
    assert plot.field.boundary.is_valid
    assert right_share(line_of(plot, xy_m), np.repeat(np.arange(16), 13)) == 1.0
    assert plot.doubts == ()


def test_plants_that_a_row_across_took_are_counted_with_the_rows():
    one, other = rows_along(1, 10, 1.0, 1.0)[0], rows_along(1, 9, 1.0, 1.0)[0][:, ::-1]
    other = other + np.array([10.0, -4.0])
    right = np.concatenate([one, other])
    assert crossed_rows(right, np.repeat([0, 1], [10, 9])).doubts == ()
    taken = np.concatenate([one, other[4:5], other[:4], other[5:]])
    found = crossed_rows(taken, np.repeat([0, 1], [11, 8]))
    assert (found.n_plants, found.pairs, found.turned) == (1, ((1, 0),), ())
    (doubt,) = found.doubts
    assert doubt == (
        "1 plant stands in line with a row that runs across its own, at rows 2 and 1: blocks may "
        "be mixed there. Look at these rows, and give blocks or name each plant's row if they are "
        "wrong."
    )


def test_a_row_across_that_lost_every_other_plant_is_counted_with_the_rows_that_took_them():
    xy_m, row = with_rows_across(1, 2.0, 10, 12, 2.0, 1.0)
    across = np.flatnonzero(row == 10)
    assert crossed_rows(xy_m, row).doubts == ()
    taken = row.copy()
    taken[across[::2]] = np.arange(10)
    order = np.lexsort((xy_m[:, 0], xy_m[:, 1] * (taken == 10), taken))
    assert crossed_rows(xy_m[order], taken[order]).n_plants == 10


def test_a_row_that_goes_on_round_a_corner_is_named():
    one, other = rows_along(1, 10, 1.0, 1.0)[0], rows_along(1, 9, 1.0, 1.0)[0][:, ::-1]
    found = crossed_rows(np.concatenate([one, other + np.array([10.0, 1.0])]), np.zeros(19, int))
    assert found.turned == (0,)
    assert found.doubts[-1].startswith("1 row turns sharply: 1. A row and one across its end may")
    angle = np.arange(40) / 10.0  # a metre apart on a circle of 10 m
    circle = 10.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    assert crossed_rows(circle, np.zeros(40, int)).doubts == ()


@pytest.mark.parametrize("noise_m", [0.0, 0.2])
def test_rows_that_miss_plants_or_end_level_with_each_other_are_not_crossed(noise_m):
    rng = np.random.default_rng(2)
    xy_m, row = rows_along(12, 30, 3.0, 1.0)
    kept = rng.random(len(row)) > 0.2
    moved = xy_m + rng.normal(0.0, noise_m, xy_m.shape)
    assert crossed_rows(moved[kept], row[kept]).doubts == ()
    assert crossed_rows(xy_m[:2], row[:2]).doubts == ()
    parts = 2 * row + (xy_m[:, 0] > 15)
    assert crossed_rows(xy_m, parts).doubts == ()
