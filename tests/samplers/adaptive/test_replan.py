"""The price that fills the day, and the plan at it."""

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import GATE
from fieldmon.samplers.adaptive.replan import _along, row_of
from fieldmon.samplers.adaptive.rows import mark_changed
from tests.samplers.adaptive.working import (
    first_price_of,
    planned_at,
    planned_on,
    scene_with,
    times_of,
    workspace,
)
from tests.thorough import seeds

GRID = rectangle(8, 12)
ONE_TIME = times_of((40.0, 0.84))


@loop
def fetch_along(travel, clock, work, state):
    _along(travel, clock, work[1], work[4], state)


def valued_along(travel, clock, work, state):
    at, _, price = state
    planned_on(travel, clock, work, (at, price, clock.seconds_left))
    fetch_along(travel, clock, work, state)


def believe(travel, work, plant, chance):
    work[0].chance[plant] = chance
    mark_changed.py_func(travel, work[1], plant)


@loop
def rows_of(travel, at):
    return row_of(travel, at)


def scene_of(seed, hours):
    chance = np.random.default_rng(seed).beta(0.4, 3.0, len(GRID))
    return scene_with(GRID, np.clip(chance, 1e-6, 1 - 1e-6), hours, returns=bool(seed % 2))


def seconds_at(scene, price, at=GATE):
    work = workspace(scene, ONE_TIME)
    return planned_at(scene.aisles.travel, scene.clock, work, (at, price)).seconds


@pytest.mark.parametrize("seed", seeds(2, 6))
@pytest.mark.parametrize("hours", [0.2, 0.6, 1.0])
def test_at_the_first_price_the_day_is_just_filled(seed, hours):
    scene = scene_of(seed, hours)
    work = workspace(scene, ONE_TIME)
    price = first_price_of(scene.aisles.travel, scene.clock, work, GATE)
    assert seconds_at(scene, price) <= scene.seconds_left
    assert seconds_at(scene, price / 1.05) > scene.seconds_left, "a lower price would fit too"


def test_with_time_for_all_a_second_costs_next_to_nothing():
    scene = scene_of(1, 24.0)
    price = first_price_of(scene.aisles.travel, scene.clock, workspace(scene, ONE_TIME), GATE)
    assert price < 1e-6 * scene.chance.max()
    assert seconds_at(scene, price) > len(GRID) * 40.0


@pytest.mark.parametrize("seed", seeds(2, 6))
@pytest.mark.parametrize("at", [GATE, 0, 53])
def test_the_dearer_a_second_the_shorter_the_plan(seed, at):
    scene = scene_of(seed, 1.0)
    prices = np.geomspace(1e-6, 0.02, 30)
    seconds = [seconds_at(scene, price, at) for price in prices]
    assert (np.diff(seconds) <= 1e-6).all()
    assert seconds[0] > seconds[-1]


@pytest.mark.parametrize("seed", seeds(2, 6))
@pytest.mark.parametrize("at", [GATE, 0, 53, 95])
def test_the_price_follows_the_hours_left_in_steps_of_a_tenth(seed, at):
    scene = scene_of(seed, 1.0)
    travel, clock, work = scene.aisles.travel, scene.clock, workspace(scene, ONE_TIME)
    usual = first_price_of(travel, clock, work, GATE)
    for left_s in (300.0, 1800.0, 3600.0, 20_000.0):
        work[1].stale[:] = True
        price, stretch = planned_on(travel, clock, work, (at, usual, left_s))
        steps = round(np.log(price / usual) / np.log(1.1))
        assert price == pytest.approx(usual * 1.1**steps)
        assert abs(steps) <= 2
        before = seconds_at(scene, usual, at)
        if 0.9 * left_s <= before <= left_s:
            assert steps == 0
        elif before > left_s:
            assert steps > 0
        else:
            assert steps < 0
        assert stretch.seconds == pytest.approx(seconds_at(scene, price, at))


