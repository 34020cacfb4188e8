"""Several ladders for parts that lie apart: each is a bound, and closer than one ladder."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon, box

from fieldmon.planning.routes import best, bound
from fieldmon.planning.routes.best_route import upper_bound
from fieldmon.planning.routes.blocks import _MOST_BLOCKS, _NEAR_M, Blocks, blockings
from fieldmon.planning.routes.pendant_parts import ladder_with_parts
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.relaxation import Ladders
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from tests.planning.routes.test_best_route import ROBOTS, crooked_aisles, rewards


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
        MultiPolygon([box(-210, -40, -150, 40), box(150, -40, 210, 40)])
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
