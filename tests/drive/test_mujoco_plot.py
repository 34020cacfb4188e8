"""The plot as the physical simulation knows it."""

import mujoco
import numpy as np
import pytest

from fieldmon.drive.ground import UnevenGround, rough_ground
from fieldmon.drive.mujoco_plot import lay_ground, world_xml
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting


def test_every_plant_stands_where_it_is_as_wide_as_it_is():
    grid = rectangle(3, 4, Planting(half_canopy_m=0.4))
    model = mujoco.MjModel.from_xml_string(world_xml(grid, 0.005))
    places = [model.geom(f"p{k}").pos[:2] for k in range(len(grid))]
    assert np.allclose(places, grid.xy_m, atol=1e-3)
    assert {round(float(model.geom(f"p{k}").size[0]), 3) for k in range(len(grid))} == {0.4}


def test_both_faces_of_a_plant_are_one_post():
    grid = rectangle(3, 4, Planting(faces=2))
    assert world_xml(grid, 0.005).count('class="plant" pos') == 12


def test_ground_is_as_high_as_its_heights_everywhere():
    """A ray from above meets the ground where the heights say, plants stand on it."""
    grid = rectangle(3, 4)
    ground = rough_ground(grid, 0.1, seed=2)
    model = mujoco.MjModel.from_xml_string(world_xml(grid, 0.005, ground))
    lay_ground(model, ground)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    places = np.random.default_rng(1).uniform(grid.xy_m.min(0) - 5, grid.xy_m.max(0) + 5, (40, 2))
    for (x, y), high in zip(places, ground.at(places), strict=True):
        met, down = np.full(1, -1, np.int32), np.array([0.0, 0.0, -1.0])
        far = mujoco.mj_ray(model, data, np.array([x, y, 9.0]), down, None, 1, -1, met)
        if met[0] == model.geom("ground").id:
            assert 9.0 - far == pytest.approx(high, abs=0.03)
    stands = model.geom("p0").pos[2] - model.geom("p0").size[1]
    assert stands == pytest.approx(ground.at(grid.xy_m[:1])[0], abs=1e-3)


def test_level_ground_of_a_raster_is_a_plane_without_height():
    ground = UnevenGround(np.array([-50.0, -50.0]), 1.0, np.zeros((101, 101)))
    assert 'type="hfield"' in world_xml(rectangle(2, 2), 0.005, ground)
    assert 'type="plane"' in world_xml(rectangle(2, 2), 0.005)
