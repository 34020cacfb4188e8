"""The exact walk beside all there is and HiGHS: ``python -m tests.benchmarks.exact_walks``.

On small instances every closed walk is searched, on middle ones a mixed-integer program proves the
most; on all of them each heuristic is driven. The first difference ends it with an error.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from fieldmon.planning.routes.exact_walk import best_walk, full_budget
from fieldmon.studies.routes import milp
from fieldmon.studies.routes.drive import driven
from fieldmon.studies.routes.heuristics import HEURISTICS
from tests.planning.routes.test_exact_walk import drive_and_check, every_walk, small

SAME = 1e-9


def must_be_best(reward, budget, most):
    """Drive the exact walk and every heuristic's; none may hold more than the most."""
    walk = best_walk(reward, budget)
    drive_and_check(reward, budget, walk)
    if abs(walk.reward - most) > SAME * max(most, 1.0):
        raise AssertionError(f"{walk.reward} of {most} in {budget} steps on {reward.tolist()}")
    for name, heuristic in HEURISTICS.items():
        other = driven(heuristic(reward, budget), reward)
        if other.steps > budget or other.reward > walk.reward + SAME:
            raise AssertionError(f"{name} holds {other.reward} of {walk.reward}")


def beside_every_walk(count, seed):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        reward, budget = small(rng, 4, 3)
        must_be_best(reward, budget, every_walk(reward, budget))


def beside_a_program(count, seed):
    """Middle size: 3 to 6 rows of 4 to 10 plants, with a proof each."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        shape = int(rng.integers(3, 7)), int(rng.integers(4, 11))
        reward = np.floor(rng.random(shape) ** 3 * 30)
        budget = int(rng.integers(10, full_budget(*shape)))
        found = milp.solve(reward, budget, 300.0)
        if not found.proved:
            raise AssertionError(f"no proof in 300 s: {budget} steps on {reward.tolist()}")
        must_be_best(reward, budget, round(found.reward))


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--small", type=int, default=2500)
    options.add_argument("--middle", type=int, default=200)
    options.add_argument("--seed", type=int, default=1)
    told = options.parse_args()
    for what, check, count in (
        ("every walk there is", beside_every_walk, told.small),
        ("a mixed-integer program", beside_a_program, told.middle),
    ):
        began = time.process_time()
        check(count, told.seed)
        took_s = time.process_time() - began
        sys.stdout.write(f"{count} instances beside {what}: no difference, {took_s:.0f} s\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
