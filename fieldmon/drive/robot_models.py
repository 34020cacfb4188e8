"""Our own robots in MuJoCo's format: two driven wheels with casters, or a steered front axle."""

from __future__ import annotations

_WHEEL_M = 0.15
_WIDE_M = 0.08
_SPRING_N_M, _CARRIES_N = 1000.0, 75.0
_DEFAULTS = f"""<default>
 <default class="wheel"><geom type="cylinder" size="{_WHEEL_M} {_WIDE_M / 2}" euler="90 0 0"
  mass="4" friction="1.2 .01 .001" rgba=".1 .1 .1 1"/></default>
 <default class="caster"><geom type="sphere" size=".07" mass="1" priority="1"
  friction=".001 .001 .0001" condim="1" rgba=".3 .3 .3 1"/></default></default>"""


def differential_xml(width_m: float, length_m: float) -> str:
    """Return a robot of 60 kg with two driven wheels in its middle and two casters on springs."""
    half_l, side = length_m / 2, (width_m - _WIDE_M) / 2
    caster_x, caster_z = half_l - 0.07, 0.07 - _WHEEL_M
    return f"""<mujoco model="differential">{_DEFAULTS}<worldbody><body name="base">
 {_hull(0.0, half_l, width_m)}
 {_caster("front", caster_x, caster_z)}{_caster("back", -caster_x, caster_z)}
 {_wheel("left", 0.0, side)}{_wheel("right", 0.0, -side)}
</body></worldbody></mujoco>"""


def ackermann_xml(width_m: float, length_m: float) -> str:
    """Return a robot of 60 kg with two driven wheels behind and two steered ones ahead.

    Its origin is the middle of the driven axle. Its wheels are its length without two wheels
    apart, and its steered ones turn by 40 degrees. The steered axle swings, so that all four
    wheels stand on uneven ground.
    """
    base, track = ackermann_sizes(width_m, length_m)
    side = track / 2
    return f"""<mujoco model="ackermann">{_DEFAULTS}<worldbody><body name="base">
 {_hull(base / 2, length_m / 2, width_m)}
 {_wheel("left", 0.0, side)}{_wheel("right", 0.0, -side)}
 <body pos="{base} 0 0"><joint name="axle" axis="1 0 0" range="-15 15" damping="5"/>
 <geom type="sphere" size=".03" mass="2" contype="0" conaffinity="0"/>
 {_steered("left", side)}{_steered("right", -side)}</body>
</body></worldbody></mujoco>"""


def ackermann_sizes(width_m: float, length_m: float) -> tuple[float, float]:
    """Return how far apart its axles are, and the wheels of one."""
    return max(length_m - 2.2 * _WHEEL_M, 0.2), width_m - _WIDE_M


def _hull(middle_m: float, half_l: float, width_m: float) -> str:
    mast = middle_m + 0.2
    return f"""<geom name="hull" type="box" size="{half_l} {width_m / 2 - _WIDE_M} .12"
  pos="{middle_m} 0 .12" mass="45" rgba=".95 .75 .1 1"/>
 <geom name="mast" type="capsule" fromto="{mast} 0 .2 {mast} 0 1" size=".03" mass="1"
  rgba=".3 .3 .3 1"/>
 <camera name="left" pos="{mast} 0 1" xyaxes="1 0 0 0 0 1" fovy="60"/>
 <camera name="chase" pos="-3 -1.2 2.2" xyaxes=".35 -.94 0 .5 .2 .8" fovy="60"/>"""


def _wheel(name: str, ahead_m: float, side_m: float) -> str:
    return f"""<body pos="{ahead_m} {side_m} 0"><joint name="{name}" axis="0 1 0" damping=".1"/>
 <geom class="wheel"/></body>"""


def _caster(name: str, ahead_m: float, high_m: float) -> str:
    # its spring carries an eighth of the robot where the ground is level
    return f"""<body pos="{ahead_m} 0 {high_m}"><joint type="slide" axis="0 0 1" range="-.1 .1"
  stiffness="{_SPRING_N_M}" springref="{-_CARRIES_N / _SPRING_N_M}" damping="60"/>
 <geom name="{name}" class="caster"/></body>"""


def _steered(name: str, side_m: float) -> str:
    return f"""<body pos="0 {side_m} 0">
 <joint name="steer_{name}" axis="0 0 1" range="-55 55" damping="2" armature=".05"/>
 <geom type="sphere" size=".02" mass=".5" contype="0" conaffinity="0"/>
 <body><joint axis="0 1 0" damping=".05"/><geom class="wheel"/></body></body>"""
