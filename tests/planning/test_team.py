"""A day of several: no plant twice, no two in one aisle at once, and a bound for all together."""

import json
from dataclasses import replace
from datetime import datetime, timedelta
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldmon.compute.wording import estimate
from fieldmon.errors import PlotError, SettingError
from fieldmon.planning.meetings import meetings
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.planning.team import (
    _day,
    _first_wait,
    _held,
    _kept_apart,
    _met_s,
    _of,
    _shortened,
    _StopSearch,
    bound_of_days,
    plan_team,
)
from fieldmon.planning.team_bound import PRICES, MemberTask
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot, scout
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock, travel_s
from tests.crooked import crooked_fields
from tests.second_by_second import nobody_together
from tests.thorough import seeds


def plot_of(n_rows=12, n_plants=15, **how):
    grid = rectangle(n_rows, n_plants, Planting(**how))
    boundary = grid.frame.geometry_lonlat(grid.drivable_m)
    return Plot(Field("even", boundary), Aisles.of(grid))


def chances(plot, seed=1):
    return np.random.default_rng(seed).beta(0.3, 3.0, len(plot.grid))


def plan_of_two():
    plot = plot_of(8, 10)
    return plan_team(plot, chances(plot), team_of(2, Robot(hours=0.3)))


#: one that is made once, for tests that only look at it
usual_plan = cache(plan_of_two)


def check(plan):
    """No plant twice, nobody together in an aisle, hours kept, a bound that holds."""
    stops = np.concatenate([day.route.plant for day in plan.days])
    assert len(np.unique(stops)) == len(stops)
    assert plan.meetings() == []
    assert nobody_together([day.route for day in plan.days], plan.starts_s)
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
    assert plan.expected_finds <= plan.bound


@pytest.mark.parametrize(("n", "faces"), [(1, 2), (3, 2), (5, 1)])
def test_a_team_shares_a_plot_and_nobody_meets(n, faces):
    plot = plot_of(6, 8, faces=faces)
    plan = plan_team(plot, chances(plot), team_of(n, Robot(hours=0.25)))
    assert len(plan.days) == n
    check(plan)


@settings(max_examples=2, deadline=None)
@given(crooked_fields(max_radius_m=20.0), st.integers(2, 3), st.booleans(), st.data())
def test_on_crooked_plots_nobody_meets_either(field, n, returns, data):
    try:
        plot = Plot.of(field)
    except PlotError:
        assume(False)
    hours = data.draw(st.floats(0.1, 0.5))
    robots = team_of(n, Robot(hours=hours, returns=returns))
    try:
        plan = plan_team(plot, chances(plot), robots)
    except SettingError:
        assume(False)
    check(plan)


def test_different_members_have_their_own_hours_gates_and_eyes():
    plot = plot_of(8, 10)
    far = tuple(plot.grid.lonlat(np.array([len(plot.grid) - 1]))[0].tolist())
    members = (
        TeamMember("wheels", Robot(hours=0.25)),
        TeamMember("Ann", scout().with_hours(0.35), gate=far, starts_s=600.0),
        TeamMember("slow", Robot(hours=0.25, speed_m_s=0.3, detection=0.95, returns=False)),
    )
    plan = plan_team(plot, chances(plot), members)
    check(plan)
    assert np.abs(plan.days[1].route.line_m[0] - plan.days[0].route.line_m[0]).max() > 10.0
    assert (plan.days[2].route.detects == 0.95).all()
    assert plan.starts_s[1] >= 600.0


