"""Dynamic as the thesis words it: open list, closed list, nearest next, neighbours after a find."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.travel import GATE
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.dynamic import Dynamic
from tests.bent import bent_grids
from tests.crooked import crooked_grids
from tests.scenes import GRIDS, charged_s, scene_on

GRID = GRIDS["rectangle"]


def scene_with(suspicious, hours=6.0, base=0.001):
    chance = np.full(len(GRID), base)
    chance[suspicious] = 0.5
    plain = scene_on(GRID, hours=hours)
    return Scene(
        aisles=plain.aisles,
        robot=plain.robot,
        chance=chance,
        last_inspected=np.full(len(GRID), NEVER, np.int32),
        seconds_left=hours * 3600,
    )


def nearest(scene, at, open_plants):
    return min(open_plants, key=lambda plant: (charged_s(scene, at, plant), plant))


def seconds_to(scene, at, plants):
    """Return the seconds from a place to each of some plants."""
    seconds = scene.aisles.distance_m(at, plants) / scene.robot.speed_m_s
    if at == GATE:
        return seconds
    grid, row = scene.grid, scene.grid.row
    other = grid.corridor[row[plants]] != grid.corridor[row[at]]
    turned = ~other & (grid.side[row[plants]] != grid.side[row[at]])
    return seconds + scene.robot.row_change_s * other + scene.robot.turn_180_s * turned


@given(st.one_of(bent_grids(), crooked_grids()), st.integers(0, 1000))
def test_wherever_rows_bend_or_are_cut_the_nearest_open_plant_is_next(grid, seed):
    scene = scene_on(grid, hours=24.0, seed=2 * seed)
    rng = np.random.default_rng(seed)
    asked = np.sort(rng.permutation(len(grid))[: min(max(len(grid) // 3, 1), 200)])
    chance = np.where(np.isin(np.arange(len(grid)), asked), 0.5, 0.001)
    scene = replace(scene, chance=chance)
    at, open_plants = GATE, asked
    for plant in plan_work(scene, Dynamic()).plant[: len(asked)].tolist():
        seconds = seconds_to(scene, at, open_plants)
        assert seconds[open_plants == plant] == pytest.approx(seconds.min())
        open_plants, at = open_plants[open_plants != plant], plant


def test_suspicious_plants_come_before_all_others():
    suspicious = [20, 21, 22, 90, 150]
    plants = plan_work(scene_with(suspicious), Dynamic()).plant.tolist()
    assert set(plants[:5]) == set(suspicious)
    assert len(plants) > 5


def test_after_a_find_the_plants_beside_it_are_inspected_while_near():
    scene = scene_with(list(range(17 * 5, 17 * 6)), hours=1.0)
    calm = plan_work(scene, Dynamic())
    found = np.zeros(len(GRID), bool)
    find = int(calm.plant[3])
    found[find] = True
    work = work_day(scene, Dynamic(), found)
    start, plant = GRID.adjacent
    beside = set(plant[start[find] : start[find + 1]].tolist())
    assert beside & set(work.plant.tolist()) > beside & set(calm.plant.tolist())


def test_a_closed_plant_is_never_opened_again():
    scene = scene_with([])
    work = work_day(scene, Dynamic(), np.ones(len(GRID), bool))
    assert len(set(work.plant.tolist())) == len(work)


def level(chance):
    """Return in which eighth of an octave a chance lies, counted from 1."""
    part, octave = math.frexp(chance)
    return 8 * octave + math.floor(8 * (2 * part - 1))


def suspicious_of(scene, share, closed, room):
    """Return the plants that are opened when none is, as the words say it."""
    left = [plant for plant in range(len(scene.chance)) if plant not in closed]
    levels = {plant: level(scene.chance[plant]) for plant in left}
    lowest = max(levels.values(), default=0) - round(8 * math.log2(1 / share))
    left = [plant for plant in left if levels[plant] >= lowest]
    return set(sorted(left, key=lambda plant: (-levels[plant], plant))[:room])


@given(
    st.one_of(bent_grids(), crooked_grids()),
    st.integers(0, 1000),
    st.floats(0.05, 8.0),
    st.sampled_from([(0.5, 1.0), (0.2, 0.3), (1.0, 0.01), (0.9, 0.6)]),
)
def test_every_stop_follows_from_the_words_of_the_sampler(grid, seed, hours, choice):
    """The lists kept as sets, all open plants tried: a day with finds, refills and its end."""
    share, at_once = choice
    rng = np.random.default_rng(seed)
    today, found = rng.random(len(grid)) < 0.1, rng.random(len(grid)) < 0.3
    scene = scene_on(grid, hours=hours, seed=seed, last_inspected=np.where(today, 3, NEVER), day=3)
    robot, (start, beside) = scene.robot, grid.adjacent
    closed, opened, at, now_s = set(np.flatnonzero(today)), set(), GATE, 0.0

    def refilled():
        room = int(at_once * ((scene.seconds_left - now_s) // robot.visit_s))
        return suspicious_of(scene, share, closed, max(room, 1))

    work = work_day(scene, Dynamic(share, at_once), found)
    for plant, arrive_s in zip(work.plant.tolist(), work.arrive_s.tolist(), strict=True):
        opened = opened or refilled()
        seconds = {one: charged_s(scene, at, one) for one in opened}
        assert seconds[plant] == pytest.approx(min(seconds.values()))
        now_s += seconds[plant]
        assert arrive_s == pytest.approx(now_s)
        now_s += robot.visit_s
        closed.add(plant)
        opened.remove(plant)
        if found[plant]:
            opened |= set(beside[start[plant] : start[plant + 1]].tolist()) - closed
        at = plant
    opened = opened or refilled()
    ways = [(charged_s(scene, at, one), one) for one in opened]
    for way_s, plant in ways:
        if way_s <= min(ways)[0] + 1e-6:  # of those that are next, one does not fit
            home_s = charged_s(scene, plant, GATE) if robot.returns else 0.0
            late = now_s + way_s + robot.visit_s + home_s > scene.seconds_left - 1e-6
            if late:
                break
    else:
        assert not opened
