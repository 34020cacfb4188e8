"""Mending stops: they fit, none is made twice, and nothing that fits is left out."""

import numpy as np
import pytest

from fieldmon.planning.routes.improve import Tour, fit, ruin
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock


def used_s(aisles, robot, stops):
    if not len(stops):
        return 0.0
    places = np.concatenate([[GATE], stops, [GATE] if robot.returns else []]).astype(np.int64)
    driving_s = driven_s(aisles.travel, robot_clock(robot, 1.0), places)
    return driving_s + len(stops) * robot.visit_s


@pytest.mark.parametrize("faces", [1, 2])
@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("seconds", [30.0, 400.0, 3000.0, 60000.0])
def test_what_comes_out_fits_and_no_further_stop_does(faces, returns, seconds):
    aisles = Aisles.of(rectangle(8, 9, Planting(faces=faces)))
    robot, rng = Robot(returns=returns), np.random.default_rng(6)
    n = len(aisles.grid)
    reward = rng.random(n)
    tour = Tour.of(rng.permutation(n)[: n // 2], n)
    held = fit(aisles.travel, robot_clock(robot, seconds), tour, reward, 0.0)
    stops = tour.stops
    assert len(np.unique(stops)) == len(stops)
    assert held == pytest.approx(reward[stops].sum())
    assert used_s(aisles, robot, stops) <= seconds
    assert tour.used[0] == pytest.approx(used_s(aisles, robot, stops))
    for plant in np.setdiff1d(np.arange(n), stops):
        ends = range(len(stops) + 1)
        assert min(used_s(aisles, robot, np.insert(stops, k, plant)) for k in ends) > seconds - 1e-6


def test_a_tour_in_a_bad_order_is_driven_in_a_better_one():
    aisles = Aisles.of(rectangle(10, 10))
    rng, robot = np.random.default_rng(1), Robot()
    n = len(aisles.grid)
    stops = rng.permutation(n)
    tour = Tour.of(stops, n)
    fit(aisles.travel, robot_clock(robot, 1e6), tour, np.ones(n), 0.0)
    assert sorted(tour.stops.tolist()) == list(range(n))
    assert used_s(aisles, robot, tour.stops) < 0.7 * used_s(aisles, robot, stops)


def test_ruin_leaves_the_poorest_out():
    aisles = Aisles.of(rectangle(1, 10))
    reward = np.append(np.ones(9), 0.001)
    tour = Tour.of(np.arange(10), 10)
    clock = robot_clock(Robot(), 1e6)
    ruin(aisles.travel, clock, tour, reward, used_s(aisles, Robot(), np.arange(10)) - 1.0)
    assert tour.stops.tolist() == list(range(9))
