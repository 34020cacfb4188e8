"""What a robot with Nav2 gets: a graph that its loader takes, a datum, and waypoints."""

import json
from collections import deque
from types import SimpleNamespace

import numpy as np
import pyproj
import pytest
import scipy.sparse.csgraph
import shapely
import yaml
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fieldmon.errors import PlotError, SettingError
from fieldmon.io.writers import nav2, write_handoff
from fieldmon.io.writers.nav2 import graph_of, nav2_files
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from tests.crooked import crooked_fields
from tests.crossing import crosses_rows
from tests.io.writers.handed import DAYS, apart_m, crooked, day, long, usual

MM = 1e-3


@pytest.fixture(scope="module", params=["usual", "long", "crooked"])
def plan(request):
    return DAYS[request.param]()


@pytest.fixture(scope="module")
def files(plan, tmp_path_factory):
    """Return a day's graph, datum and waypoints, written and parsed once."""
    return nav2_of(plan, tmp_path_factory.mktemp("nav2"))


def nav2_of(plan, folder):
    """Return graph, datum and waypoints as their readers parse them."""
    paths = write_handoff(plan, folder / "day.nav2.geojson")
    assert [path.name for path in paths] == [
        *("day.nav2.geojson", "day.datum.yaml", "day.waypoints.yaml")
    ]
    graph, datum, waypoints = (path.read_text("utf-8") for path in paths)
    return json.loads(graph), *(yaml.load(t, yaml.CSafeLoader) for t in (datum, waypoints))


def unsigned(value):
    """Return what C++ makes of a JSON value for an unsigned int; it takes no text and no null."""
    assert type(value) is int
    assert 0 <= value < 2**32
    return value


def metadata(values):
    """Walk through metadata as the loader converts them; what it throws on fails here."""
    for value in values.values():
        if isinstance(value, dict):
            metadata(value)
            continue
        for single in value if isinstance(value, list) else [value]:
            assert isinstance(single, bool | int | float | str)


def loaded(root):
    """Return nodes and edges as nav2_route's GeoJsonGraphFileLoader would, by its own steps.

    Re-implemented from its behaviour: features are sorted by the type of their geometry; nodes are
    put in a table by id; edges must join known ids; their lines are not looked at; frame, metadata
    and operations are optional.
    """
    points = [f for f in root["features"] if f["geometry"]["type"] == "Point"]
    lines = [
        f for f in root["features"] if f["geometry"]["type"] in {"LineString", "MultiLineString"}
    ]
    assert points
    assert lines
    nodes = {}
    for feature in points:
        properties = feature["properties"]
        assert isinstance(properties.get("frame", ""), str)
        metadata(properties.get("metadata", {}))
        assert "operations" not in properties  # these name plugins, which are a robot's own
        x, y = (np.float32(value) for value in feature["geometry"]["coordinates"][:2])
        nodes[unsigned(properties["id"])] = (float(x), float(y))
    edges = {}
    for feature in lines:
        properties = feature["properties"]
        metadata(properties.get("metadata", {}))
        start, end = unsigned(properties["startid"]), unsigned(properties["endid"])
        assert start in nodes
        assert end in nodes
        edges[unsigned(properties["id"])] = (start, end)
    return points, lines, nodes, edges


def test_the_loader_takes_the_graph(files):
    root, _, _ = files
    points, lines, nodes, edges = loaded(root)
    assert len(nodes) == len(points)  # ids of nodes are theirs alone
    assert len(edges) == len(lines)
    assert not nodes.keys() & edges.keys()  # and edges share none with them
    assert max(edges) < 2**16  # requests name nodes, and feedback edges, in 16 bits
    assert all(start != end for start, end in edges.values())
    assert len(set(edges.values())) == len(edges)
    assert {(end, start) for start, end in edges.values()} == set(edges.values())


def test_an_edge_is_drawn_from_its_start_to_its_end(files):
    root, _, _ = files
    places = {
        f["properties"]["id"]: f["geometry"]["coordinates"]
        for f in root["features"]
        if f["geometry"]["type"] == "Point"
    }
    for feature in root["features"]:
        if feature["geometry"]["type"] == "LineString":
            start, end = feature["properties"]["startid"], feature["properties"]["endid"]
            assert feature["geometry"]["coordinates"] == [places[start], places[end]]


def lonlat_of(xy_m, datum):
    """Return degrees of metres east and north of a datum, by a tangent plane on the ellipsoid.

    As robot_localization's local cartesian frame; not the azimuthal plane that the file is made in.
    """
    lat, lon, yaw = datum["/**"]["ros__parameters"]["datum"]
    assert yaw == 0.0
    back = pyproj.Transformer.from_pipeline(
        f"+proj=pipeline +step +inv +proj=topocentric +ellps=WGS84 +lon_0={lon} +lat_0={lat} "
        "+step +inv +proj=cart +ellps=WGS84 +step +proj=unitconvert +xy_in=rad +xy_out=deg"
    )
    xy = np.asarray(xy_m, float).reshape(-1, 2)
    lon, lat, _ = back.transform(xy[:, 0], xy[:, 1], np.zeros(len(xy)))
    return np.stack([lon, lat], axis=1)


