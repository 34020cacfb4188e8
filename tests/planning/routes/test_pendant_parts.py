"""Parts that hang on each other's ladders: each is a bound, and the way along a chain is paid."""

from types import SimpleNamespace

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.planning.routes import best
from fieldmon.planning.routes.best_route import upper_bound
from fieldmon.planning.routes.blocks import Blocks, blockings
from fieldmon.planning.routes.ladders import Ladders, Rungs
from fieldmon.planning.routes.pendant_parts import (
    LadderWithParts,
    PendantPart,
    _tree,
    _with_place,
    ladder_with_parts,
)
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.stops import stops_of
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from tests.planning.routes.tiny import best_of_all, no_line_above


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


@pytest.mark.parametrize(("ends", "driven"), [(True, "ends"), (False, "back")])
def test_where_the_day_ends_in_a_part_its_drive_there_is_the_one_that_stays(ends, driven):
    aisles = parts((0, 0, 40, 30))
    reward = np.random.default_rng(1).random(len(aisles.grid))
    ladder = Ladders(aisles).whole(hanging=False)
    both = {
        name: LadderWithParts(ladder, reward, Robot(returns=name == "back"), {})
        for name in ("ends", "back")
    }
    part = PendantPart(both["back"], both["ends"], 0.0, 1)
    drawn = both[driven].best(0.001)
    expected = stops_of(both[driven], drawn, np.full(len(drawn.way), 0.001), both[driven].robot)
    assert part.stops(0.001, ends=ends).tolist() == expected.tolist()
    other = both["back" if ends else "ends"]
    assert other.best(0.001).worth != drawn.worth


@pytest.mark.parametrize("returns", [True, False])
def test_a_drive_through_a_part_comes_back_and_only_the_last_of_a_one_way_day_stays(returns):
    chain = parts(*((300 * k, 0, 300 * k + 40, 30) for k in range(3)))
    reward = np.random.default_rng(3).random(len(chain.grid))
    ladders = Ladders(chain)
    block = max(blockings(ladders.rungs), key=lambda each: each.max())
    whole = ladder_with_parts(ladders, block, reward, Robot(returns=returns))
    every = [*whole._all_parts()]
    assert len(every) == block.max()
    for part in every:
        assert part.back.robot.returns
        assert part.back.best(0.001).worth <= (part.ends or part.back).best(0.001).worth
        # in a drive that comes back no part is where the day ends
        assert all(deeper.ends is None for deeper in part.back.parts.values())
    for part in whole.parts.values():
        assert (part.ends is None) == returns
        assert returns or not part.ends.robot.returns
        stays = {} if returns else part.ends.parts
        assert all(deeper.ends is not None for deeper in stays.values())


@pytest.mark.parametrize("seed", range(6))
def test_a_part_is_a_place_to_which_no_way_is_longer_than_it_is_and_some_are_as_long(seed):
    """What is driven in the part, the rest up to the headland, and on that: together at most so."""
    rng, n = np.random.default_rng(seed), 6
    apart_m = rng.uniform(5.0, 90.0, (2, 2, n + 1, n + 1)) * (0.02 if seed == 0 else 1.0)
    apart_m[:, 1, :, -1] = apart_m[:, 0, :, -1]
    apart_m[0, :, -1] = apart_m[1, :, -1]
    low, high, up = rng.uniform(0.0, 10.0, n), rng.uniform(20.0, 50.0, n), rng.permutation(n) * 3.0
    rungs = Rungs(low, high, up, apart_m, np.zeros(n, np.int64))
    inside, outside = np.array([1, 4]), np.array([0, 2, 3, 5])
    kept = SimpleNamespace(rungs=rungs, of=lambda made: made)
    made, into_m, away_m = _with_place(kept, inside, outside)
    out = [*outside.tolist(), -1]
    nearest = [[min(min(apart_m[end, side, f, e], apart_m[side, end, e, f]) for e in out
                    for side in range(2)) for f in inside] for end in range(2)]  # fmt: skip
    assert into_m == pytest.approx(np.array(nearest) - np.min(nearest))
    assert len(made.low) == n + 1
    assert made.part[:-1].tolist() == [0] * n
    spare = np.full((2, len(outside) + 1, 2, len(inside)), np.inf)
    for j, e in enumerate([*outside.tolist(), -1]):
        for side in range(2):
            on_m = made.apart_m[side, :, e, n].min()
            assert (made.apart_m[side, :, e, n] == on_m).all()
            assert (made.apart_m[:, side, n, e] == on_m).all()
            for end in range(2):
                for k, f in enumerate(inside):
                    true_m = min(apart_m[end, side, f, e], apart_m[side, end, e, f])
                    spare[side, j, end, k] = true_m - into_m[end, k] - away_m - on_m
    assert (spare >= -1e-9).all()
    # each end of the part, and each place outside, is as far as some way truly is
    tight = spare < 1e-6
    assert tight[:, :-1].any(axis=(2, 3)).all()
    assert tight[:, -1].any()
    to_place = made.apart_m[:, 0, outside, n]
    assert min(to_place.min(), made.apart_m[0, 0, -1, n]) == pytest.approx(0.0, abs=1e-6)
    # between others all is as it was
    others = np.append(np.arange(n), n + 1)
    assert (made.apart_m[:, :, others[:, None], others] == apart_m).all()
    side, at = np.unravel_index(np.argmin(to_place), to_place.shape)
    assert made.part[-1] == side + 1
    assert made.up[-1] == up[outside[at]]
    assert made.low[-1] == made.high[-1] == (low, high)[side][outside[at]]


@pytest.mark.parametrize("seed", range(6))
def test_parts_are_taken_the_nearest_first_and_hang_on_what_they_are_nearest_to(seed):
    rng, n = np.random.default_rng(seed), 9
    block = np.append(rng.permutation(5), rng.integers(0, 5, n - 5))
    apart_m = rng.uniform(1.0, 90.0, (2, 2, n + 1, n + 1))
    apart_m[:, :, np.arange(n), np.arange(n)] = np.inf
    apart_m[:, 1, :, -1] = apart_m[:, 0, :, -1]
    rungs = Rungs(*np.zeros((3, n)), apart_m, np.zeros(n, np.int64))
    order, onto = _tree(rungs, block)
    to_gate = [min(apart_m[s, 0, k, -1] for s in range(2)) for k in range(n)]
    assert order[0] == block[int(np.argmin(to_gate))]
    assert sorted(order) == list(range(5))
    for place in range(1, 5):
        known = order[:place]
        ways = {(min(apart_m[s, t, a, b], apart_m[s, t, b, a]), block[b], block[a])
                for a, b, s, t in np.ndindex(n, n, 2, 2)
                if block[a] in known and block[b] not in known}  # fmt: skip
        nearest = min(ways)
        assert (order[place], onto[order[place]]) == nearest[1:]


@pytest.mark.parametrize("returns", [True, False])
def test_a_part_that_must_be_visited_is_however_dear_the_way_to_it(returns):
    """A kilometre away, at prices at which nothing there pays the way."""
    aisles = parts((0, 0, 20, 12), (1000, 0, 1020, 12), (1060, 0, 1080, 12))
    reward = np.zeros(len(aisles.grid))
    reward[[0, -1]] = 1.0
    for one in taken(aisles, reward, Robot(returns=returns, look_s=1.0)):
        no_line_above(one.kinds, np.geomspace(1e-4, 30.0, 7))
