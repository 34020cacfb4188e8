"""From drives on a ladder to stops: on a plain plot they take what the ladder says."""

from collections import Counter
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.planning.routes import frontier
from fieldmon.planning.routes.aisle_ways import Costs
from fieldmon.planning.routes.binned import proposals
from fieldmon.planning.routes.frontier import (
    END_LEFT,
    END_LEFT_AND,
    END_RIGHT,
    END_RIGHT_AND,
    FROM_BOTH,
    FROM_LEFT,
    FROM_RIGHT,
    GATE_CLOSED,
    GATE_OPEN,
    LEFT_BACK,
    ONCE,
    RIGHT_BACK,
    TWICE,
)
from fieldmon.planning.routes.priced import Drawn, Priced
from fieldmon.planning.routes.stops import _Chosen, _passes, stops_of
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.planning.routes.test_frontier import DRIVEN
from tests.planning.routes.test_improve import used_s
from tests.planning.routes.tiny import ladder_below


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("price", [0.0005, 0.003, 0.006, 0.009])
def test_on_a_plain_plot_a_drive_takes_the_ladders_time_and_reward(returns, price):
    aisles, robot = Aisles.of(rectangle(14, 11)), Robot(returns=returns)
    reward = np.random.default_rng(8).random(len(aisles.grid)) ** 2
    priced = Priced(ladder_below(aisles), reward, robot)
    drawn = priced.best(price)
    stops = stops_of(priced, drawn, np.full(len(drawn.way), price), robot)
    assert len(np.unique(stops)) == len(stops)
    assert reward[stops].sum() == pytest.approx(drawn.reward)
    took_s = used_s(aisles, robot, stops)
    # one of the ways to drive it may come by an aisle twice
    assert priced.seconds(drawn, price) - 1e-3 <= took_s
    assert took_s <= 1.05 * priced.seconds(drawn, price) + 2 * robot.row_change_s


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("price", [0.003, 0.006, 0.009])
def test_from_a_gate_in_the_middle_the_lowest_aisle_s_plants_are_taken_too(returns, price):
    grid, robot = rectangle(9, 11), Robot(returns=returns)
    aisles = Aisles.of(grid, gate_xy_m=(-4.0, float(np.median(grid.lane_y_m))))
    # in the lowest row only plants near its ends, so that it is not driven through
    reward = np.random.default_rng(8).random(len(grid)) ** 2
    reward[2:9] = 0.0
    reward[[0, 1, 9, 10]] = 0.9
    priced = Priced(ladder_below(aisles), reward, robot)
    assert priced.ladder.gate > 0
    drawn = priced.best(price)
    stops = stops_of(priced, drawn, np.full(len(drawn.way), price), robot)
    assert reward[stops].sum() == pytest.approx(drawn.reward)
    assert {0, 1, 9, 10} <= set(stops.tolist())


@pytest.mark.parametrize("returns", [True, False])
def test_proposals_take_about_the_hours(returns):
    aisles, robot = Aisles.of(rectangle(14, 11)), Robot(returns=returns)
    reward = np.random.default_rng(8).random(len(aisles.grid)) ** 2
    priced = Priced(ladder_below(aisles), reward, robot)
    made = list(proposals(priced, 0.006, 2500.0))
    assert made
    for drawn, prices in made:
        stops = stops_of(priced, drawn, prices, robot)
        assert reward[stops].sum() == pytest.approx(drawn.reward)
        assert used_s(aisles, robot, stops) == pytest.approx(2500.0, rel=0.15)


#: an aisle of ten places, on both its sides, below one of one place; both above the gate
PLACES = 10
UPPER = np.array([1, 0, 1, 1, 0, 0, 1, 0, 1, 0], bool)
WORTH = np.array([5.0, 4.0, 1.0, 6.0, 7.0, 3.0, 8.0, 2.0, 9.0, 5.5])


