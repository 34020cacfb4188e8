"""What ways of driving an aisle are worth: one pass is worth its best choice of stops."""

from itertools import pairwise, product

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.planning.routes import aisle_ways, frontier
from fieldmon.planning.routes.priced import Priced
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
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


NEVER = (-np.inf, 0.0)


def ways_of_an_aisle(plants, across, costs, price):
    """Return worth and reward of each way of driving an aisle: all choices of stops are tried.

    Plants are ``(metres, upper, reward)`` from the left on. Both sides of an aisle cost a turn, or
    one more change of aisle; ONCE is given for one side, and for both in the order in which they
    come or one after the other: as it can be driven.
    """
    stop, change, turn = price * costs.stop_s, price * costs.change_s, price * costs.turn_s
    metre = price * costs.metre_s

    def gained(part, sides):
        taken = [(up, held) for _, up, held in part if held > stop and up in sides]
        both = min(turn, change) if len({up for up, _ in taken}) == 2 else 0.0
        worth = sum(held - stop for _, held in taken) - change - both
        return (worth, sum(held for _, held in taken)) if taken else NEVER

    def less(one, way):
        return one[0] - metre * way, one[1]

    def plus(one, other):
        return NEVER if NEVER in (one, other) else (one[0] + other[0], one[1] + other[1])

    every, n = ({False}, {True}, {False, True}), len(plants)
    into = [[(plants[k][0], gained(plants[: k + 1], sides)) for sides in every] for k in range(n)]
    back = [[(across - plants[k][0], gained(plants[k:], sides)) for sides in every]
            for k in range(n)]  # fmt: skip
    left, right = ([one for each in side for one in each] for side in (into, back))
    pairs = [(one, other) for k in range(n) for j in range(k + 1, n)
             for one in into[k] for other in back[j]]  # fmt: skip

    def best(one, twice):
        return max((less(w, twice * d) for d, w in one), default=NEVER)

    def best_of_two(twice, twice_back):
        return max((plus(less(a[1], twice * a[0]), less(b[1], twice_back * b[0]))
                    for a, b in pairs), default=NEVER)  # fmt: skip

    seen = [up for _, up, held in plants if held > stop]
    turns = sum(a != b for a, b in pairwise(seen))
    whole = gained(plants, every[2])
    in_order = whole[0] + min(turn, change) - min(turns * turn, turn + 2.0 * metre * across)
    one_side = [(0.0, 0.0), *(gained(plants, side) for side in every[:2])]
    found = dict.fromkeys(range(frontier.N_WAYS), NEVER)
    found |= {
        frontier.NOTHING: (0.0, 0.0),
        frontier.FROM_LEFT: best(left, 2.0),
        frontier.FROM_RIGHT: best(right, 2.0),
        frontier.FROM_BOTH: best_of_two(2.0, 2.0),
        frontier.ONCE: less(max([*one_side, (in_order, whole[1])] if turns else one_side), across),
        frontier.TWICE: less(max(*one_side, whole), 2.0 * across),
        frontier.END_LEFT: best(left, 1.0),
        frontier.END_RIGHT: best(right, 1.0),
        frontier.END_LEFT_AND: best_of_two(1.0, 2.0),
        frontier.END_RIGHT_AND: best_of_two(2.0, 1.0),
    }
    return found, less(whole, across) if turns else NEVER


def plants_of(priced, k):
    ladder = priced.ladder
    inside = range(ladder.start[k], ladder.start[k + 1])
    return [(float(ladder.in_m[i]), bool(ladder.upper[i]), float(priced.reward[i])) for i in inside]


def told(worth, reward):
    return [
        (w, r) if w > -1e200 else NEVER
        for w, r in zip(worth.tolist(), reward.tolist(), strict=True)
    ]


def held_by(priced, k, cut, price):
    """Return what the plants hold that a cut names: up to the first and from the second on."""
    ladder, stop = priced.ladder, price * priced.costs.stop_s
    held = 0.0
    for i in range(ladder.start[k], ladder.start[k + 1]):
        side = 2 if ladder.upper[i] else 1
        named = (i < cut[0] and cut[2] & side) or (i >= cut[1] and cut[3] & side)
        held += priced.reward[i] if named and priced.reward[i] > stop else 0.0
    return held


def short_aisles(seed, robot, plants=4):
    aisles = Aisles.of(rectangle(4, plants, Planting(faces=2)))
    reward = np.random.default_rng(seed).random(len(aisles.grid)) ** 2
    return Priced(ladder_below(aisles), reward, robot)


