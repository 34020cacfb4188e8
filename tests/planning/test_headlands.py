"""Head-on in a headland: seen on the lines, and avoided where it is too narrow."""

import itertools

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.headlands import Steps, _nearest, head_on, headlands_of
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.planning.team import plan_team
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.planning.test_meetings import route

# rows of 4 x 10 plants, 4 m apart; a headland of 4 m at their ends
WIDE, NARROW = 20.0, 3.0


def up_and_down():
    """Return two routes: one goes up the headland to the last row, the other comes down it."""
    return route(0, 30), route(31, 1)


def test_two_who_drive_towards_each_other_in_a_headland_meet_where_it_is_too_narrow():
    up, down = up_and_down()
    # the second leaves the last row some time before the first comes there
    both = [np.array([0.0, up.arrive_s[1] - down.leave_s[0] - s]) for s in range(0, 20, 2)]
    starts_s = next(each for each in both if head_on([up, down], each, WIDE))
    (met, *_) = head_on([up, down], starts_s, WIDE)
    assert met.who == (0, 1)
    y = up.line_m[:, 1]
    assert y.min() < met.place_m[1] < y.max()
    assert head_on([up, down], starts_s, NARROW) == []


def test_one_after_the_other_meets_nobody_and_who_follows_is_not_head_on():
    up, down = up_and_down()
    assert head_on([up, down], np.array([0.0, up.end_s]), WIDE) == []
    assert head_on([up, route(1, 31)], np.array([0.0, 3.0]), WIDE) == []
    assert head_on([up, route()], np.zeros(2), WIDE) == []


def seen_second_by_second(plan, step_s=0.5):
    """Tell whether two come near while driving to each other in headlands: by sampling."""
    until = max(d.route.end_s + s for d, s in zip(plan.days, plan.starts_s, strict=True))
    clock = np.arange(0.0, until, step_s)
    places = []
    for day, start_s in zip(plan.days, plan.starts_s, strict=True):
        line, grid = day.route, day.scene.grid
        times, way = [], []
        for v, (at_s, place) in enumerate(zip(line.line_s, line.line_m, strict=True)):
            for moment in (at_s, *line.leave_s[line.line_stop == v]):
                times.append(moment + start_s)
                way.append(place)
        xy = np.stack([np.interp(clock, times, np.array(way)[:, k]) for k in range(2)], axis=1)
        out = (xy[:, 0] < grid.lane_x_m.min() + 0.1) | (xy[:, 0] > grid.lane_x_m.max() - 0.1)
        out &= (clock >= start_s) & (clock <= start_s + line.end_s)
        places.append((xy, out))
    (a, out_a), (b, out_b) = places
    step_a, step_b = np.diff(a, axis=0), np.diff(b, axis=0)
    to_each_other = (step_a * step_b).sum(axis=1) < -1e-6
    near = np.hypot(*(a - b).T)[:-1] < 1.5
    return bool((to_each_other & near & out_a[:-1] & out_b[:-1]).any())


def test_a_plan_for_narrow_headlands_has_nobody_meet_head_on():
    """One comes home from the far rows when the other sets out for them."""
    grid = rectangle(10, 8)
    plot = Plot(Field("even", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))
    chance = np.where(grid.row >= 8, 0.5, 1e-6)
    robot = Robot(hours=0.15)
    home_s = plan_team(plot, chance, team_of(1, robot)).days[0].route.end_s
    members = (TeamMember("early", robot), TeamMember("late", robot, starts_s=home_s - 30.0))
    careless = plan_team(plot, chance, members)
    assert seen_second_by_second(careless)
    careful = plan_team(plot, chance, members, passing_m=2.0 * WIDE)
    assert careful.head_on() == []
    assert careful.meetings() == []
    assert not seen_second_by_second(careful)
    assert careful.starts_s[1] > careless.starts_s[1]


