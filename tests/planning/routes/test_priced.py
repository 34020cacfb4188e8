"""Drives at a price: their bounds fall to one least price, and prices order time."""

import numpy as np
import pytest

from fieldmon.planning.routes.priced import Priced, least_by_kind
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.planning.routes.tiny import ladder_below, no_line_above


@pytest.fixture(params=[(1, True), (2, True), (1, False), (2, False)])
def priced(request):
    faces, returns = request.param
    aisles = Aisles.of(rectangle(12, 15, Planting(faces=faces)))
    reward = np.random.default_rng(4).random(len(aisles.grid)) ** 2
    return Priced(ladder_below(aisles), reward, Robot(returns=returns))


PRICES = np.geomspace(1e-5, 0.03, 40)


def test_dearer_time_is_spent_less(priced):
    used = [priced.seconds(priced.best(price), price) for price in PRICES]
    assert (np.diff(used) <= 1e-6 * max(used)).all()


def test_a_free_drive_takes_every_plant(priced):
    assert priced.best(1e-9).reward == pytest.approx(priced.reward.sum())


def test_the_best_of_all_kinds_is_the_best_drive(priced):
    for price in PRICES[::8]:
        best, (worth, reward) = priced.best(price), priced.kinds(price)
        at = np.unravel_index(worth.argmax(), worth.shape)
        assert (worth[at], reward[at]) == pytest.approx((best.worth, best.reward))


def test_kinds_grant_what_the_best_drive_is_granted():
    """Where turns are dear, plants on both sides of an aisle are granted more than is driven."""
    aisles = Aisles.of(rectangle(2, 11, Planting(faces=2)), gate_xy_m=(-2.0, -3.0))
    ladder = ladder_below(aisles)
    between = ladder.plant[ladder.start[2] : ladder.start[3]]
    reward = np.zeros(len(aisles.grid))
    reward[between] = np.random.default_rng(6).random(len(between))
    priced = Priced(ladder, reward, Robot(turn_180_s=60.0, row_change_s=3.0))
    for price in np.geomspace(1e-4, 1e-2, 7):
        granted = priced.best(price)
        worth, held = priced.kinds(price)
        at = np.unravel_index(worth.argmax(), worth.shape)
        assert (worth[at], held[at]) == pytest.approx((granted.worth, granted.reward))


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


def all_drives(priced, metre):
    """Yield worth, reward, first element and last of every drive by the tables."""
    ladder, tables, room = priced.ladder, priced.tables, priced._room
    n = len(ladder.across_m)
    onward = [
        [[tuple(one) for one in ways if one[0] == state] for state in range(len(tables.passes))]
        for ways in ((tables.gate if k == ladder.gate else tables.aisle).tolist() for k in range(n))
    ]
    waiting = [(0, 0, 0.0, 0.0, -1)]
    while waiting:
        k, state, worth, reward, begin = waiting.pop()
        for _, way, after in onward[k][state]:
            if room.worth[k, way] < -1e200 or (after == 1 and k < ladder.gate):
                continue
            first = k if begin < 0 and after != 0 else begin
            on = worth + room.worth[k, way], reward + room.reward[k, way]
            if after == 1:
                yield *on, first, k
            elif k + 1 < n:
                up = float(tables.passes[after] @ ladder.up_m[k])
                waiting.append((k + 1, after, on[0] - metre * up, on[1], first))


@pytest.mark.parametrize(
    ("returns", "rows", "gate_y"),
    [(True, 2, -9.0), (True, 2, 9.0), (True, 3, 1.0), (False, 2, -9.0), (False, 2, 0.0)],
)
def test_the_best_drive_and_that_of_each_kind_are_the_best_of_all_drives(returns, rows, gate_y):
    robot, price = Robot(returns=returns, row_change_s=2.0, speed_m_s=0.5), 0.003
    aisles = Aisles.of(rectangle(rows, 4), gate_xy_m=(-4.0, gate_y))
    reward = np.random.default_rng(7).random(len(aisles.grid)) ** 2
    priced = Priced(ladder_below(aisles), reward, robot)
    drawn = priced.best(price)
    metre = price * priced.costs.metre_s
    drives = [*all_drives(priced, metre)]
    assert drawn.worth == pytest.approx(max(drives)[0])
    assert drawn.reward == pytest.approx(max(drives)[1])
    # what it is made of comes to that worth
    at = np.arange(len(drawn.way)), drawn.way
    up = (drawn.passes[:-1] * priced.ladder.up_m).sum()
    assert drawn.worth == pytest.approx(priced._room.worth[at].sum() - metre * up)
    priced._room.held[:] = np.nan  # what was worked out before is not read
    worth, held = priced.kinds(price)
    gate = priced.ladder.gate
    assert worth.shape == (gate + 1, len(drawn.way) - gate)
    for begin, end in np.ndindex(worth.shape):
        kind = [one[:2] for one in drives if one[2:] == (begin, gate + end)]
        if kind:
            assert worth[begin, end] == pytest.approx(max(kind)[0])
            assert held[begin, end] == pytest.approx(max(kind)[1])
        else:
            assert worth[begin, end] < -1e200


