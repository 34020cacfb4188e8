"""Plants in rows that bend and blocks that turn: lanes, neighbours, ways."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldmon.plot.travel import Aisles, crosses_rows
from tests.bent import bent_grids

FEW = settings(max_examples=40)


def length_m(line):
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


@FEW
@given(bent_grids(), st.integers(0, 1000))
def test_paths_are_as_long_as_said_and_cross_no_row(grid, seed):
    aisles = Aisles.of(grid)
    stops = np.concatenate([aisles.stop_m, [aisles.gate_m]])
    plants = np.random.default_rng(seed).integers(-1, len(grid), 15)
    for i, j in pairwise(plants):
        line = aisles.path(i, j)
        assert len(line) >= 2
        assert line[[0, -1]] == pytest.approx(stops[[i, j]])
        assert length_m(line) == pytest.approx(aisles.distance_m(i, j), abs=1e-6)
        assert not crosses_rows(grid, line)
