"""Plants traced into rows: bent, in blocks, with gaps, and by their names."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.plot.row_tracing import trace
from tests.bent import right_share, turned


def arcs(n_rows, n_plants, spacings, radius_m):
    """Return plants ``(n, 2)`` on concentric rows, and the row of each."""
    row_spacing_m, plant_spacing_m = spacings
    k, j = np.divmod(np.arange(n_rows * n_plants), n_plants)
    at = radius_m + k * row_spacing_m
    turn = (j - n_plants / 2) * plant_spacing_m / at
    return np.stack([at * np.sin(turn), at * np.cos(turn) - radius_m], axis=1), k


def row_of(traced):
    row = np.empty(len(traced.plant), int)
    row[traced.plant] = np.repeat(np.arange(len(traced.block)), np.diff(traced.row_start))
    return row


@given(
    size=st.tuples(st.integers(5, 15), st.integers(15, 40)),
    row_spacing_m=st.floats(2.0, 5.0),
    # nearly square ones, bent, fit another direction as well, and that is said: docs/rows
    closer=st.floats(0.25, 0.55),
    bend=st.floats(0.02, 0.9),
    turn_deg=st.floats(0.0, 180.0),
    seed=st.integers(0, 2**32),
)
def test_bent_rows_are_traced_whatever_their_spacings_and_bend(
    size, row_spacing_m, closer, bend, turn_deg, seed
):
    spacings = row_spacing_m, row_spacing_m * closer
    # rows turn by at most 50 degrees, and no tighter than 15 row spacings
    radius_m = max(size[1] * spacings[1] / bend, 15 * row_spacing_m)
    xy_m, row = arcs(*size, spacings, radius_m)
    rng = np.random.default_rng(seed)
    kept = rng.permutation(np.flatnonzero(rng.random(len(row)) > 0.1))
    xy_m = turned(xy_m[kept], turn_deg) + rng.normal(0.0, 0.05 * spacings[1], (len(kept), 2))
    traced = trace(xy_m)
    wrong = (1.0 - right_share(row_of(traced), row[kept])) * len(kept)
    assert round(wrong) <= max(1, 0.01 * len(kept))
    assert traced.row_spacing_m == pytest.approx(row_spacing_m, rel=0.05)
    assert traced.plant_spacing_m == pytest.approx(spacings[1], rel=0.05)


def test_plants_come_row_by_row_and_along_each_and_rows_from_right_to_left():
    xy_m, row = arcs(6, 30, (2.5, 1.4), 60.0)
    order = np.random.default_rng(1).permutation(len(row))
    traced = trace(xy_m[order])
    assert sorted(traced.plant) == list(range(180))
    assert traced.block.tolist() == [0] * 6
    assert row[order][traced.plant].tolist() == np.repeat(np.arange(6), 30).tolist()
    steps = np.diff(xy_m[order][traced.plant][:30], axis=0)
    assert np.hypot(*steps.T) == pytest.approx(np.full(29, 1.4), abs=0.01)
    assert traced.off_m.max() < 0.01


def test_a_gap_in_the_middle_of_a_block_parts_no_row():
    xy_m, row = arcs(8, 40, (2.5, 1.4), 70.0)
    hole = (np.abs(xy_m[:, 0] - 3.0) < 6.0) & (np.abs(row - 3.5) < 2)
    traced = trace(xy_m[~hole])
    assert traced.block.max() == 0
    assert right_share(row_of(traced), row[~hole]) == 1.0


def test_a_headland_between_rows_that_go_on_behind_it_parts_blocks():
    east, row = arcs(8, 20, (2.5, 1.4), 300.0)
    west = turned(east, 8.0) - np.array([40.0, 0.0])
    traced = trace(np.concatenate([east, west]))
    assert len(traced.block) == 16
    assert traced.block.max() == 1
    assert right_share(row_of(traced), np.concatenate([row, row + 8])) == 1.0


def test_names_decide_where_a_row_is_even_against_what_is_seen():
    xy_m, row = arcs(5, 20, (2.5, 1.4), 60.0)
    # the far half of two rows is named the other way round
    named = row.copy()
    far = xy_m[:, 0] > 0
    named[far & (row == 1)], named[far & (row == 2)] = 2, 1
    traced = trace(xy_m, named)
    assert right_share(row_of(traced), named) == 1.0


def test_two_plants_are_too_few_to_tell():
    assert trace(np.array([[0.0, 0.0], [1.0, 0.0]])) is None


def two_exact_blocks(n_rows, n_plants, row_m, plant_m, gap_m):
    """Return plants of a block of rows along x and one along y, and the row of each."""
    x, y = np.meshgrid(plant_m * np.arange(n_plants), row_m * np.arange(n_rows))
    one, row = np.stack([x.ravel(), y.ravel()], axis=1), np.repeat(np.arange(n_rows), n_plants)
    other = one[:, ::-1] + (x.max() + gap_m, 0.0)
    return np.concatenate([one, other]), np.concatenate([row, n_rows + row])


@pytest.mark.parametrize(
    ("row_m", "plant_m", "gap_m"), [(2.0, 0.8, 3.0), (2.5, 1.0, 2.5), (2.5, 1.0, 8.0)]
)
def test_rows_that_end_at_a_block_turned_across_keep_their_ends(row_m, plant_m, gap_m):
    xy_m, row = two_exact_blocks(26, 30, row_m, plant_m, gap_m)
    found = trace(xy_m)
    named = row[found.plant]
    assert len(found.row_start) == 53
    parts = np.split(named, found.row_start[1:-1])
    assert all(len(part) == 30 and len(set(part.tolist())) == 1 for part in parts)
    assert len(set(found.block.tolist())) == 2
