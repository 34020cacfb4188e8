"""Every field of every route format, read back by another program's reader."""

import csv
import io
import json
import zipfile
from datetime import timedelta
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pyogrio
import pytest
import yaml

from fieldmon.compute.wording import chance_figure
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import write_handoff
from fieldmon.plot.grid import plant_numbers
from tests.io.writers.handed import (
    NAMES,
    START,
    among_trees,
    crooked,
    in_blocks,
    long,
    of_team,
    usual,
    with_named_rows,
    without_start,
)
from tests.pages import Page

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
        "look_s": [40.0] * len(route),
        "chance": route.chance.round(6).tolist(),
        "detects": route.detects.round(6).tolist(),
        "lon": route.stops_lonlat()[:, 0].round(8).tolist(),
        "lat": route.stops_lonlat()[:, 1].round(8).tolist(),
    }
    if not grid.has_faces and grid.n_blocks == 1:  # else several rows share a line
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
        row["look_s"] = placemark.findtext(f"{KML}description").split()[1]
        rows.append(row)
    return {name: [row[name] for row in rows] for name in rows[0]}


def from_waypoints(data, _):
    waypoints = yaml.load(data, yaml.CSafeLoader)["waypoints"]
    rows = [waypoints[f"waypoint{k}"] for k in range(len(waypoints))]
    told = {
        name: [row[name] for row in rows] for name in ("stop", "plant", "row", "number", "detects")
    }
    return told | {"arrive_s": [row["arrive_s"] for row in rows],
                   "look_s": [row["pause_s"] for row in rows]}  # fmt: skip


