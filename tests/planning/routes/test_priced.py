"""Drives at a price: their bounds fall to one least price, and prices order time."""

from itertools import pairwise, product

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.planning.routes import priced as priced_room
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.relaxation import ladder_below
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles


@pytest.fixture(params=[(1, True), (2, True), (1, False), (2, False)])
def priced(request):
    faces, returns = request.param
    aisles = Aisles.of(rectangle(12, 15, Planting(faces=faces)))
    reward = np.random.default_rng(4).random(len(aisles.grid)) ** 2
    return Priced(ladder_below(aisles), reward, Robot(returns=returns))


_once = priced_room._once
PRICES = np.geomspace(1e-5, 0.03, 40)


def test_dearer_time_is_spent_less(priced):
    used = [priced.seconds(priced.best(price), price) for price in PRICES]
    assert (np.diff(used) <= 1e-6 * max(used)).all()


def test_a_free_drive_takes_every_plant(priced):
    assert priced.best(1e-9).reward == pytest.approx(priced.reward.sum())


def test_bounds_are_a_valley_over_the_price(priced):
    bounds = [
        priced.bound(priced.best(price), price, 3600.0) for price in np.linspace(1e-5, 0.02, 40)
    ]
    turns = np.diff(np.sign(np.diff(np.round(bounds, 9))))
    assert (turns >= 0).all()


def test_ways_that_can_be_driven_just_so_are_worth_no_more_than_those_granted(priced):
    price = 0.005
    offered = priced.ways(price)
    granted = priced.best(price)
    at = np.arange(len(granted.way)), granted.way
    worth = priced._room.worth.copy()
    granted_again = priced.best(price)
    assert granted_again.worth == granted.worth
    assert (offered.worth[at] <= priced._room.worth[at] + 1e-9).all()
    assert worth.shape == offered.worth.shape


@loop
def once(ladder, reward, state, turns):
    return _once(ladder, reward, state, turns)


@pytest.mark.parametrize("turn", [0.0, 0.2, 0.7])
def test_one_pass_is_worth_as_much_as_any_choice_of_stops_that_turns_for_each_change_of_side(turn):
    ladder = ladder_below(Aisles.of(rectangle(3, 5, Planting(faces=2))))
    k = int(np.argmax(np.diff(ladder.start)))
    inside = np.arange(ladder.start[k], ladder.start[k + 1])
    assert {*ladder.upper[inside].tolist()} == {False, True}
    reward, stop = np.random.default_rng(6).random(len(ladder.plant)), 0.3
    found = once(ladder, reward, (k, stop, 50.0), (turn, turn))
    best = 0.0
    for chosen in product((False, True), repeat=len(inside)):
        at = inside[list(chosen)]
        places = [ladder.upper[at[ladder.in_m[at] == here]] for here in np.unique(ladder.in_m[at])]
        turns = min(
            sum(one != other for one, other in pairwise(side for place in order for side in place))
            for order in product(*({tuple(each), tuple(each[::-1])} for each in places))
        )
        best = max(best, (reward[at] - stop).sum() - turn * turns)
    assert best - 1e-12 <= found <= np.maximum(reward[inside] - stop, 0.0).sum() + 1e-12


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("row", [1, 3, 8])
def test_a_kind_of_drive_begins_and_ends_in_its_own_stretches(row, returns):
    """All that pays is in one row: whoever begins below it or ends above it gets less."""
    grid = rectangle(12, 15)
    aisles = Aisles.of(grid, gate_xy_m=(-2.0, float(np.median(grid.lane_y_m))))
    reward = np.where(grid.row == row, 1.0, 0.0)
    priced = Priced(ladder_below(aisles), reward, Robot(returns=returns))
    worth, held = priced.kinds(1e-4)
    at = np.unravel_index(np.argmax(worth), worth.shape)
    assert worth[at] == pytest.approx(priced.best(1e-4).worth)
    assert held[at] == pytest.approx(reward.sum())
    assert min(worth.shape) > 3
    below, above = worth[: at[0] + 1, at[1]], worth[at[0], at[1] :]
    # the gate may lie where an aisle ends
    for less in (np.diff(below), -np.diff(above)):
        assert (less >= 0.0).all()
        assert (less < 1e-9).sum() <= 1
    # nor does it take what lies out of its stretches
    assert (worth[at[0] + 1 :] < worth[at]).all()
    assert (worth[:, : at[1]] < worth[at]).all()


def most_in_a_pass(places, costs):
    """Return the most that a pass by some places can gain: every way to take each is tried.

    A place ``(metres, lower, upper)`` gives what one side gains, what both do in either order, or
    all of it on a stretch that is driven three times: "T", and "S" where another stretch begins.
    """
    turn, least, twice_m = costs
    best = -np.inf
    for ways in product(("", "L", "U", "LU", "UL", "T", "S"), repeat=len(places)):
        gain, side, last = 0.0, "", None
        for way, (at, lower, upper) in zip(ways, places, strict=True):
            if way == "":
                last = None
            elif way in "TS":
                begins = way == "S" or last is None
                gain += lower + upper - (least if begins else twice_m * (at - last))
                last, side = at, ""
            else:
                gain += lower * ("L" in way) + upper * ("U" in way)
                gain -= turn * sum(one != other for one, other in pairwise(side + way))
                last, side = None, way[-1]
        best = max(best, gain)
    return best


@pytest.mark.parametrize(("turn", "twice_m"), [(0.05, 5.0), (0.3, 0.1), (0.5, 0.02), (0.8, 0.1)])
@pytest.mark.parametrize("seed", range(2))
def test_one_pass_is_worth_the_most_of_all_ways_to_stop_turn_and_drive_stretches_three_times(
    turn, twice_m, seed
):
    ladder = ladder_below(Aisles.of(rectangle(3, 4, Planting(faces=2))))
    k, stop, least = int(np.argmax(np.diff(ladder.start))), 0.2, 0.6 * turn
    inside = np.arange(ladder.start[k], ladder.start[k + 1])
    reward = np.random.default_rng(seed).random(len(ladder.plant))
    gain = np.maximum(reward - stop, 0.0)
    places = []
    for here in np.unique(ladder.in_m[inside]):
        upper = (ladder.in_m == here) & ladder.upper
        lower = (ladder.in_m == here) & ~ladder.upper
        sides = (gain[inside][each[inside]].sum() for each in (lower, upper))
        places.append((here, *sides))
    found = once(ladder, reward, (k, stop, twice_m / 2), (turn, least))
    assert found == pytest.approx(most_in_a_pass(places, (turn, least, twice_m)))
