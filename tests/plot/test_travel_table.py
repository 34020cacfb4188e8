"""What compiled loops are handed of a plot is a map: the same there as back, no detour shorter."""

import numpy as np
from hypothesis import given

from fieldmon.plot.travel import Aisles
from tests.crooked import crooked_grids


@given(crooked_grids(max_radius_m=25.0))
def test_ways_between_lane_ends_are_as_long_back_and_no_detour_is_shorter(grid):
    between_m = Aisles.of(grid).travel.between_m
    np.testing.assert_allclose(between_m, between_m.T, atol=1e-6)
    detours_m = between_m[:, :, None] + between_m[None]
    assert (between_m <= detours_m.min(axis=1) + 1e-6).all()


@given(crooked_grids(max_radius_m=25.0))
def test_every_plant_is_on_its_lane(grid):
    travel = Aisles.of(grid).travel
    assert (np.repeat(np.arange(len(travel.side)), np.diff(travel.row_start)) == travel.row).all()
    low_m, high_m = travel.end_x_m[travel.row].T
    assert ((low_m <= travel.x_m) & (travel.x_m <= high_m)).all()
    assert repr(travel).startswith(f"<TravelTable: {len(grid):,} plant")
