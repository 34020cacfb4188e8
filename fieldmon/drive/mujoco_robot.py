"""A robot with wheels in MuJoCo: it drives the way, sees with GNSS, and may touch plants."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely

from fieldmon.drive.errand import Visit
from fieldmon.drive.mujoco_plot import lay_ground, world_xml
from fieldmon.drive.pursuit import Pace, Pursuit
from fieldmon.drive.robot_body import RobotBody, sharpest_of
from fieldmon.drive.steered_pursuit import SteeredPursuit
from fieldmon.drive.track import Track
from fieldmon.errors import SettingError
from fieldmon.plot.clearance import STRAY_M, half_canopy_m
from fieldmon.plot.steered_way import way_of
from fieldmon.plot.turning import TurningRoom

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.drive.errand import Errand, Float
    from fieldmon.drive.ground import UnevenGround
    from fieldmon.monitoring.estimates.asked_day import PlantToInspect
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

_STEP_S = 0.005
_CONTROL_S = 0.05
# what is measured of a model may be so much more than was said
_MEASURED_M = 0.02
_SETTLES_S = 1.0
# a turn may leave the plot by so much
_BEYOND_M = 0.1


class Physics(NamedTuple):
    """What a robot is and meets in the simulation.

    Parameters
    ----------
    body
        Its model; None: ours of two driven wheels, of the size that was said.
    gnss_m
        Standard deviation of each position that it is told, to each side.
    seed
        Of that noise.
    ground
        Under it; None: level.
    """

    body: RobotBody | None = None
    gnss_m: float = 0.0
    seed: int = 1
    ground: UnevenGround | None = None

    def __repr__(self) -> str:
        return f"<Physics: {self.gnss_m:g} m of noise>"


class MujocoRobot:
    """Drives on wheels past plants that are solid; needs ``pip install fieldmon[sim]``.

    Parameters
    ----------
    robot
        Its size, speed and seconds of looking.
    look
        Told a plant to inspect; says whether it is found infested.
    physics
        What it is and meets.
    track
        Where it notes its way; None: nowhere.
    """

    def __init__(
        self,
        robot: Robot,
        look: Callable[[PlantToInspect], bool],
        physics: Physics | None = None,
        track: Track | None = None,
    ) -> None:
        self._robot, self._look = robot, look
        self._physics = physics or Physics()
        self._noise = np.random.default_rng(self._physics.seed)
        self._track = track or Track()
        self._track.fix_m = self._physics.gnss_m
        # while it stands nobody steers by positions: those are noise of its own
        self._standing = np.random.default_rng((self._physics.seed, 1))
        self._body = self._physics.body or RobotBody.of(robot)
        self._pace = Pace(robot.speed_m_s)
        self._model: Any = None

    def begin(self, aisles: Aisles, at_m: Float, gone_s: float) -> None:
        """Stand at a place of a plot; where to point is chosen on the first way."""
        mujoco = _mujoco()
        grid = aisles.grid
        self._ground = self._physics.ground
        world = mujoco.MjSpec.from_string(world_xml(grid, _STEP_S, self._ground))
        self._body.put_into(world, mujoco)
        self._model = world.compile()
        if self._ground is not None:
            lay_ground(self._model, self._ground)
        self._wheels = self._body.wheels(self._model, mujoco)
        self._room = self._measured(aisles, mujoco)
        self._free = _free(aisles, float(np.hypot(*self._room.corners_m.T).max()))
        self._data = mujoco.MjData(self._model)
        self._step, self._at_m = mujoco.mj_step, at_m
        names = [mujoco.mj_id2name(self._model, mujoco.mjtObj.mjOBJ_GEOM, g) or ""
                 for g in range(self._model.ngeom)]  # fmt: skip
        self._plant_of = np.array([int(n[1:]) if n[:1] == "p" and n[1:].isdigit() else -1
                                   for n in names])  # fmt: skip
        self._data.time, self._placed = gone_s, False

    def _measured(self, aisles: Aisles, mujoco: Any) -> TurningRoom:  # noqa: ANN401
        """Return the room it needs to turn; raise `SettingError` if it is wider than was said."""
        low, high = self._body.box_m(self._model, mujoco)
        wide, long = float(high[1] - low[1]), float(high[0] - low[0])
        said = self._robot.width_m or 0.0
        said_long = self._robot.length_m or said
        if self._body.is_of_file and (wide > said + _MEASURED_M or long > said_long + _MEASURED_M):
            raise SettingError(
                f"The robot of {self._body.name} is {wide:.2f} m wide and {long:.2f} m long, more "
                "than the day was planned for. Plan for it: "
                f"--width {wide + 0.005:.2f} --length {long + 0.005:.2f}"
            )
        corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]],
                            [low[0], high[1]]])  # fmt: skip
        corners[:, 0] -= self._wheels.axle_m
        turning_m = self._turning_m(self._wheels.turning_m)
        apart_m = half_canopy_m(aisles.grid) + STRAY_M / 2
        area = shapely.buffer(aisles.grid.ground_m, _BEYOND_M)
        shapely.prepare(area)
        return TurningRoom(turning_m, corners, aisles.grid.tree, apart_m, area)

    def _turning_m(self, least_m: float) -> float:
        """Return the radius that it turns by, 0: on the spot; raise `SettingError` if unplanned.

        `least_m` is what its wheels can.
        """
        said_m = self._robot.turning_radius_m
        if said_m is not None and not least_m:
            raise SettingError(
                "A robot with a turning radius must steer, but the simulated one turns on the "
                "spot. Give --steering ackermann, or no --turning-radius."
            )
        if self._robot.width_m is not None and least_m > (said_m or 0.0) + _MEASURED_M:
            planned = "one that turns on the spot" if said_m is None else f"{said_m:g} m"
            raise SettingError(
                f"The turning radius of the simulated robot is {least_m:.2f} m, but the day was "
                f"planned for {planned}. Plan for it: --turning-radius {least_m + 0.005:.2f}"
            )
        return max(least_m, said_m or 0.0)

    def visit(self, errand: Errand) -> Visit:
        """Drive to a plant and look at it."""
        driven = self._drive(errand.line_m)
        if driven.stuck:
            return driven._replace(there=False)
        self._note()
        # it stands still: no physics needed
        self._fixes(errand.look_s)
        self._data.time += errand.look_s
        self._note()
        found = self._look(errand.stop)
        return driven._replace(found=found, done_s=float(self._data.time))

    def _fixes(self, seconds: float) -> None:
        """Note the positions that it is told while it stands."""
        if gnss_m := self._physics.gnss_m:
            for k in range(int(seconds)):
                x, y = np.add(self.pose[:2], gnss_m * self._standing.standard_normal(2)).tolist()
                self._track.fix(float(self._data.time) + k, x, y)

    def home(self, line_m: Float) -> Visit | None:
        """Drive back to the gate."""
        return self._drive(line_m)

    def _drive(self, line_m: Float) -> Visit:
        """Drive along a line; it ends at its end, or where the robot is stuck."""
        data = self._data
        if not self._placed:
            self._point(line_m)
        way, no_room = self._way(line_m)
        touched, strayed_m, over_m = set[int](), 0.0, 0.0
        length_m = float(np.hypot(*np.diff(line_m, axis=0).T).sum())
        each_s = 40.0 if self._wheels.base_m else 10.0
        until_s = data.time + 30.0 + 3.0 * length_m / self._pace.speed_m_s + each_s * len(line_m)
        v, every, gnss_m = 0.0, round(_CONTROL_S / _STEP_S), self._physics.gnss_m
        while not way.done:
            x, y, yaw = self.pose
            if gnss_m:
                dx, dy = gnss_m * self._noise.standard_normal(2)
                x, y = x + dx, y + dy
                self._track.fix(float(data.time), x, y)
            v, turn = way.command((x, y), yaw, v, _CONTROL_S)
            data.ctrl[:] = self._wheels.commands(v, turn)
            self._step(self._model, data, every)
            self._note()
            strayed_m = max(strayed_m, way.off_m(self.pose[:2]))
            over_m = max(over_m, self._over_m())
            plants = self._plant_of[data.contact.geom]
            touched.update(plants[plants >= 0].tolist())
            if data.time > until_s:
                x, y, _ = self.pose
                where = f"at {x:.1f}, {y:.1f} m of the plot's frame"
                said = f"It did not get on {where} (touching {sorted(touched) or 'nothing'})."
                touches = strayed_m, frozenset(touched)
                return Visit(None, float(data.time), *touches, said, over_m=over_m)
        return Visit(None, float(data.time), strayed_m, frozenset(touched), no_room, over_m=over_m)

    def _over_m(self) -> float:
        """Return how far its outline reaches over what is free now."""
        x, y, yaw = self.pose
        cos, sin = math.cos(yaw), math.sin(yaw)
        corners_m = self._room.corners_m @ np.array([[cos, sin], [-sin, cos]]) + [x, y]
        outline = shapely.polygons(corners_m)
        if shapely.covers(self._free, outline):
            return 0.0
        over = shapely.get_coordinates(shapely.difference(outline, self._free))
        return float(shapely.distance(self._free, shapely.points(over)).max(initial=0.0))

    def _way(self, line_m: Float) -> tuple[Pursuit | SteeredPursuit, str]:
        """Return what follows a line, and why it cannot be followed to its end."""
        radius_m = self._room.radius_m
        if not radius_m:
            return Pursuit(line_m, self._pace), ""
        pieces, corner = way_of(line_m, self.pose[2], self._room)
        said = ""
        if corner is not None:
            x, y = corner.tolist()
            said = (
                f"There is no room to turn at {x:.1f}, {y:.1f} m of the plot's frame for a robot "
                f"with a turning circle of {2 * radius_m:.1f} m."
            )
        return SteeredPursuit(pieces, self._pace, sharpest_of(radius_m)), said

    @property
    def pose(self) -> tuple[float, float, float]:
        """Where the middle of its driven axle is, metres of the plot's frame, and its heading."""
        x, y, _, a, b, c, d = self._data.qpos[:7].tolist()
        yaw = math.atan2(2 * (a * d + b * c), 1 - 2 * (c * c + d * d))
        axle_m = self._wheels.axle_m
        return x + axle_m * math.cos(yaw), y + axle_m * math.sin(yaw), yaw

    def _point(self, line_m: Float) -> None:
        """Stand as the first way runs, and settle on the ground."""
        data, wheels = self._data, self._wheels
        dx, dy = line_m[1] - line_m[0] if len(line_m) > 1 else (1.0, 0.0)
        yaw = math.atan2(dy, dx)
        at_m = self._at_m - wheels.axle_m * np.array([math.cos(yaw), math.sin(yaw)])
        high_m = 0.0
        if self._ground is not None:
            around = at_m + np.array([[0, 0], [0.3, 0], [-0.3, 0], [0, 0.3], [0, -0.3]])
            high_m = float(self._ground.at(around).max())
        data.qpos[:3] = *at_m, high_m + wheels.stand_m
        data.qpos[3:7] = math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)
        began_s = float(data.time)
        if self._ground is not None:
            self._step(self._model, data, round(_SETTLES_S / _STEP_S))
            data.time = began_s
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


def _free(aisles: Aisles, reach_m: float) -> shapely.Geometry:
    """Return where the outline of a robot of such reach may be: on the plot, or at its gate."""
    area = aisles.grid.drivable_m
    entry: Any = shapely.shortest_line(shapely.points(aisles.gate_m), area)
    about: Any = shapely.buffer(entry, reach_m)
    free: shapely.Geometry = shapely.union(area, about)
    shapely.prepare(free)
    return free