@pytest.mark.parametrize("seed", seeds(2, 4))
def test_what_is_kept_of_the_price_before_is_what_would_be_worked_out_anew(seed):
    scene, rng = scene_of(seed, 1.0), np.random.default_rng(seed)
    travel, clock = scene.aisles.travel, scene.clock
    kept, anew = workspace(scene, ONE_TIME), workspace(scene, ONE_TIME)
    price = first_price_of(travel, clock, kept, GATE)
    prices = [price]
    for _ in range(60):
        plant, chance = rng.integers(len(GRID)), rng.uniform(0.0, 0.3)
        for work in (kept, anew):
            believe(travel, work, plant, chance)
        anew[1].stale[:] = anew[1].before.stale[:] = True
        anew[1].before.price[:] = np.nan
        state = int(rng.integers(GATE, len(GRID))), price, rng.choice([1200.0, 2400.0])
        price, stretch = planned_on(travel, clock, kept, state)
        assert (price, stretch) == planned_on(travel, clock, anew, state)
        assert (kept[1].net == anew[1].net).all()
        prices.append(price)
    turns = np.sign(np.diff(prices))
    assert (np.diff(turns[turns != 0]) != 0).sum() > 10, "the price went up and down"


@pytest.mark.parametrize("at", range(0, len(GRID), 7))
def test_a_stretch_ends_at_a_plant_of_its_row_that_pays(at):
    scene = scene_of(3, 1.0)
    work = workspace(scene, ONE_TIME)
    price = 0.002
    stretch = planned_at(scene.aisles.travel, scene.clock, work, (at, price))
    assert GRID.row[stretch.last] == stretch.row
    assert 0.84 * scene.chance[stretch.last] > price * 40.0
    if stretch.row == GRID.row[at]:
        ahead = stretch.last > at if stretch.first_end == 0 else stretch.last < at
        assert ahead or stretch.last == at


def test_a_plant_stands_in_its_row_and_the_gate_in_none():
    travel = scene_of(1, 1.0).aisles.travel
    assert [rows_of(travel, at) for at in (GATE, 0, 12, 95)] == [-1, 0, 1, 7]


@pytest.mark.parametrize("row", [0, 1, 7])
def test_from_the_gate_the_plan_leads_to_the_row_that_is_worth_it_the_first_as_any(row):
    chance = np.full(len(GRID), 1e-6)
    chance[GRID.row == row] = 0.5
    scene = scene_with(GRID, chance, 1.0, returns=True)
    travel, work = scene.aisles.travel, workspace(scene, ONE_TIME)
    stretch = planned_at(travel, scene.clock, work, (GATE, 1e-3))
    assert stretch.row == row


@pytest.mark.parametrize("at", [12, 17, 23, 53])
@pytest.mark.parametrize("price", [1e-5, 4e-4, 2e-3, 6e-3])
def test_along_its_row_it_turns_back_where_no_other_plant_is_a_better_turn(at, price):
    scene = scene_of(3, 1.0)
    travel, work = scene.aisles.travel, workspace(scene, ONE_TIME)
    _, rows, _, _, own = work
    first = travel.row_start[GRID.row[at]]
    for end, step in ((0, -1), (1, 1)):
        valued_along(travel, scene.clock, work, (at, end, price))
        n = rows.n_pays[GRID.row[at]]
        pays = rows.pays[first : first + n]
        gain, stop_s = (each[first : first + n] for each in (rows.gain, rows.stop_s))
        passed = [k for k in range(n)[::step] if (pays[k] - at) * step > 0]
        turns = {(0.0, 0.0, -1)}
        for m in range(1, len(passed) + 1):
            far = pays[passed[m - 1]]
            drive_s = 2 * abs(travel.x_m[far] - travel.x_m[at]) / scene.robot.speed_m_s
            net = gain[passed[:m]].sum() - price * drive_s
            turns.add((net, drive_s + stop_s[passed[:m]].sum(), far))
        net, seconds, turn = max(turns)
        assert own.fetch[end] == pytest.approx(net)
        assert own.fetch_s[end] == pytest.approx(seconds)
        assert own.turn[end] == turn
