"""A day for a robot that runs Nav2 (ROS 2): a route graph, its datum, and waypoints to stop at.

The rules are those of ``nav2_route``'s GeoJSON loader (``geojson_graph_file_loader.cpp``) and of
the package's description, docs.nav2.org: points are nodes, each with an unsigned 32-bit ``id`` in
its properties; lines are edges with ``id``, ``startid`` and ``endid``, driven one way only; no id
is used twice, by nodes and edges together. Both must be there. What an edge's line looks like
between its two nodes is never read, so that every corner is a node. Values in ``metadata`` are
numbers, truth values, texts, or lists and objects of these: anything else, null above all, throws.
Numbers are kept in 32 bits, which is a millimetre at 8 km, and so coordinates are metres of a local
frame. Requests name nodes by 16 bits (``ComputeRoute``: ``uint16 start_id``, ``goal_id``).

That frame is level and east-north-up (REP 103) about the datum, as ``robot_localization`` makes it
with ``use_local_cartesian``; on a plot, our azimuthal plane is the same within a millimetre.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.writers.day_file import HandoffPlan
    from fieldmon.plot.projection import Frame

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_FRAME = "map"
_GRID_M = 1e-3  # coordinates are written to the millimetre
_MOST_NODES = 2**16 - 1


class RouteGraph(NamedTuple):
    """The driven line as a network, in metres of the datum's frame.

    Parameters
    ----------
    xy_m
        ``(n, 2)`` nodes, east and north of the datum, to the millimetre.
    pair
        ``(e, 2)`` nodes that an edge joins, from and to; there and back are two edges.
    of_vertex
        ``(m,)`` the node at each vertex of the driven line.
    """

    xy_m: Float
    pair: Int
    of_vertex: Int


def nav2_files(plan: HandoffPlan) -> dict[str, bytes]:
    """Return what a robot with Nav2 needs of a day: route graph, datum and waypoints, by ending."""
    return {
        ".nav2.geojson": route_graph(plan),
        ".datum.yaml": datum_yaml(plan),
        ".waypoints.yaml": waypoints_yaml(plan),
    }


def route_graph(plan: HandoffPlan) -> bytes:
    """Return the driven line as a Nav2 route graph, every stretch in both directions.

    Where the line crosses or joins itself, there is a node. A node's metadata names the stops made
    there with their plants, and the longest pause.
    """
    graph = graph_of(plan)
    stops = _stops_by_node(plan, graph)
    n_nodes = len(graph.xy_m)
    features = [
        {
            "type": "Feature",
            "properties": {
                "id": node + 1,
                "frame": _FRAME,
                **({"metadata": stops[node]} if node in stops else {}),
            },
            "geometry": {"type": "Point", "coordinates": place},
        }
        for node, place in enumerate(graph.xy_m.tolist())
    ]
    features += [
        {
            "type": "Feature",
            "properties": {"id": n_nodes + 1 + edge, "startid": a + 1, "endid": b + 1},
            "geometry": {
                "type": "LineString",
                "coordinates": [graph.xy_m[a].tolist(), graph.xy_m[b].tolist()],
            },
        }
        for edge, (a, b) in enumerate(graph.pair.tolist())
    ]
    root = {"type": "FeatureCollection", "name": plan.title, "features": features}
    return json.dumps(root, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()


def datum_yaml(plan: HandoffPlan) -> bytes:
    """Return the frame's origin as parameters of ``robot_localization``'s navsat transform."""
    lat, lon = _origin(plan.grid.frame)
    return (
        "# Origin of the local frame in which the route graph and the waypoints are metres:\n"
        "# x east, y north (ROS REP 103), WGS 84. For robot_localization's navsat_transform_node.\n"
        "/**:\n"
        "  ros__parameters:\n"
        f"    datum: [{lat}, {lon}, 0.0]  # latitude, longitude, yaw\n"
        "    wait_for_datum: true\n"
        "    use_local_cartesian: true\n"
        "    zero_altitude: true\n"
    ).encode()


def waypoints_yaml(plan: HandoffPlan) -> bytes:
    """Return where the robot stands for each plant, facing the way it comes, and for how long.

    Nav2's waypoint follower pauses equally long everywhere (``waypoint_pause_duration``); here each
    stop has its own ``pause_s``, which is equal unless viewpoints differ. ``node`` is the node of
    the route graph.
    """
    graph = graph_of(plan)
    lat, lon = _origin(plan.grid.frame)
    yaw = _yaws(plan, graph)
    lines = [
        "# Waypoints in metres of the frame about the datum: x east, y north (ROS REP 103).",
        f"plot: {_quoted(plan.notes.plot)}",
        f"start: {_quoted(plan.clock(0.0))}",
        f"frame_id: {_FRAME}",
        f"datum: {{latitude: {lat}, longitude: {lon}}}",
        "waypoints:",
    ]
    for stop, turn in zip(plan.stops, yaw.tolist(), strict=True):
        node = int(graph.of_vertex[stop.vertex])
        x, y = graph.xy_m[node].tolist()
        lines += [
            f"  - stop: {stop.order}",
            f"    node: {node + 1}",
            f"    plant: {stop.plant}",
            f"    row: {stop.row}",
            f"    number: {stop.number}",
            f"    arrive_s: {stop.arrive_s}",
            f"    pause_s: {stop.inspect_s}",
            "    pose:",
            f"      position: {{x: {x}, y: {y}, z: 0.0}}",
            f"      orientation: {_quaternion(turn)}",
        ]
    return "\n".join([*lines, ""]).encode()


def graph_of(plan: HandoffPlan) -> RouteGraph:
    """Return the driven line as a network; raise `SettingError` for a day without a way."""
    line_m = plan.route.line_m
    ways = shapely.linestrings(np.stack([line_m[:-1], line_m[1:]], axis=1))
    # made in the plot's own frame, where aisles run along x and lie on each other to the last bit
    noded = shapely.get_parts(shapely.union_all(ways, grid_size=_GRID_M))
    steps = [_steps(part) for part in noded if shapely.length(part) > 0]
    if not steps:
        raise SettingError(
            worded(
                "A route graph must have a way between two places, but this "
                "day drives nowhere. Give it more hours."
            )
        )
    ends = np.concatenate(steps)
    places, pair = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    _, of_vertex = cKDTree(places).query(line_m)
    # numbered as they are passed, so that the first stops have the first numbers
    passed = dict.fromkeys([*of_vertex.tolist(), *range(len(places))])
    order = np.fromiter(passed, np.int64)
    rank = np.argsort(order)
    if len(order) > _MOST_NODES:
        raise SettingError(
            worded(
                "A route graph can have {most_nodes} nodes at most, but this "
                "day has {n}. Hand off a shorter day.",
                most_nodes=_MOST_NODES,
                n=len(order),
            )
        )
    there = rank[pair.reshape(-1, 2)]
    there = np.unique(np.sort(there, axis=1), axis=0)
    both = np.stack([there, there[:, ::-1]], axis=1).reshape(-1, 2)
    xy_m = _east_north(plan.grid.frame, places[order])
    return RouteGraph(xy_m, both, rank[of_vertex])


def _steps(part: shapely.Geometry) -> Float:
    """Return both ends of every straight stretch of a line, ``(k, 2, 2)``."""
    points = shapely.get_coordinates(part)
    return np.stack([points[:-1], points[1:]], axis=1)


def _east_north(frame: Frame, xy_m: Float) -> Float:
    """Return metres east and north of a frame's centre, to the millimetre."""
    return frame.turned(90.0).xy_m(frame.lonlat(xy_m)).round(3) + 0.0  # no minus zero