def test_it_says_how_many_cross_links_and_hanging_aisles_its_ladder_has():
    plain = ladder_below(Aisles.of(rectangle(4, 4)))
    hangs = np.where(np.arange(len(plain.hangs)) == 1, 2, 0)
    reward = np.ones(16)
    said = {
        "price of time on a ladder of aisles": (0, 0 * hangs),
        "on a ladder with 0 cross links and 1 hanging aisles": (0, hangs),
        "on a ladder with 3 cross links and 0 hanging aisles": (3, 0 * hangs),
    }
    for sentence, (links, each) in said.items():
        ladder = plain._replace(cross_links=links, hangs=each)
        assert sentence in Priced(ladder, reward, Robot()).how


@pytest.mark.parametrize("seed", range(5))
def test_each_kind_of_drives_is_bound_by_the_highest_line_between_two_of_its_own(seed):
    """The kind with the most is told to a ten-millionth, the others above it."""
    rng, seconds = np.random.default_rng(seed), 900.0
    took_s = np.sort(rng.uniform(20.0, 2500.0, (4, 12)), axis=1)
    held = took_s**0.7 * rng.uniform(0.7, 1.0, (4, 12))
    took_s[0], held[0] = took_s[0] / 3.0, held[0] / 2.0  # none is too long

    def kinds(price):
        at = np.argmax(held - price * took_s, axis=1)[:, None]
        of, by_s = (np.take_along_axis(each, at, axis=1)[:, 0] for each in (held, took_s))
        return of - price * by_s, of

    line = []
    for of, by_s in zip(held, took_s, strict=True):
        in_time, long = by_s <= seconds, by_s > seconds
        share = (seconds - by_s[in_time, None]) / (by_s[long] - by_s[in_time, None])
        mixed = of[in_time, None] + share * (of[long] - of[in_time, None])
        line.append(max(of[in_time].max(), mixed.max(initial=0.0)))
    least = least_by_kind(kinds, seconds, 0.05, np.inf)
    assert (least >= np.array(line) * (1 - 1e-12)).all()
    assert least.max() <= max(line) * (1.0 + 2e-7)
    # without time there is one price, and all are bound by it
    worth, _ = kinds(0.05)
    assert least_by_kind(kinds, seconds, 0.05, -np.inf) == pytest.approx(worth + 0.05 * seconds)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("returns", [True, False])
def test_what_a_kind_of_drive_is_worth_by_price_is_above_every_drive_of_it(seed, returns):
    """However dear time is: those that must begin in an aisle where nothing pays begin there."""
    rng = np.random.default_rng(seed)
    grid = rectangle(5, 9, Planting(faces=1 + seed % 2))
    low, high = grid.lane_y_m.min(), grid.lane_y_m.max()
    aisles = Aisles.of(grid, gate_xy_m=(grid.lane_x_m.min() - 2.0, rng.uniform(low, high)))
    reward = np.where(rng.random(len(grid)) < 0.3, rng.random(len(grid)), 0.0)
    robot = Robot(returns=returns, row_change_s=(0.0, 25.0)[seed % 2])
    priced = Priced(ladder_below(aisles), reward, robot)
    no_line_above(priced.kinds, np.geomspace(1e-4, 1.0, 9))
    hangs = np.where(np.arange(len(priced.ladder.hangs)) == 0, 1, 0)
    hanging = Priced(priced.ladder._replace(hangs=hangs), reward, robot)
    no_line_above(hanging.kinds, np.geomspace(1e-4, 1.0, 9))
