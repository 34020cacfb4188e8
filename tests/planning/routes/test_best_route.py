"""Routes with a bound: nothing exceeds the bound, and the route is what it says."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.compute.wording import estimate
from fieldmon.errors import PlotError, SettingError
from fieldmon.planning.routes import best_route
from fieldmon.planning.routes.aisle_ways import Costs
from fieldmon.planning.routes.best_route import _between, best, bound, bounded, upper_bound
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot, scout
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Naive
from fieldmon.samplers.without_prior import RandomShare
from tests.crooked import crooked_grids
from tests.cut_lanes import WIDE, cut_plot
from tests.planning.routes.tiny import best_of_all, earliest_of_each
from tests.thorough import seeds

ROBOTS = st.builds(
    Robot,
    speed_m_s=st.floats(0.3, 2.0),
    row_change_s=st.floats(0.0, 60.0),
    turn_180_s=st.floats(0.0, 60.0),
    look_s=st.floats(1.0, 60.0),
    returns=st.booleans(),
)


@st.composite
def crooked_aisles(draw, **how):
    grid = draw(crooked_grids(**how))
    gate = None
    if draw(st.booleans()):
        low, high = grid.lane_x_m.min(), grid.lane_x_m.max()
        x = low - 2.0 if draw(st.booleans()) else high + 2.0
        gate = (float(x), float(draw(st.sampled_from(list(grid.lane_y_m)))))
    try:
        return Aisles.of(grid, gate)
    except PlotError:
        assume(False)


@st.composite
def rewards(draw, n, most=None):
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    values = rng.random(n) ** draw(st.sampled_from((0.5, 1.0, 3.0)))
    if most is not None and n > most:
        values[rng.permutation(n)[most:]] = 0.0
    return values


def whole_day_s(aisles, reward, robot):
    plants = np.flatnonzero(reward)
    places = np.concatenate([[GATE], plants, [GATE]]).astype(np.int64)
    clock = robot_clock(robot, 1.0)
    return float(driven_s(aisles.travel, clock, places)) + len(plants) * robot.visit_s


def check(aisles, reward, robot, seconds, route):
    """A route is within its time, goes nowhere twice, and holds what it says."""
    assert len(np.unique(route.plant)) == len(route.plant)
    assert route.reward == pytest.approx(reward[route.plant].sum())
    back = [GATE] if robot.returns else []
    places = np.concatenate([[GATE], route.plant, back]).astype(np.int64)
    used = float(driven_s(aisles.travel, robot_clock(robot, seconds), places))
    used += len(route.plant) * robot.visit_s
    if len(route.plant):
        assert route.seconds == pytest.approx(used)
    assert route.seconds <= seconds * (1 + 1e-9)
    assert route.reward <= route.bound


@given(st.data())
def test_no_order_of_few_plants_exceeds_the_bound_nor_is_missed_by_much(data):
    aisles = data.draw(crooked_aisles(max_radius_m=40.0, max_plants=400))
    robot = data.draw(ROBOTS)
    reward = data.draw(rewards(len(aisles.grid), most=8))
    seconds = data.draw(st.floats(0.02, 1.1)) * whole_day_s(aisles, reward, robot)
    route = best(aisles, reward, robot, seconds)
    check(aisles, reward, robot, seconds, route)
    most = best_of_all(aisles, reward, robot, seconds)
    assert route.reward <= most + 1e-9
    assert most <= route.bound + 1e-9


@pytest.mark.parametrize("seed", range(8))
def test_where_lanes_are_cut_no_order_exceeds_the_bound_nor_is_missed_by_much(seed):
    aisles, _, _ = cut_plot(seed, n_rows=3, n_plants=9, faces=1 + seed % 2)
    assert aisles.grid.cut_ends.any()
    rng, reward = np.random.default_rng(seed), np.zeros(len(aisles.grid))
    plants = rng.permutation(np.flatnonzero(~aisles.too_narrow))[:7]
    reward[plants] = rng.random(len(plants))
    for robot in (WIDE, replace(WIDE, returns=False, row_change_s=25.0)):
        held, earliest_s = earliest_of_each(aisles, reward, robot)
        for seconds in rng.uniform(0.2, 1.0, 3) * earliest_s[-1]:
            route = best(aisles, reward, robot, seconds)
            check(aisles, reward, robot, seconds, route)
            most = float(held[earliest_s <= seconds].max())
            assert 0.8 * most <= route.reward <= most + 1e-9
            assert most <= route.bound + 1e-9


@pytest.mark.parametrize("seed", range(8))
def test_with_the_gate_at_the_side_no_set_exceeds_a_bound_and_none_falls_as_time_grows(seed):
    """Drives that must begin below the gate begin in an aisle, though no plant of it may pay."""
    rng = np.random.default_rng(seed)
    grid = rectangle(int(rng.integers(1, 5)), 14, Planting(faces=1 + seed % 2))
    y = rng.uniform(grid.lane_y_m.min(), grid.lane_y_m.max() + 2.0)
    aisles = Aisles.of(grid, gate_xy_m=(grid.lane_x_m.min() - 2.0, y))
    reward = np.zeros(len(grid))
    reward[rng.permutation(len(grid))[:5]] = rng.random(5)
    robot = Robot(returns=seed % 4 > 0, row_change_s=(0.0, 25.0)[seed % 2])
    held, earliest_s = earliest_of_each(aisles, reward, robot)
    before = 0.0
    for seconds in np.linspace(0.1, 1.05, 16) * earliest_s[-1]:
        found = bound(aisles, reward, robot, seconds)
        assert found >= held[earliest_s <= seconds].max()
        assert found >= before * (1.0 - 1e-6)
        before = found


def test_a_route_that_holds_more_than_its_bound_proves_nothing(monkeypatch):
    aisles, reward = Aisles.of(rectangle(3, 5)), np.ones(15)
    found = best(aisles, reward, Robot(), 900.0)
    least = best_route._bounds(best_route._posed(aisles, reward, Robot(), 900.0))[0]
    low = replace(least, value=0.9 * found.reward)
    monkeypatch.setattr(best_route, "_bounds", lambda _: [low])
    with pytest.warns(RuntimeWarning, match="a fault of fieldmon"):
        route = best(aisles, reward, Robot(), 900.0)
    assert route.bound == np.inf
    assert not route.proved


@given(st.data())
def test_no_sampler_expects_more_than_the_bound(data):
    aisles = data.draw(crooked_aisles(max_radius_m=40.0, max_plants=600))
    grid, robot = aisles.grid, data.draw(ROBOTS)
    chance = 0.5 * data.draw(rewards(len(grid)))
    seconds = data.draw(st.floats(0.02, 0.8)) * whole_day_s(aisles, chance, robot)
    route = best(aisles, chance, robot, seconds)
    check(aisles, chance, robot, seconds, route)
    scene = Scene(
        aisles=aisles,
        robot=robot,
        chance=chance,
        last_inspected=np.full(len(grid), NEVER, np.int32),
        seconds_left=seconds,
    )
    for sampler in (Adaptive(), Adaptive(spares=0.0), Dynamic(), Naive(), RandomShare()):
        work = plan_work(scene, sampler)
        assert chance[work.plant].sum() <= route.bound + 1e-9, type(sampler).__name__


@pytest.mark.parametrize("faces", [1, 2])
@pytest.mark.parametrize(
    "robot", [Robot(hours=2.0), scout().with_hours(3.0), Robot(hours=2.0, returns=False)]
)
def test_on_a_plain_plot_route_and_bound_are_close(faces, robot):
    aisles = Aisles.of(rectangle(28, 28, Planting(faces=faces)))
    reward = np.random.default_rng(3).beta(0.3, 20.0, len(aisles.grid))
    route = best(aisles, reward, robot)
    check(aisles, reward, robot, robot.day_s, route)
    assert route.gap <= (0.01 if faces == 1 else 0.03)


def test_with_time_for_all_it_is_proved_that_nothing_is_better():
    aisles = Aisles.of(rectangle(4, 5))
    route = best(aisles, np.ones(20), Robot())
    assert len(route.plant) == 20
    assert route.proved
    assert route.sentence() == "20 finds expected; no route of these hours can expect more."


def test_with_time_for_nothing_it_stays_at_the_gate():
    route = best(Aisles.of(rectangle(4, 5)), np.ones(20), Robot(), 30.0)
    assert len(route.plant) == 0
    assert route.reward == route.bound == 0.0


def test_it_says_what_no_other_route_can_exceed():
    aisles = Aisles.of(rectangle(20, 20))
    route = best(aisles, np.random.default_rng(1).random(400), Robot(hours=1.0))
    assert route.sentence().startswith(f"{estimate(route.reward)} finds expected; no ")
    # it is rounded up: what is said is no less than what was proved
    gap = np.ceil(1000 * route.gap) / 10
    assert gap < 1.0
    assert f"no route of these hours can expect over {gap:.1f} % more." in route.sentence()


def test_it_is_never_below_a_route_it_was_told_of():
    aisles = Aisles.of(rectangle(6, 6, Planting(faces=2)))
    reward = np.random.default_rng(5).random(len(aisles.grid))
    first = best(aisles, reward, Robot(), 900.0)
    again = best(aisles, reward, Robot(), 900.0, others=[first.plant])
    assert again.reward >= first.reward


@pytest.mark.parametrize(
    ("reward", "seconds", "said"),
    [
        (np.ones(19), 60.0, r"20 numbers in a row, one a plant, but they have the shape \(19,\)"),
        (np.ones((20, 1)), 60.0, r"they have the shape \(20, 1\)"),
        (-np.ones(20), 60.0, "0 or more, but one is -1"),
        (np.r_[np.ones(19), np.inf], 60.0, "0 or more, but one is inf"),
        (np.ones(20), 0.0, "must be above 0 s"),
    ],
)
def test_what_makes_no_sense_is_refused(reward, seconds, said):
    with pytest.raises(SettingError, match=said):
        best(Aisles.of(rectangle(4, 5)), reward, Robot(), seconds)


@pytest.mark.parametrize("hours", [0.3, 0.5, 1.0])
def test_the_visits_behind_a_bound_hold_what_it_says_and_are_parts_of_a_visit(hours):
    """Drives at one price that fill the hours; of short days another bound is a little lower."""
    aisles = Aisles.of(rectangle(8, 9))
    reward = np.random.default_rng(4).random(72)
    reward[::5] = 0.0
    found = bounded(aisles, reward, Robot(hours=hours))
    assert ((found.visits >= 0.0) & (found.visits <= 1.0)).all()
    assert (found.visits[::5] == 0.0).all()
    assert found.visits @ reward == pytest.approx(found.value, rel=0.01)


@pytest.mark.parametrize("hours", [0.3, 0.4, 0.6])
def test_of_two_drives_so_much_of_each_is_visited_as_fills_the_hours(hours):
    """Where they are of the least price, that is the bound itself."""
    reward = np.random.default_rng(2).random(120) ** 3
    found = bounded(Aisles.of(rectangle(6, 20)), reward, Robot(hours=hours))
    assert ((found.visits > 0.0) & (found.visits < 1.0)).any()
    assert found.visits @ reward == pytest.approx(found.value, rel=1e-6)


def test_with_time_for_all_the_visits_behind_a_bound_are_all_there_is():
    aisles, reward = Aisles.of(rectangle(4, 5)), np.linspace(0.1, 1.0, 20)
    found = bounded(aisles, reward, Robot(hours=12.0))
    assert found.visits.tolist() == [1.0] * 20
    assert found.value == pytest.approx(reward.sum())
    nothing = bounded(aisles, 0.0 * reward, Robot(hours=12.0))
    assert (nothing.value, nothing.visits.tolist()) == (0.0, [0.0] * 20)


class Drives:
    """A few drives of which each holds so much and takes so long; the shortest is none at all."""

    def __init__(self, reward, seconds, of_all=None, stop_s=1.0):
        self.reward, self.took_s = np.append(0.0, reward), np.append(0.0, seconds)
        self.of_all = self.reward[1:] if of_all is None else of_all
        self.costs = Costs(0.0, stop_s, 0.0, 0.0)
        self.tried, self.by_kind = [], np.inf

    def best(self, price):
        self.tried.append(price)
        return int(np.argmax(self.reward - price * self.took_s))

    def bound(self, one, price, seconds):
        return self.reward[one] + price * (seconds - self.took_s[one])

    def seconds(self, one, price):
        assert one == self.best(price)
        return self.took_s[one]

    def bound_by_kind(self, *told):
        self.told = told
        return self.by_kind

    def highest_line(self, seconds):
        """Return what no mixture of two drives exceeds, and those two, the one in time first."""
        pairs = [(self.reward[a], a, a) for a in np.flatnonzero(self.took_s <= seconds)]
        for a in np.flatnonzero(self.took_s <= seconds):
            for b in np.flatnonzero(self.took_s > seconds):
                share = (seconds - self.took_s[a]) / (self.took_s[b] - self.took_s[a])
                pairs.append((self.reward[a] + share * (self.reward[b] - self.reward[a]), a, b))
        return max(pairs)


def drives(seed):
    rng = np.random.default_rng(seed)
    seconds = np.sort(rng.uniform(50.0, 4000.0, 30))
    return Drives(3.0 * seconds**0.6 * rng.uniform(0.5, 1.0, 30), seconds)


@pytest.mark.parametrize("seed", seeds(4, 12))
def test_the_least_bound_of_all_prices_is_the_highest_line_between_two_drives(seed):
    below = drives(seed)
    seconds = float(np.random.default_rng(seed).uniform(100.0, 3900.0))
    found = upper_bound(below, seconds)
    line, a, b = below.highest_line(seconds)
    assert found.value >= line
    # where no longer drive holds more than one in time, a second is still charged a little
    charged = 1e-7 * below.reward.max() * (seconds - below.took_s[a]) if a == b else 0.0
    assert found.value == pytest.approx(line + charged, rel=3e-9)
    n_tried = len({*below.tried})
    # at its price the bound is that bound, and of all its drives none is above the line
    at_price = (below.reward + found.price * (seconds - below.took_s)).max()
    assert at_price == pytest.approx(found.value, rel=3e-9)
    # the last drives to either side are those of the line, each with a price that it is best at
    met = sorted(one for one, _ in found.met)
    assert met == sorted({int(a), int(b)})
    for one, price in found.met:
        assert one == int(np.argmax(below.reward - price * below.took_s))
    assert n_tried <= 16


def test_no_time_is_lost_on_prices_where_all_drives_are_in_time():
    below = drives(1)
    found = upper_bound(below, 5000.0)
    left_s = 5000.0 - below.took_s[below.reward.argmax()]
    assert found.value == pytest.approx(below.reward.max() * (1.0 + 1e-7 * left_s), rel=3e-9)
    assert found.value >= below.reward.max()
    assert len({*below.tried}) == 1


@pytest.mark.parametrize("stop_s", [0.25, 1.0, 4.0])
@pytest.mark.parametrize("left_s", [0.0, 0.5, -0.5])
def test_a_drive_that_fits_by_a_hair_counts_as_in_time_and_one_that_fails_by_a_hair_does_not(
    stop_s, left_s
):
    """The last drives tried are one in time and one too long, whatever a stop takes."""
    took_s = np.array([500.0, 1000.0 - left_s, 2000.0])
    below = Drives([700.0, 900.0, 1000.0], took_s, np.full(9000, 5.0), stop_s)
    found = upper_bound(below, 1000.0)
    line, *_ = below.highest_line(1000.0)
    assert found.value == pytest.approx(line, rel=1e-8)
    sides = [below.took_s[one] > 1000.0 for one, _ in found.met]
    assert sorted(sides) == [False, True]


def test_where_a_stop_takes_no_time_all_plants_may_be_visited():
    below = Drives([50.0, 90.0], [10.0, 60.0], np.full(6, 2.0), 0.0)
    assert upper_bound(below, 49.0).value == pytest.approx(12.0)


def test_prices_are_tried_for_as_long_as_there_is_time_by_the_clock(monkeypatch):
    clock = iter([])
    monkeypatch.setattr(type(best_route.FIRST_USE), "work_clock", lambda _: next(clock))
    for each_s, within_s, n in ((0.0, 0.0, None), (1.0, 2.5, 3), (1.0, 3.5, 4), (1.0, 1e9, None)):
        clock = itertools.count(5000.0, each_s)
        below = drives(4)
        found = upper_bound(below, 1500.0, within_s)
        if n is None:
            assert found.value == pytest.approx(below.highest_line(1500.0)[0], rel=3e-9)
            assert below.told[2] == 5000.0 + within_s
        else:
            assert len({*below.tried}) == n
            # no time was left for drives of each kind
            assert not hasattr(below, "told")


@pytest.mark.parametrize(("stop_s", "most"), [(10.0, 4), (9.0, 5), (8.0, 6), (50.0, 0), (6.0, 6)])
def test_no_bound_is_above_what_the_best_plants_hold_that_there_are_stops_for(stop_s, most):
    """Drives on the ladder promise far more in 49 s, which no route can hold."""
    of_all = np.array([1.0, 6.0, 3.0, 5.0, 2.0, 4.0])
    below = Drives([900.0, 1900.0], [10.0, 60.0], of_all, stop_s)
    found = upper_bound(below, 49.0)
    assert found.value == pytest.approx(np.sort(of_all)[::-1][:most].sum())


def test_a_bound_by_kinds_of_drives_counts_if_it_is_less_and_there_is_time_for_it():
    below, seconds = drives(2), 1500.0
    line = below.highest_line(seconds)[0]
    for by_kind, least in ((0.9 * line, 0.9 * line), (1.1 * line, line)):
        below.by_kind = by_kind
        assert upper_bound(below, seconds).value == pytest.approx(least, rel=3e-9)
    below.by_kind, below.tried = 0.9 * line, []
    # without any time one price is tried, the first
    late = upper_bound(below, seconds, -1.0)
    assert len({*below.tried}) == 1
    assert late.value >= line


def test_to_seconds_a_rounding_of_every_leg_is_added():
    """Legs of one stop more than there can be, each a thousandth of a millimetre."""
    for n, legs in ((5, 6), (200, 101)):
        of_all = np.full(n, 50.0)
        below = Drives([1.0, 500.0], [1.0, 2000.0], of_all, stop_s=10.0)
        below.costs = Costs(2.0, 10.0, 0.0, 0.0)
        took_s = 1000.0 + legs * 1e-6 * 2.0
        upper_bound(below, 1000.0)
        assert below.told[0] == pytest.approx(took_s, abs=1e-9)


@pytest.mark.parametrize("halve", [False, True])
def test_the_next_price_is_where_two_lines_cross_or_between_those_tried(halve):
    """By prices one falls by its overtime, the other, in time, rises by what is left."""
    long, short = (90.0, -300.0), (40.0, 200.0)
    price, least = _between({True: long, False: short}, (0.01, 1.0), halve=halve)
    crossing = 0.1
    assert price == pytest.approx(0.1 if halve else crossing)
    assert least == pytest.approx(60.0)
    assert least == pytest.approx(short[0] + crossing * short[1])
    # if they cross beyond what was tried, it is between
    for low, high in ((0.2, 0.8), (0.0025, 0.04), (0.1, 0.4), (0.025, 0.1)):
        price, _ = _between({True: long, False: short}, (low, high), halve=halve)
        assert price == pytest.approx((low * high) ** 0.5)
    price, _ = _between({True: long, False: short}, (0.09, 0.4), halve=halve)
    assert price == pytest.approx(0.036**0.5 if halve else crossing)
    # of lines that never cross no more is known than the one
    same, least = _between({True: (50.0, 20.0), False: (40.0, 20.0)}, (0.1, 0.4), halve=False)
    assert (same, least) == (pytest.approx(0.2), pytest.approx(54.0))


@pytest.mark.parametrize(
    ("took_s", "shares"),
    [((3000.0, 4000.0), (0.4, 0.6)), ((4000.0, 3000.0), (0.6, 0.4)), ((3600.0,), (1.0,)),
     ((3600.0, 4000.0), (1.0, 0.0)), ((100.0, 3000.0), (0.0, 1.0)), ((5000.0, 4000.0), (0.0, 1.0))],
)  # fmt: skip
def test_two_drives_are_visited_as_their_seconds_fill_the_hours(monkeypatch, took_s, shares):
    """A plant of both as often as both together, and never more than once."""
    below = type("Below", (), {"seconds": lambda _, *met: took_s[met[0]]})()
    met = tuple((k, 0.1) for k in range(len(took_s)))
    stops = ([0, 1, 2], [2, 3])
    found = [best_route.PriceBound(value, 0.1, below, of) for value, of in ((7.0, ()), (5.0, met))]
    monkeypatch.setattr(best_route, "_bounds", lambda _: found)
    monkeypatch.setattr(best_route, "_stops_met", lambda *told: stops[told[1][0]])
    of = bounded(Aisles.of(rectangle(2, 3)), np.ones(6), Robot(hours=1.0))
    one, other = shares if len(shares) == 2 else (shares[0], 0.0)
    assert of.value == 5.0
    assert of.visits == pytest.approx([one, one, one + other, other, 0.0, 0.0])


@pytest.mark.parametrize("returns", [True, False])
def test_a_plant_is_in_reach_if_a_day_for_it_alone_is_just_long_enough(returns):
    aisles, robot = Aisles.of(rectangle(3, 6)), Robot(returns=returns)
    ways = 2 if returns else 1
    for plant in (0, 9, 17):
        just_s = ways * float(aisles.distance_m(GATE, np.array([plant]))[0]) / robot.speed_m_s
        just_s += robot.visit_s
        reward = np.zeros(18)
        reward[plant] = 1.0
        # a change of aisle may be charged on the way, too
        for seconds, reached in ((just_s + 1e-6, True), (just_s - 1e-3, False)):
            posed = best_route._posed(aisles, reward, robot, seconds)
            assert posed.reward.any() == reached
            assert (bound(aisles, reward, robot, seconds) > 0.0) == reached


def test_a_plot_turned_round_mirrored_or_with_all_rewards_scaled_has_the_same_bound():
    grid, robot = rectangle(5, 7), Robot(hours=0.25)
    middle = float(np.median(grid.lane_y_m))
    reward = np.random.default_rng(5).random((5, 7))
    gates = [(grid.lane_x_m.min() - 2.0, middle), (grid.lane_x_m.max() + 2.0, middle)]
    west, east = (Aisles.of(grid, gate_xy_m=gate) for gate in gates)
    found = bound(west, reward.ravel(), robot)
    assert bound(west, reward[::-1].ravel(), robot) == pytest.approx(found, rel=1e-6)
    assert bound(east, reward[:, ::-1].ravel(), robot) == pytest.approx(found, rel=1e-6)
    assert bound(east, reward[::-1, ::-1].ravel(), robot) == pytest.approx(found, rel=1e-6)
    assert bound(west, 1e-6 * reward.ravel(), robot) == pytest.approx(1e-6 * found, rel=1e-6)
    # more hours or a quicker robot never hold less, and twice as quick with stops half as long in
    # half the hours the same
    more = [bound(west, reward.ravel(), robot, s) for s in (100.0, 300.0, 900.0, 901.0, 1500.0)]
    assert (np.diff(more) >= -1e-9).all()
    quick = Robot(
        hours=0.125, speed_m_s=2 * robot.speed_m_s, row_change_s=robot.row_change_s / 2,
        turn_180_s=robot.turn_180_s / 2, stop_s=robot.stop_s / 2, look_s=robot.look_s / 2,
        detection=robot.detects,
    )  # fmt: skip
    assert bound(west, reward.ravel(), quick) == pytest.approx(found, rel=1e-6)
