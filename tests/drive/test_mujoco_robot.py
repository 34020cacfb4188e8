"""Driven in MuJoCo: no plant touched, the seconds as charged, and what goes wrong is said."""

import builtins
from dataclasses import replace

import numpy as np
import pytest
import shapely

from fieldmon.drive.day import drive_day
from fieldmon.drive.ground import rough_ground
from fieldmon.drive.mujoco_robot import MujocoRobot, Physics
from fieldmon.drive.robot_body import RobotBody, with_turning_radius
from fieldmon.drive.track import Track
from fieldmon.errors import SettingError
from fieldmon.plot.clear_lanes import lane_lines
from fieldmon.plot.clearance import STRAY_M
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.drive.models import TRACTOR, urdf


@pytest.fixture(scope="module")
def driven(plot, robot):
    from fieldmon.monitoring.estimates.monitor import Monitor

    chance = np.random.default_rng(3).uniform(0.005, 0.3, len(plot.grid))
    robot, track = replace(robot, hours=0.14, turn_180_s=0.0), Track()
    aisles = plot.aisles.for_robot(robot)
    driver = MujocoRobot(robot, lambda stop: stop.plant % 4 == 0, Physics(gnss_m=0.02), track)
    with Monitor(plot, robot=robot, chance=chance).day() as day:
        return drive_day(day, aisles, (robot, driver)), track.poses, aisles


def test_a_day_is_driven_without_touching_a_plant(driven):
    day, _, _ = driven
    assert len(day.stops) > 6
    assert day.found > 0
    assert day.touched == frozenset()
    assert day.stuck == []
    assert day.strayed_m < STRAY_M


@pytest.mark.parametrize(("room_m", "over_m"), [(0.1, (0.1, 0.5)), (1.5, (0.0, 0.01))])
def test_how_far_an_outline_reaches_over_the_boundary_is_measured(plot, robot, room_m, over_m):
    lanes = shapely.union_all(lane_lines(plot.grid))
    area = shapely.MultiPolygon([shapely.convex_hull(lanes).buffer(room_m)])
    grid = replace(plot.grid, drivable_m=area)
    on = replace(plot, aisles=Aisles.of(grid, tuple(plot.aisles.gate_m)))
    least, most = over_m
    assert least <= a_short_day(on, robot, RobotBody.of(robot)).over_m < most


def test_charged_and_driven_seconds_are_as_one(driven):
    day, _, _ = driven
    assert day.driven_s == pytest.approx(day.charged_s, rel=0.03)


def test_the_track_runs_by_every_plant_and_back_to_the_gate(driven):
    day, poses, aisles = driven
    for one in day.stops:
        at = np.searchsorted(poses[:, 0], one.visit.done_s) - 1
        assert poses[at, 1:3] == pytest.approx(aisles.stop_m[one.stop.plant], abs=0.1)
    assert poses[-1, 1:3] == pytest.approx(aisles.gate_m, abs=0.1)
    assert (np.diff(poses[:, 0]) > 0).all()


def test_a_robot_too_wide_for_its_way_touches_plants_and_is_stuck(plot, robot):
    """The fault of planning for a point: it is seen, and the day ends there."""
    from fieldmon.monitoring.estimates.monitor import Monitor

    wide = replace(robot, width_m=2.9, length_m=2.9)
    driver = MujocoRobot(wide, lambda stop: False)  # noqa: ARG005
    with Monitor(plot, robot=replace(robot, width_m=None, length_m=None)).day() as day:
        done = drive_day(day, plot.aisles, (robot, driver))
    assert done.touched
    assert "did not get on" in done.stuck[0]
    assert done.stops[-1].visit.found is None


def a_short_day(plot, robot, body, ground=None, planned=None):
    from fieldmon.monitoring.estimates.monitor import Monitor

    robot = replace(robot, hours=0.06, turn_180_s=0.0, look_s=20.0)
    planned = robot if planned is None else replace(planned, hours=0.06)
    chance = np.random.default_rng(3).uniform(0.005, 0.3, len(plot.grid))
    driver = MujocoRobot(robot, lambda stop: stop.plant == -1, Physics(body, 0.02, 1, ground))
    with Monitor(plot, robot=planned, chance=chance).day() as day:
        return drive_day(day, plot.aisles.for_robot(planned), (planned, driver))