def test_nodes_lie_on_the_earth_where_the_line_is_to_the_centimetre(files, plan):
    root, datum, _ = files
    _, _, nodes, _ = loaded(root)
    placed = shapely.points(plan.grid.frame.xy_m(lonlat_of(list(nodes.values()), datum)))
    line = shapely.linestrings(plan.route.line_m)
    assert shapely.distance(placed, line).max() < 0.005
    corners = shapely.points(plan.route.line_m)
    tree = shapely.STRtree(placed)
    nearest = tree.nearest(corners)
    assert shapely.distance(corners, placed[nearest]).max() < 0.005


def test_nodes_stand_on_the_line_s_corners_to_the_millimetre(plan):
    """Put on whole millimetres twice, in the plot's frame and in the file's: each may lose half."""
    graph = graph_of(plan)
    corners = plan.grid.frame.turned(90.0).xy_m(plan.route.line_lonlat())
    off_m = np.hypot(*(graph.xy_m[graph.of_vertex] - corners).T)
    assert off_m.max() < np.sqrt(0.5) * (MM + MM)


def test_the_graph_is_the_driven_line_and_no_more(files, plan):
    root, datum, _ = files
    _, _, nodes, edges = loaded(root)
    ids = list(nodes)
    xy_m = plan.grid.frame.xy_m(lonlat_of([nodes[i] for i in ids], datum))
    at = dict(zip(ids, xy_m, strict=True))
    # each leads there and back, see above
    steps = shapely.linestrings([[at[a], at[b]] for a, b in edges.values() if a < b])
    line = shapely.linestrings(plan.route.line_m)
    assert shapely.within(steps, shapely.buffer(line, 0.01)).all()
    assert shapely.within(line, shapely.buffer(shapely.union_all(steps), 0.01))
    assert not any(crosses_rows(plan.grid, shapely.get_coordinates(step)) for step in steps)


def test_every_node_can_be_reached_from_every_other(files):
    root, _, _ = files
    _, _, nodes, edges = loaded(root)
    onward = {node: [] for node in nodes}
    for start, end in edges.values():
        onward[start].append(end)
    seen, queue = {1}, deque([1])
    while queue:
        for other in onward[queue.popleft()]:
            if other not in seen:
                seen.add(other)
                queue.append(other)
    assert seen == nodes.keys()


def test_no_node_lies_on_an_edge_that_passes_it_by(tmp_path):
    root, _, _ = nav2_of(usual(), tmp_path)
    _, _, nodes, edges = loaded(root)
    points = shapely.points(list(nodes.values()))
    ids = np.array(list(nodes))
    steps = shapely.linestrings([[nodes[a], nodes[b]] for a, b in edges.values()])
    step, point = shapely.STRtree(points).query(steps, predicate="dwithin", distance=MM)
    ends = np.array(list(edges.values()))[step]
    assert (ends == ids[point][:, None]).any(axis=1).all()


def test_every_stop_stands_in_the_metadata_of_its_node(files):
    root, _, waypoints = files
    told = {}
    for feature in root["features"]:
        data = feature["properties"].get("metadata")
        if data:
            assert data["pause_s"] == pytest.approx(40.0)
            told |= dict.fromkeys(data["stops"], feature["properties"]["id"])
    assert told == {point["stop"]: point["node"] for point in waypoints["waypoints"].values()}


# --- waypoints ---------------------------------------------------------------------------------


def test_waypoints_are_where_the_robot_stands_and_how_long(files, plan):
    _, datum, told = files
    lat, lon, _ = datum["/**"]["ros__parameters"]["datum"]
    assert told["datum"] == {"latitude": lat, "longitude": lon}
    assert told["frame_id"] == "map"
    assert told["plot"] == plan.notes.plot
    assert list(told["waypoints"]) == [f"waypoint{k}" for k in range(len(plan.route))]
    points = told["waypoints"].values()
    assert [point["plant"] for point in points] == plan.route.plant.tolist()
    places = [p["pose"][:2] for p in points]
    assert {p["pose"][2] for p in points} == {0.0}
    stands = plan.grid.frame.lonlat(plan.route.line_m[plan.route.line_stop])
    assert apart_m(lonlat_of(places, datum), stands) < 0.01
    pauses = [point["pause_s"] for point in points]
    assert pauses == [40.0] * len(plan.stops)
    assert [p["arrive_s"] for p in points] == pytest.approx(plan.route.arrive_s.tolist(), abs=1e-3)


