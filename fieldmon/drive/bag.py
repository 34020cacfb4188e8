"""A driven day as a bag of ROS 2 (MCAP), with layouts for RViz and Foxglove beside it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.drive.bag_layouts import foxglove_layout, rviz_layout
from fieldmon.errors import FieldmonError, FileProblem, SettingError
from fieldmon.io.atomic_write import require_place, why_not_written, write_whole
from fieldmon.plot.clearance import half_canopy_m

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from datetime import datetime

    from fieldmon.drive.errand import Float
    from fieldmon.drive.recording import Recording
    from fieldmon.plot.projection import Frame

#: one position fix and one odometry in so many seconds, and while it stands one pose in as many
_FIX_S = 1.0
_TALL_M = 1.5
# SPHERE_LIST of visualization_msgs/Marker
_SPHERES = 7
_FOUND = (0.84, 0.15, 0.12, 1.0)
_CLEAN = (0.13, 0.44, 0.71, 1.0)
# variance of what nobody knows: heights, and turns but about the vertical
_UNKNOWN = 1e6
# how a covariance of sensor_msgs/NavSatFix is known
_NOT_KNOWN, _KNOWN = 0, 2
_STATIC = "/tf_static"
_TOPICS = {
    "/tf": "tf2_msgs/msg/TFMessage",
    _STATIC: "tf2_msgs/msg/TFMessage",
    "/plan": "nav_msgs/msg/Path",
    "/odom": "nav_msgs/msg/Odometry",
    "/gps/fix": "sensor_msgs/msg/NavSatFix",
    "/plants": "visualization_msgs/msg/MarkerArray",
    "/finds": "visualization_msgs/msg/MarkerArray",
}


def write_bag(recording: Recording, begins: datetime, to: Path) -> tuple[Path, Path, Path]:
    """Write a driven day as a bag; return it and its layouts for RViz and Foxglove.

    The frame ``map`` is metres east and north of the plot's centre, as in the Nav2 files. Topics:
    the transform to ``base_link`` (the receiver of positions, ``gps``, is there), the plan as it
    changes, odometry, position fixes as the robot had them, plants by their chance, and what was
    found.

    Parameters
    ----------
    recording
        What was noted.
    begins
        When the day began; with its time zone.
    to
        The bag, ``day.mcap``.

    Raises
    ------
    FileProblem, SettingError
        As `require_bag` does, and if there is no room.
    """
    require_bag(to)
    writer, store = _rosbags()
    try:
        with working_folder() as folder:
            inner = Path(folder) / "bag"
            with writer(inner) as bag:
                _Pen(bag, store, begins.timestamp()).write(recording)
            data = next(inner.glob("*.mcap*")).read_bytes()
    except OSError as error:
        raise FileProblem(
            worded(
                "{target} could not be written: there is no room for it in the folder for "
                "temporary files ({value}). Make room, or name another folder in TMPDIR.",
                target=to,
                value=why_not_written(error),
            )
        ) from error
    layouts = to.with_suffix(".rviz"), to.with_suffix(".foxglove.json")
    write_whole(to, data)
    write_whole(layouts[0], rviz_layout())
    write_whole(layouts[1], foxglove_layout())
    return (to, *layouts)


def require_bag(to: Path) -> None:
    """Hold that a bag can be written to a place, before a day is driven for it.

    Raises
    ------
    FileProblem
        If nothing can be written there.
    SettingError
        If the library that writes bags is not installed, or the name does not end in .mcap.
    """
    if to.suffix.lower() != ".mcap":
        raise SettingError(
            worded(
                "The name of a bag must end in .mcap, but it is {name!r}.",
                name=to.name,
            )
        )
    _rosbags()
    require_place(to)


class _Pen:
    """Writes messages, each at its second of the day."""

    def __init__(self, bag: Any, store: Any, begins_s: float) -> None:  # noqa: ANN401
        self._bag, self._store, self._begins_s = bag, store, begins_s
        self._type = store.types
        self._topic = {
            name: bag.add_connection(name, kind, typestore=store, offered_qos_profiles=_offer(name))
            for name, kind in _TOPICS.items()
        }

    def write(self, recording: Recording) -> None:
        """Write a day: poses in time, plans and finds as they come."""
        frame = recording.aisles.grid.frame
        track = recording.track
        poses = _filled(_east_north_poses(frame, track.poses))
        kept = _thinned(poses)
        poses, moves = poses[kept], _moves(poses)[kept]
        first_s = float(poses[0, 0]) if len(poses) else 0.0
        self._put("/plants", first_s, self._plants(recording))
        planned_s = first_s
        for one in recording.stops:
            self._put("/plan", planned_s, self._plan(planned_s, _places(frame, one.line_m)))
            planned_s = one.at_s
            self._put("/finds", one.at_s, self._find(recording, one.plant, one.found))
        antenna = self._transform(first_s, (0.0, 0.0, 0.0), ("base_link", "gps"))
        self._put(_STATIC, first_s, antenna)
        fixes, last_s = [(at_s, x, y) for at_s, x, y in track.fixes], -math.inf
        for pose, move in zip(poses.tolist(), moves.tolist(), strict=True):
            at_s = pose[0]
            self._put("/tf", at_s, self._transform(at_s, pose[1:], ("map", "base_link")))
            if at_s - last_s >= _FIX_S:
                last_s = at_s
                self._put("/odom", at_s, self._odometry(pose, move, track.off_m))
                if not track.fixes:
                    fixes.append((at_s, *pose[1:3]))
        places = np.array([one[1:] for one in fixes]).reshape(-1, 2)
        lonlat = (frame if track.fixes else frame.turned(90.0)).lonlat(places)
        for (at_s, _, _), place in zip(fixes, lonlat.tolist(), strict=True):
            self._put("/gps/fix", at_s, self._fix(at_s, place, track.fix_m))

    def _put(self, topic: str, at_s: float, message: Any) -> None:  # noqa: ANN401
        data = self._store.serialize_cdr(message, _TOPICS[topic])
        self._bag.write(self._topic[topic], int((self._begins_s + at_s) * 1e9), data)

    def _make(self, kind: str, *values: Any) -> Any:  # noqa: ANN401
        package, name = kind.split("/")
        return self._type[f"{package}/msg/{name}"](*values)

    def _head(self, at_s: float, frame: str = "map") -> Any:  # noqa: ANN401
        now = self._begins_s + at_s
        stamp = self._make("builtin_interfaces/Time", int(now), int(now % 1 * 1e9))
        return self._make("std_msgs/Header", stamp, frame)

    def _point(self, x: float, y: float, z: float = 0.0) -> Any:  # noqa: ANN401
        return self._make("geometry_msgs/Point", x, y, z)

    def _turn(self, yaw: float) -> Any:  # noqa: ANN401
        return self._make(
            "geometry_msgs/Quaternion", 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)
        )

    def _pose(self, x: float, y: float, yaw: float) -> Any:  # noqa: ANN401
        return self._make("geometry_msgs/Pose", self._point(x, y), self._turn(yaw))

    def _vector(self, x: float, y: float, z: float) -> Any:  # noqa: ANN401
        return self._make("geometry_msgs/Vector3", x, y, z)

    def _transform(self, at_s: float, pose: Sequence[float], frames: tuple[str, str]) -> Any:  # noqa: ANN401
        """Return where a frame is in another: metres, metres, radians."""
        x, y, yaw = pose
        moved = self._make("geometry_msgs/Transform", self._vector(x, y, 0.0), self._turn(yaw))
        head = self._head(at_s, frames[0])
        one = self._make("geometry_msgs/TransformStamped", head, frames[1], moved)
        return self._make("tf2_msgs/TFMessage", [one])

    def _odometry(self, pose: Sequence[float], move: Sequence[float], off_m: float) -> Any:  # noqa: ANN401
        """Return odometry of a pose, which may be so far off, and of its speed and turn rate."""
        (at_s, x, y, yaw), (speed_m_s, turn) = pose, move
        spread = np.diag([off_m**2] * 2 + [_UNKNOWN] * 3 + [off_m**2]).ravel()
        moves = self._make(
            "geometry_msgs/Twist", self._vector(speed_m_s, 0.0, 0.0), self._vector(0.0, 0.0, turn)
        )
        here = self._make("geometry_msgs/PoseWithCovariance", self._pose(x, y, yaw), spread)
        twist = self._make("geometry_msgs/TwistWithCovariance", moves, spread)
        return self._make("nav_msgs/Odometry", self._head(at_s), "base_link", here, twist)

    def _fix(self, at_s: float, lonlat: Sequence[float], fix_m: float | None) -> Any:  # noqa: ANN401
        lon, lat = lonlat
        status = self._make("sensor_msgs/NavSatStatus", 2, 15)
        spread = np.zeros(9) if fix_m is None else np.diag([fix_m**2] * 2 + [_UNKNOWN]).ravel()
        known = _NOT_KNOWN if fix_m is None else _KNOWN
        head = self._head(at_s, "gps")
        return self._make("sensor_msgs/NavSatFix", head, status, lat, lon, 0.0, spread, known)

    def _plan(self, at_s: float, places: Float) -> Any:  # noqa: ANN401
        poses = [
            self._make("geometry_msgs/PoseStamped", self._head(at_s), self._pose(x, y, 0.0))
            for x, y in places.tolist()
        ]
        return self._make("nav_msgs/Path", self._head(at_s), poses)

    def _plants(self, recording: Recording) -> Any:  # noqa: ANN401
        grid = recording.aisles.grid
        chance = np.zeros(len(grid)) if recording.chance is None else recording.chance
        share = np.clip(chance / max(float(np.quantile(chance, 0.99)), 1e-6), 0.0, 1.0)
        colours = [(0.25 + 0.6 * s, 0.5 - 0.25 * s, 0.2, 1.0) for s in share.tolist()]
        places = _places(grid.frame, grid.xy_m)
        wide = max(2 * half_canopy_m(grid), 0.1)
        spheres = self._marker("plants", 0, (wide, wide, _TALL_M), places, colours)
        return self._make("visualization_msgs/MarkerArray", [spheres])

    def _find(self, recording: Recording, plant: int, found: bool | None) -> Any:  # noqa: ANN401, FBT001
        grid = recording.aisles.grid
        colour = _FOUND if found else _CLEAN if found is False else (0.5, 0.5, 0.5, 1.0)
        places = _places(grid.frame, grid.xy_m[[plant]])
        wide = max(2.4 * half_canopy_m(grid), 0.2)
        one = self._marker("finds", plant, (wide, wide, _TALL_M + 0.2), places, [colour])
        return self._make("visualization_msgs/MarkerArray", [one])

    def _marker(
        self,
        space: str,
        number: int,
        size: tuple[float, float, float],
        places: Float,
        colours: list[tuple[float, float, float, float]],
    ) -> Any:  # noqa: ANN401
        """Return a marker of spheres of one size, one at each place in its colour."""
        make = self._make
        points = [self._point(x, y, _TALL_M / 2) for x, y in places.tolist()]
        tints = [make("std_msgs/ColorRGBA", *each) for each in colours]
        no_picture = make("sensor_msgs/CompressedImage", self._head(0.0), "", np.zeros(0, np.uint8))
        no_mesh = make("visualization_msgs/MeshFile", "", np.zeros(0, np.uint8))
        return make(
            "visualization_msgs/Marker",
            *(self._head(0.0), space, number, _SPHERES, 0, self._pose(0.0, 0.0, 0.0)),
            *(self._vector(*size), make("std_msgs/ColorRGBA", *colours[0])),
            *(make("builtin_interfaces/Duration", 0, 0), False, points, tints, "", no_picture),
            *([], "", "", no_mesh, False),
        )


def _places(frame: Frame, xy_m: Float) -> Float:
    """Return metres of the plot's frame as metres east and north of its centre."""
    return frame.turned(90.0).xy_m(frame.lonlat(xy_m))


