"""A robot that cannot turn on the spot: where it has room at row ends, and what that takes."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from fieldmon.errors import PlotError, SettingError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.planning.assumptions import assumed_by
from fieldmon.planning.routes.best_route import best
from fieldmon.plot.clearance import Clearance
from fieldmon.plot.end_turns import end_turns
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.steered_way import way_of
from fieldmon.plot.travel import Aisles, driven_s, robot_clock

STEERED = Robot(width_m=0.6, length_m=1.0, turning_radius_m=1.2)


def grid(row_m=3.0, headland_m=4.0, n_rows=6, plants=20):
    planting = Planting(row_spacing_m=row_m, plant_spacing_m=1.0, headland_m=headland_m)
    return rectangle(n_rows, plants, planting)


def turns_of(plot, robot=STEERED):
    return end_turns(plot, Clearance.of(robot, plot).circle)


def tight_at_the_high_end(n_rows=4):
    """Return a plot whose lanes end 0.9 m beyond the last plants, where it ends too."""
    plot = grid(n_rows=n_rows)
    ends_m = plot.lane_x_m.copy()
    ends_m[:, 1] = float(plot.along_m.max()) + 0.9
    inside = shapely.intersection(plot.drivable_m, shapely.box(-99, -99, ends_m[0, 1] + 0.05, 99))
    area = shapely.multipolygons([*getattr(inside, "geoms", [inside])])
    return replace(plot, lane_x_m=ends_m, drivable_m=area)


def test_wide_headlands_have_room_everywhere_and_the_ways_planned_are_those_without_a_radius():
    plot = grid()
    assert turns_of(plot).room.all()
    usual = Aisles.of(plot).for_robot(replace(STEERED, turning_radius_m=None))
    steered = Aisles.of(plot).for_robot(STEERED)
    places = np.arange(0, len(plot), 7)
    assert (steered.distance_m(-1, places) == usual.distance_m(-1, places)).all()


def test_without_room_at_any_row_end_nothing_is_planned_and_the_radius_named():
    with pytest.raises(PlotError, match=r"turning radius of 3 m it has none at any row"):
        Aisles.of(grid(headland_m=1.2)).for_robot(
            Robot(width_m=1.1, length_m=2.4, turning_radius_m=3.0)
        )


def test_ends_without_room_are_not_turned_at():
    plot, robot = tight_at_the_high_end(), Robot(width_m=0.6, length_m=2.0, turning_radius_m=3.0)
    room = turns_of(plot, robot).room
    assert room[:, 0].all()
    assert not room[:, 1].any()
    usual = Aisles.of(plot).for_robot(replace(robot, turning_radius_m=None, length_m=0.6))
    steered = Aisles.of(plot).for_robot(robot)
    assert not steered.too_narrow.any()
    here, there = 19, 39  # the last plants of two rows
    assert usual.distance_m(here, there) < 6
    assert steered.distance_m(here, there) > 40
    line = steered.path(here, there)
    _, stuck = way_of(line, np.pi, steered.clearance.circle.room(plot))
    assert stuck is None


def test_a_way_leaves_no_lane_to_the_side_without_room():
    """Ways between lane ends whose sides are shut are none; the other side's stay."""
    plot = grid()
    circle = Clearance.of(STEERED, plot).circle
    known = end_turns(plot, circle)
    room = known.room.copy()
    room[2, 1, 1] = False
    ways = Aisles.of(plot).for_robot(STEERED)
    here, upper = 59, 79
    short_m = float(ways.distance_m(here, upper))

    class Shut(Clearance):
        def turn_room(self, _grid):
            return room

    shut = Aisles.of(plot, clearance=Shut(*Clearance.of(STEERED, plot)))
    assert float(shut.distance_m(here, upper)) == short_m + 3
    assert shut.distance_m(here, 19) == ways.distance_m(here, 19)


def test_wider_turns_take_longer_and_narrow_aisles_cost_shunts():
    seconds = [
        Aisles.of(grid()).worked_by(replace(STEERED, turning_radius_m=r)).row_change_s
        for r in (0.7, 1.2, 2.5, 4.0)
    ]
    assert seconds == sorted(seconds)
    narrow = Aisles.of(grid(row_m=2.0)).worked_by(STEERED).row_change_s
    assert narrow > Aisles.of(grid()).worked_by(STEERED).row_change_s + 3


@pytest.mark.parametrize(
    "robot",
    [
        STEERED.with_times("thesis"),
        replace(STEERED, row_change_s=40.0),
        replace(STEERED, turning_radius_m=None),
        Robot(),
    ],
)
def test_times_that_were_chosen_are_charged_as_they_are(robot):
    assert Aisles.of(grid()).worked_by(robot) is robot


def test_what_is_charged_is_charged_once_and_said():
    plot = grid()
    worked = Aisles.of(plot).worked_by(STEERED)
    assert worked.row_change_s != STEERED.row_change_s
    assert Aisles.of(plot).worked_by(worked) is worked
    said = {one.setting: one.value for one in assumed_by((), PriorSettings(), STEERED, plot)}
    assert said["row_change_s"] == worked.row_change_s
    assert said["stop_s"] == worked.stop_s


def test_a_best_route_is_charged_its_turns():
    aisles, worth = Aisles.of(grid()), np.ones(120)
    found = best(aisles, worth, STEERED, 1200.0)
    places = np.concatenate([[-1], found.plant, [-1]]).astype(np.int64)
    worked = aisles.worked_by(STEERED)
    took_s = driven_s(aisles.for_robot(STEERED).travel, robot_clock(worked, 1200.0), places)
    took_s += worked.visit_s * len(found.plant)
    assert found.seconds == pytest.approx(took_s)
    assert took_s <= 1200.0


@pytest.mark.parametrize("radius_m", [0.0, 0.05, 21.0])
def test_impossible_radii_are_refused(radius_m):
    with pytest.raises(SettingError, match=r"turning_radius_m must be 0\.1 to 20 metres"):
        replace(STEERED, turning_radius_m=radius_m)


def test_a_radius_needs_a_width():
    with pytest.raises(SettingError, match="must have a width too"):
        Robot(turning_radius_m=1.0)