def test_each_route_says_who_drives_it_from_when_and_goes_to_files_as_it_is(tmp_path):
    plot, robot = plot_of(8, 8), Robot(hours=0.25)
    members = TeamMember("Ann", robot), TeamMember("Ben", robot, None, 300)
    plan = plan_team(plot, chances(plot), members, on="2026-11-18 05:30")
    begins = datetime(2026, 11, 18, 5, 30)
    for member, route, starts_s in zip(members, plan.routes, plan.starts_s, strict=True):
        assert route.notes.who == member.name
        assert route.notes.start == begins + timedelta(seconds=round(starts_s))
    assert plan.routes[1].notes.start >= begins + timedelta(seconds=300)
    (file,) = plan.routes[1].to_file(tmp_path / "ben.geojson")
    line = json.loads(file.read_text(encoding="utf-8"))["features"][0]["properties"]
    assert (line["who"], line["start"]) == ("Ben", plan.routes[1].notes.start.isoformat())


def test_a_gate_from_which_nobody_drives_and_what_is_no_chance_are_refused():
    plot = plot_of()
    far = TeamMember("Ann", gate=(0.0, 0.0))
    with pytest.raises(SettingError, match=r"^Ann: The gate at 0, 0 .* lies"):
        plan_team(plot, chances(plot), [far])
    with pytest.raises(SettingError, match=r"chances in 0\.\.1"):
        plan_team(plot, chances(plot) + 1.0, team_of(2))
    with pytest.raises(SettingError, match="'members' of plan_team must be a sequence of"):
        plan_team(plot, chances(plot), 2)
    with pytest.raises(SettingError, match="chance of infestation above 0, but none has"):
        plan_team(plot, 0.0 * chances(plot), team_of(2))


@pytest.mark.parametrize("detection", [0.5, 1.0])
def test_a_member_s_day_is_expected_to_find_what_its_stops_hold_for_its_own_eyes(detection):
    """By this the best of three ways to share a plot is chosen, also where eyes differ."""
    plot, robot = plot_of(), Robot(hours=0.5, detection=detection)
    stops = np.array([3, 4, 40, 41])
    day = _day(MemberTask(plot.aisles, robot, detection * chances(plot)), stops)
    assert day.route.expected_finds == pytest.approx(detection * chances(plot)[stops].sum())
    assert day.scene.chance == pytest.approx(chances(plot))


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_two_are_never_worse_than_one_of_the_same_hours(seed):
    plot = plot_of(8, 10)
    one, two = (
        plan_team(plot, chances(plot, seed), team_of(n, Robot(hours=0.3))).expected_finds
        for n in (1, 2)
    )
    assert two >= one


def test_on_an_even_plot_a_team_comes_within_a_twentieth_of_its_bound():
    plot = plot_of(14, 14)
    for n in (2, 3):
        plan = plan_team(plot, chances(plot), team_of(n, Robot(hours=0.7)))
        assert plan.expected_finds >= 0.95 * plan.bound
    assert plan.sentence.startswith(
        f"{estimate(plan.expected_finds)} finds expected; no routes of "
    )


def test_the_same_team_has_the_same_plan():
    for one, other in zip(usual_plan().days, plan_of_two().days, strict=True):
        assert (one.route.plant == other.route.plant).all()


@pytest.mark.parametrize(
    ("members", "says"),
    [
        ((), r"must have 1 member or more, but it has none. Give one: team_of\(1\)."),
        ((TeamMember("a"), TeamMember("A")), "must have members of different names"),
        (team_of(2, Robot(hours=0.001)), "must be long enough"),
    ],
)
def test_a_team_that_cannot_work_is_refused(members, says):
    plot = plot_of()
    with pytest.raises(SettingError, match=says):
        plan_team(plot, chances(plot), members)


def test_the_days_of_a_team_have_a_bound_as_long_as_they_are_whole():
    plan = usual_plan()
    said = bound_of_days(plan.days)
    number, rest = said.split(maxsplit=1)
    assert float(number) == pytest.approx(plan.expected_finds, abs=0.05)
    assert rest.startswith("finds expected; no routes of these hours ")
    begun = replace(plan.days[0], scene=replace(plan.days[0].scene, seconds_left=60.0))
    assert bound_of_days([begun, plan.days[1]]) == ""


def two_tasks(plot, hours=0.4, starts_s=0.0):
    value = chances(plot)
    return [MemberTask(plot.aisles, Robot(hours=hours), value * 0.84, at) for at in (0.0, starts_s)]


