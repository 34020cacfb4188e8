"""Adaptive: where it drives, what it skips, and what a find changes."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Naive
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.scenes import GRIDS, scene_on

GRID = rectangle(30, 30)
N = len(GRID)


def scene_with(chance, hours=2.0, company=0.0):
    plain = scene_on(GRID, hours=hours)
    belief = PairApproximation.of(GRID, chance, company)
    return replace(plain, chance=belief.chance, pair_chance=belief.pair_chance)


@pytest.mark.parametrize("seed", range(6))
def test_it_expects_more_finds_than_dynamic_and_naive(seed):
    scene = replace(scene_on(GRID, hours=3.0, seed=seed), pair_chance=None)
    chance = scene.chance
    expected = {
        type(s).__name__: chance[plan_work(scene, s).plant].sum()
        for s in (Adaptive(spares=0.0, beside_find=0.0), Dynamic(), Naive())
    }
    assert expected["Adaptive"] > 1.1 * expected["Dynamic"]
    assert expected["Adaptive"] > 1.1 * expected["Naive"]


def test_where_nothing_is_known_and_plants_are_independent_the_day_is_a_sweep():
    scene = scene_with(np.full(N, 0.2))
    work, sweep = plan_work(scene, Adaptive()), plan_work(scene, Naive())
    assert len(work) >= 0.97 * len(sweep)
    rows = GRID.row[work.plant]
    assert np.count_nonzero(np.diff(rows)) <= len(np.unique(rows)) + 1


def test_after_a_clean_look_the_plant_beside_it_can_wait():
    apart = plan_work(scene_with(np.full(N, 0.02), company=0.6), Adaptive())
    in_first_row = apart.plant[GRID.row[apart.plant] == GRID.row[apart.plant[0]]]
    assert np.median(np.abs(np.diff(in_first_row))) > 1


def test_a_hot_spot_is_driven_to_across_the_plot():
    chance = np.full(N, 0.001)
    hot = np.array([25 * 30 + 20, 25 * 30 + 21, 26 * 30 + 20])
    chance[hot] = 0.6
    work = plan_work(scene_with(chance, hours=0.5), Adaptive())
    assert set(hot) <= set(work.plant.tolist())


def test_of_several_looks_the_suspected_plant_gets_the_long_one_and_the_others_short_ones():
    chance = np.full(N, 0.02)
    hot = np.arange(3 * 30, 3 * 30 + 10)
    chance[hot] = 0.6
    work = plan_work(scene_with(chance, hours=3.0), Adaptive(chooses_time=True))
    suspected = np.isin(work.plant, hot)
    assert (work.detects[suspected] == 0.84).all()
    assert (work.detects[~suspected] < 0.84).mean() > 0.5
    assert work.stop_s[work.detects == 0.5] == pytest.approx(20.0)
    fixed = plan_work(scene_with(chance, hours=3.0), Adaptive())
    found, found_fixed = (chance[w.plant] @ w.detects for w in (work, fixed))
    assert found > found_fixed


def test_what_a_look_finds_depends_on_which_look_it_was():
    chance = np.full(N, 0.02)
    scene = scene_with(chance, hours=1.0)
    only_long = np.full(N, 5, np.uint8)  # nothing is seen in less than the longest look
    work = work_day(scene, Adaptive(chooses_time=True), only_long)
    assert (work.found == (work.detects == 0.84)).all()
    assert not work.found.all()


def test_a_robot_whose_detection_is_given_outright_has_no_looks_to_choose_from():
    with pytest.raises(SettingError, match="what each time of looking detects"):
        Adaptive(chooses_time=True).inspection_times(Robot(detection=0.7))


def test_a_season_learns_from_short_looks_less_than_from_long_ones():
    grid = rectangle(20, 20)
    start = Start(np.zeros(400, bool), np.full(400, 0.05))
    settings = SimulationSettings(n_days=2, spread=Spread(0.0, arrivals_per_day=0.0))
    season = simulated_days(
        Aisles.of(grid),
        Robot(hours=1.5),
        Adaptive(chooses_time=True),
        start,
        settings,
        RandomStreams(1),
    )
    first, second = season
    short = first.work.plant[first.work.detects == 0.5]
    long = first.work.plant[first.work.detects == 0.84]
    assert len(short) > 0
    for plants, detects in ((short, 0.5), (long, 0.84)):
        if len(plants):
            alone = 0.05 * (1 - detects) / (1 - 0.05 * detects)
            assert second.chance[plants].max() <= alone + 1e-9


def test_a_plant_that_is_hardly_suspected_is_not_worth_a_long_way():
    chance = np.full(N, 1e-6)
    chance[:60] = 0.1
    chance[29 * 30 + 29] = 0.001
    work = plan_work(scene_with(chance, hours=0.6), Adaptive())
    assert 29 * 30 + 29 not in work.plant


def test_the_plants_beside_finds_are_inspected_those_in_their_row_at_once():
    scene = scene_with(np.full(N, 0.01), company=0.6)
    calm = plan_work(scene, Adaptive())
    k = len(calm) // 3
    find = int(calm.plant[k])
    found = np.zeros(N, bool)
    found[find - 1 : find + 2] = True
    start, other = GRID.adjacent
    beside = set(other[start[find] : start[find + 1]].tolist()) - set(calm.plant[:k].tolist())
    work = work_day(scene, Adaptive(), found)
    assert beside <= set(work.plant.tolist())
    assert {find - 1, find + 1} & beside <= set(work.plant[k + 1 : k + 8].tolist())


@pytest.mark.parametrize("seed", range(5))
def test_where_finds_stand_alone_it_soon_finds_as_many_as_a_sweep(seed):
    """Clusters are believed in and there are none: learnt from the first finds, the same day."""
    start, other = GRID.adjacent
    rng = np.random.default_rng(seed)
    alone = np.zeros(N, bool)
    for plant in rng.permutation(N):
        if not alone[other[start[plant] : start[plant + 1]]].any():
            alone[plant] = rng.random() < 0.15
    scene = scene_with(np.full(N, 0.1), hours=6.0, company=0.6)
    scene = replace(scene, robot=scene.robot.with_times("thesis"))  # as it was tuned
    work, sweep = (work_day(scene, s, alone) for s in (Adaptive(), Naive()))
    assert work.found.sum() >= 0.9 * sweep.found.sum()


@pytest.mark.parametrize("bad", [{"spares": -1.0}, {"spares": np.inf}, {"beside_find": 1.5}])
def test_impossible_settings_are_refused(bad):
    with pytest.raises(SettingError, match="but it is"):
        Adaptive(**bad)


def test_one_plant_is_visited():
    scene = scene_on(GRIDS["one plant"], hours=1.0)
    assert plan_work(scene, Adaptive()).plant.tolist() == [0]
