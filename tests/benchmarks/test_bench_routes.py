"""Seconds of the exact walk and of a bounded route."""

import numpy as np
import pytest

from fieldmon.planning.routes.best_route import best
from fieldmon.planning.routes.exact_walk import best_walk, full_budget
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles


@pytest.mark.parametrize(("shape", "most_s"), [((100, 50), 0.3), ((240, 500), 5.0)])
def test_the_exact_walk_takes_less_than(benchmark, shape, most_s):
    reward = np.random.default_rng(1).random(shape)
    best_walk(reward[:3, :3], 20)
    benchmark.pedantic(best_walk, (reward, full_budget(*shape)), rounds=2)
    assert benchmark.stats["min"] < most_s


@pytest.mark.parametrize("faces", [1, 2])
def test_a_bounded_route_over_thousands_of_plants(benchmark, faces):
    aisles = Aisles.of(rectangle(91, 91, Planting(faces=faces)))
    reward = np.random.default_rng(1).beta(0.3, 20.0, len(aisles.grid))
    best(aisles, reward, Robot(hours=1.0))
    route = benchmark.pedantic(best, (aisles, reward, Robot()), rounds=1)
    assert route.gap < 0.03