@pytest.mark.parametrize("returns", [True, False])
def test_a_member_s_day_is_charged_leg_by_leg_and_stop_by_stop(returns):
    plot, robot = plot_of(), Robot(hours=0.5, returns=returns)
    stops = np.array([3, 40, 4])
    day = _day(MemberTask(plot.aisles, robot, chances(plot)), stops)
    at_s = 0.0
    for k, (one, other) in enumerate(pairwise([GATE, *stops.tolist()])):
        at_s += travel_s(plot.aisles.travel, day.scene.clock, one, other)
        assert day.work.arrive_s[k] == pytest.approx(at_s)
        at_s += robot.visit_s
    home_s = travel_s(plot.aisles.travel, day.scene.clock, 4, GATE) if returns else 0.0
    assert day.work.end_s == pytest.approx(at_s + home_s)
    assert _day(MemberTask(plot.aisles, robot, chances(plot)), stops[:0]).work.end_s == 0.0


def test_a_day_is_shortened_by_its_poorest_stops_and_by_no_more_than_must_be():
    plot = plot_of()
    task, stops = two_tasks(plot)[0], np.array([3, 4, 9, 40, 44, 80])
    whole = _day(task, stops)
    assert _shortened(task, whole, whole.work.end_s).work.plant.tolist() == stops.tolist()
    poorest = stops[np.argsort(task.value[stops])]
    for n_gone in range(1, 7):
        left = [plant for plant in stops.tolist() if plant in poorest[n_gone:].tolist()]
        seconds = _day(task, np.array(left, np.int64)).work.end_s
        shorter = _shortened(task, whole, seconds)
        assert shorter.work.end_s <= seconds
        assert shorter.work.plant.tolist() == left


def test_of_two_who_meet_the_later_in_the_team_waits_until_the_first_has_left():
    plot = plot_of()
    task = two_tasks(plot)[0]
    days = [_day(task, np.array(stops)) for stops in ([20, 25], [21, 27])]
    (first, *_) = meetings([day.route for day in days], np.zeros(2))
    assert _first_wait(days, np.zeros(2), 0.0) == (1, first.until_s - first.since_s + 1.0)
    assert _met_s(days, np.zeros(2)) == pytest.approx(
        sum(met.until_s - met.since_s for met in meetings([d.route for d in days], np.zeros(2)))
    )
    tasks = two_tasks(plot)
    apart = _kept_apart(tasks, days, 0.0)
    assert apart.late_s[0] == 0.0
    assert apart.late_s[1] > 0.0
    assert meetings([day.route for day in apart.days], apart.late_s) == []
    assert _first_wait(apart.days, apart.late_s, 0.0) is None
    alone = [days[0], _day(task, np.array([100, 110]))]
    head = [_day(task, np.array([15, 165])), _day(task, np.array([166, 16]))]
    assert _first_wait(alone, np.array([0.0, 1e5]), 30.0) is None
    until = (_first_wait(head, np.array([0.0, s]), 30.0) for s in range(0, 200, 5))
    assert (1, 20.0) in until


def test_routes_are_looked_for_where_the_others_are_not_and_never_get_worse():
    plot, told = plot_of(8, 8), []
    tasks = two_tasks(plot, 0.15)
    search = _StopSearch(plot, tasks, lambda done, of: told.append((done, of)))
    in_turn = search.in_turn()
    exclusive = search.aisle_by_aisle(in_turn)
    shared = search.plant_by_plant(exclusive)
    aisle = plot.grid.corridor[plot.grid.row]
    for stops in (in_turn, exclusive):
        assert not set(aisle[stops[0]]) & set(aisle[stops[1]])
    assert not set(shared[0].tolist()) & set(shared[1].tolist())
    held = [sum(tasks[k].value[own].sum() for k, own in enumerate(stops))
            for stops in (in_turn, exclusive, shared)]  # fmt: skip
    assert held[0] <= held[1] <= held[2]
    assert _held(tasks, shared) == pytest.approx(held[2])
    # the first has the plot to itself
    assert in_turn[0].tolist() == search.look(0, np.ones(64, np.bool_)).tolist()
    assert [done for done, _ in told] == [*range(1, len(told) + 1)]
    assert all(of == 10 + PRICES for done, of in told if done <= 10)
    there = aisle == aisle[shared[0][0]]
    value = sum(tasks[0].value[plant] for plant in shared[0] if there[plant])
    assert _of(tasks[0], shared[0], there) == pytest.approx(value)
    untaken = search._untaken(shared, 1)
    assert np.flatnonzero(~untaken).tolist() == sorted(shared[0].tolist())


