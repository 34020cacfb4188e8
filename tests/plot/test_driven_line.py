"""The line driven from place to place, leg by leg."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.plot.driven_line import _plain
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import Aisles
from tests.bent import bent_grids
from tests.crossing import crosses_rows


@given(bent_grids(), st.integers(0, 2**32))
def test_legs_end_at_their_stops_and_are_as_long_as_charged(grid, seed):
    aisles = Aisles.of(grid)
    places = np.random.default_rng(seed).integers(-1, len(grid), 12)
    line, leg_end = aisles.line(places)
    step = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
    ends = np.append(0, leg_end)
    assert np.diff(step[ends]) == pytest.approx(
        aisles.distance_m(places[:-1], places[1:]), abs=1e-6
    )
    at = np.where(places[:, None] < 0, aisles.gate_m, aisles.stop_m[places])
    assert line[ends] == pytest.approx(at, abs=1e-9)
    assert not crosses_rows(grid, line)
    for leg in range(3):
        alone = aisles.path(*places[leg : leg + 2].tolist())
        assert alone == pytest.approx(line[ends[leg] : ends[leg + 1] + 1], abs=1e-9)


def test_a_line_along_a_straight_aisle_has_no_corners():
    aisles = Aisles.of(rectangle(4, 20))
    line, leg_end = aisles.line(np.array([0, 7, 3, 19]))
    assert leg_end.tolist() == [1, 2, 3]
    assert line.tolist() == aisles.stop_m[[0, 7, 3, 19]].tolist()


def test_points_passed_straight_on_are_left_out_and_turns_back_are_kept():
    line = np.array([[9.0, 9], [0, 0], [1, 0], [2, 0], [2, 0], [1, 0], [1, 3]])
    size = _plain(line, 1, 7)
    assert line[1:size].tolist() == [[0, 0], [2, 0], [1, 0], [1, 3]]
