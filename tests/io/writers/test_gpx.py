"""GPX 1.1 by the rules of its schema, and as handhelds take it."""

import re
from dataclasses import replace
from datetime import UTC, timedelta, timezone
from itertools import pairwise
from xml.etree import ElementTree as ET
from zoneinfo import ZoneInfo

import numpy as np
import pyogrio
import shapely
from shapely import MultiPolygon

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import write_handoff
from fieldmon.io.writers.gpx import route_gpx
from fieldmon.io.writers.kml import route_kml
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.local_clock import grid_clock
from fieldmon.plot.plot import Plot
from tests.io.writers.handed import CM, START, apart_m, crooked, day, usual, without_start

GPX = "{http://www.topografix.com/GPX/1/1}"
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


def test_the_start_is_said_in_utc_by_its_own_zone_or_the_plots(tmp_path):
    def stated(plan):
        return gpx_of(plan, tmp_path).findtext(f"{GPX}metadata/{GPX}time")

    local = START.replace(tzinfo=timezone(timedelta(hours=-3)))
    assert stated(day(rectangle(3, 4), start=local)) == f"{local.astimezone(UTC):%FT%TZ}"
    plan = usual()
    here = START.replace(tzinfo=ZoneInfo(grid_clock(plan.grid).zone))
    assert here.utcoffset()
    assert stated(plan) == f"{here.astimezone(UTC):%FT%TZ}"
    assert stated(without_start()) is None


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


def test_comment_and_description_say_the_same_as_converters_drop_one_of_them(tmp_path, plan):
    for waypoint in gpx_of(plan, tmp_path).iter(f"{GPX}wpt"):
        assert waypoint.find(f"{GPX}cmt").text == waypoint.find(f"{GPX}desc").text
        assert "plant" in waypoint.find(f"{GPX}cmt").text


def test_no_chance_is_said_to_be_nothing_or_all():
    route = usual().route
    chance = np.resize([1e-6, 0.5, 1 - 1e-6], len(route))
    plan = replace(usual(), route=replace(route, chance=chance))
    for written in (route_gpx(plan), route_kml(plan)):
        said = re.findall(r"chance ([^;<]*)[^<]*</desc", written.decode())
        assert said[:3] == ["under 0.1 %", "50.0 %", "over 99.9 %"]


def test_the_file_is_named_by_its_day(tmp_path, plan):
    root = gpx_of(plan, tmp_path)
    assert root.find(f"{GPX}metadata/{GPX}name").text == plan.title


def test_the_bounds_hold_every_place_and_nothing_more(tmp_path, plan):
    root = gpx_of(plan, tmp_path)
    bounds = root.find(f"{GPX}metadata/{GPX}bounds")
    every = [p for kind in ("wpt", "rtept", "trkpt") for p in root.iter(f"{GPX}{kind}")]
    assert (bounds is not None) == bool(every)
    if every:
        lonlat = places(every)
        low, high = (
            [float(bounds.get(f"{end}{k}")) for k in ("lon", "lat")] for end in ("min", "max")
        )
        np.testing.assert_array_equal(low, lonlat.min(axis=0))
        np.testing.assert_array_equal(high, lonlat.max(axis=0))


def test_a_day_across_longitude_180_has_no_bounds_as_they_would_go_round_the_earth(tmp_path):
    area = MultiPolygon([shapely.box(179.9995, -16.801, 180.0005, -16.8)])
    root = gpx_of(day(Plot.of(Field("Taveuni", area, row_bearing_deg=90.0)).grid), tmp_path)
    assert root.find(f"{GPX}metadata/{GPX}bounds") is None


def test_the_pieces_of_a_line_are_numbered_and_one_alone_has_the_name_of_the_day(tmp_path, plan):
    root = gpx_of(plan, tmp_path)
    for kind in ("rte", "trk"):
        names = [part.findtext(f"{GPX}name") for part in root.iter(f"{GPX}{kind}")]
        if len(names) == 1:
            assert names == [plan.title]
        else:
            assert names == [f"{plan.title} {k}/{len(names)}" for k in range(1, len(names) + 1)]
