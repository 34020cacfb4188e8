"""Walks in W form."""

import numpy as np

from fieldmon.plot.layout import rectangle
from fieldmon.studies.verdicts.walks import random_walk, w_walk

GRID = rectangle(40, 40)


def test_a_w_goes_down_up_down_up_across_the_whole_plot():
    walk = w_walk(GRID, 40, 40)
    x, y = ((GRID.xy_m - GRID.xy_m.min(axis=0)) / np.ptp(GRID.xy_m, axis=0))[walk].T
    assert (np.diff(x) >= -1e-9).all()
    legs = [y[(x >= low) & (x < low + 0.25)] for low in (0.0, 0.25, 0.5, 0.75)]
    assert [np.sign(leg[-1] - leg[0]) for leg in legs] == [-1, 1, -1, 1]
    assert (x.min(), x.max()) < (0.05, 1.0)
    assert x.max() > 0.95


def test_further_ws_take_other_plants():
    walk = w_walk(GRID, 40, 150)
    assert len(set(walk.tolist())) == len(walk) == 150
    assert len(set(random_walk(1600, 50, np.random.default_rng(1)).tolist())) == 50