FORMATS = {
    "route.csv": (from_csv, {"look_s"}),
    "route.geojson": (from_geojson, {"face", "look_s"}),
    "route.gpkg": (from_gpkg, {"look_s"}),
    "route.shp.zip": (from_shapefile, {"look_s"}),
    "route.kml": (from_kml, set()),
    "route.waypoints.yaml": (
        from_waypoints,
        {"arrive", "inspect_s", "chance", "lon", "lat", "face"},
    ),
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
        plant, arrive, pause, chance, detects = said.split("; ")
        assert plant == f"plant {told['plant'][k]}"
        assert arrive == f"arrive {told['arrive'][k]}"
        assert float(pause.split()[1]) == told["look_s"][k]
        assert chance == f"chance {chance_figure(told['chance'][k], 1)}"
        assert float(detects.removeprefix("detects ")) == pytest.approx(told["detects"][k])


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


# --- whatever the plot, the start and whoever drives ----------------------------------------------


def said_of(plan):
    """Return all that a format of a table says of each stop, by name: these fields and no more."""
    route, grid, notes = plan.route, plan.grid, plan.notes
    told = {name: values for name, values in wanted(plan).items() if name not in ("number", "face")}
    told["number"] = [int(plant_numbers(grid, np.array([p])).number[0]) for p in route.plant]
    told["arrive"] = [
        "" if notes.start is None else (notes.start + timedelta(seconds=round(s))).isoformat()
        for s in route.arrive_s.tolist()
    ]
    if not grid.in_rows:
        del told["row"]
    if grid.block is not None:
        told["block"] = (grid.block[grid.row[route.plant]] + 1).tolist()
    if grid.has_faces:
        told["face"] = np.where(route.plant < grid.twin[route.plant], 1, 2).tolist()
    return told | {name: [""] * len(route) for name in ("found", "count", "notes")} | {
        "who": [notes.who or ""] * len(route)
    }  # fmt: skip


#: what each has besides, and what it does not say
ODD = {
    "route.csv": ({"plot"}, {"look_s"}),
    "route.geojson": ({"kind", "order", "line_vertex"}, {"face", "look_s"}),
    "route.gpkg": ({"time"}, {"look_s"}),
    "route.shp.zip": (set(), {"look_s"}),
    "route.kml": (set(), set()),
}


@pytest.mark.parametrize("make", [in_blocks, among_trees, of_team, without_start, crooked])
@pytest.mark.parametrize("name", ODD)
def test_a_format_of_a_table_says_what_there_is_to_say_and_no_more(tmp_path, name, make):
    plan = make()
    (path,) = write_handoff(plan, tmp_path / name)
    (tmp_path / "read").mkdir()
    told = FORMATS[name][0](path.read_bytes(), tmp_path / "read")
    more, less = ODD[name]
    said = {one: values for one, values in said_of(plan).items() if one not in less}
    if name == "route.geojson" and plan.notes.start is None:
        del said["arrive"]
    assert set(told) == set(said) | more
    for field, values in said.items():
        read = ["" if pd.isna(one) else one for one in told[field]]
        if field in ("found", "count", "notes"):
            assert set(read) == {""}, field
        elif field == "who":
            assert [str(one).removeprefix("'") for one in read] == values
        elif field == "arrive":
            assert read == values
        else:
            np.testing.assert_allclose(np.array(read, float), values, atol=1e-7, rtol=0)


@pytest.mark.parametrize("name", ODD)
def test_a_format_of_a_table_says_what_the_plots_file_calls_rows_without_a_number(tmp_path, name):
    plan = with_named_rows()
    (path,) = write_handoff(plan, tmp_path / name)
    (tmp_path / "read").mkdir()
    told = FORMATS[name][0](path.read_bytes(), tmp_path / "read")
    numbers = [1, 2, 101, 102, 4, 5]
    line = plan.grid.row_line[plan.grid.row[plan.route.plant]].tolist()
    assert {2, 3} < set(line)
    assert [int(row) for row in told["row"]] == [numbers[k] for k in line]
    names = ["" if pd.isna(one) else one.removeprefix("'") for one in told["row_name"]]
    assert names == [NAMES[k] if k in {2, 3} else "" for k in line]


def test_waypoints_and_the_sheet_say_what_the_plots_file_calls_rows_without_a_number(tmp_path):
    plan = with_named_rows()
    line = plan.grid.row_line[plan.grid.row[plan.route.plant]].tolist()
    names = ["R1", "R2", "R101·5A", "R102·=<Top>_7_8", "R4", "R5"]
    (path,) = write_handoff(plan, tmp_path / "route.gpx")
    tree = ET.parse(path)  # noqa: S314 - written above
    points = [point.find(f"{GPX}name") for point in tree.getroot().findall(f"{GPX}wpt")]
    shown = [point.text.split(" ", 1)[1].rsplit("/", 1)[0] for point in points]
    assert shown == [names[k] for k in line]
    for point in points:
        point.text += " +3"
    back = read_inspections(Upload("r.gpx", ET.tostring(tree.getroot())), plan.grid).value
    assert back.plant.tolist() == plan.route.plant.tolist()
    assert set(back.count.tolist()) == {3.0}
    sheet, *_ = write_handoff(plan, tmp_path / "sheet.html")
    ((_, *rows),) = Page(sheet.read_text("utf-8")).tables
    signs = ["1", "2", "101 · 5A", "102 · =<Top> 7/8", "4", "5"]
    assert [row[1] for row in rows] == [signs[k] for k in line]


@pytest.mark.parametrize("make", [in_blocks, among_trees, of_team, without_start])
def test_the_sheet_and_waypoints_have_rows_where_there_are_rows(tmp_path, make):
    plan = make()
    sheet, *_ = write_handoff(plan, tmp_path / "sheet.html")
    ((heads, *rows),) = Page(sheet.read_text("utf-8")).tables
    assert ("row" in heads) == plan.grid.in_rows
    assert {len(row) for row in rows} == {len(heads)}
    (points,) = write_handoff(plan, tmp_path / "day.waypoints.yaml")
    for point in yaml.load(points.read_text("utf-8"), yaml.CSafeLoader)["waypoints"].values():
        assert ("row" in point) == plan.grid.in_rows


@pytest.mark.parametrize("make", [usual, of_team, without_start])
def test_the_line_says_the_figures_of_the_day_and_its_bound_where_it_is_known(tmp_path, make):
    plan = make()
    route, notes = plan.route, plan.notes
    (geojson,) = write_handoff(plan, tmp_path / "route.geojson")
    said = json.loads(geojson.read_text("utf-8"))["features"][0]["properties"]
    pause_s = float((route.leave_s - route.arrive_s).sum())
    figures = {
        "kind": "route", "plot": notes.plot, "sampler": notes.sampler, "stops": len(route.plant),
        "seconds": round(route.end_s, 3), "drive_m": round(route.drive_m, 3),
        "inspect_s": round(pause_s, 3), "infested_expected": round(float(route.chance.sum()), 3),
    }  # fmt: skip
    if notes.who:
        figures["who"] = notes.who
    if notes.start:
        ends = notes.start + timedelta(seconds=round(route.end_s))
        figures |= {"start": notes.start.isoformat(), "end": ends.isoformat()}
    if route.found_bound is not None:
        figures["finds_expected"] = round(float((route.chance * route.detects).sum()), 3)
        figures["bound"] = route.bound_sentence
        assert route.found_bound <= said.pop("finds_bound") < route.found_bound + 0.001
    assert said.pop("vertex_s") == route.line_s.round(3).tolist()
    assert said == figures
    (gpkg,) = write_handoff(plan, tmp_path / "route.gpkg")
    (line,) = (
        pyogrio.read_dataframe(gpkg, layer="route").drop(columns="geometry").to_dict("records")
    )
    shared = ("plot", "sampler", "stops", "seconds", "drive_m", "bound")
    assert line == {name: figures[name] for name in shared if name in figures} | {
        "start": figures.get("start", "")
    }
    told = f"{len(route)} stops, {route.drive_m:.0f} m"
    more = f". {route.bound_sentence}" if route.bound_sentence else ""
    for name, where, expected in (
        ("route.kml", f"{KML}Document/{KML}description", f"{told}{more}"),
        ("route.gpx", f"{GPX}metadata/{GPX}desc", f"{told}, {route.end_s:.0f} s{more}"),
    ):
        (path,) = write_handoff(plan, tmp_path / name)
        assert ET.parse(path).getroot().findtext(where) == expected  # noqa: S314 - written above
    assert plan.title == " ".join(
        part for part in (notes.plot, notes.start and f"{notes.start:%Y-%m-%d}", notes.who) if part
    )


def test_without_a_start_gpx_says_seconds_and_kml_no_time(tmp_path):
    plan = without_start()
    (gpx,), (kml,) = (write_handoff(plan, tmp_path / f"route.{end}") for end in ("gpx", "kml"))
    points = ET.parse(gpx).getroot().findall(f"{GPX}wpt")  # noqa: S314 - written above
    for point, arrive_s in zip(points, plan.route.arrive_s.tolist(), strict=True):
        assert f"; after {arrive_s:.0f} s; " in point.findtext(f"{GPX}desc")
        assert (point.findtext(f"{GPX}sym"), point.findtext(f"{GPX}type")) == ("Flag, Blue", "stop")
    assert "TimeStamp" not in kml.read_text("utf-8")