def test_a_steered_robot_touches_no_plant_on_rough_ground(plot, robot):
    robot = with_turning_radius(robot)
    day = a_short_day(plot, robot, RobotBody.of(robot, "ackermann"), rough_ground(plot.grid, 0.02))
    assert len(day.stops) > 2
    assert not day.touched
    assert not day.stuck
    assert day.strayed_m < STRAY_M


def test_a_steered_robot_takes_what_its_turns_are_charged():
    """Every plant in another aisle: two turns a stop, some of them with shunts."""
    grid = rectangle(10, 6, Planting(row_spacing_m=2.0, plant_spacing_m=1.5, headland_m=4.0))
    robot = with_turning_radius(Robot(width_m=0.7, length_m=1.3, look_s=5.0))
    aisles = Aisles.of(grid)
    ways, worked = aisles.for_robot(robot), aisles.worked_by(robot)
    driver = MujocoRobot(robot, lambda stop: False, Physics(RobotBody.of(robot, "ackermann")))  # noqa: ARG005
    turns = range(1, 4)
    driver.begin(ways, ways.gate_m, 0.0)
    driver.home(ways.path(-1, 3))
    since_s = driver.home(ways.path(3, 3 + 6)).done_s
    for row in turns:
        done = driver.home(ways.path(6 * row + 3, 6 * (row + 1) + 3))
        assert not done.touched
        assert not done.stuck
    way_m = sum(float(ways.distance_m(6 * row + 3, 6 * row + 9)) for row in turns)
    took_s = (done.done_s - since_s - way_m / robot.speed_m_s) / len(turns) - worked.stop_s
    assert worked.row_change_s > 5.0
    assert took_s == pytest.approx(worked.row_change_s, rel=0.1)


def test_a_robot_that_turns_wider_than_planned_for_is_refused(plot, robot):
    steered = RobotBody.of(robot, "ackermann")
    with pytest.raises(SettingError, match=r"planned for one that turns on the spot.* 0\.90"):
        a_short_day(plot, robot, steered)
    with pytest.raises(SettingError, match=r"is 0\.89 m, but the day was planned for 0\.5 m"):
        a_short_day(plot, replace(robot, turning_radius_m=0.5), steered)
    with pytest.raises(SettingError, match="must steer, but the simulated one turns on the spot"):
        a_short_day(plot, replace(robot, turning_radius_m=0.9), RobotBody.of(robot))


def test_the_robot_of_a_file_drives_and_one_wider_than_planned_for_is_refused(
    plot, robot, tmp_path
):
    (tmp_path / "robot.urdf").write_text(urdf())
    body = RobotBody.of(robot, model=tmp_path / "robot.urdf")
    day = a_short_day(plot, robot, body)
    assert len(day.stops) > 2
    assert not day.touched
    assert not day.stuck
    with pytest.raises(SettingError, match=r"0\.56 m wide and 0\.74 m long.* --width 0\.57"):
        a_short_day(plot, replace(robot, width_m=0.4, length_m=0.6), body)


def test_where_a_steered_robot_has_no_room_to_turn_the_day_ends_and_says_so(plot, robot, tmp_path):
    """A tractor that hardly steers, in narrow headlands: no shunt is short enough."""
    grid = rectangle(8, 12, Planting(row_spacing_m=2.0, plant_spacing_m=1.5, headland_m=1.6))
    plot = Plot(plot.field, Aisles.of(grid))
    (tmp_path / "long.xml").write_text(TRACTOR.replace('range="-.6 .6"', 'range="-.034 .034"'))
    wide = replace(robot, width_m=0.65, length_m=1.1, turning_radius_m=19.9)
    body = RobotBody.of(wide, model=tmp_path / "long.xml")
    day = a_short_day(plot, wide, body, planned=replace(wide, turning_radius_m=None))
    assert "no room to turn" in day.stuck[0]
    assert "turning circle of" in day.stuck[0]


def test_without_mujoco_it_is_said_how_to_get_it(plot, robot, monkeypatch):
    real = builtins.__import__

    def missing(name, *rest):
        if name == "mujoco":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", missing)
    driver = MujocoRobot(robot, lambda stop: False)  # noqa: ARG005
    with pytest.raises(SettingError, match=r"fieldmon\[sim\]"):
        driver.begin(plot.aisles, plot.aisles.gate_m, 0.0)
