"""Rows that bend as obstacles, and the ways that bend along aisles."""

import numpy as np
import pytest
import shapely
from hypothesis import given

from fieldmon.plot.bent_ways import off_steps, row_end_places, row_steps
from fieldmon.plot.road_network import find_roads
from tests.bent import bent_grids


@given(bent_grids())
def test_a_way_is_off_the_rows_just_as_it_is_away_from_them(grid):
    clearance_m = 0.3
    steps = row_steps(grid, clearance_m)
    rng = np.random.default_rng(len(grid))
    low, size = grid.xy_m.min(axis=0) - 5, np.ptp(grid.xy_m, axis=0) + 10
    from_m = low + rng.random((200, 2)) * size
    to_m = from_m + rng.normal(0, 6, (200, 2))
    off = np.ones(200, np.bool_)
    off_steps(steps, clearance_m, from_m, to_m, off)
    pairs = steps[1].reshape(-1, 2, 2)
    same = (pairs[:, 0] == pairs[:, 1]).all(axis=1)
    rows = shapely.union_all([*shapely.linestrings(pairs[~same]), *shapely.points(pairs[same, 0])])
    away_m = shapely.distance(rows, shapely.linestrings(np.stack([from_m, to_m], axis=1)))
    sure = np.abs(away_m - clearance_m) > 0.03
    assert off[sure].tolist() == (away_m > clearance_m)[sure].tolist()


@given(bent_grids())
def test_ways_are_as_long_as_their_corners_say(grid):
    roads = find_roads(grid)
    for node in range(len(roads.xy_m)):
        for e in range(roads.start[node], roads.start[node + 1]):
            via = roads.via_m[roads.via_start[e] : roads.via_start[e + 1]]
            line = np.concatenate([roads.xy_m[[node]], via, roads.xy_m[[roads.to[e]]]])
            length_m = np.hypot(*np.diff(line, axis=0).T).sum()
            assert roads.length_m[e] == pytest.approx(length_m, abs=1e-6)


@given(bent_grids(faces=(1,)))
def test_at_a_row_end_the_aisles_lie_on_either_side(grid):
    places, _ = row_end_places(grid)
    right, on_line, left = (places[:, :, k] for k in range(3))
    across = left - right
    ahead = np.stack([across[:, :, 1], -across[:, :, 0]], axis=2)
    # going along the row its own aisle is to the left
    way = on_line[:, 1] - on_line[:, 0]
    assert (np.einsum("ij,ikj->ik", way, ahead) > 0).all()