def _east_north_poses(frame: Frame, poses: Float) -> Float:
    turned = poses.copy()
    turned[:, 1:3] = _places(frame, poses[:, 1:3])
    turned[:, 3] += east_north_yaw(frame)
    return turned


def east_north_yaw(frame: Frame) -> float:
    """Return the angle by which rows are turned from east, radians, against the clock."""
    return math.radians(90.0 - frame.bearing_deg)


def _filled(poses: Float) -> Float:
    """Return poses, with others where there were none for a while: it moved evenly, or stood."""
    if len(poses) < 2:
        return poses
    long_s = np.diff(poses[:, 0])
    n = np.maximum(np.ceil(long_s / _FIX_S - 1e-9), 1).astype(int)
    k = np.repeat(np.arange(len(n)), n)
    since_s = _FIX_S * (np.arange(len(k)) - np.repeat(np.cumsum(n) - n, n))
    # two poses may be of one moment
    share = np.divide(since_s, long_s[k], out=np.zeros(len(k)), where=long_s[k] > 0)
    between = poses[k] + share[:, None] * np.diff(poses, axis=0)[k]
    between[:, 3] = poses[k, 3]
    return np.concatenate([between, poses[-1:]])


def _moves(poses: Float) -> Float:
    """Return speed (forwards, m/s) and turn rate (rad/s) from each pose to the next, ``(k, 2)``."""
    step, moves = np.diff(poses, axis=0), np.zeros((len(poses), 2))
    took_s, yaw = np.maximum(step[:, 0], 1e-3), poses[:-1, 3]
    moves[:-1, 0] = (np.cos(yaw) * step[:, 1] + np.sin(yaw) * step[:, 2]) / took_s
    moves[:-1, 1] = (np.mod(step[:, 3] + np.pi, 2 * np.pi) - np.pi) / took_s
    return moves


