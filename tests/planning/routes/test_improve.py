"""Mending stops: they fit, none is made twice, and nothing that fits is left out."""

from itertools import combinations, combinations_with_replacement, pairwise

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.planning.routes import improve
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


_leave_out, _fill = improve._leave_out, improve._fill


@loop
def left_out(travel, clock, tour, reward, seconds):
    _leave_out(travel, clock, tour, reward, seconds)


@loop
def filled(travel, clock, tour, reward, least):
    _fill(travel, clock, tour, reward, least)


_move = improve._move


@loop
def moved(travel, clock, tour):
    return _move(travel, clock, tour)


@pytest.mark.parametrize("returns", [True, False])
def test_where_stops_of_an_aisle_are_made_elsewhere_the_drive_is_shorter(returns):
    """Turned round too, where that is what makes it so."""
    aisles, robot = Aisles.of(rectangle(6, 9)), Robot(returns=returns)
    clock, rng, n_moved = robot_clock(robot, 1e6), np.random.default_rng(5), 0
    for _ in range(30):
        runs = [9 * row + np.sort(rng.permutation(9)[:3])[:: rng.choice([1, -1])]
                for row in rng.permutation(6)[:4]]  # fmt: skip
        tour = Tour.of(np.concatenate(runs), 54)
        before = tour.stops
        did = moved(aisles.travel, clock, tour)
        assert sorted(tour.stops.tolist()) == sorted(before.tolist())
        shorter_s = used_s(aisles, robot, before) - used_s(aisles, robot, tour.stops)
        assert shorter_s > 0.0 if did else tour.stops.tolist() == before.tolist()
        n_moved += did
    assert n_moved > 5


def runs_of(aisles, stops):
    """Return where stops in one aisle begin, and where all end."""
    aisle = aisles.grid.corridor[aisles.grid.row[stops]]
    return [0, *(np.flatnonzero(np.diff(aisle)) + 1).tolist(), len(stops)]


@pytest.mark.parametrize("faces", [1, 2])
@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("seed", range(4))
def test_no_stretch_turned_round_and_no_aisle_s_stops_elsewhere_would_shorten_the_drive(
    faces, returns, seed
):
    """Stretches between changes of aisle; stops in one aisle before any others, turned or not."""
    aisles = Aisles.of(rectangle(5, 4, Planting(faces=faces)))
    robot, rng, n = Robot(returns=returns), np.random.default_rng(seed), len(aisles.grid)
    stops = rng.permutation(n)[:10]
    tour = Tour.of(stops, n)
    held = fit(aisles.travel, robot_clock(robot, used_s(aisles, robot, stops)), tour,
               np.where(np.isin(np.arange(n), stops), 1.0, 0.0), 0.5)  # fmt: skip
    best = tour.stops
    assert held == 10.0
    assert sorted(best.tolist()) == sorted(stops.tolist())
    took_s, cuts = used_s(aisles, robot, best), runs_of(aisles, best)
    assert took_s <= used_s(aisles, robot, stops) + 1e-9
    assert tour.used[0] == pytest.approx(took_s)
    for a, b in combinations(cuts, 2):
        turned = np.concatenate([best[:a], best[a:b][::-1], best[b:]])
        assert used_s(aisles, robot, turned) >= took_s - 1e-6
    for a, b in pairwise(cuts):
        rest, own = np.delete(best, range(a, b)), best[a:b]
        for k in {cut if cut <= a else cut - (b - a) for cut in cuts}:
            for way in (own, own[::-1]):
                assert used_s(aisles, robot, np.insert(rest, k, way)) >= took_s - 1e-6


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("seed", range(4))
def test_what_is_left_out_is_always_the_stop_that_holds_least_for_the_seconds_it_saves(
    returns, seed
):
    aisles = Aisles.of(rectangle(4, 5, Planting(faces=2)))
    robot, rng, n = Robot(returns=returns), np.random.default_rng(seed), len(aisles.grid)
    stops, reward = rng.permutation(n)[:9], rng.uniform(0.1, 1.0, n)
    seconds = rng.uniform(0.2, 0.8) * used_s(aisles, robot, stops)
    tour = Tour.of(stops, n)
    tour.used[0] = used_s(aisles, robot, stops)
    left_out(aisles.travel, robot_clock(robot, 1.0), tour, reward, seconds)
    while used_s(aisles, robot, stops) > seconds:
        less_s = [used_s(aisles, robot, np.delete(stops, k)) for k in range(len(stops))]
        saved_s = used_s(aisles, robot, stops) - np.array(less_s)
        stops = np.delete(stops, np.argmin(reward[stops] / saved_s))
    assert tour.stops.tolist() == stops.tolist()
    assert np.flatnonzero(tour.visited).tolist() == sorted(stops.tolist())
    assert tour.used[0] == pytest.approx(used_s(aisles, robot, stops))


def places_of(aisles, robot, stops, plant):
    """Return the least seconds that a plant adds, and all places where it adds no more."""
    aisle, own_s = aisles.grid.corridor[aisles.grid.row], used_s(aisles, robot, stops)
    found = []
    for k in range(len(stops) + 1):
        amid = 0 < k < len(stops) and aisle[stops[k - 1]] == aisle[stops[k]] != aisle[plant]
        if not amid:  # of another aisle's stops
            found.append((used_s(aisles, robot, np.insert(stops, k, plant)) - own_s, k))
    return min(found)[0], [k for more_s, k in found if more_s < min(found)[0] + 1e-6]


