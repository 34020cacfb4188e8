"""Several ladders for parts that lie apart: each is a bound, and closer than one ladder."""

from itertools import pairwise, permutations, product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon, box

from fieldmon.planning.routes import best, blocks, bound
from fieldmon.planning.routes.best_route import upper_bound
from fieldmon.planning.routes.blocks import (
    _MOST_BLOCKS,
    _NEAR_M,
    Blocks,
    _apart_m,
    _gate,
    _order,
    _tours,
    _way_out,
    blockings,
)
from fieldmon.planning.routes.ladders import Ladders
from fieldmon.planning.routes.pendant_parts import ladder_with_parts
from fieldmon.planning.routes.priced import Priced
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from tests.planning.routes.test_best_route import ROBOTS, crooked_aisles, rewards
from tests.planning.routes.tiny import no_line_above
from tests.thorough import seeds


def below(aisles, reward, robot):
    """Return everything that a plot is taken for."""
    ladders = Ladders(aisles)
    whole = [ladders.whole(hanging=hanging) for hanging in (False, True)]
    blocks = [Blocks(ladders, block, reward, robot) for block in blockings(ladders.rungs)]
    hanging = [
        ladder_with_parts(ladders, block, reward, robot) for block in blockings(ladders.rungs)
    ]
    return [*(Priced(ladder, reward, robot) for ladder in whole), *blocks, *hanging]


@given(st.data())
def test_at_no_price_is_any_route_worth_more_than_the_best_drive(data):
    aisles = data.draw(crooked_aisles(max_radius_m=80.0, max_plants=500))
    robot = data.draw(ROBOTS)
    reward = data.draw(rewards(len(aisles.grid)))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    price = float(reward.max()) / robot.visit_s * data.draw(st.floats(0.001, 0.9))
    everything = below(aisles, reward, robot)
    most = [one.best(price).worth + price * robot.row_change_s for one in everything]
    for n in rng.integers(1, len(reward) + 1, 12):
        route = rng.permutation(len(reward))[:n]
        if rng.random() < 0.7:
            # aisle by aisle, which a price likes better
            route = np.sort(route)
        back = [GATE] if robot.returns else []
        places = np.concatenate([[GATE], route, back]).astype(np.int64)
        used_s = float(driven_s(aisles.travel, robot_clock(robot, 1.0), places)) + n * robot.visit_s
        worth = reward[route].sum() - price * used_s
        assert all(worth <= one + 1e-6 * max(1.0, abs(one)) for one in most)


def far_apart():
    """Return two parts beside each other, with a way of 300 m between them."""
    area = Frame(35.15, 30.36).geometry_lonlat(
        MultiPolygon([box(-200, -30, -150, 30), box(150, -30, 200, 30)])
    )
    return Aisles.of(lay(Field("apart", area), Planting(row_bearing_deg=90.0)))


@pytest.mark.parametrize("returns", [True, False])
def test_two_parts_far_apart_are_bound_more_closely_by_two_ladders_than_by_one(returns):
    aisles, robot = far_apart(), Robot(hours=1.0, returns=returns)
    reward = np.random.default_rng(2).random(len(aisles.grid))
    one, _, two, on_another = (
        upper_bound(each, robot.day_s).value for each in below(aisles, reward, robot)
    )
    assert two < one
    assert bound(aisles, reward, robot) == min(one, two, on_another)


@pytest.mark.parametrize("returns", [True, False])
def test_a_route_through_both_parts_drives_there_once_and_back(returns):
    aisles, robot = far_apart(), Robot(hours=3.0, returns=returns)
    reward = np.random.default_rng(2).random(len(aisles.grid)) ** 4
    route = best(aisles, reward, robot)
    part = aisles.grid.xy_m[route.plant, 0] > aisles.grid.xy_m[:, 0].mean()
    assert sum(a != b for a, b in pairwise(part.tolist())) <= 2
    assert route.gap < 0.05


