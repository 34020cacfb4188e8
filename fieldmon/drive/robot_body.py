"""The robot that MuJoCo drives: one of ours, or the model of a file, with its driven wheels."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.drive.robot_models import ackermann_sizes, ackermann_xml, differential_xml
from fieldmon.errors import FileProblem, SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]

#: how a robot changes its heading
DIFFERENTIAL, ACKERMANN = "differential", "ackermann"
#: size of a robot whose own nobody said
USUAL_SIZE_M = (0.58, 0.8)
_DRIVEN, _STEERED = ("left", "right"), ("steer_left", "steer_right")
# a joint may be called as in the models of ROS, too
_ENDINGS = ("", "_joint", "_wheel", "_wheel_joint")
_USUAL_KG = 60.0
_MOST_BYTES = 5_000_000
_STEERS_RAD = math.radians(40.0)
# a little less than its wheels can: pure pursuit must be able to turn sharper
_SPARE = 1.1


class Wheels(NamedTuple):
    """What a robot's wheels make of a command.

    Parameters
    ----------
    radius_m, track_m
        Of the driven wheels, and between their middles.
    axle_m
        Where the middle between them is, ahead of the model's origin.
    stand_m
        How high the model's origin is above level ground.
    base_m
        From the driven axle to the steered one; 0: it turns by its driven wheels.
    steers_rad
        How far the inner of the steered wheels turns; 0 as above.
    """

    radius_m: float
    track_m: float
    axle_m: float
    stand_m: float
    base_m: float = 0.0
    steers_rad: float = 0.0

    @property
    def turning_m(self) -> float:
        """Return the least radius of a turn, at the middle of the driven axle; 0: on the spot."""
        if not self.base_m:
            return 0.0
        return _least_radius_m(self.base_m, self.track_m, self.steers_rad)

    def commands(self, speed_m_s: float, turn: float) -> list[float]:
        """Return the commands of its actuators.

        Parameters
        ----------
        speed_m_s
            Of the middle of the driven axle.
        turn
            Radians a second; of a robot that steers 1 over the radius of its turn, 1/m.
        """
        half = self.track_m / 2
        if not self.base_m:
            apart = turn * half
            return [(speed_m_s - apart) / self.radius_m, (speed_m_s + apart) / self.radius_m]
        driven = [speed_m_s * (1 + side * turn * half) / self.radius_m for side in (-1, 1)]
        steered = [math.atan2(self.base_m * turn, 1 + side * turn * half) for side in (-1, 1)]
        return driven + steered


def sharpest_of(radius_m: float) -> float:
    """Return the bend, 1/m, up to which a robot steers whose turns have such a radius."""
    return _SPARE / radius_m


def with_turning_radius(robot: Robot) -> Robot:
    """Return a robot that turns as our steered one of its size, unless more was said of it.

    Without a width nothing is planned by its size.
    """
    if robot.width_m is None or robot.turning_radius_m is not None:
        return robot
    base_m, track_m = ackermann_sizes(robot.width_m, robot.length_m or robot.width_m)
    # to a centimetre, and never less than its wheels can
    radius_m = math.ceil(100 * _least_radius_m(base_m, track_m, _STEERS_RAD)) / 100
    return replace(robot, turning_radius_m=radius_m)


def _least_radius_m(base_m: float, track_m: float, steers_rad: float) -> float:
    return _SPARE * (base_m / math.tan(steers_rad) + track_m / 2)


@dataclass(frozen=True)
class RobotBody:
    """A robot to be put among plants.

    Parameters
    ----------
    source
        Its model: text of MJCF, or a file of MJCF or URDF.
    steering
        ``"differential"``, ``"ackermann"``, or "" to go by the joints of the model.

    Examples
    --------
    >>> import fieldmon as fm
    >>> from fieldmon.drive.robot_body import RobotBody
    >>> RobotBody.of(fm.rover(), "ackermann").steering
    'ackermann'
    """

    source: str | Path
    steering: str = ""

    @classmethod
    def of(cls, robot: Robot, steering: str = DIFFERENTIAL, model: Path | None = None) -> RobotBody:
        """Return the body of a robot's size, or that of a model's file.

        Raise `SettingError` if none is so small, or there is no such steering.
        """
        if steering not in (DIFFERENTIAL, ACKERMANN):
            raise SettingError(
                f"Steering must be {DIFFERENTIAL} or {ACKERMANN}, but it is {steering!r}."
            )
        if model is not None:
            return cls(model)
        width_m = robot.width_m or USUAL_SIZE_M[0]
        length_m = robot.length_m or (robot.width_m or USUAL_SIZE_M[1])
        if width_m < 0.3 or length_m < 0.3:
            raise SettingError(
                "A robot to be simulated must be 0.3 m wide and long at least, but it is "
                f"{width_m:g} m by {length_m:g} m. Give another --width."
            )
        own = differential_xml if steering == DIFFERENTIAL else ackermann_xml
        return cls(own(width_m, length_m), steering)

    @property
    def name(self) -> str:
        """What to call it in a sentence."""
        return self.source.name if isinstance(self.source, Path) else "own"

    def put_into(self, world: Any, mujoco: Any) -> None:  # noqa: ANN401 - modules without types
        """Put it into the specification of a world, named ``robot``, with its actuators."""
        spec = self._spec(mujoco)
        joints, heavy = self._joints(spec), _mass_kg(spec) / _USUAL_KG
        for actuator in list(spec.actuators):
            spec.delete(actuator)
        root = self._root(spec)
        for joint in list(root.joints):
            spec.delete(joint)
        root.pos, root.quat = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)
        for shape in spec.geoms:
            # it touches plants and ground, not itself
            if shape.contype or shape.conaffinity:
                shape.contype, shape.conaffinity = 0, 1
        if self.is_of_file:
            _slides(root)
        placed = world.worldbody.add_frame().attach_body(root, "robot/", "")
        placed.name = "robot"
        placed.add_freejoint()
        for own, name in joints.items():
            actuator = world.add_actuator()
            actuator.name, actuator.target = own, f"robot/{name}"
            actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
            if own in _DRIVEN:
                actuator.set_to_velocity(40.0 * heavy)
                actuator.forcelimited, actuator.forcerange = 1, [-60.0 * heavy, 60.0 * heavy]
            else:
                actuator.set_to_position(400.0 * heavy, dampratio=1.0)

    def wheels(self, model: Any, mujoco: Any) -> Wheels:  # noqa: ANN401
        """Return its wheels, measured in a compiled world; raise `FileProblem` if they are none."""
        return _MeasuredRobot(model, mujoco, self.name).wheels()

    def box_m(self, model: Any, mujoco: Any) -> tuple[Float, Float]:  # noqa: ANN401
        """Return the corners ``(3,)`` of the box around all of it that can touch."""
        return _MeasuredRobot(model, mujoco, self.name).box_m()

    @property
    def is_of_file(self) -> bool:
        """Whether somebody brought its model."""
        return isinstance(self.source, Path)

    def _spec(self, mujoco: Any) -> Any:  # noqa: ANN401
        if not isinstance(self.source, Path):
            return mujoco.MjSpec.from_string(self.source)
        try:
            size = self.source.stat().st_size
        except OSError as error:
            raise FileProblem(f"There is no robot model {self.source}.") from error
        if size > _MOST_BYTES:
            raise FileProblem(
                f"The robot model {self.name} is {size / 1e6:.0f} MB; 5 MB at most are read."
            )
        try:
            spec = mujoco.MjSpec.from_file(str(self.source))
            # links that are joined rigidly stay links, the first one too
            spec.compiler.fusestatic = False
            _mass_kg(spec)
        except Exception as error:  # MuJoCo's own sentence says where
            said = " ".join(str(error).split())[:200]
            raise FileProblem(
                f"MuJoCo cannot read the robot model {self.name}: {said} A model is URDF or MJCF, "
                "with its meshes where it says."
            ) from error
        return spec

    def _root(self, spec: Any) -> Any:  # noqa: ANN401
        roots = list(spec.worldbody.bodies)
        if len(roots) != 1:
            raise FileProblem(
                f"A robot model must be one body with everything on it, but {self.name} has "
                f"{len(roots)} ({', '.join(body.name or 'without name' for body in roots)})."
            )
        return roots[0]

    def _joints(self, spec: Any) -> dict[str, str]:  # noqa: ANN401
        """Return the model's joints by what they are here: driven wheels, and steered ones."""
        there = {joint.name for joint in spec.joints}
        known = {
            own: next((own + end for end in _ENDINGS if own + end in there), "")
            for own in (*_DRIVEN, *_STEERED)
        }
        steers = any(known[own] for own in _STEERED)
        needed = (*_DRIVEN, *(_STEERED if steers else ()))
        if not all(known[own] for own in needed):
            named = ", ".join(sorted(name for name in there if name)[:12]) or "none"
            raise FileProblem(
                f"A robot model must have hinges named left and right at its driven wheels, and "
                f"steer_left and steer_right if it steers; each may end in _wheel, _joint or "
                f"_wheel_joint. The joints of {self.name} are: {named}."
            )
        return {own: known[own] for own in needed}


