"""Exact walks on a ladder: against every walk there is, against another formulation, and driven."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.routes.ladder import best_walk, full_budget, sweep
from fieldmon.studies.routes import milp
from fieldmon.studies.routes.drive import driven
from fieldmon.studies.routes.heuristics import HEURISTICS


def every_walk(reward, budget):
    """Return the most reward of any closed walk, by searching all places and plants passed."""
    m, n = reward.shape
    here, seen, best = {((0, 0), 0)}, {((0, 0), 0)}, 0.0
    for _ in range(budget + 1):
        for place, passed in here:
            if place == (0, 0):
                held = [reward.flat[k] for k in range(m * n) if passed >> k & 1]
                best = max(best, float(sum(held)))
        onward = set()
        for (row, column), passed in here:
            beside = [(row, column - 1), (row, column + 1)]
            if column in {0, n + 1}:
                beside += [(row - 1, column), (row + 1, column)]
            for r, c in beside:
                if not (0 <= r < m and 0 <= c <= n + 1):
                    continue
                after = passed | (1 << (r * n + c - 1) if 0 < c <= n else 0)
                if ((r, c), after) not in seen:
                    seen.add(((r, c), after))
                    onward.add(((r, c), after))
        here = onward
    return best


def small(rng, most_rows, most_plants):
    m, n = rng.integers(1, most_rows + 1), rng.integers(1, most_plants + 1)
    reward = rng.integers(0, 20, (m, n)) * (rng.random((m, n)) < rng.uniform(0.2, 1.0))
    return reward.astype(float), int(rng.integers(0, full_budget(m, n) + 4))


def drive_and_check(reward, budget, walk):
    checked = driven(walk.place, reward)
    assert checked.steps == walk.steps <= budget
    assert checked.reward == pytest.approx(walk.reward)


@pytest.mark.parametrize("seed", range(8))
def test_no_walk_of_all_there_are_holds_more(seed):
    rng = np.random.default_rng(seed)
    for _ in range(50):
        reward, budget = small(rng, 4, 3)
        walk = best_walk(reward, budget)
        drive_and_check(reward, budget, walk)
        assert walk.reward == pytest.approx(every_walk(reward, budget))


@pytest.mark.parametrize("seed", range(5))
def test_a_mixed_integer_program_proves_the_same(seed):
    rng = np.random.default_rng(100 + seed)
    reward = np.floor(rng.random((4 + seed % 3, 7)) ** 3 * 30)
    budget = int(rng.integers(10, full_budget(*reward.shape)))
    found = milp.solve(reward, budget, 100.0)
    assert found.proved
    assert best_walk(reward, budget).reward == pytest.approx(found.reward)


@pytest.mark.parametrize("seed", range(4))
def test_no_heuristic_is_better_and_one_sweep_serves_all_budgets(seed):
    rng = np.random.default_rng(seed)
    reward = rng.zipf(1.9, (int(rng.integers(2, 30)), int(rng.integers(2, 30)))).astype(float)
    full = full_budget(*reward.shape)
    swept = sweep(reward, full)
    for budget in np.linspace(1, full, 7).astype(int):
        walk = swept.walk(int(budget))
        drive_and_check(reward, budget, walk)
        assert walk.reward == swept.most(int(budget)) == best_walk(reward, int(budget)).reward
        for name, heuristic in HEURISTICS.items():
            other = driven(heuristic(reward, int(budget)), reward)
            assert other.steps <= budget, name
            assert other.reward <= walk.reward + 1e-9, name


@pytest.mark.parametrize("shape", [(1, 1), (1, 4), (4, 1), (4, 5), (5, 4), (2, 7)])
def test_with_the_full_budget_every_plant_is_passed_and_with_two_steps_less_not(shape):
    reward = np.ones(shape)
    full = full_budget(*shape)
    assert best_walk(reward, full).reward == reward.size
    assert best_walk(reward, full - 2).reward < reward.size or 1 in shape


def test_rewards_that_are_no_whole_numbers_are_traced_back():
    reward = np.random.default_rng(2).random((9, 11))
    for budget in range(0, full_budget(9, 11), 7):
        drive_and_check(reward, budget, best_walk(reward, budget))


@pytest.mark.parametrize("reward", [np.ones(3), -np.ones((2, 2)), np.ones((0, 3))])
def test_what_is_no_matrix_of_rewards_is_refused(reward):
    with pytest.raises(SettingError, match="matrix of numbers"):
        sweep(reward, 10)
