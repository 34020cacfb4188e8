"""Along pieces of a way, by a robot with a steered axle that does exactly what it is told."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from fieldmon.drive.pursuit import REACH_M, Pace
from fieldmon.drive.steered_pursuit import SteeredPursuit
from fieldmon.plot.steered_way import way_of
from fieldmon.plot.turning import TurningRoom

BOX = np.array([[-0.2, -0.3], [0.6, -0.3], [0.6, 0.3], [-0.2, 0.3]])
SHARPEST = 1.1


def driven(line, posts, yaw=0.0):
    line = np.asarray(line, float)
    pieces, stuck = way_of(line, yaw, TurningRoom(1.0, BOX, cKDTree(np.array(posts, float)), 0.3))
    assert stuck is None
    way = SteeredPursuit(pieces, Pace(0.7), SHARPEST)
    (x, y), v, dt, poses = line[0], 0.0, 0.05, []
    while not way.done:
        v, bend = way.command((x, y), yaw, v, dt)
        assert abs(bend) <= SHARPEST + 1e-9
        yaw += v * bend * dt
        x, y = x + v * dt * math.cos(yaw), y + v * dt * math.sin(yaw)
        poses.append((len(poses) * dt, x, y, yaw, v))
        assert len(poses) * dt < 300
    return np.array(poses), way


def test_a_corner_is_driven_by_an_arc_without_stopping():
    poses, way = driven([[0, 0], [6, 0], [6, 6]], [[50, 50]])
    assert poses[-1, 1:3] == pytest.approx([6, 6], abs=2 * REACH_M)
    assert max(way.off_m((x, y)) for _, x, y, _, _ in poses) < 0.05
    assert poses[40:-40, 4].min() > 0.3


def test_a_shunt_goes_ahead_and_back_and_stays_on_its_way():
    poses, way = driven([[0, 0], [6, 0], [6, 6]], [[5.3, 0.7], [5.3, 1.7], [4.3, 0.7]])
    assert poses[-1, 1:3] == pytest.approx([6, 6], abs=2 * REACH_M)
    assert poses[:, 4].min() < -0.1
    assert poses[:, 4].max() > 0.1
    assert max(way.off_m((x, y)) for _, x, y, _, _ in poses) < 0.05


def test_backwards_it_keeps_its_heading():
    poses, _ = driven([[0, 0], [-4, 0]], [[50, 50]])
    assert poses[-1, 1] == pytest.approx(-4.0, abs=REACH_M)
    assert np.abs(poses[:, 3]).max() < 0.02


def test_no_way_is_done_at_once():
    assert SteeredPursuit([], Pace(0.7), SHARPEST).done