def test_two_need_some_room_or_none():
    grid = rectangle(3, 5)
    plot = Plot(Field("even", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))
    with pytest.raises(SettingError, match="0 m or more to pass"):
        plan_team(plot, np.full(15, 0.1), team_of(2), passing_m=-1.0)


@pytest.mark.parametrize("back", [False, True])
def test_a_line_straight_through_an_aisle_is_in_the_headlands_before_it_and_after_it(back):
    grid = rectangle(4, 10)
    (low, high), y = grid.lane_x_m[1], grid.lane_y_m[1]
    line_m = np.array([[low - 5.0, y], [high + 10.0, y], [high + 10.0, y + 3.0]])
    times_s = np.array([7.0, 7.0 + (high - low) + 15.0, 40.0 + (high - low)])
    if back:
        line_m, times_s = line_m[::-1], (times_s[-1] - times_s)[::-1]
    steps = headlands_of(grid).steps(line_m, (times_s, times_s))
    length_m = np.hypot(*(steps.to_m - steps.from_m).T)
    assert sorted(length_m) == pytest.approx([3.0, 5.0, 10.0])
    straight = length_m > 4.0
    # one metre takes one second on the straight
    took_s = (steps.until_s - steps.since_s)[straight]
    assert took_s == pytest.approx(length_m[straight])
    x = np.stack([steps.from_m[straight, 0], steps.to_m[straight, 0]])
    assert ((x <= low + 1e-9).all(axis=0) | (x >= high - 1e-9).all(axis=0)).all()


def drawn_steps(rng, n):
    """Return steps of a line that is driven one after the other, with pauses."""
    at = rng.uniform(0.0, 12.0, (n + 1, 2))
    took_s, pause_s = rng.uniform(2.0, 9.0, n), rng.uniform(0.0, 2.0, n)
    until_s = np.cumsum(took_s + pause_s)
    return Steps(at[:-1], at[1:], until_s - took_s, until_s)


def place_at(steps, k, clock):
    share = (clock - steps.since_s[k]) / (steps.until_s[k] - steps.since_s[k])
    return steps.from_m[k] + share[:, None] * (steps.to_m[k] - steps.from_m[k])


@pytest.mark.parametrize("seed", range(8))
def test_who_drive_towards_each_other_are_nearest_when_a_clock_of_a_hundredth_has_them_so(seed):
    rng, within_m, told = np.random.default_rng(seed), 2.5, []
    one, other = drawn_steps(rng, 6), drawn_steps(rng, 5)
    found = _nearest(one, other, within_m)
    for i, j in np.ndindex(6, 5):
        begin, end = max(one.since_s[i], other.since_s[j]), min(one.until_s[i], other.until_s[j])
        if begin >= end:
            continue
        clock = np.linspace(begin, end, 2 + int((end - begin) / 0.005))
        here, there = place_at(one, i, clock), place_at(other, j, clock)
        gap_m = np.hypot(*(here - there).T)
        against = ((here[-1] - here[0]) * (there[-1] - there[0])).sum() < 0.0
        least = int(np.argmin(gap_m))
        # who have met before drive away from each other from the first on
        if against and least > 0 and gap_m[least] < within_m:
            told.append([clock[least], *here[least]])
    assert len(found) == len(told)
    assert np.array(sorted(found.tolist())) == pytest.approx(np.array(sorted(told)), abs=0.05)


def test_two_who_pass_each_other_with_half_the_room_they_need_between_them_do_not_meet():
    grid = Aisles.of(rectangle(4, 10)).grid
    x, low, high = grid.xy_m[:, 0].min() - 2.0, *np.sort(grid.lane_y_m)[[0, -1]]

    def drive(at_x, from_y, to_y):
        ends = np.array([[at_x, from_y]]), np.array([[at_x, to_y]])
        return Steps(*ends, np.zeros(1), np.full(1, 20.0))

    for apart_m, meets in ((0.5, True), (4.9, True), (5.1, False), (9.0, False), (19.0, False)):
        pair = drive(x, low, high), drive(x - apart_m, high, low)
        when = headlands_of(grid).meet(*pair, 10.0)
        assert len(when) == meets
        for at_s, *place in when:
            assert at_s == pytest.approx(10.0)
            assert place == pytest.approx([x, (low + high) / 2])


