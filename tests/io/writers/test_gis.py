"""GeoPackage and zipped shapefile, read back by GDAL and held to their formats' limits."""

import io
import re
import sqlite3
import struct
import zipfile
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pyogrio
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import write_handoff
from fieldmon.plot.layout import rectangle
from fieldmon.plot.projection import Frame
from tests.io.writers.handed import CM, apart_m, crooked, day, usual


def check(plan, stops, line):
    """Check both layers of a map file against the plan."""
    assert stops.crs.to_epsg() == line.crs.to_epsg() == 4326
    assert apart_m(stops.get_coordinates(), plan.route.stops_lonlat()) < CM
    assert stops.plant.tolist() == plan.route.plant.tolist()
    assert stops.stop.tolist() == list(range(1, len(stops) + 1))
    np.testing.assert_allclose(stops.arrive_s, plan.route.arrive_s, atol=1e-3)
    assert {"found", "count", "who", "notes"} <= set(stops.columns)
    assert len(line) == (len(plan.route) > 0)
    if len(line):
        assert apart_m(line.get_coordinates(), plan.route.line_lonlat()) < CM
        assert line["plot"][0] == plan.notes.plot


# --- GeoPackage --------------------------------------------------------------------------------


def test_geopackage_is_read_by_gdal_to_the_centimetre(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.gpkg")
    assert [name for name, shape in pyogrio.list_layers(path) if shape] == ["stops", "route"]
    stops, line = (pyogrio.read_dataframe(path, layer=name) for name in ("stops", "route"))
    check(plan, stops, line)


def test_geopackage_is_one_by_its_own_standard(tmp_path):
    (path,) = write_handoff(usual(), tmp_path / "route.gpkg")
    data = path.read_bytes()
    assert data.startswith(b"SQLite format 3\x00")
    assert data[68:72] == b"GPKG"  # OGC 12-128r18, requirement 2
    with sqlite3.connect(path) as db:
        assert db.execute("pragma integrity_check").fetchall() == [("ok",)]  # requirement 6
        assert db.execute("pragma foreign_key_check").fetchall() == []  # requirement 7
        kinds = dict(db.execute("select table_name, geometry_type_name from gpkg_geometry_columns"))
        assert db.execute("pragma user_version").fetchone() == (10300,)  # QGIS 3.22 warns of 1.4
    assert kinds == {"stops": "POINT", "route": "LINESTRING"}


@pytest.mark.parametrize("name", ["route.gpkg", "route.shp.zip"])
def test_a_day_across_longitude_180_lies_in_one_piece_and_is_read_back(tmp_path, name):
    grid = replace(rectangle(9, 14), frame=Frame(179.9999, -16.8))
    plan = day(grid)
    assert np.ptp(plan.route.stops_lonlat()[:, 0]) > 300
    (path,) = write_handoff(plan, tmp_path / name)
    layers = {}
    for layer in ("stops", "route"):
        inside = (path, layer) if name.endswith("gpkg") else (f"/vsizip/{path}/{layer}.shp",)
        layers[layer] = pyogrio.read_dataframe(*inside)
        west, _, east, _ = layers[layer].total_bounds
        assert 179.999 < west < 180.0 < east < 180.001
    found = layers["stops"]
    found["found"] = "yes"
    found["date"] = "2026-04-06"
    pyogrio.write_dataframe(found.drop(columns=["plant"]), edited := tmp_path / "edited.gpkg")
    read = read_inspections(edited, grid).value
    assert sorted(read.plant.tolist()) == sorted(plan.route.plant.tolist())


def test_the_geopackage_comes_back_edited(tmp_path):
    plan = crooked()
    (path,) = write_handoff(plan, tmp_path / "route.gpkg")
    edited = tmp_path / "edited.gpkg"
    stops = pyogrio.read_dataframe(path, layer="stops")
    stops["found"] = stops["found"].astype(object)
    stops.loc[[0, 3], "found"] = ["yes", "no"]
    stops.loc[0, "count"] = 4
    stops.loc[0, "time"] = np.datetime64("2026-11-18T09:12:00")
    pyogrio.write_dataframe(stops, edited, layer="stops")
    pyogrio.write_dataframe(pyogrio.read_dataframe(path, layer="route"), edited, layer="route")
    findings = read_inspections(edited, plan.grid).value
    assert findings.plant.tolist() == plan.route.plant[[0, 3]].tolist()
    assert findings.result.tolist() == [FOUND, CLEAN]
    assert findings.count[0] == 4
    np.testing.assert_array_equal(findings.second, [9 * 3600 + 12 * 60, np.nan])
    assert findings.date.astype(str).tolist() == ["2026-11-18"] * 2


def styles_of(path):
    with sqlite3.connect(path) as db:
        return dict(db.execute("SELECT f_table_name, styleQML FROM layer_styles"))


def test_stops_of_a_geopackage_carry_their_order_and_a_list_to_choose_findings_from(tmp_path):
    plan = usual()
    (path,) = write_handoff(plan, tmp_path / "route.gpkg")
    styles = styles_of(path)
    assert styles.keys() == {"stops", "route"}
    stops = ET.fromstring(styles["stops"])  # noqa: S314 - our own
    assert stops.get("labelsEnabled") == "1"
    assert stops.find(".//text-style").get("fieldName") == '"stop"'
    widget = stops.find(".//field[@name='found']/editWidget")
    words = [o.get("value") for o in widget.iter("Option") if o.get("value")]
    shown = {one.get("value") for one in stops.iter("category")}
    assert shown == {*words, ""}
    # whatever is chosen from the list is read again
    edited = pyogrio.read_dataframe(path, layer="stops").head(len(words))
    edited["found"] = words
    pyogrio.write_dataframe(edited, tmp_path / "edited.gpkg", layer="stops")
    read = read_inspections(tmp_path / "edited.gpkg", plan.grid).value
    assert read.result.tolist() == [FOUND, CLEAN, SKIPPED, SKIPPED]
    assert read.notes.tolist() == ["", "", "", "gone"]


def test_in_the_form_of_a_stop_only_what_is_filled_in_stands_beside_what_names_it(tmp_path):
    """Numbers that nobody needs in the field, and may not change, are hidden."""
    (path,) = write_handoff(crooked(), tmp_path / "route.gpkg")
    form = ET.fromstring(styles_of(path)["stops"]).find("fieldConfiguration")  # noqa: S314 - ours
    widgets = {one.get("name"): one.find("editWidget").get("type") for one in form}
    columns = set(pyogrio.read_info(path, layer="stops")["fields"])
    hidden = {name for name, kind in widgets.items() if kind == "Hidden"}
    assert hidden == {"plant", "arrive_s", "inspect_s", "chance", "detects"}
    assert widgets.keys() - hidden == {"found", "count"}
    assert hidden < columns
    assert {"who", "notes", "time", "stop", "row", "number", "face"} <= columns - hidden


# --- zipped shapefile --------------------------------------------------------------------------


def unzipped(plan, folder):
    (path,) = write_handoff(plan, folder / "route.zip")
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        # by whoever unpacks it on a system with rights
        assert {one.external_attr >> 16 & 0o777 for one in archive.infolist()} == {0o644}
        return {name: archive.read(name) for name in archive.namelist()}


def test_shapefiles_are_read_by_gdal_to_the_centimetre(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.shp.zip")
    stops, line = (
        pyogrio.read_dataframe(f"zip://{path}!{name}.shp") for name in ("stops", "route")
    )
    check(plan, stops, line)


def test_shapefiles_keep_the_limits_of_their_format(tmp_path, plan):
    parts = unzipped(plan, tmp_path)
    for name in ("stops", "route"):
        assert {f"{name}.{end}" for end in ("shp", "shx", "dbf", "prj", "cpg")} <= parts.keys()
        assert parts[f"{name}.cpg"].strip() == b"UTF-8"
        assert b"GCS_WGS_1984" in parts[f"{name}.prj"]
        code, length = struct.unpack(">i20xi", parts[f"{name}.shp"][:28])
        assert (code, 2 * length) == (9994, len(parts[f"{name}.shp"]))
        (kind,) = struct.unpack("<i", parts[f"{name}.shp"][32:36])
        assert kind == {"stops": 1, "route": 3}[name]
        names, widths = dbf_fields(parts[f"{name}.dbf"])
        assert all(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,9}", field) for field in names)
        assert len({field.upper() for field in names}) == len(names) <= 255
        assert max(widths) <= 254


def dbf_fields(table):
    """Return names and widths of a dBASE table's columns, from its own bytes."""
    (head,) = struct.unpack("<H", table[8:10])
    fields = [table[at : at + 32] for at in range(32, head - 1, 32)]
    names = [field[:11].split(b"\x00")[0].decode("ascii") for field in fields]
    return names, [field[16] for field in fields]


@pytest.mark.parametrize("first", ["", "a"])  # a letter that ends at an odd byte, or an even one
def test_a_long_name_is_cut_between_letters(tmp_path, first):
    plan = day(rectangle(3, 4), plot=first + "חלקה " * 30 + "ח" * 60)
    (path,) = write_handoff(plan, tmp_path / "route.zip")
    name = pyogrio.read_dataframe(f"zip://{path}!route.shp")["plot"][0]
    assert len(name.encode()) > 240
    assert plan.notes.plot.startswith(name)


def test_equal_days_make_equal_zips(tmp_path):
    (one,) = write_handoff(usual(), tmp_path / "a.zip")
    (two,) = write_handoff(usual(), tmp_path / "b.zip")
    names = [zipfile.ZipFile(path).namelist() for path in (one, two)]
    assert names[0] == names[1]


def test_the_shapefile_comes_back_filled_in(tmp_path):
    plan = usual()
    (path,) = write_handoff(plan, tmp_path / "route.zip")
    stops = pyogrio.read_dataframe(f"zip://{path}!stops.shp")
    stops["found"] = stops["found"].astype(object)
    stops.loc[[1, 2], "found"] = ["לא", "3"]
    folder = tmp_path / "edited"
    folder.mkdir()
    pyogrio.write_dataframe(stops, folder / "stops.shp", encoding="UTF-8")
    pyogrio.write_dataframe(
        pyogrio.read_dataframe(f"zip://{path}!route.shp"), folder / "route.shp", encoding="UTF-8"
    )
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for part in folder.iterdir():
            archive.write(part, part.name)
    findings = read_inspections(Upload("route.zip", packed.getvalue()), plan.grid).value
    assert findings.plant.tolist() == plan.route.plant[[1, 2]].tolist()
    assert findings.result.tolist() == [CLEAN, FOUND]
    assert findings.count[1] == 3
