"""Walks of several: nobody meets in a row, budgets are kept, and nothing exceeds the bound."""

from contextlib import contextmanager
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.planning.routes.exact_walk import best_walk
from fieldmon.studies.routes.drive import driven
from fieldmon.studies.routes.instances import full_budget, zipf
from fieldmon.studies.routes.team_walks import meetings, team_walks
from tests.thorough import seeds


@contextmanager
def few_trials(shakes=8, prices=12):
    """Let searches try little: what holds of any walks holds of those that are not the best."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fieldmon.studies.routes.team_walks._SHAKES", shakes)
        patch.setattr("fieldmon.studies.routes.team_walks._PRICES", prices)
        yield


def walks_of(reward, budget):
    """Return what each walk of two rows and few steps passes, as sets of plants (all of them)."""
    m, n = reward.shape
    found, open_walks = set(), [((0, 0), frozenset(), 0)]
    seen = set(open_walks)
    while open_walks:
        (row, column), passed, steps = open_walks.pop()
        if (row, column) == (0, 0):
            found.add(passed)
        if steps == budget:
            continue
        for down, along in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            to = row + down, column + along
            if not (0 <= to[0] < m and 0 <= to[1] <= n + 1) or (down and 0 < column <= n):
                continue
            plant = {to[0] * n + to[1] - 1} if 0 < to[1] <= n else set()
            one = to, passed | plant, steps + 1
            if one not in seen:
                seen.add(one)
                open_walks.append(one)
    return found


@pytest.mark.parametrize("seed", seeds(2, 6))
def test_no_two_walks_of_all_there_are_exceed_the_bound(seed):
    rng = np.random.default_rng(seed)
    reward = rng.random((2, 3)) ** 2
    budget = int(rng.integers(4, 10))
    passed = walks_of(reward, budget)
    most = max(reward.ravel()[list(a | b)].sum() for a, b in product(passed, passed))
    with few_trials():
        team = team_walks(reward, budget, 2)
    assert team.reward <= most + 1e-9
    assert most <= team.bound + 1e-9


@given(st.integers(1, 8), st.integers(1, 8), st.integers(1, 4), st.integers(0, 2**32))
def test_nobody_meets_and_budgets_are_kept(m, n, n_walks, seed):
    rng = np.random.default_rng(seed)
    reward = rng.random((m, n)) ** 3
    budget = int(rng.integers(0, full_budget(m, n)))
    with few_trials():
        team = team_walks(reward, budget, n_walks)
    assert meetings(team.places, n) == []
    passed = np.zeros((m, n + 2), np.bool_)
    for places in team.places:
        assert driven(places, reward).steps <= budget
        passed[tuple(places.T)] = True
    assert team.reward == pytest.approx(reward[passed[:, 1:-1]].sum())
    assert team.reward <= team.bound * (1 + 1e-9)


def test_one_walk_is_the_exact_one():
    reward = zipf((12, 9), 1.9, 1).reward
    team = team_walks(reward, 60, 1)
    assert team.reward == pytest.approx(best_walk(reward, 60).reward)


def test_two_in_one_row_at_one_step_are_seen_and_one_after_the_other_are_not():
    there = np.array([[0, 0], [0, 1], [0, 2], [0, 1], [0, 0]])
    late = np.concatenate([np.zeros((5, 2), np.int64), there])
    assert meetings([there, there], 4) == [(0, 1, 0)]
    assert meetings([there, late], 4) == []


def test_on_a_published_family_a_team_is_near_its_bound():
    reward = zipf((12, 20), 0.8, 1).reward
    team = team_walks(reward, int(0.1 * full_budget(12, 20)), 3)
    assert team.reward >= 0.97 * team.bound


def test_how_much_of_a_long_search_is_done_is_told_and_changes_nothing():
    reward = np.random.default_rng(1).random((4, 6)) ** 3
    told = []
    with few_trials(shakes=20, prices=20):
        team = team_walks(reward, 18, 2, told.append)
        quiet = team_walks(reward, 18, 2)
    assert told == sorted(told)
    assert 0.0 <= told[0] < 0.1
    assert 0.5 <= told[-1] <= 1.0
    assert len(set(told)) > 20
    assert (team.reward, team.bound) == (quiet.reward, quiet.bound)