def chosen(way, cut, price=0.02, *, hangs=False, turn_s=0.0, parts=None):
    """Return who hands out the plants of one aisle, the third element, that is driven so."""
    ladder = SimpleNamespace(
        gate=0, start=np.array([0, 0, 0, PLACES, PLACES + 1]), upper=np.append(UPPER, True),
        plant=100 + np.arange(PLACES + 1), hangs=np.array([0, 0, int(hangs), 0]),
        across_m=np.array([0.0, 2.0, 2.0, 2.0]),
    )  # fmt: skip
    priced = SimpleNamespace(
        ladder=ladder,
        reward=np.append(WORTH, 99.0),
        costs=Costs(2.0, 100.0, 0.0, turn_s),
        parts=parts or {},
    )
    ways, cuts = np.zeros(4, np.int64), np.zeros((4, 4), np.int64)
    ways[2], cuts[2] = way, cut
    drawn = Drawn(0.0, 0.0, ways, cuts, np.zeros((4, 2), np.int64))
    return _Chosen(priced, drawn, np.array([0.0, 0.0, price, 0.0]), Robot())


def good(places, sides, price=0.02):
    """Return those of some places on sides (1 lower, 2 upper) that are worth their stop."""
    return [k for k in places if sides & (2 if UPPER[k] else 1) and WORTH[k] > 100.0 * price]


def in_and_out(places):
    """Return places as one comes by them: the upper side on the way in, the lower one back."""
    return [k for k in places if UPPER[k]] + [k for k in places[::-1] if not UPPER[k]]


def told(plants):
    return [int(p) - 100 for p in plants]


@pytest.mark.parametrize("sides", [1, 2, 3])
@pytest.mark.parametrize("deep", [0, 1, 4, 10])
def test_in_and_out_of_an_aisle_one_side_is_visited_on_the_way_in_the_other_on_the_way_out(
    sides, deep
):
    other = 3 if sides < 3 else 1
    from_left, from_right = list(range(deep)), list(range(PLACES - 1, PLACES - 1 - deep, -1))
    for way in (FROM_LEFT, FROM_BOTH, END_RIGHT_AND):
        of = chosen(way, (deep, PLACES, sides, other))
        places = good(from_left, sides)
        # on one side alone, they are visited on the way in
        expected = places if sides == 1 else in_and_out(places)
        assert told(of.excursion(2, 0)) == expected
        assert told(of.excursion(2, 0)) == []
    for way in (FROM_RIGHT, FROM_BOTH, END_LEFT_AND):
        of = chosen(way, (0, PLACES - deep, other, sides))
        places = good(from_right, sides)
        assert told(of.excursion(2, 1)) == (places if sides == 1 else in_and_out(places))
        assert told(of.excursion(2, 1)) == []
    for way, side in ((FROM_LEFT, 1), (FROM_RIGHT, 0), (ONCE, 0), (TWICE, 1), (END_LEFT, 0),
                      (END_LEFT_AND, 0), (END_RIGHT_AND, 1), (LEFT_BACK, 1)):  # fmt: skip
        assert told(chosen(way, (PLACES, 0, 3, 3)).excursion(2, side)) == []


def test_a_plant_is_visited_if_it_is_worth_more_than_its_stop_at_the_aisle_s_price():
    for price in (0.0, 0.03, 0.05, 0.085, 1.0):
        of = chosen(ONCE, (PLACES, PLACES, 3, 3), price)
        assert told(of.through(2, up=True)) == [k for k in range(PLACES) if WORTH[k] > 100 * price]


@pytest.mark.parametrize("way", [ONCE, TWICE, LEFT_BACK, RIGHT_BACK])
@pytest.mark.parametrize("up", [True, False])
def test_through_an_aisle_plants_are_visited_as_they_come_or_side_by_side_where_turns_cost_more(
    way, up
):
    """Six turns as they come; side by side one turn, and the aisle crossed twice."""
    as_they_come = [*range(PLACES)][:: 1 if up else -1]
    for turn_s, by_side in ((0.0, False), (1.33, False), (1.34, True), (9.0, True)):
        of = chosen(way, (PLACES, PLACES, 3, 3), 0.0, turn_s=turn_s)
        turns = np.count_nonzero(np.diff(UPPER.astype(int)))
        assert by_side == (turns * turn_s > turn_s + 2.0 * 2.0 * 2.0)
        lower = [k for k in as_they_come if not UPPER[k]]
        expected = [k for k in as_they_come if UPPER[k]] + lower if by_side else as_they_come
        assert told(of.through(2, up=up)) == expected
        assert told(of.through(2, up=up)) == []
    for other in (FROM_LEFT, FROM_BOTH, END_LEFT, END_RIGHT_AND):
        assert told(chosen(other, (PLACES, PLACES, 3, 3)).through(2, up=up)) == []


