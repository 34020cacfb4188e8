"""Robots of a simulation."""

import numpy as np
import pytest

from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.mujoco_robot import MujocoRobot
from fieldmon.drive.recording import Recording
from fieldmon.drive.simulated_robots import MadeUp, simulated_robot
from fieldmon.errors import SettingError
from fieldmon.samplers import sampler


@pytest.mark.parametrize(("kind", "made"), [("charged", ChargedRobot), ("mujoco", MujocoRobot)])
def test_a_simulated_robot_is_made_by_its_name(plot, robot, kind, made):
    recording = Recording(plot.aisles, robot, np.full(len(plot.grid), 0.1))
    assert isinstance(simulated_robot(kind, recording, sampler("adaptive"), MadeUp()), made)


def test_an_unknown_robot_and_one_without_chances_are_refused(plot, robot):
    recording = Recording(plot.aisles, robot, np.full(len(plot.grid), 0.1))
    with pytest.raises(SettingError, match="charged or mujoco, but it is 'gazebo'"):
        simulated_robot("gazebo", recording, sampler("adaptive"), MadeUp())
    with pytest.raises(SettingError, match="the morning's chances"):
        simulated_robot("charged", Recording(plot.aisles, robot), sampler("adaptive"), MadeUp())
