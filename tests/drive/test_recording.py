"""What is noted of a driven day."""

from itertools import pairwise

import numpy as np
import pytest

from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.errand import Visit
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


def of_live(monitor, plot, robot, pace, *, tells):
    """Return what is recorded of a live robot of a pace of its own, which looks as long as told."""
    aisles = plot.aisles.for_robot(robot)
    recording = Recording(aisles, robot)

    class Live:
        """Says at each corner where it is, 5 cm to the left, if it `tells`."""

        def begin(self, _aisles, _at_m, gone_s):
            self.now_s = gone_s

        def drives(self, line_m):
            for a, b in pairwise(line_m):
                self.now_s += float(np.hypot(*(b - a))) / pace
                self.says(b)

        def says(self, at_m):
            if tells:
                recording.see(self.now_s, at_m + np.array([0.0, 0.05]))

        def visit(self, errand):
            self.drives(errand.line_m)
            there_s = self.now_s
            self.now_s += errand.look_s
            self.says(errand.line_m[-1])
            return Visit(found=False, done_s=self.now_s, there_s=there_s if tells else None)

        def home(self, line_m):
            self.drives(line_m)
            return Visit(None, self.now_s)

    with monitor.day() as day:
        driven = drive_day(day, aisles, (robot, Live()), recording.note_live)
    recording.end(driven)
    return recording, driven


@pytest.mark.parametrize("times", [0.2, 1.0, 3.0])
@pytest.mark.parametrize("tells", [True, False])
def test_a_live_robot_is_drawn_as_fast_as_it_was_and_all_the_way_home(
    monitor, plot, robot, times, tells
):
    pace = times * robot.speed_m_s
    recording, driven = of_live(monitor, plot, robot, pace, tells=tells)
    assert len(driven.stops) > 3
    poses = recording.track.poses
    took_s = np.diff(poses[:, 0])
    assert (took_s > 0).all()
    speed = np.hypot(*np.diff(poses[:, 1:3], axis=0).T) / took_s
    assert np.sort(speed)[-3:] == pytest.approx(pace, rel=0.1)
    assert poses[-1, 0] == pytest.approx(driven.home.done_s)
    off_m = np.array([0.0, 0.05 if tells else 0.0])
    assert poses[-1, 1:3] == pytest.approx(recording.aisles.gate_m + off_m, abs=0.01)
    for one in recording.stops:
        at = np.searchsorted(poses[:, 0], one.at_s + 1e-6) - 1
        assert poses[at, 1:3] == pytest.approx(recording.aisles.stop_m[one.plant] + off_m, abs=0.01)


def test_the_way_home_of_a_robot_without_a_track_is_recorded(monitor, plot, robot):
    aisles = plot.aisles.for_robot(robot)
    recording, charged = Recording(aisles, robot), ChargedRobot(lambda _: False)
    with monitor.day() as day:
        driven = drive_day(day, aisles, (robot, charged), recording.note)
    recording.end(driven)
    ends_s = recording.stops[-1].at_s + driven.home_charged_s
    assert recording.track.poses[-1, :3] == pytest.approx([ends_s, *aisles.gate_m])
