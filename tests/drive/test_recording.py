"""What is noted of a driven day."""

import numpy as np
import pytest

from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.recording import Recording


def test_a_robot_without_a_track_is_taken_to_drive_its_lines_evenly(monitor, plot, robot):
    aisles = plot.aisles.for_robot(robot)
    recording = Recording(aisles, robot)
    charged = ChargedRobot(lambda stop: stop.plant % 7 == 0)
    with monitor.day() as day:
        driven = drive_day(day, aisles, (robot, charged), recording.note)
    assert [one.plant for one in recording.stops] == [one.stop.plant for one in driven.stops]
    assert sum(one.found is True for one in recording.stops) == driven.found
    poses = recording.track.poses
    assert (np.diff(poses[:, 0]) > 0).all()
    speed = np.hypot(*np.diff(poses[:, 1:3], axis=0).T) / np.diff(poses[:, 0])
    assert speed.max() <= robot.speed_m_s * 1.5
    for one in recording.stops:
        at = np.searchsorted(poses[:, 0], one.at_s + 1e-6) - 1
        assert poses[at, 1:3] == pytest.approx(aisles.stop_m[one.plant], abs=1e-6)
