"""Our own robots."""

import mujoco
import pytest

from fieldmon.drive.robot_models import ackermann_xml, differential_xml


@pytest.mark.parametrize("xml", [differential_xml, ackermann_xml])
def test_our_robots_weigh_about_sixty_kilograms_and_stand_on_their_wheels(xml):
    model = mujoco.MjModel.from_xml_string(
        xml(0.6, 0.9)
        .replace("<worldbody>", '<worldbody><geom type="plane" size="9 9 .1" pos="0 0 -.15"/>')
        .replace('<body name="base">', '<body name="base"><freejoint/>')
    )
    assert model.body_mass.sum() == pytest.approx(60, rel=0.15)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    assert data.body("base").xpos == pytest.approx([0, 0, 0], abs=0.02)