def ends_of(aisles, robot, stops, reward, seconds):
    """Yield all tours that may come of it, plant by plant: the most for the seconds it adds."""
    used, rates = used_s(aisles, robot, stops), []
    for plant in np.setdiff1d(np.flatnonzero(reward > 0.15), stops).tolist():
        more_s, places = places_of(aisles, robot, stops, plant)
        if used + more_s <= seconds:
            rates.append((reward[plant] / more_s, plant, places))
    if not rates:
        yield stops.tolist()
        return
    _, plant, places = max(rates)
    for place in places:
        longer = np.insert(stops, place, plant).astype(np.int64)
        yield from ends_of(aisles, robot, longer, reward, seconds)


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_what_is_put_in_is_always_the_plant_that_holds_most_for_the_seconds_it_adds(returns, seed):
    aisles = Aisles.of(rectangle(4, 4))
    rng, n = np.random.default_rng(seed), len(aisles.grid)
    # stops so long that three or four fit
    robot = Robot(returns=returns, stop_s=400.0)
    reward, stops = rng.uniform(0.0, 1.0, n), rng.permutation(n)[: rng.integers(0, 4)]
    seconds = used_s(aisles, robot, stops) + rng.uniform(3.2, 4.0) * robot.visit_s
    tour = Tour.of(stops, n)
    tour.used[0] = used_s(aisles, robot, stops)
    filled(aisles.travel, robot_clock(robot, seconds), tour, reward, 0.15)
    assert len(tour.stops) > len(stops)
    assert tour.stops.tolist() in [*ends_of(aisles, robot, stops, reward, seconds)]
    assert np.flatnonzero(tour.visited).tolist() == sorted(tour.stops.tolist())
    assert tour.used[0] == pytest.approx(used_s(aisles, robot, tour.stops))


_shorten = improve._shorten


@loop
def shortened(travel, clock, tour):
    _shorten(travel, clock, tour)


def turned_one_by_one(aisles, robot, stops):
    """Turn stretches between changes of aisle round, each that is shorter so, until none is."""
    stops, n = [*stops], len(stops)
    aisle = aisles.grid.corridor[aisles.grid.row]
    for _ in range(20):
        turned = False
        for a, b in combinations_with_replacement(range(n), 2):
            if (a > 0 and aisle[stops[a - 1]] == aisle[stops[a]]) or (
                b + 1 < n and aisle[stops[b]] == aisle[stops[b + 1]]
            ):
                continue
            other = [*stops[:a], *stops[a : b + 1][::-1], *stops[b + 1 :]]
            ends_s = used_s(aisles, robot, np.array(other)) - used_s(aisles, robot, np.array(stops))
            if ends_s < -improve._NOTICEABLE_S:
                stops, turned = other, True
        if not turned:
            break
    return stops


def moved_one_by_one(aisles, robot, stops):
    """Move each aisle's stops in turn to where the whole drive is shortest, turned round or not."""
    stops, n, a = [*stops], len(stops), 0
    aisle = aisles.grid.corridor[aisles.grid.row]
    while a < n:
        b = a
        while b + 1 < n and aisle[stops[b + 1]] == aisle[stops[b]]:
            b += 1
        run, found = stops[a : b + 1], []
        for k in range(n + 1):
            if a <= k <= b + 1 or (0 < k < n and aisle[stops[k - 1]] == aisle[stops[k]]):
                continue
            for way in (run, run[::-1]):
                others = [*stops[:a], *stops[b + 1 :]]
                at = k if k < a else k - len(run)
                other = [*others[:at], *way, *others[at:]]
                more_s = used_s(aisles, robot, np.array(other))
                found.append((round(more_s - used_s(aisles, robot, np.array(stops)), 6), other))
        least_s, best = min(found, key=lambda each: each[0], default=(0.0, stops))
        if least_s < -improve._NOTICEABLE_S:
            stops = best
        a = b + 1
    return stops


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_stretches_are_turned_and_aisles_moved_as_whole_drives_driven_one_by_one_have_it(
    returns, seed
):
    grid = rectangle(6, 7, Planting(faces=1 + seed % 2))
    # a gate beside no axis of the plot, so that hardly any two drives are as long
    aisles = Aisles.of(grid, gate_xy_m=(grid.lane_x_m.min() - 2.5, grid.lane_y_m.min() + 3.7))
    robot, rng = Robot(returns=returns, speed_m_s=0.37), np.random.default_rng(seed)
    clock, n = robot_clock(robot, 1e6), len(grid)
    stops = rng.permutation(n)[:9]
    if seed > 3:  # as in a drive, stops of an aisle one after the other
        aisle = grid.corridor[grid.row]
        stops = stops[np.lexsort((rng.permutation(9), rng.permutation(n)[aisle[stops]]))]
    tour = Tour.of(stops, n)
    shortened(aisles.travel, clock, tour)
    assert tour.stops.tolist() == turned_one_by_one(aisles, robot, stops)
    for _ in range(2):
        before = tour.stops
        did = moved(aisles.travel, clock, tour)
        expected = moved_one_by_one(aisles, robot, before)
        assert used_s(aisles, robot, tour.stops) == pytest.approx(
            used_s(aisles, robot, np.array(expected))
        )
        assert sorted(tour.stops.tolist()) == sorted(before.tolist())
        assert did == (used_s(aisles, robot, tour.stops) < used_s(aisles, robot, before) - 1e-9)