def test_waypoints_face_the_way_the_robot_comes(files, plan):
    _, _, told = files
    enu = plan.grid.frame.turned(90.0).xy_m(plan.route.line_lonlat())
    points = told["waypoints"].values()
    for point, vertex in zip(points, plan.route.line_stop.tolist(), strict=True):
        w, x, y, z = point["orientation"]  # as RViz's panel reads it
        assert (x, y) == (0, 0)
        assert np.hypot(z, w) == pytest.approx(1.0, abs=1e-8)
        yaw = 2 * np.arctan2(z, w)
        way = enu[vertex] - enu[:vertex]
        way = way[np.hypot(*way.T) > 0.01][-1:]
        if len(way):
            ahead = way[0] / np.hypot(*way[0])
            assert np.dot(ahead, (np.cos(yaw), np.sin(yaw))) > 0.999


def test_the_datum_file_holds_parameters_alone(tmp_path):
    _, datum, _ = nav2_of(crooked(), tmp_path)
    assert list(datum) == ["/**"]
    parameters = datum["/**"]["ros__parameters"]
    assert all(type(value) is float for value in parameters["datum"])
    assert parameters["wait_for_datum"] is True  # else the datum is not looked at
    assert parameters["use_local_cartesian"] is True  # else metres are those of UTM
    assert parameters["yaw_offset"] == parameters["magnetic_declination_radians"] == 0.0


def test_the_datum_file_says_how_far_ways_keep_off_plants(tmp_path):
    nav2_of(crooked(), tmp_path)
    said = (tmp_path / "day.datum.yaml").read_text("utf-8")
    assert "width was not said: ways keep 0.3 m" in said
    assert "Humble" in said
    assert "Heights are ignored" in said


def test_pauses_are_operations_only_where_they_are_asked_for(tmp_path):
    plan = crooked()
    paths = write_handoff(plan, tmp_path / "day.pauses.nav2.geojson")
    assert [path.name for path in paths] == [
        *("day.pauses.nav2.geojson", "day.datum.yaml", "day.waypoints.yaml")
    ]
    root = json.loads(paths[0].read_text("utf-8"))
    told = {}
    for feature in root["features"]:
        for each in feature["properties"].pop("operations", {}).values():
            assert (each["type"], each["trigger"]) == ("InspectPlant", "NODE")
            metadata(each["metadata"])
            told |= dict(zip(each["metadata"]["stops"], each["metadata"]["plants"], strict=True))
    assert [told[k + 1] for k in range(len(plan.route))] == plan.route.plant.tolist()
    assert root == json.loads(nav2_files(plan)[".nav2.geojson"])


def test_a_day_of_more_nodes_and_edges_than_feedback_can_name_is_refused(monkeypatch):
    assert np.iinfo(np.uint16).max == nav2._MOST_IDS  # as nav2_msgs/Route numbers edges
    graph = graph_of(usual())
    monkeypatch.setattr(nav2, "_MOST_IDS", len(graph.xy_m) + len(graph.pair))
    graph_of(usual())
    monkeypatch.setattr(nav2, "_MOST_IDS", len(graph.xy_m) + len(graph.pair) - 1)
    with pytest.raises(SettingError, match="nodes and edges at most"):
        graph_of(usual())


def test_waypoints_alone_are_the_same(tmp_path):
    plan = long()
    (alone,) = write_handoff(plan, tmp_path / "day.yaml")
    *_, beside = write_handoff(plan, tmp_path / "day.geojson", "nav2")
    assert alone.read_bytes() == beside.read_bytes()
    assert beside.name == "day.waypoints.yaml"


@given(field=crooked_fields(60.0), seed=st.integers(0, 1000))
@settings(max_examples=5)
def test_on_crooked_plots_the_graph_joins_every_stop_and_crosses_no_row(field, seed):
    try:
        plan = day(lay(field, Planting()), hours=1.0, seed=seed)
        graph = graph_of(plan)
    except (PlotError, SettingError):  # no room for a plant, or one stop at the gate
        assume(False)
    n = len(graph.xy_m)
    links = scipy.sparse.coo_array((np.ones(len(graph.pair)), graph.pair.T), (n, n))
    assert scipy.sparse.csgraph.connected_components(links)[0] == 1
    enu = plan.grid.frame.turned(90.0)
    there = plan.grid.frame.xy_m(enu.lonlat(graph.xy_m))
    assert np.abs(there[graph.of_vertex] - plan.route.line_m).max() < 0.005
    assert not any(crosses_rows(plan.grid, there[pair]) for pair in graph.pair)


def test_who_stands_at_the_gate_faces_the_way_that_comes():
    xy_m = np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]])
    graph = SimpleNamespace(xy_m=xy_m, of_vertex=np.arange(3))
    plan = SimpleNamespace(route=SimpleNamespace(line_stop=np.array([0, 1, 2])))
    assert nav2._yaws(plan, graph) == pytest.approx([0.0, 0.0, np.pi / 2])
