"""The mixed-integer program proves what it finds."""

import numpy as np
import pytest

from fieldmon.studies.routes.milp import solve


def best_of_all_walks(reward, budget):
    """Return the most reward of any closed walk, by a search over places and plants passed."""
    m, n = reward.shape
    start = ((0, 0), frozenset())
    seen, front, most = {start}, [start], 0.0
    for step in range(1, budget + 1):
        after = set()
        for (row, column), passed in front:
            near = [(row, column - 1), (row, column + 1)]
            if column in {0, n + 1}:
                near += [(row - 1, column), (row + 1, column)]
            for r, c in near:
                if 0 <= r < m and 0 <= c <= n + 1 and step + r + c <= budget:
                    here = ((r, c), passed | ({(r, c)} if 0 < c <= n else set()))
                    if here not in seen:
                        after.add(here)
        seen |= after
        front = list(after)
        for place, passed in front:
            if place == (0, 0):
                most = max(most, sum(reward[r, c - 1] for r, c in passed))
    return most


@pytest.mark.parametrize("budget", [2, 4, 7, 8, 10, 12])
def test_it_is_the_best_of_all_walks_there_are(budget):
    reward = np.random.default_rng(budget).integers(0, 9, (3, 2)).astype(float)
    found = solve(reward, budget, 20.0)
    assert found.proved
    assert found.reward == pytest.approx(best_of_all_walks(reward, budget))
