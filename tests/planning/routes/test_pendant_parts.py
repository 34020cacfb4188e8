"""Parts that hang on each other's ladders: each is a bound, and the way along a chain is paid."""

from types import SimpleNamespace

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.planning.routes import best
from fieldmon.planning.routes.best_route import upper_bound
from fieldmon.planning.routes.blocks import Blocks, blockings
from fieldmon.planning.routes.pendant_parts import _tree, ladder_with_parts
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.relaxation import Ladders
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from tests.planning.routes.tiny import best_of_all


def parts(*boxes):
    """Return the aisles of a plot of some rectangles, rows from left to right."""
    area = Frame(35.15, 30.36).geometry_lonlat(MultiPolygon([box(*each) for each in boxes]))
    return Aisles.of(lay(Field("parts", area), Planting(row_bearing_deg=90.0)))


def scattered(seed):
    """Return aisles of three to five parts, wherever they lie."""
    rng = np.random.default_rng(seed)
    places = rng.permutation(9)[: rng.integers(3, 6)]
    corners = [(140 * (k % 3) + rng.uniform(0, 40), 90 * (k // 3) + rng.uniform(0, 30))
               for k in places.tolist()]  # fmt: skip
    sizes = rng.uniform(20, 55, (len(corners), 2)).tolist()
    return parts(*((x, y, x + w, y + h) for (x, y), (w, h) in zip(corners, sizes, strict=True)))


def taken(aisles, reward, robot):
    """Return the plot with parts hanging on each other, for every way of taking parts together."""
    ladders = Ladders(aisles)
    return [ladder_with_parts(ladders, block, reward, robot) for block in blockings(ladders.rungs)]


@pytest.mark.parametrize("seed", range(6))
def test_no_order_of_a_few_plants_holds_more_than_the_bound(seed):
    aisles, rng = scattered(seed), np.random.default_rng(seed)
    n = len(aisles.grid)
    robot = Robot(hours=1.0, returns=bool(seed % 2))
    reward = np.zeros(n)
    reward[rng.permutation(n)[:9]] = rng.uniform(1.0, 3.0, 9)
    everything = taken(aisles, reward, robot)
    assert everything
    for seconds in (600.0, 1200.0, 2000.0):
        most = best_of_all(aisles, reward, robot, seconds)
        for one in everything:
            assert most <= upper_bound(one, seconds).value


@pytest.mark.parametrize("seed", range(6, 12))
def test_at_no_price_is_any_route_worth_more_than_the_best_drive(seed):
    aisles, rng = scattered(seed), np.random.default_rng(seed)
    n = len(aisles.grid)
    robot = Robot(returns=bool(seed % 2), row_change_s=0.0, turn_180_s=0.0)
    everything = taken(aisles, reward := rng.random(n) ** 6, robot)
    for _ in range(20):
        price = 10.0 ** rng.uniform(-5.0, -1.7)
        route = np.sort(rng.permutation(n)[: rng.integers(1, 60)])
        places = np.concatenate([[GATE], route, [GATE] if robot.returns else []]).astype(np.int64)
        clock = robot_clock(robot, 1.0)
        used_s = float(driven_s(aisles.travel, clock, places)) + len(route) * robot.visit_s
        for one in everything:
            assert reward[route].sum() - price * used_s <= one.best(price).worth + 1e-9


@pytest.mark.parametrize("returns", [True, False])
def test_along_a_chain_of_parts_side_by_side_every_way_is_paid(returns):
    """On one ladder they stand at one height, where nothing is paid to go from one to the other."""
    chain = parts(*((300 * k, 0, 300 * k + 60, 60) for k in range(4)))
    robot = Robot(hours=3.0, returns=returns)
    reward = np.random.default_rng(3).random(len(chain.grid)) ** 8
    ladders = Ladders(chain)
    (block, *_) = blockings(ladders.rungs)
    others = [Priced(ladders.whole(hanging=True), reward, robot)]
    others += [Blocks(ladders, each, reward, robot) for each in blockings(ladders.rungs)]
    least = min(upper_bound(one, robot.day_s).value for one in others)
    hanging = upper_bound(ladder_with_parts(ladders, block, reward, robot), robot.day_s).value
    route = best(chain, reward, robot)
    assert route.reward <= route.bound <= hanging < least
    assert route.gap < 0.06


@pytest.mark.parametrize("seed", range(4))
def test_each_part_hangs_on_the_nearest_of_those_before_it(seed):
    """As in Prim's tree, a way being as long as the shorter of there and back."""
    n = 6
    # the last is the gate
    apart_m = np.random.default_rng(seed).uniform(1.0, 99.0, (2, 2, n + 1, n + 1))
    order, onto = _tree(SimpleNamespace(apart_m=apart_m), np.arange(n))
    there_m = apart_m[:, :, :n, :n].min(axis=(0, 1))
    either_m = np.minimum(there_m, there_m.T)
    assert order[0] == apart_m[:, 0, :n, n].min(axis=0).argmin()
    assert sorted(order) == list(range(n))
    for k in range(1, n):
        nearest_m = either_m[np.ix_(order[:k], order[k:])].min()
        assert onto[order[k]] in order[:k]
        assert either_m[onto[order[k]], order[k]] == nearest_m
