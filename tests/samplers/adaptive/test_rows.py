"""What each way of driving a row comes to, against all choices of plants there are."""

from itertools import combinations

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.plot.layout import rectangle
from fieldmon.samplers.adaptive.arrays import BLOCK
from fieldmon.samplers.adaptive.rows import (
    _pays_from,
    best_time,
    mark_changed,
    most_in,
    value_after_clean,
    value_row,
)
from tests.samplers.adaptive.working import belief_on, scene_with, times_of, workspace
from tests.thorough import seeds

ROWS, PLANTS = 3, 8
GRID = rectangle(ROWS, PLANTS)
ONE_TIME = times_of((40.0, 0.84))
QUICK = times_of((0.5, 0.9))
TIMES = times_of((20.0, 0.5), (30.0, 0.7), (40.0, 0.84))


@loop
def value(travel, clock, work, state):
    value_row(travel, clock, work, state)


@loop
def most(belief, rows, block):
    return most_in(belief, rows, ONE_TIME, block)


@loop
def after_clean(belief, rows, i):
    return value_after_clean(belief, rows, (i, 0), ONE_TIME.detects[0])


def valued(chance, price, times=ONE_TIME, together=0.0, row=1):
    scene = scene_with(GRID, chance)
    belief, rows, _, _, _ = workspace(scene, times, together)
    value(scene.aisles.travel, scene.clock, (belief, rows, times), (row, price))
    return scene, rows


def gains_of(chance, price, times):
    """Return the best gain of each plant, over the inspection times there are."""
    each = times.detects[:, None] * chance - price * times.stop_s[:, None]
    return each.max(axis=0), times.stop_s[each.argmax(axis=0)]


def subsets(paying):
    return (s for k in range(1, len(paying) + 1) for s in combinations(paying, k))


@pytest.mark.parametrize("seed", seeds(3, 8))
@pytest.mark.parametrize(
    "times", [ONE_TIME, TIMES, QUICK], ids=["one time", "three times", "half a second"]
)
def test_each_way_has_the_best_of_all_choices_of_plants(seed, times):
    rng = np.random.default_rng(seed)
    chance, price = rng.beta(0.5, 3.0, len(GRID)), 0.84 / 40 * rng.uniform(0.02, 0.5)
    scene, rows = valued(chance, price, times)
    gain, stop_s = gains_of(chance, price, times)
    first, end = GRID.row_start[1], GRID.row_start[2]
    paying = [i for i in range(first, end) if gain[i] > 0]
    low_m, high_m = GRID.lane_x_m[1]
    speed = scene.robot.speed_m_s

    def drive_s(way, inspected):
        x = GRID.along_m[list(inspected)]
        if way < 2:
            return (high_m - low_m) / speed
        return 2 * (x.max() - low_m if way == 2 else high_m - x.min()) / speed

    if not paying:
        assert (rows.last[1] == -1).all()
        return
    for way in range(4):
        worth = {s: gain[list(s)].sum() - price * drive_s(way, s) for s in subsets(paying)}
        best = max(worth, key=worth.get)
        assert rows.net[1, way] == pytest.approx(worth[best])
        seconds = drive_s(way, best) + stop_s[list(best)].sum()
        assert rows.seconds[1, way] == pytest.approx(seconds)
        assert rows.last[1, way] == (max(best) if way in {0, 2} else min(best))


def test_a_row_where_nothing_pays_is_not_driven():
    _, rows = valued(np.full(len(GRID), 0.01), price=0.02)
    assert rows.n_pays[1] == 0
    assert (rows.last[1] == -1).all()


def test_the_second_of_two_neighbours_counts_as_after_a_clean_first():
    """By Bayes' rule on the four states of a pair."""
    chance = np.full(len(GRID), 1e-6)
    first = GRID.row_start[1]
    chance[first : first + 2] = 0.4, 0.3
    price, d = 0.001, 0.84
    belief = belief_on(GRID, chance, together=0.8)
    both = belief.pair_chance[belief.pair_before[first + 1]]
    assert both > 0.4 * 0.3
    clean = {(1, 1): both * (1 - d), (0, 1): 0.3 - both}  # first clean, second infested
    nobody = {(1, 0): (0.4 - both) * (1 - d), (0, 0): 1 - 0.4 - 0.3 + both}
    after = sum(clean.values()) / (sum(clean.values()) + sum(nobody.values()))
    _, rows = valued(chance, price, together=0.8)
    assert rows.n_pays[1] == 2
    gains = rows.gain[first : first + 2]
    assert gains[0] == pytest.approx(d * 0.4 - price * 40.0)
    assert gains[1] == pytest.approx(d * after - price * 40.0)


@pytest.mark.parametrize("price", [1e-4, 0.003, 0.01, 0.03])
def test_a_plant_gets_the_time_that_is_worth_most_beyond_what_it_costs(price):
    for chance in (0.01, 0.2, 0.9):
        gain, time = best_time.py_func(TIMES, chance, price)
        each = TIMES.detects * chance - price * TIMES.stop_s
        assert gain == pytest.approx(each.max())
        assert time == each.argmax()


def test_the_most_in_a_block_is_remembered_until_it_is_marked_as_changed():
    grid = rectangle(3, BLOCK)
    chance = np.random.default_rng(1).random(3 * BLOCK)
    scene = scene_with(grid, chance)
    belief, rows, *_ = workspace(scene, ONE_TIME)
    for block in range(3):
        assert most(belief, rows, block) == chance[block * BLOCK : (block + 1) * BLOCK].max()
    belief.chance[BLOCK] = 2.0
    assert most(belief, rows, 1) < 2.0
    rows.most[1] = -1.0
    assert most(belief, rows, 1) == 2.0


@pytest.mark.parametrize("changed", [BLOCK - 2, BLOCK - 1, BLOCK, 2 * BLOCK - 1])
def test_a_plant_that_changed_changes_what_the_next_is_worth_after_it_too(changed):
    grid = rectangle(1, 2 * BLOCK)
    scene = scene_with(grid, np.random.default_rng(1).uniform(0.1, 0.5, 2 * BLOCK))
    belief, rows, *_ = workspace(scene, ONE_TIME, 0.3)
    plants = range(2 * BLOCK)

    def values(rows):
        known = [most(belief, rows, block) for block in range(2)]
        return known, rows.value.copy(), [after_clean(belief, rows, i) for i in plants]

    before = values(rows)
    belief.chance[changed] *= 0.5
    mark_changed.py_func(scene.aisles.travel, rows, changed)
    anew = rows._replace(most=np.full_like(rows.most, -1.0), value=rows.value.copy(),
                         after_clean=rows.after_clean.copy())  # fmt: skip
    now, wanted = values(rows), values(anew)
    for mine, theirs in zip(now, wanted, strict=True):
        np.testing.assert_array_equal(mine, theirs)
    # of its own, and of the next after it
    assert (np.flatnonzero(now[1] != before[1]) == changed).all()
    differ = np.flatnonzero(np.array(now[2]) != before[2])
    assert set(differ) == {changed, changed + 1} & set(plants)


@pytest.mark.parametrize("times", [ONE_TIME, QUICK, TIMES])
def test_no_plant_that_pays_by_a_rounding_is_passed_over(times):
    for price in (1e-4, 0.0031, 0.07):
        pays = _pays_from.py_func(times, price)
        # of what is just worth its seconds the best inspection gains nothing
        assert best_time.py_func(times, pays * (1.0 + 1e-6), price)[0] > 0.0
        assert best_time.py_func(times, pays, price)[0] < 0.0