def test_an_aisle_in_which_nobody_else_stops_is_free_the_first_one_too():
    plot = plot_of(8, 8)
    aisle = plot.grid.corridor[plot.grid.row]
    first = np.flatnonzero(aisle == aisle[0])
    sees = (np.zeros(64), np.where(aisle == aisle[0], 0.5, 0.0))  # one sees nothing at all
    tasks = [MemberTask(plot.aisles, Robot(hours=3.0), value, 0.0) for value in sees]
    nothing = np.empty(0, np.int64)
    search = _StopSearch(plot, tasks, lambda *_: None)
    of_one, of_other = search.aisle_by_aisle([nothing, first[:3]])
    assert len(of_one) == 0
    assert sorted(of_other.tolist()) == first.tolist()


@pytest.mark.parametrize("returns", [True, False])
def test_the_way_round_is_the_one_on_which_fewer_are_met_and_a_one_way_day_has_but_one(returns):
    plot = plot_of(8, 8)
    tasks = [MemberTask(plot.aisles, Robot(hours=0.4, returns=returns), chances(plot), 0.0)] * 2
    search = _StopSearch(plot, tasks, lambda *_: None)
    stops = [np.array([3, 20, 36, 52]), np.array([5, 22, 38, 54])]
    first, second = search.turned(stops)
    assert first.work.plant.tolist() == stops[0].tolist()
    ways = [_day(tasks[1], own) for own in (stops[1], stops[1][::-1])]
    met_s = [_met_s([first, day], np.zeros(2)) for day in ways]
    assert met_s[0] > met_s[1]
    assert second.work.plant.tolist() == (stops[1][::-1] if returns else stops[1]).tolist()


def test_where_two_would_meet_the_poorer_looks_elsewhere_and_the_other_stays():
    plot = plot_of(6, 10)
    tasks = two_tasks(plot, 0.3)
    search = _StopSearch(plot, tasks, lambda *_: None)
    value = tasks[0].value
    by_row = np.argsort([value[plot.grid.row == row].sum() for row in range(6)])
    here = np.flatnonzero(plot.grid.row == by_row[-1])
    both = here[np.argsort(value[here])[::-1]]  # the best plants of one row, and the others
    known = [np.sort(both[:4]), np.sort(both[4:8])]
    assert meetings([day.route for day in search.turned(known)], np.zeros(2))
    rich, poor = search.apart(known)
    assert rich.tolist() == known[0].tolist()
    assert not set(poor.tolist()) & set(here.tolist())
    assert len(poor) > 0
    assert meetings([day.route for day in search.turned([rich, poor])], np.zeros(2)) == []


def test_progress_goes_on_while_the_bound_is_looked_for_and_ends_at_the_end():
    told = []
    plot = plot_of(8, 8)
    plan_team(
        plot, chances(plot), team_of(2, Robot(hours=0.2)), progress=lambda *one: told.append(one)
    )
    done, of = (np.array(column) for column in zip(*told, strict=True))
    assert (np.diff(done) >= 0).all()
    assert (done <= of).all()
    assert done[-1] == of[-1]
    # all routes are looked for before the first price is tried
    assert np.count_nonzero(done > of - PRICES) >= 2