def _slides(body: Any) -> None:  # noqa: ANN401
    """Let what is rigid on a robot slide on the ground, as the balls do that stand for casters."""
    for shape in body.geoms:
        shape.priority, shape.condim, shape.friction = 1, 1, (1e-3, 1e-3, 1e-4)
    for link in body.bodies:
        if not list(link.joints):
            _slides(link)


def _mass_kg(spec: Any) -> float:  # noqa: ANN401
    """Return what a model weighs; it must be whole."""
    return float(spec.copy().compile().body_mass.sum())


class _MeasuredRobot:
    """A robot in a compiled world, stood at the origin and measured."""

    def __init__(self, model: Any, mujoco: Any, name: str) -> None:  # noqa: ANN401
        self._model, self._mujoco, self._name = model, mujoco, name
        self._data = mujoco.MjData(model)
        self._data.qpos[:7] = 0, 0, 0, 1, 0, 0, 0
        mujoco.mj_kinematics(model, self._data)

    def wheels(self) -> Wheels:
        model, data = self._model, self._data
        driven = [self._wheel(own) for own in _DRIVEN]
        (left, low_l), (right, low_r) = driven
        radius = left[2] - low_l
        if radius <= 0.01 or abs(radius - (right[2] - low_r)) > 0.01 or left[1] - right[1] < 0.05:
            raise FileProblem(
                f"The driven wheels of {self._name} must be alike, the left one at the left (y "
                "above 0, x is ahead), and able to touch the ground: with a shape for contact."
            )
        stand_m = -min(low_l, low_r)
        sizes = radius, left[1] - right[1], (left[0] + right[0]) / 2, stand_m
        if model.nu == len(_DRIVEN):
            return Wheels(*sizes)
        steered = [data.xanchor[self._joint(own)] for own in _STEERED]
        base_m = sum(place[0] for place in steered) / 2 - sizes[2]
        if base_m < 0.1:
            raise FileProblem(
                f"The steered wheels of {self._name} must be 0.1 m ahead of the driven ones at "
                f"least, but they are {base_m:.2f} m."
            )
        limits = [model.jnt_range[self._joint(own)] for own in _STEERED]
        stops = [min(-low, high) for low, high in limits if low < 0 < high]
        return Wheels(*sizes, base_m, min([_STEERS_RAD, *stops]))

    def box_m(self) -> tuple[Float, Float]:
        """Return the corners of the box around all shapes of contact, ``(3,)`` each."""
        boxes = [self._box(geom) for geom in self._geoms(self._body("robot"))]
        lows, highs = zip(*boxes, strict=True)
        return np.min(lows, axis=0), np.max(highs, axis=0)

    def _wheel(self, own: str) -> tuple[Float, float]:
        """Return the place of a driven wheel's hinge, and the lowest point of the wheel."""
        model, joint = self._model, self._joint(own)
        axis = self._data.xaxis[joint]
        hinge = int(model.jnt_type[joint]) == int(self._mujoco.mjtJoint.mjJNT_HINGE)
        if not hinge or axis[1] < 0.99:
            raise FileProblem(
                f"The joint {own} of {self._name} must be a hinge around the y axis (0 1 0): x is "
                "ahead, y to the left, z up."
            )
        lows = [self._box(geom)[0][2] for geom in self._geoms(int(model.jnt_bodyid[joint]))]
        place: Float = self._data.xanchor[joint]
        return place, min(lows, default=float(place[2]))

    def _joint(self, own: str) -> int:
        return int(self._model.actuator_trnid[self._model.actuator(own).id, 0])

    def _body(self, name: str) -> int:
        return int(self._mujoco.mj_name2id(self._model, self._mujoco.mjtObj.mjOBJ_BODY, name))

    def _geoms(self, body: int) -> list[int]:
        """Return the shapes of contact of a body and all that hang on it."""
        model, hang = self._model, {body}
        for k in range(body + 1, model.nbody):
            if int(model.body_parentid[k]) in hang:
                hang.add(k)
        touches = (model.geom_contype | model.geom_conaffinity) > 0
        return [g for g in range(model.ngeom) if touches[g] and int(model.geom_bodyid[g]) in hang]

    def _box(self, geom: int) -> tuple[Float, Float]:
        turn = self._data.geom_xmat[geom].reshape(3, 3)
        centre, half = self._model.geom_aabb[geom].reshape(2, 3)
        middle = self._data.geom_xpos[geom] + turn @ centre
        reach = np.abs(turn) @ half
        return middle - reach, middle + reach
