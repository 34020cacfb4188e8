"""What each row yields is the most that so deep a drive can hold, and is traced back to it."""

from itertools import product

import numpy as np
import pytest

from fieldmon.planning.routes.walk_sweep import (
    CLOSING,
    FROM_BOTH,
    FROM_LEFT,
    FROM_RIGHT,
    NEVER,
    ONCE,
    SOME_LEFT,
    SOME_RIGHT,
    TABLES,
    depths,
    fill_tables,
)

REWARD = np.random.default_rng(7).integers(0, 9, (3, 6)).astype(float)
N = REWARD.shape[1]


@pytest.fixture(scope="module")
def tables():
    made = np.full((len(REWARD), TABLES, N + 2), NEVER)
    fill_tables(REWARD, made)
    return made


def held(row, left, right):
    """Return what plants so deep from the left and from the right hold, each counted once."""
    passed = np.arange(N)
    return REWARD[row, (passed < left) | (passed >= N - right)].sum()


@pytest.mark.parametrize(("row", "deep"), list(product(range(3), range(N + 1))))
def test_no_other_way_in_and_out_holds_more(tables, row, deep):
    ways = [(deep - right, right) for right in range(deep + 1)]
    assert tables[row, FROM_LEFT, deep] == held(row, deep, 0)
    assert tables[row, FROM_RIGHT, deep] == held(row, 0, deep)
    assert tables[row, FROM_BOTH, deep] == max(held(row, *way) for way in ways)
    if deep:
        assert tables[row, SOME_RIGHT, deep] == max(held(row, *way) for way in ways if way[1])
        assert tables[row, SOME_LEFT, deep] == max(held(row, *way) for way in ways if way[0])


def test_a_row_driven_through_holds_all_its_plants(tables):
    assert tables[:, ONCE, 0].tolist() == tables[:, CLOSING, N + 1].tolist() == (
        REWARD.sum(axis=1).tolist()
    )  # fmt: skip


@pytest.mark.parametrize("table", [FROM_LEFT, FROM_RIGHT, FROM_BOTH, SOME_RIGHT, SOME_LEFT])
def test_what_a_row_yields_is_traced_back_to_how_deep_it_was_driven(tables, table):
    for row, deep in product(range(3), range(1, N + 1)):
        left, right = depths(tables[row], table, deep)
        assert left + right == deep
        assert held(row, left, right) == tables[row, table, deep]
        assert right > 0 or table != SOME_RIGHT
        assert left > 0 or table != SOME_LEFT