SLOW_TURNS, QUICK_TURNS, DEAR_SIDES = (
    Robot(row_change_s=8.0, turn_180_s=30.0, stop_s=2.0, look_s=20.0, speed_m_s=0.3),
    Robot(row_change_s=12.0, turn_180_s=1.0, stop_s=2.0, look_s=20.0, speed_m_s=0.3),
    Robot(row_change_s=60.0, turn_180_s=50.0, stop_s=2.0, look_s=5.0, speed_m_s=0.3),
)


@pytest.mark.parametrize("price", [0.001, 0.004, 0.012])
@pytest.mark.parametrize(
    "robot", [SLOW_TURNS, QUICK_TURNS, DEAR_SIDES], ids=["slow", "quick", "dear"]
)
@pytest.mark.parametrize("seed", range(3))
def test_each_way_of_driving_an_aisle_is_worth_the_most_of_all_its_choices_of_stops(
    price, robot, seed
):
    priced = short_aisles(seed, robot)
    ladder, offered = priced.ladder, priced.ways(price)
    priced.best(price)
    granted = priced._room
    backs = [frontier.LEFT_BACK, frontier.RIGHT_BACK]
    for k in range(len(ladder.across_m)):
        if k == ladder.gate:
            continue
        across = float(ladder.across_m[k])
        asked, back = ways_of_an_aisle(plants_of(priced, k), across, priced.costs, price)
        expected = [asked[way] for way in range(frontier.N_WAYS)]
        for (worth, reward), one in zip(
            told(offered.worth[k], offered.reward[k]), expected, strict=True
        ):
            assert worth == pytest.approx(one[0])
            assert reward == pytest.approx(one[1])
        for way in range(frontier.N_WAYS):
            held = held_by(priced, k, offered.cut[k, way].tolist(), price)
            assert offered.reward[k, way] == pytest.approx(held)
        # as granted, one pass is worth more, and one side is for the way back to where a day ends
        given = told(granted.worth[k], granted.reward[k])
        assert given[frontier.ONCE][0] >= expected[frontier.ONCE][0] - 1e-12
        for way in range(frontier.N_WAYS):
            if way in backs:
                assert given[way] == pytest.approx(back)
            elif way != frontier.ONCE:
                assert given[way] == pytest.approx(expected[way])


def test_one_pass_as_granted_is_worth_what_its_choices_of_stops_are_less_the_way_through():
    price = 0.002
    priced = short_aisles(5, QUICK_TURNS)
    ladder, costs = priced.ladder, priced.costs
    priced.best(price)
    twice_m, turn = 2.0 * price * costs.metre_s, price * min(costs.turn_s, costs.change_s)
    for k in range(1, len(ladder.across_m)):
        plants = plants_of(priced, k)
        if k == ladder.gate or len({up for _, up, _ in plants}) < 2:
            continue
        places = []
        for at in sorted({at for at, _, _ in plants}):
            gains = [sum(max(held - price * costs.stop_s, 0.0) for here, up, held in plants
                         if here == at and up == side) for side in (False, True)]  # fmt: skip
            places.append((at, *gains))
        most = most_in_a_pass(places, (price * costs.turn_s, turn, twice_m))
        less = price * (costs.change_s + costs.metre_s * ladder.across_m[k])
        assert priced._room.worth[k, frontier.ONCE] == pytest.approx(most - less)


@pytest.mark.parametrize("side", [0, 1])
def test_an_aisle_that_hangs_is_driven_in_and_out_by_its_headland_as_is_best(side):
    priced = short_aisles(2, QUICK_TURNS)
    k = 2
    free = priced.ways(0.003)
    hangs = priced.ladder.hangs.copy()
    hangs[k] = side + 1
    hung = Priced(priced.ladder._replace(hangs=hangs), priced.of_all, QUICK_TURNS).ways(0.003)
    ends = np.arange(frontier.N_WAYS) >= frontier.END_LEFT
    own = {
        int((frontier.FROM_LEFT, frontier.FROM_RIGHT)[side]): ~ends,
        int((frontier.END_LEFT, frontier.END_RIGHT)[side]): ends,
    }
    for way in range(1, frontier.N_WAYS):
        if way not in own:
            assert hung.worth[k, way] < -1e200
            continue
        among = np.flatnonzero(own[way] & (np.arange(frontier.N_WAYS) > 0))
        best = among[np.argmax(free.worth[k, among])]
        assert hung.worth[k, way] == free.worth[k, best]
        assert hung.reward[k, way] == free.reward[k, best]
        assert hung.cut[k, way].tolist() == free.cut[k, best].tolist()
    assert hung.worth[k, 0] == 0.0
    others = np.arange(len(hangs)) != k
    assert (hung.worth[others] == free.worth[others]).all()
