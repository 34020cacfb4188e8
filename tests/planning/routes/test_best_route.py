"""Routes with a bound: nothing exceeds the bound, and the route is what it says."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldmon.compute.wording import estimate
from fieldmon.errors import PlotError, SettingError
from fieldmon.planning.routes.best_route import best, bounded
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
from tests.planning.routes.tiny import best_of_all

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


@settings(max_examples=12)
@given(st.data())
def test_no_sampler_expects_more_than_the_bound(data):
    aisles = data.draw(crooked_aisles(max_radius_m=60.0, max_plants=1500))
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
@pytest.mark.parametrize("robot", [Robot(hours=4.0), scout(), Robot(hours=4.0, returns=False)])
def test_on_a_plain_plot_route_and_bound_are_close(faces, robot):
    aisles = Aisles.of(rectangle(40, 40, Planting(faces=faces)))
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
    # both are rounded up: what is said is no less than what was proved
    bound, gap = np.ceil(route.bound), np.ceil(1000 * route.gap) / 10
    assert f"more than {bound:.0f} ({gap:.1f} %)." in route.sentence()


def test_it_is_never_below_a_route_it_was_told_of():
    aisles = Aisles.of(rectangle(6, 6, Planting(faces=2)))
    reward = np.random.default_rng(5).random(len(aisles.grid))
    first = best(aisles, reward, Robot(), 900.0)
    again = best(aisles, reward, Robot(), 900.0, others=[first.plant])
    assert again.reward >= first.reward


@pytest.mark.parametrize(
    ("reward", "seconds"), [(np.ones(19), 60.0), (-np.ones(20), 60.0), (np.ones(20), 0.0)]
)
def test_what_makes_no_sense_is_refused(reward, seconds):
    with pytest.raises(SettingError, match="must be"):
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