def _thinned(poses: Float) -> list[int]:
    """Return which poses are not those at which the robot only stands, but for one in a while."""
    if not len(poses):
        return []
    kept, last = [0], poses[0]
    for k in range(1, len(poses)):
        moved = np.abs(poses[k, 1:] - last[1:]).max() > 1e-3
        if moved or poses[k, 0] - last[0] >= _FIX_S or k == len(poses) - 1:
            kept.append(k)
            last = poses[k]
    return kept


def colour_says(colour: Any) -> bool | None:  # noqa: ANN401 - a message
    """Return what the colour of a find means: found, clean, or neither."""
    red, green, blue = round(colour.r, 2), round(colour.g, 2), round(colour.b, 2)
    return {_FOUND[:3]: True, _CLEAN[:3]: False}.get((red, green, blue))


def read_bag(path: Path, topics: tuple[str, ...]) -> Iterator[tuple[str, float, Any]]:
    """Yield topic, seconds since the first message, and message of a bag (.mcap).

    Raises
    ------
    FileProblem
        If it cannot be read.
    SettingError
        If the library that reads bags is not installed.
    """
    _rosbags()
    from rosbags.highlevel import AnyReader  # noqa: PLC0415 - an extra
    from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415

    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as bag:
            ours = [one for one in bag.connections if one.topic in topics]
            for one, at_ns, data in bag.messages(ours):
                at_s = (at_ns - bag.start_time) / 1e9
                yield one.topic, at_s, bag.deserialize(data, one.msgtype)
    except FieldmonError:
        raise
    except Exception as error:  # a damaged bag fails in many ways
        raise FileProblem(
            worded("The bag cannot be read: is it whole, and an .mcap of ROS 2?")
        ) from error


