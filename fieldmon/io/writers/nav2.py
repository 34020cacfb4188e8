"""A day for a robot that runs Nav2 (ROS 2): a route graph, its datum, and waypoints to stop at.

The rules are those of ``nav2_route``'s GeoJSON loader (``geojson_graph_file_loader.cpp``) and of
the package's description, docs.nav2.org: points are nodes, each with an unsigned 32-bit ``id`` in
its properties; lines are edges with ``id``, ``startid`` and ``endid``, driven one way only; no id
is used twice, by nodes and edges together. Both must be there. What an edge's line looks like
between its two nodes is never read, so that every corner is a node. Values in ``metadata`` are
numbers, truth values, texts, or lists and objects of these: anything else, null above all, throws.
Numbers are kept in 32 bits, which is a millimetre at 8 km, and so coordinates are metres of a local
frame. Requests name nodes, and feedback of ``ComputeAndTrackRoute`` names edges, by 16 bits. Edges
are numbered on from the nodes, so that both together must fit.

That frame is level and east-north-up (REP 103) about the datum, as ``robot_localization`` makes it
with ``use_local_cartesian``; on a plot, our azimuthal plane is the same within a millimetre. It
lies on the ellipsoid: heights are ignored, and at 300 m above it a kilometre is 4.7 cm longer.

What a node's ``operations`` name are plugins of the robot's own: an unknown one stops the loader.
So pauses are operations only where they are asked for.
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
_MOST_IDS = 2**16 - 1
#: what the robot's route server must call its plugin for pauses
PAUSE = "InspectPlant"


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


def nav2_files_with_pauses(plan: HandoffPlan) -> dict[str, bytes]:
    """Return the same with an operation at each stop, for a robot that has a plugin for it.

    In the route server's parameters: ``operations: ["InspectPlant"]``, and as its plugin for
    instance ``nav2_route::TriggerEvent``, which calls the service that the operation names.
    """
    return {".pauses.nav2.geojson": route_graph(plan, pauses=True)} | dict(
        list(nav2_files(plan).items())[1:]
    )


def route_graph(plan: HandoffPlan, *, pauses: bool = False) -> bytes:
    """Return the driven line as a Nav2 route graph, every stretch in both directions.

    Where the line crosses or joins itself, there is a node. A node's metadata names the stops made
    there with their plants, and the longest pause; with `pauses` it has an operation as well.
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
                **({"operations": _pause(stops[node])} if pauses and node in stops else {}),
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
        "# It adds the yaw offset and the declination to the datum's yaw: all three must be 0.\n"
        "# In ROS 2 Humble fixes go through UTM in spite of use_local_cartesian, which turns the\n"
        "# frame by up to 3 degrees: use a later ROS, or a bridge that does not.\n"
        "# Heights are ignored: at 300 m above the ellipsoid a kilometre is 4.7 cm longer.\n"
        f"# {_told_width(plan)}\n"
        "/**:\n"
        "  ros__parameters:\n"
        f"    datum: [{lat}, {lon}, 0.0]  # latitude, longitude, yaw\n"
        "    wait_for_datum: true\n"
        "    use_local_cartesian: true\n"
        "    yaw_offset: 0.0\n"
        "    magnetic_declination_radians: 0.0\n"
        "    zero_altitude: true\n"
    ).encode()


def waypoints_yaml(plan: HandoffPlan) -> bytes:
    """Return where the robot stands for each plant, facing the way it comes, and for how long.

    In the form that RViz's waypoint panel (``nav2_rviz_plugins``) loads: a position, and a
    quaternion with w first. What else stands at a waypoint, it does not read. Nav2's waypoint
    follower, to which the panel hands them, pauses equally long everywhere
    (``waypoint_pause_duration``); here each stop has its own ``pause_s``, which is equal unless
    viewpoints differ. ``node`` is the node of the route graph.
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
    for k, (stop, turn) in enumerate(zip(plan.stops, yaw.tolist(), strict=True)):
        node = int(graph.of_vertex[stop.vertex])
        x, y = graph.xy_m[node].tolist()
        lines += [
            f"  waypoint{k}:",
            f"    pose: [{x}, {y}, 0.0]",
            f"    orientation: {_quaternion(turn)}",
            f"    stop: {stop.order}",
            f"    node: {node + 1}",
            f"    plant: {stop.plant}",
            *([f"    row: {stop.row}"] if plan.in_rows else []),
            f"    number: {stop.number}",
            f"    arrive_s: {stop.arrive_s}",
            f"    pause_s: {stop.look_s}",
            f"    detects: {stop.detects}",
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
    there = rank[pair.reshape(-1, 2)]
    there = np.unique(np.sort(there, axis=1), axis=0)
    both = np.stack([there, there[:, ::-1]], axis=1).reshape(-1, 2)
    if len(order) + len(both) > _MOST_IDS:
        raise SettingError(
            worded(
                "A route graph can have {most} nodes and edges at most, but this day has {nodes} "
                "nodes and {edges} edges. Hand off a shorter day.",
                most=_MOST_IDS,
                nodes=len(order),
                edges=len(both),
            )
        )
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
        here["pause_s"] = max(here["pause_s"], stop.look_s)
    return found


def _pause(metadata: dict[str, Any]) -> dict[str, Any]:
    """Return what a robot's plugin is told to do at a node."""
    told = {"service_name": "inspect_plant", **metadata}
    return {"inspect": {"type": PAUSE, "trigger": "NODE", "metadata": told}}


def _told_width(plan: HandoffPlan) -> str:
    """Return how far the way keeps off plants, in a sentence."""
    needs = plan.route.aisles.clearance
    if needs is None:
        return "The robot's width was not said: ways keep 0.3 m off the middle of plants."
    return f"Ways keep {needs.way_m:.2f} m off the middle of plants."


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
    """Return a turn about the vertical as w, x, y, z: as RViz's panel wants it."""
    return f"[{np.cos(yaw / 2):.9f}, 0.0, 0.0, {np.sin(yaw / 2):.9f}]"


def _origin(frame: Frame) -> tuple[str, str]:
    """Return latitude and longitude of a frame's centre, without an exponent: YAML 1.1 has none."""
    return f"{frame.lat:.12f}", f"{frame.lon:.12f}"


def _quoted(text: str) -> str:
    # a JSON string is a YAML string
    return json.dumps(text, ensure_ascii=False)
