"""Every field of every route format, read back by another program's reader."""

import csv
import io
import json
import zipfile
from datetime import timedelta
from xml.etree import ElementTree as ET

import numpy as np
import pyogrio
import pytest
import yaml

from fieldmon.io.writers import write_handoff
from tests.io.writers.handed import START, crooked, long, usual

KML = "{http://www.opengis.net/kml/2.2}"
GPX = "{http://www.topografix.com/GPX/1/1}"


def wanted(plan):
    """Return what the route says of each stop, from the route and the plants alone."""
    route, grid = plan.route, plan.grid
    row = grid.row[route.plant]
    arrive = [(START + timedelta(seconds=round(s))).isoformat() for s in route.arrive_s.tolist()]
    columns = {
        "stop": list(range(1, len(route) + 1)),
        "plant": route.plant.tolist(),
        "row": (grid.row_line[row] + 1).tolist(),
        "arrive": arrive,
        "arrive_s": route.arrive_s.round(3).tolist(),
        "inspect_s": (route.leave_s - route.arrive_s).round(3).tolist(),
        "chance": route.chance.round(6).tolist(),
        "lon": route.stops_lonlat()[:, 0].round(8).tolist(),
        "lat": route.stops_lonlat()[:, 1].round(8).tolist(),
    }
    if (grid.twin < 0).all() and grid.n_blocks == 1:  # else several rows share a line
        columns["number"] = (route.plant - grid.row_start[row] + 1).tolist()
    else:
        columns["face"] = np.where(route.plant < grid.twin[route.plant], 1, 2).tolist()
    return columns


def from_csv(data, _):
    rows = list(csv.DictReader(io.StringIO(data.decode("utf-8-sig"))))
    return {name: [row[name] for row in rows] for name in rows[0]}


def from_geojson(data, _):
    features = [f for f in json.loads(data)["features"] if f["properties"]["kind"] == "stop"]
    rows = [{**f["properties"], "stop": f["properties"]["order"],
             "lon": f["geometry"]["coordinates"][0], "lat": f["geometry"]["coordinates"][1]}
            for f in features]  # fmt: skip
    return {name: [row[name] for row in rows] for name in rows[0]}


def of_frame(frame):
    told = {name: frame[name].tolist() for name in frame.columns if name != "geometry"}
    return told | {"lon": frame.geometry.x.tolist(), "lat": frame.geometry.y.tolist()}


def from_gpkg(data, folder):
    (folder / "read.gpkg").write_bytes(data)
    return of_frame(pyogrio.read_dataframe(folder / "read.gpkg", layer="stops"))


def from_shapefile(data, folder):
    with zipfile.ZipFile(io.BytesIO(data)) as packed:
        packed.extractall(folder)
    return of_frame(pyogrio.read_dataframe(folder / "stops.shp"))


def from_kml(data, _):
    rows = []
    for placemark in ET.fromstring(data).iter(f"{KML}Placemark"):  # noqa: S314 - written above
        place = placemark.findtext(f"{KML}Point/{KML}coordinates")
        if place is None:
            continue
        row = {one.get("name"): one.findtext(f"{KML}value") for one in placemark.iter(f"{KML}Data")}
        row["lon"], row["lat"] = place.split(",")
        row["arrive"] = placemark.findtext(f"{KML}TimeStamp/{KML}when")
        rows.append(row)
    return {name: [row[name] for row in rows] for name in rows[0]}


def from_waypoints(data, _):
    waypoints = yaml.safe_load(data)["waypoints"]
    rows = [waypoints[f"waypoint{k}"] for k in range(len(waypoints))]
    told = {name: [row[name] for row in rows] for name in ("stop", "plant", "row", "number")}
    return told | {"arrive_s": [row["arrive_s"] for row in rows],
                   "inspect_s": [row["pause_s"] for row in rows]}  # fmt: skip


FORMATS = {
    "route.csv": (from_csv, set()),
    "route.geojson": (from_geojson, {"face"}),
    "route.gpkg": (from_gpkg, set()),
    "route.shp.zip": (from_shapefile, set()),
    "route.kml": (from_kml, set()),
    "route.waypoints.yaml": (from_waypoints, {"arrive", "chance", "lon", "lat", "face"}),
}


@pytest.mark.parametrize("make", [usual, crooked, long])
@pytest.mark.parametrize("name", FORMATS)
def test_each_field_of_each_stop_is_what_the_route_says(tmp_path, name, make):
    plan = make()
    asked = "route.nav2.geojson" if name.endswith(".yaml") else name
    files = write_handoff(plan, tmp_path / asked)
    (path,) = [f for f in files if f.name.endswith(name.removeprefix("route"))] or files
    read, left_out = FORMATS[name]
    folder = tmp_path / "read"
    folder.mkdir()
    told = read(path.read_bytes(), folder)
    for field, values in wanted(plan).items():
        if field in left_out:
            continue
        assert len(told[field]) == len(values), field
        if field == "arrive":
            assert told[field] == values
        else:
            np.testing.assert_allclose(np.array(told[field], float), values, atol=1e-7, rtol=0)


@pytest.mark.parametrize("make", [usual, crooked, long])
def test_waypoints_of_gpx_say_plant_arrival_pause_and_chance_in_words(tmp_path, make):
    plan = make()
    (path,) = write_handoff(plan, tmp_path / "route.gpx")
    told = wanted(plan)
    points = ET.parse(path).getroot().findall(f"{GPX}wpt")  # noqa: S314 - written above
    assert len(points) == len(plan.route)
    for k, point in enumerate(points):
        assert point.findtext(f"{GPX}name").startswith(f"{told['stop'][k]:03d} R{told['row'][k]}/")
        said = point.findtext(f"{GPX}desc")
        assert point.findtext(f"{GPX}cmt") == said, "gpsbabel keeps one of the two"
        plant, arrive, pause, chance = said.split("; ")
        assert plant == f"plant {told['plant'][k]}"
        assert arrive == f"arrive {told['arrive'][k]}"
        assert float(pause.split()[1]) == pytest.approx(told["inspect_s"][k])
        assert float(chance.split()[1].rstrip("%")) == pytest.approx(
            100 * told["chance"][k], abs=0.06
        )


def test_the_line_of_a_geojson_says_when_the_robot_is_where(tmp_path):
    plan = usual()
    (path,) = write_handoff(plan, tmp_path / "route.geojson")
    root = json.loads(path.read_text("utf-8"))
    line, stops = root["features"][0], root["features"][1:]
    seconds = line["properties"]["vertex_s"]
    assert len(seconds) == len(line["geometry"]["coordinates"])
    assert (np.diff(seconds) >= 0).all()
    assert seconds[-1] == pytest.approx(line["properties"]["seconds"])
    for stop in stops:
        at = stop["properties"]["line_vertex"]
        assert seconds[at] == pytest.approx(stop["properties"]["arrive_s"], abs=0.002)
    figures = line["properties"]
    assert figures["stops"] == len(stops)
    assert figures["inspect_s"] == pytest.approx(sum(s["properties"]["inspect_s"] for s in stops))
    assert figures["infested_expected"] == pytest.approx(plan.route.chance.sum(), abs=1e-3)
    assert figures["start"] == START.isoformat()
    ends = START + timedelta(seconds=round(figures["seconds"]))
    assert figures["end"] == ends.isoformat()
