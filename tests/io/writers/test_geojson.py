"""GeoJSON by RFC 7946, rule by rule."""

import json
import re
from dataclasses import replace

import numpy as np
import pyogrio
import shapely
from shapely import MultiPolygon

from fieldmon.infestation.forecast import Forecast
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import write_handoff
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from tests.io.writers.handed import CM, apart_m, crooked, day, usual


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


def test_the_box_of_a_day_across_longitude_180_has_its_greater_longitude_in_the_west(tmp_path):
    area = MultiPolygon([shapely.box(179.9995, -16.801, 180.0005, -16.8)])
    root = geojson_of(day(Plot.of(Field("Taveuni", area, row_bearing_deg=90.0)).grid), tmp_path)
    west, south, east, north = root["bbox"]  # RFC 7946, 5.2
    assert 179.999 < west < 180.0
    assert -180.0 < east < -179.999
    assert south < north


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
    frame = pyogrio.read_dataframe(path)
    if not len(plan.route):
        assert "stop" not in frame.kind.tolist()
        return
    assert frame.crs.to_epsg() == 4326
    stops = frame[frame.kind == "stop"]
    lonlat = np.stack([stops.geometry.x, stops.geometry.y], axis=1)
    assert apart_m(lonlat, plan.route.stops_lonlat()) < CM
    line = frame[frame.kind == "route"].geometry.iloc[0]
    assert apart_m(line.coords[:], plan.route.line_lonlat()) < CM
    assert stops.plant.tolist() == plan.route.plant.tolist()


def test_the_geojson_comes_back_filled_in(tmp_path):
    plan = crooked()
    root = geojson_of(plan, tmp_path)
    for feature, found in zip(root["features"][1:], [True, False, None, 3], strict=False):
        feature["properties"]["found"] = found
    imported = read_inspections(Upload("r.geojson", json.dumps(root).encode()), plan.grid)
    assert imported.value.plant.tolist() == plan.route.plant[[0, 1, 3]].tolist()
    assert imported.value.result.tolist() == [FOUND, CLEAN, FOUND]
    assert imported.value.date.astype(str).tolist() == ["2026-11-18"] * 3


def test_figures_of_the_day_have_three_decimals_and_stops_are_counted_from_one(tmp_path, plan):
    line, *stops = geojson_of(plan, tmp_path)["features"]
    route, said = plan.route, line["properties"]
    for name, value in (("seconds", route.end_s), ("drive_m", route.drive_m)):
        assert said[name] == round(value, 3)
    assert [stop["properties"]["order"] for stop in stops] == list(range(1, len(route) + 1))
    assert all("block" not in stop["properties"] for stop in stops)  # there is one only


def test_who_drives_is_said_of_a_team_alone(tmp_path):
    plan = usual()
    told = [
        geojson_of(replace(plan, notes=replace(plan.notes, who=who)), tmp_path)["features"][0]
        for who in (None, "Ann")
    ]
    assert [one["properties"].get("who") for one in told] == [None, "Ann"]


def test_the_mornings_ahead_are_said_with_their_interval(tmp_path):
    plan = usual()
    ahead = Forecast(np.array([4.04, 5.0]), np.array([2, 3.0]), np.array([7, 9.0]), None)
    noted = replace(plan, notes=replace(plan.notes, ahead=lambda: ahead))
    said = json.dumps(geojson_of(noted, tmp_path))
    for part in ("[4.0, 5.0]", "[2.0, 3.0]", "[7.0, 9.0]", '"chance": 0.9', ahead.basis()):
        assert part in said
