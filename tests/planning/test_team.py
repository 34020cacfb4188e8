"""A day of several: no plant twice, no two in one aisle at once, and a bound for all together."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldmon.errors import PlotError, SettingError
from fieldmon.planning.team import TeamMember, plan_team, team_of
from fieldmon.plot.field import Field
from fieldmon.plot.layout import Planting, rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot, scout
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from tests.crooked import crooked_fields


def plot_of(n_rows=12, n_plants=15, **how):
    grid = rectangle(n_rows, n_plants, Planting(**how))
    boundary = grid.frame.geometry_lonlat(grid.drivable_m)
    return Plot(Field("even", boundary), Aisles.of(grid))


def chances(plot, seed=1):
    return np.random.default_rng(seed).beta(0.3, 3.0, len(plot.grid))


def in_aisles_second_by_second(plan, step_s=2.0):
    """Return in which aisle each is at every step of the day, -1 for none, ``(m, t)``.

    By where it stands: between two lane ends, at the height of their lane. It knows nothing of
    the checker.
    """
    until = max(day.route.end_s + at for day, at in zip(plan.days, plan.starts_s, strict=True))
    clock = np.arange(0.0, until, step_s)
    found = np.full((len(plan.days), len(clock)), -1)
    for m, (day, begins) in enumerate(zip(plan.days, plan.starts_s, strict=True)):
        route, grid = day.route, day.scene.grid
        if not len(route):
            continue
        times, places = [], []
        for v, (at_s, place) in enumerate(zip(route.line_s, route.line_m, strict=True)):
            leaves = route.leave_s[route.line_stop == v]
            for moment in (at_s, *leaves):
                times.append(moment + begins)
                places.append(place)
        x, y = (np.interp(clock, times, np.array(places)[:, k]) for k in range(2))
        there = (clock >= begins) & (clock <= begins + route.end_s)
        for row in range(grid.n_rows):
            low, high = grid.lane_x_m[row]
            inside = (np.abs(y - grid.lane_y_m[row]) < 0.01) & (x > low + 0.1) & (x < high - 0.1)
            found[m, there & inside] = grid.corridor[row]
    return found


def check(plan):
    """No plant twice, nobody together in an aisle, hours kept, a bound that holds."""
    stops = np.concatenate([day.route.plant for day in plan.days])
    assert len(np.unique(stops)) == len(stops)
    assert plan.meetings() == []
    aisles = in_aisles_second_by_second(plan)
    for one, other in combinations(aisles, 2):
        assert not ((one == other) & (one >= 0)).any()
    for day, late_s in zip(plan.days, plan.late_s, strict=True):
        robot = day.scene.robot
        assert day.route.end_s + late_s <= robot.day_s * (1 + 1e-9)
        places = [GATE, *day.route.plant.tolist(), *([GATE] if robot.returns else [])]
        if len(day.route):
            used = float(
                driven_s(
                    day.scene.aisles.travel, robot_clock(robot, 1.0), np.array(places, np.int64)
                )
            )
            assert day.route.end_s == pytest.approx(used + len(day.route) * robot.visit_s)
    assert plan.expected_found <= plan.bound


@pytest.mark.parametrize("faces", [1, 2])
@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_a_team_shares_a_plot_and_nobody_meets(n, faces):
    plot = plot_of(faces=faces)
    plan = plan_team(plot, chances(plot), team_of(n, Robot(hours=0.6)))
    assert len(plan.days) == n
    check(plan)


@settings(max_examples=6, deadline=None)
@given(crooked_fields(max_radius_m=60.0), st.integers(2, 3), st.booleans(), st.data())
def test_on_crooked_plots_nobody_meets_either(field, n, returns, data):
    try:
        plot = Plot.of(field)
    except PlotError:
        return
    hours = data.draw(st.floats(0.1, 1.0))
    robots = team_of(n, Robot(hours=hours, returns=returns))
    try:
        plan = plan_team(plot, chances(plot), robots)
    except SettingError:
        return
    check(plan)


def test_different_members_have_their_own_hours_gates_and_eyes():
    plot = plot_of()
    far = tuple(plot.grid.lonlat(np.array([len(plot.grid) - 1]))[0].tolist())
    members = (
        TeamMember("wheels", Robot(hours=0.5)),
        TeamMember("Ann", scout().with_hours(0.7), gate=far, starts_s=600.0),
        TeamMember("slow", Robot(hours=0.5, speed_m_s=0.3, detection=0.95, returns=False)),
    )
    plan = plan_team(plot, chances(plot), members)
    check(plan)
    assert np.abs(plan.days[1].route.line_m[0] - plan.days[0].route.line_m[0]).max() > 10.0
    assert (plan.days[2].route.detects == 0.95).all()
    assert plan.starts_s[1] >= 600.0


@pytest.mark.parametrize("seed", range(4))
def test_two_are_never_worse_than_one_of_the_same_hours(seed):
    plot = plot_of()
    one, two = (
        plan_team(plot, chances(plot, seed), team_of(n, Robot(hours=0.7))).expected_found
        for n in (1, 2)
    )
    assert two >= one


def test_on_an_even_plot_a_team_comes_within_a_twentieth_of_its_bound():
    plot = plot_of(40, 40)
    for n in (2, 3):
        plan = plan_team(plot, chances(plot), team_of(n, Robot(hours=3.0)))
        assert plan.expected_found >= 0.95 * plan.bound
    assert plan.sentence.startswith(f"{plan.expected_found:.1f} finds expected; no routes of ")


def test_plants_done_today_are_left_alone():
    plot = plot_of()
    done = np.zeros(len(plot.grid), np.bool_)
    done[:90] = True
    plan = plan_team(plot, chances(plot), team_of(2, Robot(hours=0.6)), done)
    check(plan)
    assert not any(done[day.route.plant].any() for day in plan.days)


def test_the_same_team_has_the_same_plan():
    plot = plot_of()
    first, again = (plan_team(plot, chances(plot), team_of(2, Robot(hours=0.6))) for _ in range(2))
    for one, other in zip(first.days, again.days, strict=True):
        assert (one.route.plant == other.route.plant).all()


@pytest.mark.parametrize(
    ("members", "says"),
    [
        ((), "must have members of different names"),
        ((TeamMember("a"), TeamMember("A")), "must have members of different names"),
        (team_of(2, Robot(hours=0.001)), "must be long enough"),
    ],
)
def test_a_team_that_cannot_work_is_refused(members, says):
    plot = plot_of()
    with pytest.raises(SettingError, match=says):
        plan_team(plot, chances(plot), members)


def test_a_team_of_none_or_a_start_on_another_day_is_refused():
    with pytest.raises(SettingError, match="1 member or more"):
        team_of(0)
    with pytest.raises(SettingError, match="must start within a day"):
        TeamMember("late", starts_s=1e6)
