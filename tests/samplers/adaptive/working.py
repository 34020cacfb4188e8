"""Adaptive's arrays on small plots, as `Adaptive.walk` makes them."""

from dataclasses import replace

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.infestation.pairs.clustering import ClusterEstimate
from fieldmon.infestation.pairs.pairs import Neighbourhood, pair_chances
from fieldmon.infestation.tracing.tracing import Raised, Traces
from fieldmon.plot.robot import Robot
from fieldmon.samplers.adaptive.arrays import NOWHERE, BeliefArrays, BestTours, OwnRow, RowTours
from fieldmon.samplers.adaptive.replan import _plan_at, first_price, plan_on
from fieldmon.samplers.adaptive.tours import measure_ways
from fieldmon.samplers.base import InspectionTimes
from tests.scenes import scene_on


def scene_with(grid, chance, hours=1.0, *, returns=True):
    robot = Robot(hours=hours, returns=returns)
    return replace(scene_on(grid), robot=robot, chance=chance, seconds_left=robot.day_s)


def times_of(*pairs):
    """Return inspection times from pairs of seconds and detection."""
    stop_s, detects = np.array(pairs).T
    return InspectionTimes(stop_s.copy(), detects.copy())


def belief_on(grid, chance, together=0.0):
    """Return what is believed of a plot, a find worth 1; `together`: how much pairs go together."""
    pair_chance = pair_chances(chance, grid, together)
    if together == 0.0:
        start, other = grid.adjacent
        pair_chance = np.repeat(chance, np.diff(start)) * chance[other]
    n, (start, other) = len(grid), grid.adjacent
    before = np.full(n, NOWHERE)
    for i in range(n):
        for e in range(start[i], start[i + 1]):
            if other[e] == i - 1 and grid.row[i - 1] == grid.row[i]:
                before[i] = e
    return BeliefArrays(
        chance.copy(), pair_chance.copy(), np.ones(n), Neighbourhood.of(n), before,
        chance.copy(), pair_chance.copy(), ClusterEstimate.none(n),
        np.array([1.0, 0.0, 0.5, 1.0]), np.array([1.0, 1.0, 1.0]), Traces.none(n), Raised.of(n),
    )  # fmt: skip


def workspace(scene, times, together=0.0):
    """Return what planning works in."""
    n, n_rows = len(scene.grid), scene.grid.n_rows
    tours = BestTours.of(n_rows)
    measure_ways(scene.aisles.travel, scene.clock, tours.next_s, tours.home_s)
    belief = belief_on(scene.grid, scene.chance, together)
    return belief, RowTours.of(n, n_rows, times.stop_s.size), tours, times, OwnRow.blank()


@loop
def _planned(travel, clock, work, state, how):
    # one loop: what it calls is compiled with it, and again with another
    at, price, left_s = state
    if how == 0:
        price = first_price(travel, clock, work, at)
    elif how == 1:
        return plan_on(travel, clock, work, (at, price, left_s))
    return price, _plan_at(travel, clock, work, (at, price))


def first_price_of(travel, clock, work, at):
    """Return `first_price`."""
    return _planned(travel, clock, work, (at, 0.0, 0.0), 0)[0]


def planned_on(travel, clock, work, state):
    """Return `plan_on`."""
    return _planned(travel, clock, work, state, 1)


def planned_at(travel, clock, work, state):
    """Return `_plan_at`."""
    return _planned(travel, clock, work, (*state, 0.0), 2)[1]