def test_a_headland_is_as_wide_as_from_the_nearest_row_to_the_edge_of_the_plot():
    grid = rectangle(4, 10)
    headlands = headlands_of(grid)
    left_m = grid.drivable_m.bounds[0]
    first_m, y = grid.xy_m[:, 0].min(), grid.xy_m[15, 1]
    for x in (left_m + 0.5, left_m + 1.5):
        width_m = headlands._width_m(np.array([[x, y]]))
        assert width_m == pytest.approx([first_m - left_m], abs=1e-6)
    steps = [Steps(*(np.array([[x, y + s]]) for s in way), np.zeros(1), np.full(1, 9.0))
             for x, way in ((left_m + 1.0, (-2.0, 2.0)), (left_m + 1.2, (2.0, -2.0)))]  # fmt: skip
    needs_m = first_m - left_m
    assert len(headlands.meet(*steps, needs_m + 0.01)) == 1
    assert len(headlands.meet(*steps, needs_m - 0.01)) == 0


@pytest.mark.parametrize("seed", range(6))
def test_steps_in_headlands_are_what_of_each_step_lies_outside_the_aisle_it_is_driven_in(seed):
    """Into aisles, out of them, through them and back, with pauses; piece by piece."""
    rng, grid = np.random.default_rng(seed), rectangle(5, 8)
    line, lane = [[0.0, 0.0]], 0
    for _ in range(14):
        (low, high), y = grid.lane_x_m[lane], grid.lane_y_m[lane]
        x = float(rng.choice([low - 3.0, low - 1.0, low + 2.0, high - 3.0, high + 1.5, high + 4.0]))
        line.append([x, y])
        # from one lane to the next in a headland only
        if not low < x < high:
            lane = int(rng.integers(5))
            line.append([x, grid.lane_y_m[lane]])
    line_m = np.array(line[1:])
    took_s = rng.uniform(1.0, 9.0, len(line_m))
    pause_s = rng.uniform(0.0, 5.0, len(line_m)) * (rng.random(len(line_m)) < 0.5)
    arrive_s = np.cumsum(took_s) + np.append(0.0, np.cumsum(pause_s)[:-1])
    leave_s = arrive_s + pause_s
    expected = []
    for k, (here, there) in enumerate(itertools.pairwise(line_m)):
        (way,) = np.flatnonzero(np.abs(here - there) > 1e-9)[:1] if (here != there).any() else (0,)
        since_s, until_s = leave_s[k], arrive_s[k + 1]
        shares = [0.0, 1.0]
        inside = np.zeros(2)
        if way == 0 and here[0] != there[0]:
            inside = grid.lane_x_m[np.abs(grid.lane_y_m - here[1]).argmin()]
            ends = (inside - here[0]) / (there[0] - here[0])
            shares = sorted([*shares, *ends[(ends > 1e-9) & (ends < 1 - 1e-9)]])
        for a, b in itertools.pairwise(shares):
            middle = here + (a + b) / 2 * (there - here)
            if (here != there).any() and not (way == 0 and inside[0] < middle[0] < inside[1]):
                expected.append([*(here + a * (there - here)), *(here + b * (there - here)),
                                 since_s + a * (until_s - since_s),
                                 since_s + b * (until_s - since_s)])  # fmt: skip
    found = headlands_of(grid).steps(line_m, (arrive_s, leave_s))
    told = np.column_stack([found.from_m, found.to_m, found.since_s, found.until_s])
    assert told.tolist() == pytest.approx(np.array(expected), abs=1e-6)