def test_where_the_day_ends_plants_are_visited_as_they_come_from_the_end_it_came_in_by():
    cut = (3, 6, 3, 3)
    for way in (END_LEFT, END_LEFT_AND):
        assert told(chosen(way, cut, 0.0).end(2)) == [0, 1, 2]
    for way in (END_RIGHT, END_RIGHT_AND):
        assert told(chosen(way, cut, 0.0).end(2)) == [9, 8, 7, 6]
    # of an aisle that hangs, both ends are one: all its plants, once
    for way, expected in ((END_LEFT, [0, 1, 2, 6, 7, 8, 9]), (END_RIGHT, [9, 8, 7, 6, 2, 1, 0])):
        of = chosen(way, cut, 0.0, hangs=True)
        assert told(of.end(2)) == expected
        assert told(of.end(2)) == []
    of = chosen(FROM_LEFT, cut, 0.0, hangs=True)
    assert told(of.excursion(2, 0)) == in_and_out([0, 1, 2, 6, 7, 8, 9])
    assert told(of.excursion(2, 1)) == []
    of = chosen(FROM_RIGHT, cut, 0.0, hangs=True)
    assert sorted(told(of.excursion(2, 1))) == [0, 1, 2, 6, 7, 8, 9]


def test_the_lowest_aisle_s_plants_are_visited_as_any_other_s():
    of = chosen(FROM_LEFT, (PLACES, PLACES, 3, 3), 0.0)
    of.priced.ladder.gate, of.priced.ladder.start[1:] = 1, PLACES
    of.drawn.way[0], of.drawn.cut[0] = FROM_LEFT, of.drawn.cut[2]
    assert told(of.excursion(0, 0)) == in_and_out(range(PLACES))


def test_a_part_that_hangs_is_visited_once_as_its_own_best_drive_has_it():
    class Part:
        def stops(self, price, *, ends):
            assert price == 0.02
            return np.array([7, 5]) if ends else np.array([5, 7])

    of = chosen(FROM_LEFT, (PLACES, PLACES, 3, 3), parts={2: Part()})
    assert of.excursion(2, 0).tolist() == [5, 7]
    assert of.excursion(2, 0).tolist() == []
    of = chosen(END_LEFT, (PLACES, PLACES, 3, 3), parts={2: Part()})
    assert of.end(2).tolist() == [7, 5]
    assert of.end(2).tolist() == []


def test_no_plants_are_at_the_gate_nor_before_it():
    of = chosen(ONCE, (PLACES, PLACES, 3, 3))
    assert told(of.excursion(-1, 0)) == told(of.excursion(0, 0)) == []
    of.drawn.way[:] = ONCE
    of.priced.ladder.start[:2] = 0, PLACES
    assert told(of.through(0, up=True)) == []


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("gate", [0, 1, 2])
def test_passes_are_those_of_each_way_of_the_gate_s_stubs_and_of_the_headlands(returns, gate):
    rng = np.random.default_rng(gate)
    ways = [name for name, driven in DRIVEN.items()
            if not returns or all(one[-1] in "LR" for one in driven)]  # fmt: skip
    stubs = GATE_CLOSED if returns else GATE_OPEN
    for _ in range(30):
        names, stub = rng.choice(ways, 4), int(rng.integers(4))
        way = np.array([int(getattr(frontier, name)) for name in names])
        way[gate] = stub
        up = np.vstack([rng.integers(0, 3, (3, 2)), [[0, 0]]])
        priced = SimpleNamespace(ladder=SimpleNamespace(gate=gate))
        expected = Counter({((-1, 0), (gate, side)): stubs[stub][side] for side in range(2)})
        for k, side in product(range(3), range(2)):
            expected[(k, side), (k + 1, side)] += int(up[k, side])
        for k, name in enumerate(names):
            for one in DRIVEN[name] if k != gate else ():
                ends = {(k, {"L": 0, "R": 1}.get(end, 2)) for end in (one[0], one[-1])}
                if len(ends) == 2:
                    expected[tuple(sorted(ends))] += 1
        made = _passes(priced, Drawn(0.0, 0.0, way, np.zeros((4, 4)), up), Robot(returns=returns))
        links = Counter((a, b) for a, ways_on in made._ways.items() for b, _ in ways_on if a < b)
        assert links == +expected