@pytest.mark.parametrize("returns", [True, False])
def test_a_price_for_each_set_of_parts_bounds_no_less_sharply_than_one_for_all(returns):
    """At one price a drive half-way between two sets seems possible, which does not exist."""
    aisles, robot = far_apart(), Robot(hours=0.6, returns=returns)
    reward = np.random.default_rng(1).beta(0.3, 3.0, len(aisles.grid))
    ladders = Ladders(aisles)
    (block, *_) = blockings(ladders.rungs)
    parts = Blocks(ladders, block, reward, robot)
    highest = float(reward.max()) / robot.visit_s
    prices = highest / 1.1 ** np.arange(150)
    at_one = min(parts.bound(parts.best(p), p, robot.day_s) for p in prices)
    middle = float(min(prices, key=lambda p: parts.bound(parts.best(p), p, robot.day_s)))
    by_set = parts.bound_by_kind(robot.day_s, middle, np.inf)
    assert best(aisles, reward, robot).reward <= by_set <= at_one * (1 + 1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_two_aisles_in_different_blocks_lie_further_apart_than_any_step_within_one(seed):
    """At each way of taking them together, steps of one length lead to all of a block."""
    rng = np.random.default_rng(seed)
    at = np.cumsum(rng.choice([2.0, 9.0, 45.0, 70.0, 130.0, 300.0], 13))
    metres = np.abs(at[:, None] - at)
    # the nearest ends may be any of four, and a way there need not be a way back
    apart_m = metres + rng.uniform(0.0, 500.0, (2, 2, 13, 13))
    low, high = np.triu_indices(13, 1)
    ends = rng.integers(0, 2, (2, len(low)))
    apart_m[*ends, low, high] = metres[low, high]
    apart_m[:, :, range(13), range(13)] = np.inf
    apart_m = np.pad(apart_m, ((0, 0), (0, 0), (0, 1), (0, 1)), constant_values=1.0)  # the gate
    found = [block.tolist() for block in blockings(SimpleNamespace(apart_m=apart_m))]
    told = []
    for cut_m in np.unique(np.diff(at)[np.diff(at) > _NEAR_M]):
        block = np.concatenate([[0], np.cumsum(np.diff(at) >= cut_m)])
        told += [block] if 1 < block[-1] + 1 <= _MOST_BLOCKS else []
    assert len(found) == len(told)
    assert told or seed
    for one, other in zip(found, told, strict=True):
        same = np.array(one)[:, None] == np.array(one)
        assert (same == (other[:, None] == other)).all()


def test_two_aisles_that_lie_apart_are_two_blocks_and_two_that_touch_are_none():
    def blocks_at(metres):
        apart_m = np.full((2, 2, 3, 3), metres)
        return [block.tolist() for block in blockings(SimpleNamespace(apart_m=apart_m))]

    (block,) = blocks_at(400.0)
    assert sorted(block) == [0, 1]
    assert blocks_at(3.0) == []


def some_rungs(seed, n=5):
    """Return rungs, and the three blocks that they are in."""
    rng = np.random.default_rng(seed)
    apart_m = rng.uniform(1.0, 40.0, (2, 2, n + 1, n + 1)) + 250.0 * rng.integers(0, 2, n + 1)
    if seed == 0:
        apart_m[0, 1, 0, 1] = apart_m[1, 0, 2, -1] = 0.0
    apart_m[:, :, range(n + 1), range(n + 1)] = np.inf
    # the gate's two ends are one, and as far from here as here from there
    apart_m[:, 1, :, -1] = apart_m[:, 0, :, -1]
    apart_m[0, :, -1] = apart_m[1, :, -1] = apart_m[:, 0, :, -1]
    block = np.append([0, 1, 2], rng.integers(0, 3, n - 3))
    return SimpleNamespace(apart_m=apart_m, up=rng.permutation(n) * 10.0), block


@pytest.mark.parametrize("seed", seeds(4, 12))
def test_ways_between_blocks_are_what_is_left_of_the_shortest_round_by_others_too(seed):
    rungs, block = some_rungs(seed)
    n, gate = len(block), 3
    out = _way_out(rungs, block)
    for side, k in product(range(2), range(n)):
        outside = [rungs.apart_m[side, other, k, j] for other in range(2) for j in range(n)
                   if block[j] != block[k]]  # fmt: skip
        to_gate = rungs.apart_m[side, 0, k, -1]
        assert out[side, k] == pytest.approx(min(0.5 * min(outside), to_gate))
        assert out[side, k] <= min(0.5 * min(outside), to_gate)
    metres = _apart_m(rungs, block, out)
    left = np.full((gate + 1, gate + 1), np.inf)
    for a, b, i, j in product(range(2), range(2), range(n), range(n)):
        if block[i] != block[j]:
            way = max(rungs.apart_m[a, b, i, j] - out[a, i] - out[b, j], 0.0)
            for one, other in ((block[i], block[j]), (block[j], block[i])):
                left[one, other] = min(left[one, other], way)
    for a, i in product(range(2), range(n)):
        way = max(rungs.apart_m[a, 0, i, -1] - out[a, i], 0.0)
        left[block[i], gate] = left[gate, block[i]] = min(left[gate, block[i]], way)
    for a, b in product(range(gate + 1), repeat=2):
        if a == b:
            assert metres[a, b] == 0.0
            continue
        between = [k for k in range(gate + 1) if k not in (a, b)]
        ways = [(a, *middle, b) for n_by in range(3) for middle in permutations(between, n_by)]
        shortest = min(sum(left[i, j] for i, j in pairwise(way)) for way in ways)
        assert metres[a, b] == pytest.approx(shortest, abs=1e-6)
    for k in range(3):
        own = np.flatnonzero(block == k)
        to_gate, up = _gate(rungs, own, out)
        assert (to_gate == out[:, own]).all()
        assert up == rungs.up[own[np.argmin(out[:, own].min(axis=0))]]


@pytest.mark.parametrize("seed", range(3))
def test_ways_through_each_set_of_blocks_are_the_shortest_of_all_orders(seed):
    n = 4
    metres = np.random.default_rng(seed).uniform(1.0, 100.0, (n + 1, n + 1))
    metres = metres + metres.T
    tours = _tours(metres)

    def length(order, home):
        return sum(metres[i, j] for i, j in pairwise([n, *order, *([n] if home else [])]))

    assert tours.closed_m[0] == 0.0
    assert _order(tours, 0, -1) == []
    for chosen in range(1, 1 << n):
        orders = [*permutations([k for k in range(n) if chosen >> k & 1])]
        assert tours.closed_m[chosen] == pytest.approx(min(length(one, True) for one in orders))
        assert length(_order(tours, chosen, -1), False) == pytest.approx(
            min(length(one, False) for one in orders)
        ) or length(_order(tours, chosen, -1), True) == pytest.approx(tours.closed_m[chosen])
        for last in range(n):
            ends = [length(one, False) for one in orders if one[-1] == last]
            assert tours.open_m[chosen, last] == pytest.approx(min(ends, default=np.inf))
            if ends:
                order = _order(tours, chosen, last)
                assert sorted(order) == sorted(orders[0])
                assert order[-1] == last
                assert length(order, False) == pytest.approx(min(ends))


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("first", [0.05, 0.3, 1.0])
def test_the_part_in_which_most_time_is_won_is_driven_for_what_the_others_leave(
    returns, first, monkeypatch
):
    aisles, robot = far_apart(), Robot(hours=0.9, returns=returns)
    reward = np.random.default_rng(2).random(len(aisles.grid))
    west = aisles.grid.xy_m[:, 0] < aisles.grid.xy_m[:, 0].mean()
    reward = np.where(west, first * (reward > 0.95), reward**6)
    ladders = Ladders(aisles)
    (block, *_) = blockings(ladders.rungs)
    parts, asked = Blocks(ladders, block, reward, robot), []
    monkeypatch.setattr(blocks, "proposals", lambda *told: asked.append(told) or ())
    sets, n_asked = ((1, 0), (2, 0 if returns else 1), (3, 0)), 0
    for (chosen, last), high in product(sets, (0.003, 0.01)):
        low = high / 5
        short, long = (parts._through(chosen, last, price) for price in (high, low))
        asked.clear()
        (stops,) = parts._between(short, long, (low, high), robot.day_s)
        assert stops.tolist() == parts.stops(short, high).tolist()

        def seconds(drives, price):
            return [(drive.reward - drive.worth) / price for _, _, drive in drives]

        took_s, takes_s = seconds(short.drives, high), seconds(long.drives, low)
        k = int(np.argmax(np.subtract(takes_s, took_s)))
        number, ends, _ = short.drives[k]
        way_m = parts.tours.closed_m[chosen] if returns else parts.tours.open_m[chosen, last]
        others_s = sum(took_s) - took_s[k] + way_m / robot.speed_m_s
        left_s = robot.day_s + robot.row_change_s - others_s
        assert len(asked) == (left_s > 0.0 and takes_s[k] > 0.0)
        if not asked:
            continue
        n_asked += 1
        (told,) = asked
        assert told[0] is (parts.open if ends else parts.closed)[number]
        assert told[1] == low
        # a first change of aisle is charged to each that none pays
        assert told[2] == pytest.approx(left_s)
    assert n_asked >= 3


def three_parts(returns, n_parts=3):
    """Return blocks, one a part, of plots 60 m apart."""
    boxes = [box(x, y, x + 18, y + 14) for x, y in ((0, 0), (80, 5), (20, 70), (90, 80))[:n_parts]]
    area = Frame(35.15, 30.36).geometry_lonlat(MultiPolygon(boxes))
    aisles = Aisles.of(lay(Field("parts", area), Planting(row_bearing_deg=90.0)))
    ladders = Ladders(aisles)
    (block,) = [one for one in blockings(ladders.rungs) if one.max() + 1 == n_parts]
    reward = np.random.default_rng(4).random(len(aisles.grid)) ** 2
    metres = _apart_m(ladders.rungs, block, _way_out(ladders.rungs, block))
    return Blocks(ladders, block, reward, Robot(returns=returns)), metres


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("price", [0.0005, 0.002, 0.004, 0.008, 0.5])
def test_the_best_drive_is_that_of_all_sets_of_blocks_in_all_orders(returns, price):
    """What each block is worth alone, the last of a one-way day without a way back."""
    below, metres = three_parts(returns)
    n, a_metre = 3, price * below.costs.metre_s
    closed = [each.best(price) for each in below.closed]
    opened = [each.best(price) for each in below.open]
    every = {(): (0.0, 0.0)}
    for size in range(1, n + 1):
        for order in permutations(range(n), size):
            drawn = [closed[k] for k in order[:-1]] + [(closed if returns else opened)[order[-1]]]
            stops = [n, *order, *([n] if returns else [])]
            way_m = sum(metres[i, j] for i, j in pairwise(stops))
            worth = sum(one.worth for one in drawn) - a_metre * way_m
            every[order] = worth, sum(one.reward for one in drawn)
    found = below.best(price)
    best_order = max(every, key=lambda order: every[order][0])
    assert found.worth == pytest.approx(every[best_order][0])
    assert found.reward == pytest.approx(every[best_order][1])
    assert {k for k, _, _ in found.drives} == {*best_order}
    assert [ends for _, ends, _ in found.drives] == [
        not returns and k == len(best_order) - 1 for k in range(len(best_order))
    ]
    # the best of a set, by the block it ends in; of kinds of drives, too
    kinds_worth, kinds_reward = below._kinds(price)
    for chosen, last in np.ndindex(kinds_worth.shape[:2]):
        own = [k for k in range(n) if chosen >> k & 1]
        orders = [order for order in every if sorted(order) == own
                  and (returns or not order or order[-1] == last)]  # fmt: skip
        if orders:
            most = max(every[order][0] for order in orders)
            assert kinds_worth[chosen, last].max() == pytest.approx(most)
            k = int(kinds_worth[chosen, last].argmax())
            # as much in as many seconds, or a drive that is worth the same
            through = below._through(chosen, last, price)
            assert through.worth == pytest.approx(most)
            assert kinds_reward[chosen, last, k] == pytest.approx(through.reward)
        else:
            assert (kinds_worth[chosen, last] == -np.inf).all()
    took_s = (found.reward - found.worth) / price - below.costs.change_s
    assert below.seconds(found, price) == pytest.approx(took_s)
    for seconds in (500.0, 2000.0):
        expected = max(found.worth + price * (seconds + below.costs.change_s), 0.0)
        assert below.bound(found, price, seconds) == pytest.approx(expected)


@pytest.mark.parametrize("returns", [True, False])
def test_a_bound_by_kinds_is_no_less_than_any_drive_of_these_hours(returns):
    below, _ = three_parts(returns, 4)
    for price in (0.002, 0.004):
        for found in (below.best(price), below._through(5, 0 if returns else 2, price)):
            seconds = below.seconds(found, price)
            least = below.bound_by_kind(seconds, price, np.inf)
            assert found.reward <= least * (1 + 1e-9)
            assert least <= below.bound(below.best(price), price, seconds) * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_no_drive_of_a_kind_is_worth_more_at_any_price_than_the_kind(seed):
    """However dear time is, on each ladder: alone, hanging, of each part, or with parts on it."""
    rng = np.random.default_rng(seed)
    area = MultiPolygon([box(0, 0, 25, 20), box(50, 4, 80, 14), box(4, 60, 30, 75)])
    area = area.difference(box(8, 6, 14, 14))
    field = Field("parts", Frame(35.15, 30.36).geometry_lonlat(area))
    aisles = Aisles.of(
        lay(field, Planting(row_bearing_deg=90.0, faces=1 + seed % 2)),
        tuple(rng.uniform((-20.0, -20.0), (40.0, 40.0))),
    )
    reward = np.zeros(len(aisles.grid))
    reward[rng.permutation(len(reward))[:12]] = rng.random(12)
    robot = Robot(returns=seed < 3, row_change_s=(0.0, 20.0)[seed % 2])
    usual = float(reward.max()) / robot.visit_s
    for one in below(aisles, reward, robot):
        kinds = one._kinds if isinstance(one, Blocks) else one.kinds
        no_line_above(kinds, usual * np.geomspace(1e-3, 1e3, 7))
