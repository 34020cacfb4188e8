"""A robot with wheels in MuJoCo: it drives the way, sees with GNSS, and may touch plants."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.drive.errand import Visit
from fieldmon.drive.pursuit import Pace, Pursuit
from fieldmon.drive.track import Track
from fieldmon.drive.world import Chassis, world_xml
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.drive.errand import Errand, Float
    from fieldmon.monitoring.monitor import PlantToInspect
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

_STEP_S = 0.005
_CONTROL_S = 0.05


class MujocoRobot:
    """Drives with two wheels past plants that are solid; needs ``pip install fieldmon[sim]``.

    Parameters
    ----------
    robot
        Its size, speed and seconds of looking.
    look
        Told a plant to inspect; says whether it is found infested.
    gnss_m
        Standard deviation of each position that the robot is told, to each side.
    seed
        Of that noise.
    track
        Where it notes its way; None: nowhere.
    """

    def __init__(
        self,
        robot: Robot,
        look: Callable[[PlantToInspect], bool],
        gnss_m: float = 0.0,
        seed: int = 1,
        track: Track | None = None,
    ) -> None:
        self._robot, self._look, self._gnss_m = robot, look, gnss_m
        self._noise = np.random.default_rng(seed)
        self._track = track or Track()
        self._chassis = Chassis.of(robot)
        self._pace = Pace(robot.speed_m_s)
        self._model: Any = None

    def begin(self, aisles: Aisles, at_m: Float, gone_s: float) -> None:
        """Stand at a place of a plot; where to point is chosen on the first way."""
        mujoco = _mujoco()
        xml = world_xml(aisles.grid, self._chassis, _STEP_S)
        self._model = mujoco.MjModel.from_xml_string(xml)
        self._data = mujoco.MjData(self._model)
        self._step, self._at_m = mujoco.mj_step, at_m
        names = [mujoco.mj_id2name(self._model, mujoco.mjtObj.mjOBJ_GEOM, g) or ""
                 for g in range(self._model.ngeom)]  # fmt: skip
        self._plant_of = np.array([int(n[1:]) if n[:1] == "p" and n[1:].isdigit() else -1
                                   for n in names])  # fmt: skip
        data = self._data
        data.time, data.qpos[:3] = gone_s, (*at_m, self._chassis.wheel_m)
        data.qpos[3:7] = 1.0, 0.0, 0.0, 0.0
        mujoco.mj_forward(self._model, data)
        self._placed = False

    def visit(self, errand: Errand) -> Visit:
        """Drive to a plant and look at it."""
        driven = self._drive(errand.line_m)
        if driven.stuck:
            return driven
        self._note()
        # it stands still: no physics needed
        self._data.time += max(errand.stop.inspect_s - self._robot.stop_s, 0.0)
        self._note()
        found = self._look(errand.stop)
        return driven._replace(found=found, done_s=float(self._data.time))

    def home(self, line_m: Float) -> Visit | None:
        """Drive back to the gate."""
        return self._drive(line_m)

    def _drive(self, line_m: Float) -> Visit:
        """Drive along a line; it ends at its end, or where the robot is stuck."""
        data, chassis = self._data, self._chassis
        if not self._placed:
            self._point(line_m)
        way, touched, strayed_m = Pursuit(line_m, self._pace), set[int](), 0.0
        length_m = float(np.hypot(*np.diff(line_m, axis=0).T).sum())
        until_s = data.time + 30.0 + 3.0 * length_m / self._pace.speed_m_s + 10.0 * len(line_m)
        v, every = 0.0, round(_CONTROL_S / _STEP_S)
        while not way.done:
            x, y, yaw = self.pose
            if self._gnss_m:
                dx, dy = self._gnss_m * self._noise.standard_normal(2)
                x, y = x + dx, y + dy
            v, turn = way.command((x, y), yaw, v, _CONTROL_S)
            spin = turn * chassis.track_m / 2
            data.ctrl[:] = (v - spin) / chassis.wheel_m, (v + spin) / chassis.wheel_m
            self._step(self._model, data, every)
            self._note()
            strayed_m = max(strayed_m, way.off_m(self.pose[:2]))
            plants = self._plant_of[data.contact.geom]
            touched.update(plants[plants >= 0].tolist())
            if data.time > until_s:
                x, y, _ = self.pose
                where = f"at {x:.1f}, {y:.1f} m of the plot's frame"
                said = f"It did not get on {where} (touching {sorted(touched) or 'nothing'})."
                return Visit(None, float(data.time), strayed_m, frozenset(touched), said)
        return Visit(None, float(data.time), strayed_m, frozenset(touched))

    @property
    def pose(self) -> tuple[float, float, float]:
        """Where the robot is, metres of the plot's frame, and where it points, radians."""
        x, y, _, a, b, c, d = self._data.qpos[:7].tolist()
        return x, y, math.atan2(2 * (a * d + b * c), 1 - 2 * (c * c + d * d))

    def _point(self, line_m: Float) -> None:
        """Stand as the first way runs."""
        dx, dy = line_m[1] - line_m[0] if len(line_m) > 1 else (1.0, 0.0)
        half = math.atan2(dy, dx) / 2
        self._data.qpos[3:7] = math.cos(half), 0.0, 0.0, math.sin(half)
        self._placed = True
        self._note()

    def _note(self) -> None:
        self._track.add(float(self._data.time), *self.pose)


def _mujoco() -> Any:  # noqa: ANN401 - a module without types
    try:
        import mujoco  # noqa: PLC0415 - heavy, and an extra
    except ImportError as error:
        raise SettingError(
            "The physical simulation needs MuJoCo, which is not installed. "
            'Install it with: pip install "fieldmon[sim]"'
        ) from error
    return mujoco
