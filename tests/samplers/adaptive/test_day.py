"""Adaptive's day as it goes: it stops where nothing more fits, and learns on the way."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.infestation.calibration_slope import no_inspections
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, travel_s
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.adaptive.day import (
    _learn_clustering,
    times_odds,
    times_odds_of_all,
    trust_in_differences,
)
from fieldmon.samplers.sweeps import Naive
from tests.samplers.adaptive.working import times_of, workspace
from tests.scenes import scene_on

GRID = rectangle(12, 15)
N = len(GRID)


def scene_of(seed, hours, at=GATE, *, returns=True):
    chance = np.clip(np.random.default_rng(seed).beta(0.4, 3.0, N), 1e-5, 1 - 1e-5)
    robot, belief = Robot(hours=hours, returns=returns), PairApproximation.of(GRID, chance, 0.5)
    return replace(
        scene_on(GRID), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        seconds_left=robot.day_s, at=at,
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("hours", [0.1, 0.4, 1.3])
@pytest.mark.parametrize(("returns", "at"), [(True, GATE), (False, 100)])
@pytest.mark.parametrize("chooses", [False, True])
def test_the_day_ends_only_where_no_other_plant_would_fit(seed, hours, returns, at, chooses):
    scene = scene_of(seed, hours, at, returns=returns)
    found = np.random.default_rng(seed).random(N) < 0.1
    sampler = Adaptive(chooses_time=chooses)
    work = work_day(scene, sampler, found.astype(np.uint8))
    quickest_s = sampler.inspection_times(scene.robot).stop_s[0]
    place = int(work.plant[-1]) if len(work) else scene.at
    now_s = float(work.arrive_s[-1] + work.stop_s[-1]) if len(work) else 0.0
    travel, clock = scene.aisles.travel, scene.clock
    for plant in np.setdiff1d(np.arange(N), work.plant).tolist():
        end_s = now_s + travel_s(travel, clock, place, plant) + quickest_s
        end_s += travel_s(travel, clock, plant, GATE) if returns else 0.0
        assert end_s > scene.seconds_left


def test_until_the_first_find_the_day_is_that_on_which_nothing_is_found():
    scene = scene_of(1, 1.0)
    calm = plan_work(scene, Adaptive())
    found = np.zeros(N, np.bool_)
    found[calm.plant[20]] = True
    work = work_day(scene, Adaptive(), found)
    assert work.plant[:21].tolist() == calm.plant[:21].tolist()
    assert work.plant.tolist() != calm.plant.tolist()


def test_a_find_draws_the_robot_to_its_neighbours_and_a_clean_plant_does_not():
    scene = replace(scene_of(1, 0.8), chance=np.full(N, 0.03))
    scene = replace(scene, pair_chance=PairApproximation.of(GRID, scene.chance, 0.8).pair_chance)
    calm = plan_work(scene, Adaptive())
    k = len(calm) // 2
    found = np.zeros(N, np.bool_)
    found[calm.plant[k]] = True
    work = work_day(scene, Adaptive(), found)
    start, other = GRID.adjacent
    beside = set(other[start[calm.plant[k]] : start[calm.plant[k] + 1]].tolist())
    seen = set(work.plant[k + 1 :].tolist()) & beside
    assert len(seen) > len(set(calm.plant[k + 1 :].tolist()) & beside)


def test_plants_that_were_inspected_today_are_worth_nothing_more():
    scene = scene_of(2, 24.0)
    last = scene.last_inspected.copy()
    last[::3] = scene.day
    work = plan_work(replace(scene, last_inspected=last), Adaptive())
    assert set(work.plant.tolist()) == set(range(N)) - set(range(0, N, 3))


@pytest.mark.parametrize("seed", range(4))
def test_a_longer_day_is_expected_to_find_more(seed):
    found = [scene_of(seed, hours).chance[plan_work(scene_of(seed, hours), Adaptive()).plant].sum()
             for hours in (0.2, 0.5, 1.0, 1.8)]  # fmt: skip
    assert (np.diff(found) > 0).all()


def test_the_scene_is_left_as_it_was():
    scene = scene_of(3, 1.0)
    chance, pair_chance = scene.chance.copy(), scene.pair_chance.copy()
    work_day(scene, Adaptive(), np.ones(N, np.bool_))
    np.testing.assert_array_equal(scene.chance, chance)
    np.testing.assert_array_equal(scene.pair_chance, pair_chance)


def test_where_all_plants_are_infested_unannounced_the_day_is_driven_as_a_sweep():
    belief = TracedPairs.of(GRID, np.full(N, 0.02))
    robot = Robot(hours=1.5)
    scene = replace(
        scene_on(GRID), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        traces=belief.traces, seconds_left=robot.day_s,
    )  # fmt: skip
    every = np.ones(N, np.bool_)
    assert len(work_day(scene, Adaptive(), every)) >= 0.95 * len(work_day(scene, Naive(), every))


@loop
def trust(share, slope_sums):
    return trust_in_differences(share, slope_sums)


def traced_scene(share, hours, **given):
    belief, robot = TracedPairs.of(GRID, np.full(N, share)), Robot(hours=hours)
    return replace(
        scene_on(GRID), robot=robot, chance=belief.chance, pair_chance=belief.pair_chance,
        traces=belief.traces, seconds_left=robot.day_s, **given,
    )  # fmt: skip


def test_a_plan_that_takes_plants_for_clean_learns_nothing_of_how_many_are_infested():
    scene, chances = traced_scene(0.3, 1.5), []
    none = np.zeros(N, np.bool_)
    plan = plan_work(scene, Adaptive())
    supposed = work_day(replace(scene, supposed=True), Adaptive(), none)
    assert plan.plant.tolist() == supposed.plant.tolist()
    for each in (scene, replace(scene, supposed=True)):
        belief = replace(each, robot=replace(each.robot, hours=1.0), seconds_left=3600.0)
        chances.append(Adaptive().walk(belief, none).plant.tolist())
    assert chances[0] != chances[1]


def test_where_few_are_infested_differences_count_and_where_many_are_they_must_have_come_true():
    nothing, proved = no_inspections(), np.array([400.0, -400.0, 160.0, 1200.0, 80.0, 0.0])
    assert [trust(share, nothing) for share in (0.0, 0.015, 0.03)] == [1.0] * 3
    assert trust(0.1, nothing) == pytest.approx(0.5)
    assert 0.0 < trust(0.6, nothing) < 0.002
    assert trust(0.6, proved) > 0.6
    assert trust(0.1, proved) > trust(0.1, nothing)
    told = no_inspections(np.where(np.arange(N) < 20, 0.6, 0.1))
    assert trust(0.6, told) > 0.4


def test_odds_are_multiplied_and_chances_stay_chances():
    assert times_odds.py_func(0.5, 3.0) == pytest.approx(0.75)
    assert times_odds.py_func(0.2, 1.0) == pytest.approx(0.2)
    assert 0.0 < times_odds.py_func(1e-6, 0.01) < times_odds.py_func(1.0 - 1e-6, 100.0) < 1.0


def test_with_all_odds_multiplied_neighbours_stay_as_correlated():
    before = PairApproximation.of(GRID, np.random.default_rng(3).uniform(0.1, 0.3, N), 0.3)
    chance, pair_chance = before.chance.copy(), before.pair_chance.copy()
    times_odds_of_all.py_func((chance, pair_chance), GRID.linked, 1.7, tuple(np.empty((2, N))))
    odds = [c / (1.0 - c) for c in (chance, before.chance)]
    np.testing.assert_allclose(odds[0], 1.7 * odds[1])

    def correlation(chance, pair_chance):
        start, other = GRID.adjacent
        p, q = np.repeat(chance, np.diff(start)), chance[other]
        return (pair_chance - p * q) / np.sqrt(p * (1.0 - p) * q * (1.0 - q))

    was = correlation(before.chance, before.pair_chance)
    np.testing.assert_allclose(correlation(chance, pair_chance), was)


@loop
def learn_clustering(linked, belief, rows):
    _learn_clustering(linked, belief, rows)


def test_neighbours_with_nothing_in_common_are_thought_over_once():
    belief, rows, *_ = workspace(scene_of(3, 1.0), times_of((40.0, 0.84)))
    belief.clusters.finds[:] = 0.0, 5.0
    learn_clustering(GRID.linked, belief, rows)
    assert belief.scale[0] == 0.0
    assert rows.stale.all()
    rows.stale[:] = False
    learn_clustering(GRID.linked, belief, rows)
    assert not rows.stale.any()
