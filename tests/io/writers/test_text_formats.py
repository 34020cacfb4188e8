"""GeoJSON, CSV and GPX as their own readers and rules want them."""

import csv
import json
import re
from datetime import UTC, timedelta, timezone
from itertools import pairwise
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pyogrio
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import write_handoff
from fieldmon.plot.layout import rectangle
from tests.io.writers.handed import DAYS, START, apart_m, crooked, day, usual

CM = 0.01
GPX = "{http://www.topografix.com/GPX/1/1}"


@pytest.fixture(params=DAYS)
def plan(request):
    return DAYS[request.param]()


# --- GeoJSON: RFC 7946, rule by rule -----------------------------------------------------------


def no_constants(word):
    raise AssertionError(f"{word} is no JSON (RFC 8259)")


def geojson_of(plan, folder):
    (path,) = write_handoff(plan, folder / "route.geojson")
    data = path.read_bytes()
    assert not data.startswith(b"\xef\xbb\xbf")  # RFC 8259, 8.1: no byte order mark
    return json.loads(data.decode("utf-8"), parse_constant=no_constants)


def positions_of(geometry):
    if geometry is None:
        return []
    inside = geometry["coordinates"]
    return [inside] if geometry["type"] == "Point" else inside


def test_geojson_keeps_the_rules_of_rfc_7946(tmp_path, plan):
    root = geojson_of(plan, tmp_path)
    assert root["type"] == "FeatureCollection"  # 3.3
    assert "crs" not in root  # 4
    assert not {"coordinates", "geometry", "properties"} & root.keys()  # 7.1
    positions = []
    for feature in root["features"]:
        assert feature["type"] == "Feature"  # 3.2
        assert {"geometry", "properties"} <= feature.keys()
        assert isinstance(feature.get("id", ""), str | int | float)
        geometry = feature["geometry"]
        if geometry is not None:
            assert geometry["type"] in {"Point", "LineString"}  # 1.4: capitals count; no rings here
            assert geometry["type"] != "LineString" or len(geometry["coordinates"]) >= 2  # 3.1.4
        positions += positions_of(geometry)
    assert len({feature["id"] for feature in root["features"]}) == len(root["features"])
    assert all(len(position) == 2 for position in positions)  # 3.1.1
    lonlat = np.array(positions).reshape(-1, 2)
    assert (np.abs(lonlat) <= (180, 90)).all()  # 4: longitude first
    if positions:
        low, high = lonlat.min(axis=0), lonlat.max(axis=0)
        assert root["bbox"] == [*low, *high]  # 5: all axes of the lowest, then of the highest
    else:
        assert "bbox" not in root


def test_geojson_has_no_more_digits_than_mean_anything(tmp_path):
    (path,) = write_handoff(usual(), tmp_path / "route.geojson")
    pairs = re.findall(r"\[(-?\d+\.\d+),(-?\d+\.\d+)\]", path.read_text("utf-8"))
    assert pairs
    assert all(len(number.partition(".")[2]) <= 8 for pair in pairs for number in pair)  # 11.2


