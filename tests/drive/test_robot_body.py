"""Robots of ours and of files: what is read of them, and what is refused in a sentence."""

import math

import mujoco
import pytest

from fieldmon.drive.mujoco_plot import world_xml
from fieldmon.drive.robot_body import RobotBody, sharpest_of
from fieldmon.errors import FileProblem, SettingError
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from tests.drive.models import TRACTOR, urdf


def measured(body):
    world = mujoco.MjSpec.from_string(world_xml(rectangle(2, 2), 0.005))
    body.put_into(world, mujoco)
    model = world.compile()
    return body.wheels(model, mujoco), body.box_m(model, mujoco)


def of_file(folder, text, name="robot.urdf"):
    (folder / name).write_text(text)
    return RobotBody.of(Robot(), model=folder / name)


@pytest.mark.parametrize("steering", ["differential", "ackermann"])
def test_our_robot_is_as_wide_and_as_long_as_was_said(steering):
    _, (low, high) = measured(RobotBody.of(Robot(width_m=0.7, length_m=1.1), steering))
    assert high[1] - low[1] == pytest.approx(0.7)
    assert high[0] - low[0] == pytest.approx(1.1)


def test_the_wheels_of_a_model_of_ros_are_measured(tmp_path):
    wheels, (low, high) = measured(of_file(tmp_path, urdf()))
    assert wheels.radius_m == pytest.approx(0.16)
    assert wheels.track_m == pytest.approx(0.5)
    assert wheels.axle_m == pytest.approx(0.05)
    assert wheels.stand_m == pytest.approx(0.16)
    assert wheels.turning_m == 0.0
    assert high[1] - low[1] == pytest.approx(0.56, abs=1e-4)


def test_a_steered_model_has_its_turning_circle(tmp_path):
    wheels, _ = measured(of_file(tmp_path, TRACTOR, "tractor.xml"))
    assert wheels.base_m == pytest.approx(0.6)
    assert wheels.steers_rad == pytest.approx(0.6)
    # the inner wheel at its stop: the circle of the driven axle, and a tenth to spare
    assert wheels.turning_m == pytest.approx(1.1 * (0.6 / math.tan(0.6) + 0.25))
    inner = wheels.commands(1.0, sharpest_of(wheels.turning_m))[2]
    assert inner == pytest.approx(0.6)


def test_wheels_turn_as_the_robot_drives(tmp_path):
    wheels, _ = measured(of_file(tmp_path, urdf()))
    left, right = wheels.commands(0.5, 1.0)
    assert (left + right) / 2 * wheels.radius_m == pytest.approx(0.5)
    assert (right - left) * wheels.radius_m / wheels.track_m == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<robot", "MuJoCo cannot read the robot model robot.urdf"),
        ("{}", "cannot read the robot model"),
        (urdf(("a", "b")), "hinges named left and right .* are: a_wheel_joint, b_wheel_joint"),
        (urdf(("right", "left")), "the left one at the left"),
        (urdf(axis="0 0 1"), "must be a hinge around the y axis"),
        ('<mujoco><worldbody><geom size="1"/></worldbody></mujoco>', "joints of .* are: none"),
        (TRACTOR.replace('"steer_right"', '"wheel"'), "steer_left and steer_right if it steers"),
        (TRACTOR.replace('pos=".6', 'pos=".05'), "ahead of the driven ones"),
        (urdf().replace('<sphere radius="0.07"/>', '<mesh filename="no.stl"/>'), "cannot read"),
    ],
)  # fmt: skip
def test_a_wrong_model_is_refused_in_a_sentence(tmp_path, text, says):
    with pytest.raises(FileProblem, match=says):
        measured(of_file(tmp_path, text))


def test_a_model_that_is_not_there_and_one_too_large_are_refused(tmp_path):
    with pytest.raises(FileProblem, match="There is no robot model"):
        measured(RobotBody.of(Robot(), model=tmp_path / "none.urdf"))
    with pytest.raises(FileProblem, match="5 MB at most"):
        measured(of_file(tmp_path, "<robot>" + " " * 6_000_000))


def test_a_robot_too_small_and_a_strange_steering_are_refused():
    with pytest.raises(SettingError, match=r"0\.3 m wide"):
        RobotBody.of(Robot(width_m=0.1))
    with pytest.raises(SettingError, match="differential or ackermann, but it is 'crab'"):
        RobotBody.of(Robot(), "crab")
