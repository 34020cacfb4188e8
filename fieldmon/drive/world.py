"""A plot and a robot as MuJoCo knows them: plants as posts with canopies on level ground."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.errors import SettingError
from fieldmon.plot.clearance import half_canopy_m

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]

#: size of a robot whose own nobody said
USUAL_SIZE_M = (0.58, 0.8)
_HEIGHT_M = 1.5


class Chassis(NamedTuple):
    """A robot with two driven wheels, as far as the simulation needs it.

    Parameters
    ----------
    width_m, length_m
        Over everything.
    wheel_m
        Radius of the wheels.
    track_m
        Between the middles of the wheels.
    """

    width_m: float
    length_m: float
    wheel_m: float
    track_m: float

    @classmethod
    def of(cls, robot: Robot) -> Chassis:
        """Return the chassis of a robot's size; raise `SettingError` if none fits."""
        width_m = robot.width_m or USUAL_SIZE_M[0]
        length_m = robot.length_m or (robot.width_m or USUAL_SIZE_M[1])
        if width_m < 0.3 or length_m < 0.3:
            raise SettingError(
                "A robot to be simulated must be 0.3 m wide and long at least, but it is "
                f"{width_m:g} m by {length_m:g} m. Give another --width."
            )
        return cls(width_m, length_m, 0.15, width_m - 0.08)


def world_xml(grid: PlantGrid, chassis: Chassis, step_s: float) -> str:
    """Return a plot with a robot in MuJoCo's own format.

    Plants are ``p0`` on, in the order of the grid; twin faces are one plant. The robot's joints
    and actuators are ``left`` and ``right``, velocities in radians a second.
    """
    alone = [k for k in range(len(grid)) if grid.vine[k] == k]
    plants = "".join(
        f'<geom name="p{k}" class="plant" pos="{x:.3f} {y:.3f} {_HEIGHT_M / 2}"/>'
        for k, (x, y) in zip(alone, grid.xy_m[alone].tolist(), strict=True)
    )
    low, high = grid.xy_m.min(axis=0) - 30.0, grid.xy_m.max(axis=0) + 30.0
    (x, y), (wide, deep) = (low + high) / 2, (high - low) / 2
    reach = max(half_canopy_m(grid), 0.02)
    return f"""<mujoco model="plot">
<option timestep="{step_s}" integrator="implicitfast" cone="elliptic"/>
<visual><global offwidth="1280" offheight="720"/><map zfar="400" znear=".05"/></visual>
<statistic center="{x} {y} 0" extent="30"/>
<asset><texture name="soil" type="2d" builtin="checker" rgb1=".55 .45 .33" rgb2=".52 .42 .3"
 width="256" height="256"/><material name="soil" texture="soil" texrepeat="{wide} {deep}"/></asset>
<default><default class="plant">
 <geom type="cylinder" size="{reach} {_HEIGHT_M / 2}" rgba=".2 .5 .2 1"/></default>
 <default class="wheel"><geom type="cylinder" size="{chassis.wheel_m} .04" euler="90 0 0" mass="4"
 friction="1.2 .01 .001" rgba=".1 .1 .1 1"/></default>
 <default class="caster"><geom type="sphere" size=".07" mass="1" priority="1"
 friction=".001 .001 .0001" condim="1"/></default></default>
<worldbody><light directional="true" pos="0 0 20" dir=".3 .2 -1" diffuse=".8 .8 .8"/>
<geom name="ground" type="plane" pos="{x} {y} 0" size="{wide} {deep} .1" material="soil"/>
{plants}
{_robot_xml(chassis)}</worldbody>
<actuator><velocity name="left" joint="left" kv="40" forcerange="-60 60"/>
<velocity name="right" joint="right" kv="40" forcerange="-60 60"/></actuator></mujoco>"""


def _robot_xml(chassis: Chassis) -> str:
    half_l, half_w, wheel = chassis.length_m / 2, chassis.width_m / 2, chassis.wheel_m
    caster_x, caster_z = half_l - 0.07, 0.07 - wheel
    side = chassis.track_m / 2
    return f"""<body name="robot" pos="0 0 {wheel}"><freejoint/>
 <geom name="hull" type="box" size="{half_l} {half_w - 0.08} .12" pos="0 0 .12" mass="45"
  rgba=".95 .75 .1 1"/>
 <geom name="mast" type="capsule" fromto=".2 0 .2 .2 0 1" size=".03" mass="1" rgba=".3 .3 .3 1"/>
 <geom name="front" class="caster" pos="{caster_x} 0 {caster_z}"/>
 <geom name="back" class="caster" pos="-{caster_x} 0 {caster_z}"/>
 <camera name="left" pos=".2 0 1" xyaxes="1 0 0 0 0 1" fovy="60"/>
 <camera name="chase" pos="-3 -1.2 2.2" xyaxes=".35 -.94 0 .5 .2 .8" fovy="60"/>
 <body pos="0 {side} 0"><joint name="left" axis="0 1 0" damping=".1"/><geom class="wheel"/></body>
 <body pos="0 -{side} 0"><joint name="right" axis="0 1 0" damping=".1"/><geom class="wheel"/></body>
</body>"""
