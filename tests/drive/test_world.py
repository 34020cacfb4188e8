"""The plot and the robot as the physical simulation knows them."""

import mujoco
import numpy as np
import pytest

from fieldmon.drive.world import Chassis, world_xml
from fieldmon.errors import SettingError
from fieldmon.plot.layout import Planting, rectangle
from fieldmon.plot.robot import Robot


def test_every_plant_stands_where_it_is_as_wide_as_it_is():
    grid = rectangle(3, 4, Planting(half_canopy_m=0.4))
    model = mujoco.MjModel.from_xml_string(world_xml(grid, Chassis.of(Robot()), 0.005))
    places = [model.geom(f"p{k}").pos[:2] for k in range(len(grid))]
    assert np.allclose(places, grid.xy_m, atol=1e-3)
    assert {round(float(model.geom(f"p{k}").size[0]), 3) for k in range(len(grid))} == {0.4}


def test_both_faces_of_a_plant_are_one_post():
    grid = rectangle(3, 4, Planting(faces=2))
    xml = world_xml(grid, Chassis.of(Robot()), 0.005)
    assert xml.count('class="plant" pos') == 12


def test_the_robot_is_as_wide_and_as_long_as_was_said():
    chassis = Chassis.of(Robot(width_m=0.7, length_m=1.1))
    model = mujoco.MjModel.from_xml_string(world_xml(rectangle(2, 2), chassis, 0.005))
    hull = model.geom("hull").size
    assert 2 * hull[0] == pytest.approx(1.1)
    assert chassis.track_m + 2 * 0.04 == pytest.approx(0.7)
    assert 2 * hull[1] < 0.7


def test_a_robot_too_small_to_be_built_is_refused():
    with pytest.raises(SettingError, match=r"0\.3 m wide"):
        Chassis.of(Robot(width_m=0.1))
