"""Rows of plants that bend, cut where they cannot go on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.plot.bent_pieces import bent_pieces
from fieldmon.plot.planting import Planting
from fieldmon.plot.row_lines import Blocked, row_aisles
from tests.plot.test_row_lines import straight

PLANTING = Planting(row_spacing_m=3.0, plant_spacing_m=2.0, headland_m=2.0)


def pieces_of(blocked, planting=PLANTING):
    """Return pieces of three straight rows of 20 plants, 2 m apart from 1 m on."""
    rows = straight()
    along = np.tile(1.0 + 2.0 * np.arange(20), 3)
    row = np.repeat(np.arange(3), 20)
    plants = np.stack([along, 3.0 * row], axis=1), row
    return bent_pieces(rows, row_aisles(rows, planting), plants, blocked, planting)


@given(st.sets(st.integers(0, 18), max_size=5), st.integers(0, 2))
def test_a_row_has_one_piece_more_than_it_is_blocked_between_plants(gaps, row):
    at_m = 2.0 + 2.0 * np.array(sorted(gaps), float)
    blocked = Blocked(np.full(len(at_m), row), at_m - 0.3, at_m + 0.3)
    made = pieces_of(blocked)
    assert np.bincount(made.row).tolist() == [1 + len(gaps) * (k == row) for k in range(3)]
    assert len(made.xy_m) == made.row_start[-1] == 60
    # no lane goes on over what blocks its row
    aisle_begins_m = made.xy_m[0, 0] - made.place_m[0, 1]
    low, high = made.lane_m[made.row == row, 1].T + aisle_begins_m
    for stop in at_m:
        assert not ((low < stop - 0.3 - 1e-6) & (high > stop + 0.3 + 1e-6)).any()


def test_lanes_end_half_a_headland_beyond_the_outer_plants():
    made = pieces_of(Blocked.nowhere())
    ends = made.place_m[[0, 19]]
    assert made.lane_m[0, :, 0] == pytest.approx(ends[0] - 1.0)
    assert made.lane_m[0, :, 1] == pytest.approx(ends[1] + 1.0)


def test_plants_stand_half_a_row_off_the_middle_of_either_aisle():
    assert pieces_of(Blocked.nowhere()).off_m == pytest.approx(np.full((60, 2), 1.5))
