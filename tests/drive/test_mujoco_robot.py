"""Driven in MuJoCo: no plant touched, the seconds as charged, and what goes wrong is said."""

import builtins
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.drive.day import drive_day
from fieldmon.drive.mujoco_robot import MujocoRobot
from fieldmon.drive.track import Track
from fieldmon.errors import SettingError
from fieldmon.plot.clearance import STRAY_M


@pytest.fixture(scope="module")
def driven(plot, robot):
    from fieldmon.monitoring.monitor import Monitor

    chance = np.random.default_rng(3).uniform(0.005, 0.3, len(plot.grid))
    robot, track = replace(robot, hours=0.5, turn_180_s=0.0), Track()
    aisles = plot.aisles.for_robot(robot)
    driver = MujocoRobot(robot, lambda stop: stop.plant % 9 == 0, 0.02, track=track)
    with Monitor(plot, robot=robot, chance=chance).day() as day:
        return drive_day(day, aisles, (robot, driver)), track.poses, aisles


def test_a_day_is_driven_without_touching_a_plant(driven):
    day, _, _ = driven
    assert len(day.stops) > 20
    assert day.found > 0
    assert day.touched == frozenset()
    assert day.stuck == []
    assert day.strayed_m < STRAY_M


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
    from fieldmon.monitoring.monitor import Monitor

    wide = replace(robot, width_m=2.9, length_m=2.9)
    driver = MujocoRobot(wide, lambda stop: False)  # noqa: ARG005
    with Monitor(plot, robot=replace(robot, width_m=None, length_m=None)).day() as day:
        done = drive_day(day, plot.aisles, (robot, driver))
    assert done.touched
    assert "did not get on" in done.stuck[0]
    assert done.stops[-1].visit.found is None


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
