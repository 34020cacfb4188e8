"""Exact walks on a ladder: against every walk there is, against another formulation, and driven."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.routes.exact_walk import _WalkSearch, best_walk, full_budget
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


def every_state(reward, budget):
    """Return the most reward at each half of a budget: the five states, and nothing left out."""
    n = reward.shape[1]
    never, half, n_through = -np.inf, budget // 2, n + 1
    left, right, round_, joined, apart = range(5)
    states, most = np.full((5, half + 1), never), np.full(half + 1, never)
    states[left, 0] = 0.0
    for row in reward:
        ways = []
        for a in range(n + 1):
            for c in range(n + 1 - a):
                held = row[:a].sum() + row[n - c :].sum()
                ways += [(s, s, a + c, held) for s in (round_, joined, apart)]
                ways += [(left, apart, a + c, held)] if c else [(left, left, a, held)]
                ways += [(right, apart, a + c, held)] if a else [(right, right, c, held)]
        held = row.sum()
        ways += [(s, round_, 0, held) for s in (left, right, joined, apart)]
        ways += [(s, joined, n_through, held) for s in (left, right, round_, apart)]
        done = np.full((5, half + 1), never)
        for before, after, steps, held in ways:
            if steps <= half:
                moved = states[before, : half + 1 - steps] + held
                done[after, steps:] = np.maximum(done[after, steps:], moved)
        most = np.maximum(most, done[[left, right, joined]].max(axis=0))
        states = np.full((5, half + 1), never)
        for before, after, steps in (
            (left, left, 1), (joined, left, 1), (right, right, 1), (joined, right, 1),
            (round_, round_, 1), (joined, joined, 2), (apart, apart, 2),
        ):  # fmt: skip
            if steps <= half:
                moved = done[before, : half + 1 - steps]
                states[after, steps:] = np.maximum(states[after, steps:], moved)
    return np.maximum.accumulate(most)


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


@pytest.mark.parametrize("seed", range(3))
def test_a_mixed_integer_program_proves_the_same(seed):
    rng = np.random.default_rng(100 + seed)
    reward = np.floor(rng.random((3 + seed % 3, 6)) ** 3 * 30)
    budget = int(rng.integers(10, full_budget(*reward.shape)))
    found = milp.solve(reward, budget, 100.0)
    assert found.proved
    assert best_walk(reward, budget).reward == pytest.approx(found.reward)


@pytest.mark.parametrize("seed", range(4))
def test_what_the_bound_leaves_out_holds_no_more_and_no_heuristic_is_better(seed):
    rng = np.random.default_rng(seed)
    reward = rng.zipf(1.9, (int(rng.integers(2, 16)), int(rng.integers(2, 16)))).astype(float)
    full = full_budget(*reward.shape)
    most = every_state(reward, full)
    for budget in np.linspace(1, full, 7).astype(int):
        walk = best_walk(reward, int(budget))
        drive_and_check(reward, budget, walk)
        assert walk.reward == most[budget // 2]
        for name, heuristic in HEURISTICS.items():
            other = driven(heuristic(reward, int(budget)), reward)
            assert other.steps <= budget, name
            assert other.reward <= walk.reward + 1e-9, name


@pytest.mark.parametrize("shape", [(30, 3), (3, 30), (18, 15)])
def test_on_even_patchy_and_equal_rewards_nothing_is_lost_at_any_tenth(shape):
    rng = np.random.default_rng(shape)
    full = full_budget(*shape)
    for reward in (rng.random(shape), rng.random(shape) ** 8, np.ones(shape)):
        most = every_state(reward, full)
        for tenth in range(1, 11):
            budget = full * tenth // 10
            assert best_walk(reward, budget).reward == pytest.approx(most[budget // 2], rel=1e-12)


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


def test_of_a_row_only_its_far_ends_are_walked_where_only_they_are_worth_it():
    """Round the two rows beyond: 26 steps; the near end is 2 more, the far one 4."""
    reward = np.ones((3, 10))
    reward[0] = [3.0, *[0.0] * 8, 5.0]
    for budget, held in ((26, 20.0), (28, 23.0), (30, 25.0), (32, 28.0)):
        walk = best_walk(reward, budget)
        drive_and_check(reward, budget, walk)
        assert walk.reward == held
        assert not ((walk.place[:, 0] == 0) & (np.abs(walk.place[:, 1] - 5.5) < 4)).any()


@pytest.mark.parametrize("reward", [np.ones(3), -np.ones((2, 2)), np.ones((0, 3))])
def test_what_is_no_matrix_of_rewards_is_refused(reward):
    with pytest.raises(SettingError, match="matrix of numbers"):
        best_walk(reward, 10)


def hull(most, half):
    """Return what lies above every walk at so many half steps: of all pairs, the highest line."""
    held = [(float(most[half]), half, half)]
    for a in range(half + 1):
        held += [(most[a] + (most[b] - most[a]) * (half - a) / (b - a), a, b)
                 for b in range(half + 1, len(most))]  # fmt: skip
    return max(held)


@pytest.mark.parametrize("seed", range(6))
def test_the_least_bound_of_all_prices_is_the_line_over_two_walks(seed):
    rng = np.random.default_rng(seed)
    reward = rng.random((1 + seed % 4, int(rng.integers(2, 6)))) ** (1 + seed % 3)
    most = every_state(reward, full_budget(*reward.shape))
    search, n = _WalkSearch(reward), len(most) - 1
    for half in range(1, n + 1):
        price, bound, known, of_use = search._price(half)
        above, a, _ = hull(most, half)
        assert bound == pytest.approx(above, abs=1e-8)
        # no walk of any length is above the line of that price
        assert (most - price * (np.arange(n + 1) - half) <= bound + 1e-8).all()
        assert known <= most[half] + 1e-12
        assert known == pytest.approx(most[min(a, half)], abs=1e-8) or bound - known < 1e-8
        # beyond the fewest steps that hold all, none is of use
        assert of_use == min(half, int(np.argmax(most >= most[-1] - 1e-12)))


@pytest.mark.parametrize("budget", [0, 1, 2, 3, 7, 12])
def test_a_walk_holds_as_much_when_rewards_are_scaled_and_rows_beyond_hold_nothing(budget):
    reward = np.random.default_rng(budget).random((3, 4))
    held = best_walk(reward, budget).reward
    assert best_walk(1e6 * reward, budget).reward == pytest.approx(1e6 * held)
    assert best_walk(1e-9 * reward, budget).reward == pytest.approx(1e-9 * held, rel=1e-9)
    assert best_walk(np.vstack([reward, np.zeros((2, 4))]), budget).reward == pytest.approx(held)
    assert best_walk(reward, budget + 1).reward >= held - 1e-12


@pytest.mark.parametrize(("rows", "plants"), [(1, 1), (1, 5), (2, 3), (3, 3), (4, 2), (5, 4)])
def test_so_many_steps_as_suffice_for_all_are_the_fewest(rows, plants):
    most = every_state(np.ones((rows, plants)), 4 * rows * (plants + 2))
    assert full_budget(rows, plants) // 2 == int(np.argmax(most == rows * plants))
    assert full_budget(rows, plants) % 2 == 0


def test_no_steps_and_nothing_to_find_are_a_walk_that_stays():
    for reward, budget in ((np.zeros((2, 3)), 20), (np.ones((2, 3)), 0), (np.ones((2, 3)), 1)):
        walk = best_walk(reward, budget)
        assert (walk.steps, walk.reward) == (0, 0.0)
        assert set(map(tuple, walk.place.tolist())) == {(0, 0)}
