"""Along a line, by a robot that does exactly what it is told."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldmon.drive.pursuit import REACH_M, Pace, Pursuit

PACE = Pace(0.7)


def driven(line, yaw=0.0, most_s=600.0):
    """Return the poses ``(k, 4)`` (t, x, y, yaw) of an ideal robot, and the pursuit."""
    line = np.asarray(line, float)
    way, (x, y), v, dt, poses = Pursuit(line, PACE), line[0], 0.0, 0.05, []
    while not way.done:
        v, turn = way.command((x, y), yaw, v, dt)
        yaw += turn * dt
        x, y = x + v * dt * math.cos(yaw), y + v * dt * math.sin(yaw)
        poses.append((len(poses) * dt, x, y, yaw))
        assert len(poses) * dt < most_s
    return np.array(poses), way


def test_it_stops_at_the_end_of_the_line():
    poses, _ = driven([[0, 0], [5, 0]])
    assert poses[-1, 1] == pytest.approx(5.0, abs=REACH_M)
    # five metres, and what gathering and losing speed costs
    assert poses[-1, 0] == pytest.approx(5 / 0.7 + 0.7 / 0.5, abs=0.4)


def test_what_lies_behind_is_driven_to_backwards():
    poses, _ = driven([[0, 0], [-3, 0]])
    assert poses[-1, 1] == pytest.approx(-3.0, abs=REACH_M)
    assert np.abs(poses[:, 3]).max() < 0.05


def test_a_corner_is_turned_on_the_spot_by_a_right_angle_at_most():
    poses, way = driven([[0, 0], [4, 0], [4, 3], [1, 3]])
    assert poses[-1, 1:3] == pytest.approx([1.0, 3.0], abs=2 * REACH_M)
    assert max(way.off_m((x, y)) for _, x, y, _ in poses) < 0.05
    assert np.abs(np.diff(poses[:, 3])).sum() == pytest.approx(math.pi, abs=0.2)


def test_a_bend_is_followed_without_stopping():
    angle = np.linspace(0, math.pi / 2, 20)
    line = np.stack([8 * np.sin(angle), 8 - 8 * np.cos(angle)], axis=1)
    poses, way = driven(line)
    assert max(way.off_m((x, y)) for _, x, y, _ in poses) < 0.06
    assert poses[-1, 0] < 4 * math.pi / 0.7 + 3.0


def test_a_line_of_no_length_is_done_at_once():
    assert Pursuit(np.zeros((1, 2)), PACE).done
    assert Pursuit(np.zeros((2, 2)), PACE).done


@settings(max_examples=20)
@given(
    corners=st.lists(st.tuples(st.integers(-4, 4), st.integers(-4, 4)), min_size=2, max_size=6),
    yaw=st.floats(-3.0, 3.0),
)
def test_any_line_is_driven_to_its_end_close_by(corners, yaw):
    line = np.array(corners, float)
    keep = np.append(True, np.hypot(*np.diff(line, axis=0).T) > 0)
    assume(keep.sum() > 1)
    poses, way = driven(line[keep], yaw)
    assert np.hypot(*(poses[-1, 1:3] - line[-1])) < 0.1
    assert max(way.off_m((x, y)) for _, x, y, _ in poses) < 0.1