def _offer(topic: str) -> list[Any]:
    """Return with which quality a topic is played again: static transforms for who comes late."""
    if topic != _STATIC:
        return []
    from rosbags.interfaces import (  # noqa: PLC0415 - an extra
        Qos,
        QosDurability,
        QosHistory,
        QosLiveliness,
        QosReliability,
        QosTime,
    )

    never = QosTime(2147483647, 4294967295)
    kept = QosHistory.KEEP_LAST, 1, QosReliability.RELIABLE, QosDurability.TRANSIENT_LOCAL
    return [Qos(*kept, never, never, QosLiveliness.AUTOMATIC, never, False)]


def _rosbags() -> tuple[Any, Any]:
    """Return how a bag is opened, and the types of ROS 2."""
    try:
        from rosbags.rosbag2 import StoragePlugin, Writer  # noqa: PLC0415 - an extra
        from rosbags.rosbag2.enums import CompressionFormat, CompressionMode  # noqa: PLC0415
        from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415
    except ImportError as error:
        raise SettingError(
            worded(
                "Bags need the library rosbags, which is not installed. Install it with: pip "
                'install "fieldmon[robot]"'
            )
        ) from error

    def opened(folder: Path) -> Any:  # noqa: ANN401
        bag = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
        bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        return bag

    return opened, get_typestore(Stores.ROS2_JAZZY)
