"""Over a gap of many plants a row bends on, where both its sides lead to each other."""

import numpy as np
import pytest

from fieldmon.plot.row_curves import _curve, row_lines_of
from fieldmon.plot.row_tracing import trace
from tests.plot.test_row_tracing import arcs


@pytest.mark.parametrize("noise_m", [0.0, 0.05])
def test_over_a_gap_of_many_plants_a_row_bends_on(noise_m):
    xy_m, row = arcs(6, 40, (2.5, 1.4), 60.0)
    number = np.arange(len(row)) % 40
    there = (row != 2) | (number < 10) | (number > 29)
    moved = xy_m[there] + np.random.default_rng(3).normal(0, noise_m, (there.sum(), 2))
    lines = row_lines_of(trace(moved))
    assert len(lines) == 6
    away_m = np.hypot(*(lines.xy_m + np.array([0.0, 60.0])).T)
    radius_m = 60.0 + 2.5 * np.repeat(np.arange(6), np.diff(lines.start))
    # rows are numbered from the right of their direction, here from without or from within
    off_m = min(np.abs(away_m - r).max() for r in (radius_m, 132.5 - radius_m))
    assert off_m < (0.15 if noise_m == 0.0 else 0.5)


def test_over_a_gap_between_lines_that_do_not_lead_to_each_other_a_row_is_straight():
    x = np.arange(10.0)
    one, other = np.stack([x, 0 * x], axis=1), np.stack([0 * x + 20.0, x], axis=1)
    assert len(_curve(one, other[::-1], 5)) == 0
    assert len(_curve(one, one + np.array([20.0, 0.0]), 5)) == 5
