"""Adaptive: where it drives, what it skips, and what a find changes."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import GRIDS, scene_on

from fieldmon.belief import Pairs
from fieldmon.errors import SettingError
from fieldmon.planting import rectangle
from fieldmon.samplers import Adaptive, Dynamic, Naive
from fieldmon.workday import plan_day, work_day

GRID = rectangle(30, 30)
N = len(GRID)


def scene_with(chance, hours=2.0, company=0.0):
    plain = scene_on(GRID, hours=hours)
    belief = Pairs.of(GRID, chance, company)
    return replace(plain, chance=belief.chance, both=belief.both)


@pytest.mark.parametrize("seed", range(6))
def test_it_expects_more_finds_than_dynamic_and_naive(seed):
    scene = replace(scene_on(GRID, hours=3.0, seed=seed), both=None)
    chance = scene.chance
    expected = {
        type(s).__name__: chance[plan_day(scene, s).plant].sum()
        for s in (Adaptive(spares=0.0, beside_find=0.0), Dynamic(), Naive())
    }
    assert expected["Adaptive"] > 1.1 * expected["Dynamic"]
    assert expected["Adaptive"] > 1.1 * expected["Naive"]


def test_where_nothing_is_known_and_plants_are_independent_the_day_is_a_sweep():
    scene = scene_with(np.full(N, 0.2))
    work, sweep = plan_day(scene, Adaptive()), plan_day(scene, Naive())
    assert len(work) >= 0.97 * len(sweep)
    rows = GRID.row[work.plant]
    assert np.count_nonzero(np.diff(rows)) <= len(np.unique(rows)) + 1


def test_after_a_clean_look_the_plant_beside_it_can_wait():
    apart = plan_day(scene_with(np.full(N, 0.02), company=0.6), Adaptive())
    in_first_row = apart.plant[GRID.row[apart.plant] == GRID.row[apart.plant[0]]]
    assert np.median(np.abs(np.diff(in_first_row))) > 1


def test_a_hot_spot_is_driven_to_across_the_plot():
    chance = np.full(N, 0.001)
    hot = np.array([25 * 30 + 20, 25 * 30 + 21, 26 * 30 + 20])
    chance[hot] = 0.6
    work = plan_day(scene_with(chance, hours=0.5), Adaptive())
    assert set(hot) <= set(work.plant.tolist())


def test_a_plant_that_is_hardly_suspected_is_not_worth_a_long_way():
    chance = np.full(N, 1e-6)
    chance[:60] = 0.1
    chance[29 * 30 + 29] = 0.001
    work = plan_day(scene_with(chance, hours=0.6), Adaptive())
    assert 29 * 30 + 29 not in work.plant


def test_the_plants_beside_a_find_are_inspected_those_in_its_row_at_once():
    scene = scene_with(np.full(N, 0.01), company=0.6)
    calm = plan_day(scene, Adaptive())
    k = len(calm) // 3
    find = int(calm.plant[k])
    found = np.zeros(N, bool)
    found[find] = True
    start, other = GRID.adjacent
    beside = set(other[start[find] : start[find + 1]].tolist()) - set(calm.plant[:k].tolist())
    work = work_day(scene, Adaptive(), found)
    assert beside <= set(work.plant.tolist())
    assert {find - 1, find + 1} & beside <= set(work.plant[k + 1 : k + 8].tolist())


@pytest.mark.parametrize("bad", [{"spares": -1.0}, {"spares": np.inf}, {"beside_find": 1.5}])
def test_impossible_settings_are_refused(bad):
    with pytest.raises(SettingError, match="but it is"):
        Adaptive(**bad)


def test_one_plant_is_visited():
    scene = scene_on(GRIDS["one plant"], hours=1.0)
    assert plan_day(scene, Adaptive()).plant.tolist() == [0]
