"""What ways of driving an aisle are worth: one pass is worth its best choice of stops."""

from itertools import pairwise, product

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.planning.routes import aisle_ways
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import Aisles
from tests.planning.routes.tiny import ladder_below

_once = aisle_ways._once


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
