"""Robots as others draw them: URDF with two driven wheels, MJCF with a steered axle."""

_INERTIA = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'


def _wheel(name, y, axis="0 1 0"):
    return f"""<link name="{name}"><inertial><mass value="4"/>
 <inertia ixx=".05" iyy=".05" izz=".05" ixy="0" ixz="0" iyz="0"/></inertial>
 <collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.16" length="0.06"/></geometry>
 </collision></link>
<joint name="{name}_wheel_joint" type="continuous"><parent link="base_link"/><child link="{name}"/>
 <origin xyz="0.05 {y} 0"/><axis xyz="{axis}"/></joint>"""


def urdf(wheels=("left", "right"), axis="0 1 0", wide_m=0.5):
    """Return a robot of ROS: its wheels are a little ahead of its origin."""
    balls = "".join(
        f'<collision><origin xyz="{x} 0 -0.09"/><geometry><sphere radius="0.07"/></geometry>'
        "</collision>"
        for x in (-0.25, 0.35)
    )
    left, right = (_wheel(name, y, axis) for name, y in zip(wheels, (0.25, -0.25), strict=True))
    return f"""<robot name="scout"><link name="base_link"><inertial><mass value="40"/>{_INERTIA}
</inertial><collision><origin xyz="0.05 0 0.1"/><geometry><box size="0.7 {wide_m} 0.2"/></geometry>
</collision>{balls}</link>{left}{right}</robot>"""


TRACTOR = """<mujoco model="tractor"><compiler angle="radian"/><default>
 <default class="w"><geom type="cylinder" size=".2 .05" euler="1.5708 0 0" mass="8"/></default>
</default><worldbody><body name="chassis" pos="0 0 1"><freejoint/>
 <geom type="box" size=".5 .2 .1" pos=".3 0 .2" mass="80"/>
 <body pos="0 .25 0"><joint name="left" axis="0 1 0"/><geom class="w"/></body>
 <body pos="0 -.25 0"><joint name="right" axis="0 1 0"/><geom class="w"/></body>
 <body pos=".6 .25 0"><joint name="steer_left" axis="0 0 1" range="-.6 .6" damping="2"/>
  <geom type="sphere" size=".02" mass=".5" contype="0" conaffinity="0"/>
  <body><joint axis="0 1 0"/><geom class="w"/></body></body>
 <body pos=".6 -.25 0"><joint name="steer_right" axis="0 0 1" range="-.6 .6" damping="2"/>
  <geom type="sphere" size=".02" mass=".5" contype="0" conaffinity="0"/>
  <body><joint axis="0 1 0"/><geom class="w"/></body></body>
</body></worldbody><actuator><motor joint="left"/></actuator></mujoco>"""
