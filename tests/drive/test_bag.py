"""Bags, read back by another reader than the one that wrote them."""

import errno
import math
from datetime import UTC, datetime, timedelta
from itertools import pairwise

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from fieldmon.drive import bag
from fieldmon.drive.bag import read_bag, write_bag
from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.recording import Recording
from fieldmon.errors import FileProblem, SettingError
from fieldmon.monitoring.estimates.monitor import Monitor

BEGINS = datetime(2026, 4, 6, 3, tzinfo=UTC)


@pytest.fixture(scope="module")
def recording(plot, robot):
    chance = np.random.default_rng(3).uniform(0.005, 0.3, len(plot.grid))
    aisles = plot.aisles.for_robot(robot)
    made = Recording(aisles, robot, chance)
    with Monitor(plot, robot=robot, chance=chance).day() as day:
        drive_day(day, aisles, (robot, ChargedRobot(lambda s: s.plant % 7 == 0)), made.note)
    return made


@pytest.fixture(scope="module")
def messages(recording, tmp_path_factory):
    path, *layouts = write_bag(recording, BEGINS, tmp_path_factory.mktemp("bag") / "day.mcap")
    assert [one.name for one in layouts] == ["day.rviz", "day.foxglove.json"]
    found = {}
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append((message.log_time / 1e9, decoded))
    return found


def test_the_robot_is_where_it_was_when_it_was_there(messages, recording):
    poses = recording.track.poses
    frame = recording.aisles.grid.frame
    east_north = frame.turned(90.0).xy_m(frame.lonlat(poses[:, 1:3]))
    for at_s, message in messages["/tf"]:
        (moved,) = message.transforms
        assert (moved.header.frame_id, moved.child_frame_id) == ("map", "base_link")
        since = at_s - BEGINS.timestamp()
        k = np.argmin(np.abs(poses[:, 0] - since))
        place = moved.transform.translation
        assert (place.x, place.y) == pytest.approx(tuple(east_north[k]), abs=0.01)
    assert len(messages["/tf"]) > 100


def test_the_robot_points_where_it_drives(messages):
    transforms = [message.transforms[0].transform for _, message in messages["/tf"]]
    agreed = 0
    for one, after in pairwise(transforms):
        east, north = (
            after.translation.x - one.translation.x,
            after.translation.y - one.translation.y,
        )
        if math.hypot(east, north) > 0.3:
            yaw = 2 * math.atan2(one.rotation.z, one.rotation.w)
            agreed += math.cos(yaw - math.atan2(north, east)) > 0.999
    assert agreed > 30


def test_fixes_are_degrees_on_the_plot(messages, plot):
    west, south, east, north = plot.field.boundary.bounds
    for _, fix in messages["/gps/fix"]:
        assert west - 1e-4 < fix.longitude < east + 1e-4
        assert south - 1e-4 < fix.latitude < north + 1e-4
    assert len(messages["/odom"]) == len(messages["/gps/fix"])


def test_odometry_tells_how_fast_the_robot_is(messages, robot):
    twists = [message.twist for _, message in messages["/odom"]]
    speeds = np.array([one.twist.linear.x for one in twists])
    assert speeds.max() == pytest.approx(robot.speed_m_s, rel=0.01)
    assert (np.abs(speeds) < 1e-6).mean() > 0.5  # it stands to look
    assert min(one.covariance[0] for one in twists) > 0.0
    assert all(message.pose.covariance[0] == 1e-6 for _, message in messages["/odom"])


def test_the_receivers_frame_is_there_and_its_noise_is_not_known(messages):
    ((_, static),) = messages["/tf_static"]
    (gps,) = static.transforms
    assert (gps.header.frame_id, gps.child_frame_id) == ("base_link", "gps")
    fixes = [fix for _, fix in messages["/gps/fix"]]
    assert {fix.header.frame_id for fix in fixes} == {"gps"}
    # nobody said what a robot without physics hears
    assert {fix.position_covariance_type for fix in fixes} == {0}


def test_fixes_are_those_that_the_robot_had_and_it_turns_as_it_did(plot, robot, tmp_path):
    made = Recording(plot.aisles.for_robot(robot), robot)
    made.track.fix_m = 0.3
    for k in range(50):
        made.track.add(0.1 * k, 0.05 * k, 0.0, 3.1 + 0.01 * k)  # backwards, and over half a turn
        made.track.fix(0.1 * k, 0.05 * k + 7.0, 5.0)
    made.track.add(4.9, 2.45, 0.0, 3.59)  # of the same moment
    path, *_ = write_bag(made, BEGINS, tmp_path / "day.mcap")
    got = {topic: [] for topic in ("/gps/fix", "/odom")}
    for topic, _, message in read_bag(path, tuple(got)):
        got[topic].append(message)
    frame = plot.grid.frame
    fixes = frame.xy_m(np.array([(one.longitude, one.latitude) for one in got["/gps/fix"]]))
    assert fixes == pytest.approx(np.array([(0.5 * k + 7.0, 5.0) for k in range(5)]), abs=1e-3)
    assert {one.position_covariance[0] for one in got["/gps/fix"]} == {0.09}
    assert {one.position_covariance_type for one in got["/gps/fix"]} == {2}
    turns = [one.twist.twist.angular.z for one in got["/odom"]]
    assert turns == pytest.approx([0.1] * len(turns), abs=1e-6)
    assert got["/odom"][0].twist.twist.linear.x == pytest.approx(0.5 * math.cos(3.1), abs=1e-3)


def test_every_plant_stands_there_and_every_find_lights_up(messages, recording):
    ((_, plants),) = messages["/plants"]
    assert len(plants.markers[0].points) == len(recording.aisles.grid)
    assert len(plants.markers[0].colors) == len(recording.aisles.grid)
    finds = [(m.markers[0].id, m.markers[0].colors[0].r > 0.5) for _, m in messages["/finds"]]
    assert finds == [(one.plant, bool(one.found)) for one in recording.stops]


def test_the_plan_changes_as_it_did(messages, recording):
    assert len(messages["/plan"]) == len(recording.stops)
    for (_, path), one in zip(messages["/plan"], recording.stops, strict=True):
        assert len(path.poses) == len(one.line_m)


def test_four_hours_of_driving_are_less_than_ten_megabytes(plot, robot, tmp_path):
    """A robot that never stands, ten poses a second: here a sixteenth of it."""
    recording = Recording(plot.aisles.for_robot(robot), robot)
    rng = np.random.default_rng(1)
    places = np.cumsum(rng.normal(0, 0.05, (4 * 36_000 // 16, 3)), axis=0)
    for k, (x, y, yaw) in enumerate(places.tolist()):
        recording.track.add(0.1 * k, x, y, yaw)
    path, *_ = write_bag(recording, BEGINS + timedelta(hours=3), tmp_path / "long.mcap")
    assert path.stat().st_size < 10e6 / 16


def test_a_bag_for_which_is_no_room_is_named(recording, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.EFBIG, "File too large")

    monkeypatch.setattr(bag._Pen, "write", full)
    with pytest.raises(FileProblem, match=r"day\.mcap could not be written.*File too large"):
        write_bag(recording, BEGINS, tmp_path / "day.mcap")


def test_a_bag_of_another_name_is_refused(recording, tmp_path):
    with pytest.raises(SettingError, match=r"\.mcap"):
        write_bag(recording, BEGINS, tmp_path / "day.bag")