def _stops_by_node(plan: HandoffPlan, graph: RouteGraph) -> dict[int, dict[str, Any]]:
    found: dict[int, dict[str, Any]] = {}
    for stop in plan.stops:
        node = int(graph.of_vertex[stop.vertex])
        here = found.setdefault(node, {"stops": [], "plants": [], "pause_s": 0.0})
        here["stops"].append(stop.order)
        here["plants"].append(stop.plant)
        here["pause_s"] = max(here["pause_s"], stop.inspect_s)
    return found


def _yaws(plan: HandoffPlan, graph: RouteGraph) -> Float:
    """Return the heading at each stop, radians from east to the left: the way the robot came.

    Where it has not moved yet, it is the way it goes on.
    """
    line_m = graph.xy_m[graph.of_vertex]
    steps = np.diff(line_m, axis=0)
    moves = np.flatnonzero(np.hypot(steps[:, 0], steps[:, 1]) > 0)
    yaw = np.arctan2(steps[moves, 1], steps[moves, 0])
    before = np.searchsorted(moves, plan.route.line_stop) - 1
    turned: Float = yaw[np.maximum(before, 0)]
    return turned


def _quaternion(yaw: float) -> str:
    return f"{{x: 0.0, y: 0.0, z: {np.sin(yaw / 2):.9f}, w: {np.cos(yaw / 2):.9f}}}"


def _origin(frame: Frame) -> tuple[str, str]:
    """Return latitude and longitude of a frame's centre, without an exponent: YAML 1.1 has none."""
    return f"{frame.lat:.12f}", f"{frame.lon:.12f}"


def _quoted(text: str) -> str:
    # a JSON string is a YAML string
    return json.dumps(text, ensure_ascii=False)