def test_geojson_is_read_by_gdal_to_the_centimetre(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.geojson")
    if not len(plan.route):
        return
    frame = pyogrio.read_dataframe(path)
    assert frame.crs.to_epsg() == 4326
    stops = frame[frame.kind == "stop"]
    lonlat = np.stack([stops.geometry.x, stops.geometry.y], axis=1)
    assert apart_m(lonlat, plan.route.stops_lonlat()) < CM
    line = frame[frame.kind == "route"].geometry.iloc[0]
    assert apart_m(line.coords[:], plan.route.line_lonlat()) < CM
    assert stops.plant.tolist() == plan.route.plant.tolist()


# --- CSV ---------------------------------------------------------------------------------------


def test_csv_is_what_spreadsheets_take_for_utf_8_with_one_line_a_stop(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    data = path.read_bytes()
    assert data.startswith(b"\xef\xbb\xbf")
    assert data.count(b"\n") == data.count(b"\r\n") == 1 + len(plan.route)  # RFC 4180
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert all(None not in row and None not in row.values() for row in rows)
    assert [int(row["stop"]) for row in rows] == list(range(1, len(rows) + 1))
    assert [int(row["plant"]) for row in rows] == plan.route.plant.tolist()
    lonlat = [(float(row["lon"]), float(row["lat"])) for row in rows]
    assert apart_m(lonlat, plan.route.stops_lonlat()) < CM
    assert {row["plot"] for row in rows} <= {plan.notes.plot}
    assert all(row[k] == "" for row in rows for k in ("found", "count", "who", "notes"))
    arrivals = [START + timedelta(seconds=round(s)) for s in plan.route.arrive_s]
    assert [row["arrive"] for row in rows] == [at.isoformat() for at in arrivals]


def test_a_plot_whose_name_is_a_formula_does_not_become_one(tmp_path):
    plan = day(rectangle(3, 4), plot="=HYPERLINK(1)\n\x00")
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    with path.open(encoding="utf-8-sig", newline="") as file:
        assert next(csv.DictReader(file))["plot"].startswith("'=")


@pytest.mark.parametrize("make", [usual, crooked])
def test_the_csv_comes_back_filled_in(tmp_path, make):
    plan = make()
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    table = pd.read_csv(path, dtype={"found": object, "who": object})
    table.loc[0, ["found", "count"]] = "yes", 4
    table.loc[2, "found"] = "no"
    for data in (table.to_csv(index=False).encode(), table.to_csv(index=False, sep=";").encode()):
        findings = read_inspections(Upload("route.csv", data), plan.grid).value
        assert findings.plant.tolist() == plan.route.plant[[0, 2]].tolist()
        assert findings.result.tolist() == [FOUND, CLEAN]
        assert findings.date.astype(str).tolist() == ["2026-11-18"] * 2
        assert np.isnan(findings.second).all()


def test_the_geojson_comes_back_filled_in(tmp_path):
    plan = crooked()
    root = geojson_of(plan, tmp_path)
    for feature, found in zip(root["features"][1:], [True, False, None, 3], strict=False):
        feature["properties"]["found"] = found
    imported = read_inspections(Upload("r.geojson", json.dumps(root).encode()), plan.grid)
    assert imported.value.plant.tolist() == plan.route.plant[[0, 1, 3]].tolist()
    assert imported.value.result.tolist() == [FOUND, CLEAN, FOUND]
    assert imported.value.date.astype(str).tolist() == ["2026-11-18"] * 3


# --- GPX 1.1: the schema's rules ---------------------------------------------------------------

ORDER = {  # the sequences of http://www.topografix.com/GPX/1/1/gpx.xsd
    "gpx": "metadata wpt rte trk extensions",
    "metadata": "name desc author copyright link time keywords bounds extensions",
    "wpt": "ele time magvar geoidheight name cmt desc src link sym type fix sat hdop vdop pdop "
    "ageofdgpsdata dgpsid extensions",
    "rte": "name cmt desc src link number type extensions rtept",
    "trk": "name cmt desc src link number type extensions trkseg",
    "trkseg": "trkpt extensions",
}
ORDER |= {"rtept": ORDER["wpt"], "trkpt": ORDER["wpt"]}
MANY = {"wpt", "rte", "trk", "rtept", "trkseg", "trkpt", "link"}


def gpx_of(plan, folder):
    (path,) = write_handoff(plan, folder / "route.gpx")
    return ET.parse(path).getroot()  # noqa: S314 - written a line above


def places(points):
    return np.array([(float(p.get("lon")), float(p.get("lat"))) for p in points]).reshape(-1, 2)


def test_gpx_keeps_the_rules_of_its_schema(tmp_path, plan):
    root = gpx_of(plan, tmp_path)
    assert root.tag == f"{GPX}gpx"
    assert root.get("version") == "1.1"
    assert root.get("creator")
    for element in root.iter():
        tag = element.tag.removeprefix(GPX)
        children = [child.tag.removeprefix(GPX) for child in element]
        if tag not in ORDER:
            assert not children
            continue
        order = ORDER[tag].split()
        ranks = [order.index(child) for child in children]
        assert ranks == sorted(ranks)
        assert all(children.count(child) == 1 for child in set(children) - MANY)
        if tag in {"wpt", "rtept", "trkpt"}:
            assert re.fullmatch(r"-?\d{1,3}\.\d+", element.get("lat"))  # xsd:decimal: no exponent
            assert re.fullmatch(r"-?\d{1,3}\.\d+", element.get("lon"))
            assert -90 <= float(element.get("lat")) <= 90
            assert -180 <= float(element.get("lon")) < 180
    for number in root.iter(f"{GPX}number"):
        assert int(number.text) >= 0


def test_gpx_pieces_are_short_enough_for_handhelds_and_make_one_line(tmp_path, plan):
    root = gpx_of(plan, tmp_path)
    line = plan.route.line_lonlat()
    for parts in (
        [rte.findall(f"{GPX}rtept") for rte in root.iter(f"{GPX}rte")],
        [trk.findall(f"{GPX}trkseg/{GPX}trkpt") for trk in root.iter(f"{GPX}trk")],
    ):
        assert all(2 <= len(part) <= 250 for part in parts)
        runs = [places(part) for part in parts]
        for before, after in pairwise(runs):
            np.testing.assert_array_equal(before[-1], after[0])
        joined = np.concatenate([runs[0], *(run[1:] for run in runs[1:])]) if runs else line
        assert joined.shape == line.shape
        assert apart_m(joined, line) < CM
        assert len(parts) == int(np.ceil(max(len(line) - 1, 0) / 249))


def test_gpx_stops_are_waypoints_and_named_points_of_the_route(tmp_path, plan):
    root = gpx_of(plan, tmp_path)
    waypoints = root.findall(f"{GPX}wpt")
    assert apart_m(places(waypoints), plan.route.stops_lonlat()) < CM
    names = [w.findtext(f"{GPX}name") for w in waypoints]
    assert len(set(names)) == len(plan.route)
    on_route = [p.findtext(f"{GPX}name") for p in root.iter(f"{GPX}rtept")]
    assert list(dict.fromkeys(filter(None, on_route))) == names


def test_gpx_is_read_by_gdal_to_the_centimetre(tmp_path):
    plan = usual()
    (path,) = write_handoff(plan, tmp_path / "route.gpx")
    points = pyogrio.read_dataframe(path, layer="waypoints")
    assert apart_m(points.get_coordinates(), plan.route.stops_lonlat()) < CM
    track = pyogrio.read_dataframe(path, layer="track_points")
    assert apart_m(track.get_coordinates(), plan.route.line_lonlat()) < CM
    assert track.crs.to_epsg() == 4326


def test_gpx_times_are_utc_or_not_there(tmp_path):
    assert gpx_of(usual(), tmp_path).find(f"{GPX}metadata/{GPX}time") is None
    local = START.replace(tzinfo=timezone(timedelta(hours=2)))
    root = gpx_of(day(rectangle(3, 4), start=local), tmp_path)
    stated = root.findtext(f"{GPX}metadata/{GPX}time")
    assert stated == local.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def test_waypoints_come_back_with_what_was_added_to_their_names(tmp_path):
    plan = crooked()
    (path,) = write_handoff(plan, tmp_path / "route.gpx")
    tree = ET.parse(path)  # noqa: S314
    names = [w.find(f"{GPX}name") for w in tree.getroot().findall(f"{GPX}wpt")]
    for name, more in zip(names, [" +3", " -", "", " clean"], strict=False):
        name.text += more
    findings = read_inspections(Upload("r.gpx", ET.tostring(tree.getroot())), plan.grid).value
    assert findings.plant.tolist() == plan.route.plant[[0, 1, 3]].tolist()
    assert findings.result.tolist() == [FOUND, CLEAN, CLEAN]
