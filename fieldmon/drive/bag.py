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
from fieldmon.io.atomic_write import require_place, write_whole
from fieldmon.plot.clearance import half_canopy_m

if TYPE_CHECKING:
    from collections.abc import Iterator
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
_TOPICS = {
    "/tf": "tf2_msgs/msg/TFMessage",
    "/plan": "nav_msgs/msg/Path",
    "/odom": "nav_msgs/msg/Odometry",
    "/gps/fix": "sensor_msgs/msg/NavSatFix",
    "/plants": "visualization_msgs/msg/MarkerArray",
    "/finds": "visualization_msgs/msg/MarkerArray",
}


def write_bag(recording: Recording, begins: datetime, to: Path) -> tuple[Path, Path, Path]:
    """Write a driven day as a bag; return it and its layouts for RViz and Foxglove.

    The frame ``map`` is metres east and north of the plot's centre, as in the Nav2 files. Topics:
    the transform to ``base_link``, the plan as it changes, odometry, position fixes, plants by
    their chance, and what was found.

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
        As `require_bag` does.
    """
    require_bag(to)
    writer, store = _rosbags()
    with working_folder() as folder:
        inner = Path(folder) / "bag"
        with writer(inner) as bag:
            _Pen(bag, store, begins.timestamp()).write(recording)
        data = next(inner.glob("*.mcap*")).read_bytes()
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
            name: bag.add_connection(name, kind, typestore=store) for name, kind in _TOPICS.items()
        }

    def write(self, recording: Recording) -> None:
        """Write a day: poses in time, plans and finds as they come."""
        frame = recording.aisles.grid.frame
        poses = _thinned(_east_north_poses(frame, recording.track.poses))
        lonlat = frame.turned(90.0).lonlat(poses[:, 1:3])
        first_s = float(poses[0, 0]) if len(poses) else 0.0
        self._put("/plants", first_s, self._plants(recording))
        planned_s = first_s
        for one in recording.stops:
            self._put("/plan", planned_s, self._plan(planned_s, _places(frame, one.line_m)))
            planned_s = one.at_s
            self._put("/finds", one.at_s, self._find(recording, one.plant, one.found))
        last_s = -math.inf
        for k, (at_s, x, y, yaw) in enumerate(poses.tolist()):
            self._put("/tf", at_s, self._transform(at_s, x, y, yaw))
            if at_s - last_s >= _FIX_S:
                last_s = at_s
                self._put("/odom", at_s, self._odometry(at_s, x, y, yaw))
                self._put("/gps/fix", at_s, self._fix(at_s, *lonlat[k].tolist()))

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

    def _transform(self, at_s: float, x: float, y: float, yaw: float) -> Any:  # noqa: ANN401
        moved = self._make("geometry_msgs/Transform", self._vector(x, y, 0.0), self._turn(yaw))
        one = self._make("geometry_msgs/TransformStamped", self._head(at_s), "base_link", moved)
        return self._make("tf2_msgs/TFMessage", [one])

    def _odometry(self, at_s: float, x: float, y: float, yaw: float) -> Any:  # noqa: ANN401
        none = np.zeros(36)
        still = self._make(
            "geometry_msgs/Twist", self._vector(0.0, 0.0, 0.0), self._vector(0.0, 0.0, 0.0)
        )
        pose = self._make("geometry_msgs/PoseWithCovariance", self._pose(x, y, yaw), none)
        twist = self._make("geometry_msgs/TwistWithCovariance", still, none)
        return self._make("nav_msgs/Odometry", self._head(at_s), "base_link", pose, twist)

    def _fix(self, at_s: float, lon: float, lat: float) -> Any:  # noqa: ANN401
        status = self._make("sensor_msgs/NavSatStatus", 2, 15)
        spread = np.diag([4e-4] * 3).ravel()
        return self._make(
            "sensor_msgs/NavSatFix", self._head(at_s, "gps"), status, lat, lon, 0.0, spread, 2
        )

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


def _thinned(poses: Float) -> Float:
    """Return poses without those at which the robot only stands, but for one in a while."""
    if not len(poses):
        return poses
    kept, last = [0], poses[0]
    for k in range(1, len(poses)):
        moved = np.abs(poses[k, 1:] - last[1:]).max() > 1e-3
        if moved or poses[k, 0] - last[0] >= _FIX_S or k == len(poses) - 1:
            kept.append(k)
            last = poses[k]
    return poses[kept]


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
