"""Naive and Bouncy: row after row, on where yesterday ended, wherever the insects are."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import travel_s
from fieldmon.samplers.base import NEVER
from fieldmon.samplers.sweeps import Bouncy, Naive
from tests.scenes import GRIDS, scene_on
from tests.thorough import seeds

GRID = GRIDS["rectangle"]
N = len(GRID)
PLACE = np.argsort(GRID.snake)


def tomorrow(scene, work):
    """Return the next morning's scene."""
    last = scene.last_inspected.copy()
    last[work.plant] = scene.day
    trail = work.plant if len(work) else scene.trail
    return replace(scene, last_inspected=last, day=scene.day + 1, trail=trail)


def days(sampler, hours, n_days):
    """Return the plants of so many days, each day's for itself."""
    scene, worked = scene_on(GRID, hours=hours), []
    for _ in range(n_days):
        work = plan_work(scene, sampler)
        worked.append(work.plant)
        scene = tomorrow(scene, work)
    return worked


def test_naive_goes_up_one_row_and_down_the_next():
    rows = GRID.row[days(Naive(), 24.0, 1)[0]]
    assert rows.tolist() == sorted(rows.tolist())
    along = GRID.along_m[GRID.snake].reshape(11, 17)
    assert (np.diff(along[::2], axis=1) > 0).all()
    assert (np.diff(along[1::2], axis=1) < 0).all()


def test_naive_goes_on_where_it_ended_and_from_the_end_to_the_first_row_again():
    worked = np.concatenate(days(Naive(), 1.0, 5))
    assert len(worked) > N
    assert worked.tolist() == np.resize(GRID.snake, len(worked)).tolist()


@pytest.mark.parametrize("every", [1, 2, 3, 5])
def test_bouncy_takes_every_nth_and_in_n_passes_every_plant_once(every):
    worked = np.concatenate(days(Bouncy(every), 1.5, 8))
    first = worked[: -(-N // every)]
    assert PLACE[first].tolist() == list(range(0, N, every))
    assert sorted(worked[:N].tolist()) == list(range(N))


@pytest.mark.parametrize("every", [1, 2, 5])
def test_whichever_plant_a_day_ended_at_the_next_one_goes_on_from_there(every):
    scene = scene_on(GRID, hours=0.2)
    for plant in GRID.snake[: N - every]:
        last = np.full(N, NEVER, np.int32)
        last[plant] = 0
        trail = np.array([plant], np.int32)
        morning = replace(scene, last_inspected=last, day=1, trail=trail)
        work = plan_work(morning, Bouncy(every))
        assert PLACE[work.plant[0]] == PLACE[plant] + every


def test_bouncy_of_one_is_naive():
    for one, other in zip(days(Bouncy(1), 1.0, 4), days(Naive(), 1.0, 4), strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_pass_begins_at_the_first_plant_that_was_inspected_least_recently():
    last = np.full(N, 3, np.int32)
    last[GRID.snake[2]] = 1
    scene = replace(scene_on(GRID, hours=0.5), last_inspected=last, day=5)
    assert plan_work(scene, Bouncy(4)).plant[0] == GRID.snake[2]
    assert plan_work(scene, Bouncy(2)).plant[0] == GRID.snake[0]


@given(inspected=st.sets(st.integers(0, N - 1)), every=st.integers(1, 4), at=st.integers(-1, N - 1))
def test_whatever_was_inspected_today_the_day_ends_and_nothing_is_seen_twice(inspected, every, at):
    last = np.full(N, NEVER, np.int32)
    last[list(inspected)] = 0
    scene = replace(scene_on(GRID, hours=24.0), last_inspected=last, at=at)
    work = plan_work(scene, Bouncy(every))
    assert len(set(work.plant.tolist())) == len(work)
    assert set(work.plant.tolist()) == set(range(N)) - inspected


@pytest.mark.parametrize("sampler", [Naive(), Bouncy(3)])
def test_neither_finds_nor_chances_lead_a_sweep_astray(sampler):
    scene = scene_on(GRID, hours=1.0)
    other = replace(scene, chance=scene.chance[::-1].copy())
    calm, found = plan_work(scene, sampler), work_day(other, sampler, np.ones(N, np.bool_))
    np.testing.assert_array_equal(calm.plant, found.plant)
    assert not sampler.reads_chance


@pytest.mark.parametrize("name", GRIDS)
def test_steps_longer_than_the_plot_still_see_every_plant(name):
    grid = GRIDS[name]
    work = plan_work(scene_on(grid, hours=24.0), Bouncy(len(grid) + 3))
    assert sorted(work.plant.tolist()) == list(range(len(grid)))


@pytest.mark.parametrize("every", [0, -2])
def test_a_step_that_leads_nowhere_is_refused(every):
    with pytest.raises(SettingError, match=f"'every' must be 1 or more, but it is {every}"):
        Bouncy(every)


def sweep_told(scene, every):
    """Return the stops of a day as the sampler's words have them: plants and arrivals."""
    order, last = scene.grid.snake.tolist(), scene.last_inspected.tolist()
    travel, robot, stops = scene.aisles.travel, scene.robot, []
    place, n_before, ahead, at, now_s = 0, -1, [], scene.at, 0.0
    if scene.resume >= 0:
        ahead = order[order.index(scene.resume) + every :: every]
    while any(day != scene.day for day in last):
        ahead = [plant for plant in ahead if last[plant] != scene.day]
        if not ahead:
            if len(stops) > n_before:  # a new pass begins at whom nobody saw for longest
                first = order[:every]
                place = min(range(len(first)), key=lambda place: last[first[place]])
            else:  # all of the last one had been seen today: the next plants
                place = (place + 1) % every
            ahead, n_before = order[place::every], len(stops)
            continue
        plant = ahead.pop(0)
        arrive_s = now_s + travel_s(travel, scene.clock, at, plant)
        end_s = arrive_s + robot.visit_s
        home_s = travel_s(travel, scene.clock, plant, -1) if robot.returns else 0.0
        if end_s + home_s > scene.seconds_left:
            break
        stops.append((plant, arrive_s))
        last[plant], at, now_s = scene.day, plant, end_s
    return stops


@pytest.mark.parametrize("every", [1, 2, 3, 4, 9])
@pytest.mark.parametrize("seed", seeds(6, 12))
def test_every_stop_of_a_sweep_follows_from_its_words(every, seed):
    """Begun anew or resumed, some inspected today or earlier, with too little time or enough."""
    rng, grid = np.random.default_rng([seed, every]), rectangle(2 + seed % 3, 3)
    n = len(grid)
    scene = scene_on(grid, hours=float(rng.choice([0.06, 0.15, 2.0])), seed=seed)
    last = rng.choice([NEVER, 0, 1, 2, 3], n).astype(np.int32)
    trail = rng.permutation(n)[: rng.integers(0, 3)].astype(np.int32)
    at = int(rng.choice([-1, rng.integers(n)]))
    scene = replace(scene, last_inspected=last, day=3, trail=trail, at=at)
    work = plan_work(scene, Bouncy(every))
    stops = sweep_told(scene, every)
    assert work.plant.tolist() == [plant for plant, _ in stops]
    assert work.arrive_s == pytest.approx([arrive_s for _, arrive_s in stops])
