"""The best tour over the rows, against all tours that there are."""

from itertools import combinations, product

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import GATE
from fieldmon.samplers.adaptive.arrays import NOWHERE, REACH, BestTours, RowTours
from fieldmon.samplers.adaptive.tours import best_from, extend_tours, measure_ways
from tests.samplers.adaptive.working import scene_with
from tests.thorough import seeds

N_ROWS = 4
GRID = rectangle(N_ROWS, 5)


@loop
def best_tour(travel, clock, rows, tours, start):
    here, own, price = start
    for down in range(2):
        extend_tours(clock, rows, tours, (down, own, price))
    return best_from(travel, clock, tours, here, price)


def rows_worth(rng):
    """Return rows of random worth, some of which do not pay one way or another."""
    rows = RowTours.of(len(GRID), N_ROWS, 1)
    rows.net[:] = rng.normal(0.5, 1.0, (N_ROWS, 4))
    rows.seconds[:] = rng.uniform(50, 200, (N_ROWS, 4))
    rows.last[:] = np.where(rng.random((N_ROWS, 4)) < 0.3, NOWHERE, 1)
    return rows


def tours_on(scene):
    tours = BestTours.of(scene.grid.n_rows)
    measure_ways(scene.aisles.travel, scene.clock, tours.next_s, tours.home_s)
    return tours


def ends_of(way):
    """Return the end by which a row is entered, and the one by which it is left."""
    return way % 2, (1 - way % 2) if way < 2 else way % 2


def value(scene, rows, here, tour, price):
    """Return net and seconds of a tour, rows with their ways in order, and home at its end."""
    m, clock = scene.aisles.travel.between_m, scene.clock
    gate = len(m) - 1
    net, seconds, at = 0.0, 0.0, here
    for row, way in tour:
        into, out = ends_of(way)
        drive_s = m[at, 2 * row + into] / clock.speed_m_s + clock.row_change_s
        net += rows.net[row, way] - price * drive_s
        seconds += drive_s + rows.seconds[row, way]
        at = 2 * row + out
    home_s = m[at, gate] / clock.speed_m_s if clock.returns else 0.0
    return net - price * home_s, seconds + home_s


def all_tours(rows, own):
    """Yield every way of driving some of the rows, one after the other up or down the plot."""
    others = [row for row in range(N_ROWS) if row != own]
    for k in range(N_ROWS + 1):
        for chosen in combinations(others, k):
            ways = [[w for w in range(4) if rows.last[row, w] >= 0] for row in chosen]
            for taken in product(*ways):
                tour = list(zip(chosen, taken, strict=True))
                yield tour
                yield tour[::-1]


@pytest.mark.parametrize("seed", seeds(4, 12))
@pytest.mark.parametrize("returns", [True, False])
def test_it_is_the_best_of_all_tours_up_and_down_the_plot(seed, returns):
    rng = np.random.default_rng(seed)
    scene = scene_with(GRID, np.full(len(GRID), 0.1), returns=returns)
    rows, price = rows_worth(rng), rng.uniform(0.0, 0.01)
    own = int(rng.integers(-1, N_ROWS))
    here = 2 * N_ROWS if own < 0 else 2 * own + int(rng.integers(2))
    net, seconds, _ = best_tour(
        scene.aisles.travel, scene.clock, rows, tours_on(scene), (here, own, price)
    )
    worth = [value(scene, rows, here, tour, price) for tour in all_tours(rows, own)]
    best = max(worth)
    assert net == pytest.approx(best[0])
    assert any(seconds == pytest.approx(s) for n, s in worth if n == pytest.approx(best[0]))


def test_where_nothing_pays_the_day_goes_home_at_once():
    scene = scene_with(GRID, np.full(len(GRID), 0.1))
    rows = RowTours.of(len(GRID), N_ROWS, 1)
    start = (3, -1, 0.01)
    net, seconds, onto = best_tour(scene.aisles.travel, scene.clock, rows, tours_on(scene), start)
    home_s = scene.aisles.travel.between_m[3, -1] / scene.clock.speed_m_s
    assert (seconds, onto[1]) == (pytest.approx(home_s), NOWHERE)
    assert net == pytest.approx(-0.01 * home_s)


def test_the_ways_of_the_day_are_those_of_the_plot():
    grid = rectangle(9, 4)
    scene = scene_with(grid, np.full(len(grid), 0.1))
    tours, m = tours_on(scene), scene.aisles.travel.between_m
    speed = scene.clock.speed_m_s
    assert tours.home_s.ravel() * speed == pytest.approx(m[:-1, -1])
    for row, end, k, other_end in product(range(9), range(2), range(REACH), range(2)):
        for down, other in ((0, row + 1 + k), (1, row - 1 - k)):
            if 0 <= other < 9:
                way_s = tours.next_s[down, row, end, k, other_end]
                assert way_s * speed == pytest.approx(m[2 * row + end, 2 * other + other_end])


def test_who_does_not_return_need_not_think_of_the_way_home():
    scene = scene_with(GRID, np.full(len(GRID), 0.1), returns=False)
    assert (tours_on(scene).home_s == 0.0).all()
    assert GATE < 0


def test_the_ways_measured_are_those_of_the_table_from_every_lane_end():
    scene = scene_with(GRID, np.full(len(GRID), 0.1), 2.0, returns=True)
    tours, between_m = tours_on(scene), scene.aisles.travel.between_m
    for row, end in product(range(N_ROWS), range(2)):
        home_s = between_m[2 * row + end, -1] / scene.clock.speed_m_s
        assert tours.home_s[row, end] == pytest.approx(home_s)
        for other, other_end in product(range(N_ROWS), range(2)):
            if other != row:
                down, step = int(other < row), abs(other - row) - 1
                way_s = between_m[2 * row + end, 2 * other + other_end] / scene.clock.speed_m_s
                assert tours.next_s[down, row, end, step, other_end] == pytest.approx(way_s)


@pytest.mark.parametrize("returns", [True, False])
def test_the_ways_measured_reach_six_rows_to_either_side_and_no_further(returns):
    n_rows = 2 * REACH + 3
    grid = rectangle(n_rows, 2)
    scene = scene_with(grid, np.full(len(grid), 0.1), 2.0, returns=returns)
    between_m, speed_m_s = scene.aisles.travel.between_m, scene.clock.speed_m_s
    next_s, home_s = np.full((2, n_rows, 2, REACH, 2), np.nan), np.full((n_rows, 2), np.nan)
    measure_ways(scene.aisles.travel, scene.clock, next_s, home_s)
    told = np.full_like(next_s, np.nan)
    for row, other, end, to in product(range(n_rows), range(n_rows), range(2), range(2)):
        if 0 < abs(other - row) <= REACH:
            way_s = between_m[2 * row + end, 2 * other + to] / speed_m_s
            told[int(other < row), row, end, abs(other - row) - 1, to] = way_s
    np.testing.assert_allclose(next_s, told)
    to_gate_s = between_m[:-1, -1].reshape(n_rows, 2) / speed_m_s
    np.testing.assert_allclose(home_s, to_gate_s if returns else 0.0)
