"""Published heuristics as their descriptions read, on plots small enough to see."""

import numpy as np
import pytest

from fieldmon.studies.routes.drive import driven
from fieldmon.studies.routes.heuristics import (
    HEURISTICS,
    greedy_full_row,
    greedy_partial_row,
    greedy_row,
    heuristic_partial_row,
    optimal_full_row,
)


def rows_of(walk):
    """Return the rows that are driven into, in the order of the walk."""
    inside = walk[(walk[:, 1] == 1) | (walk[:, 1] == walk[:, 1].max() - 1), 0]
    return list(dict.fromkeys(inside.tolist()))


def test_greedy_row_takes_the_row_with_the_most_first_and_full_row_the_most_per_step():
    reward = np.zeros((12, 3))
    reward[0], reward[11] = 2.0, 3.0
    assert rows_of(greedy_row(reward, 1000)) == [11, 0]
    assert rows_of(greedy_full_row(reward, 1000))[0] == 0


def test_a_row_that_does_not_fit_is_left_out_and_the_next_one_tried():
    reward = np.zeros((12, 3))
    reward[0], reward[11] = 2.0, 3.0
    # row 0 there and back takes 8 steps, row 11 30
    assert rows_of(greedy_row(reward, 12)) == [0]
    assert driven(greedy_row(reward, 12), reward).reward == 6.0
    assert driven(greedy_row(reward, 7), reward).reward == 0.0


def test_greedy_partial_row_walks_into_a_row_for_its_first_plants_alone():
    reward = np.zeros((3, 40))
    reward[1, 0] = 5.0
    walk = driven(greedy_partial_row(reward, 10), reward)
    assert (walk.steps, walk.reward) == (4, 5.0)
    assert driven(optimal_full_row(reward, 10), reward).reward == 0.0


@pytest.mark.parametrize("seed", range(10))
def test_parts_of_rows_never_do_worse_than_whole_rows_alone(seed):
    rng = np.random.default_rng(seed)
    reward = rng.random((7, 6)) ** 3
    for budget in range(0, 130, 11):
        parts, whole = (driven(walk(reward, budget), reward).reward
                        for walk in (heuristic_partial_row, optimal_full_row))  # fmt: skip
        assert parts >= whole - 1e-12


@pytest.mark.parametrize("name", HEURISTICS)
def test_rewards_counted_in_another_unit_change_no_walk(name):
    reward = np.random.default_rng(5).integers(0, 50, (6, 5)).astype(float)
    for budget in (10, 25, 50):
        one, other = (HEURISTICS[name](scale * reward, budget) for scale in (1.0, 8.0))
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("name", HEURISTICS)
@pytest.mark.parametrize("budget", [0, 1])
def test_with_no_steps_one_stays_at_home(name, budget):
    walk = HEURISTICS[name](np.ones((4, 3)), budget)
    assert driven(walk, np.ones((4, 3))) == (0, 0.0)
