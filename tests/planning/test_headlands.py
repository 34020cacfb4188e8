"""Head-on in a headland: seen on the lines, and avoided where it is too narrow."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.headlands import head_on, headlands_of
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
