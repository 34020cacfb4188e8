"""KML, read back by GDAL and held to the rules of its schema."""

import re
from xml.etree import ElementTree as ET

import pyogrio

from fieldmon.io.writers import write_handoff
from fieldmon.plot.layout import rectangle
from tests.io.writers.handed import CM, apart_m, crooked, day

KML = "{http://www.opengis.net/kml/2.2}"
ORDER = {  # OGC 07-147r2: the sequence of a feature's elements, as far as they stand here
    "Document": "name description Style ExtendedData Placemark Folder",
    "Folder": "name description Placemark",
    "Placemark": "name description TimeStamp styleUrl ExtendedData Point LineString",
    "LineString": "tessellate altitudeMode coordinates",
    "Point": "coordinates",
    "Data": "displayName value",
}


def test_kml_keeps_the_rules_of_its_schema(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.kml")
    root = ET.parse(path).getroot()  # noqa: S314 - written a line above
    assert root.tag == f"{KML}kml"
    assert [child.tag for child in root] == [f"{KML}Document"]
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(set(ids)) == len(ids)
    assert all(re.fullmatch(r"[A-Za-z_][\w.-]*", name) for name in ids)
    for element in root.iter():
        tag = element.tag.removeprefix(KML)
        order = ORDER.get(tag, "").split()
        ranks = [order.index(c.tag.removeprefix(KML)) for c in element] if order else []
        assert ranks == sorted(ranks)
        if tag == "coordinates":
            assert all(re.fullmatch(r"-?\d+\.\d+,-?\d+\.\d+", p) for p in element.text.split())
        if tag == "styleUrl":
            assert element.text.removeprefix("#") in ids
        if tag == "when":
            assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", element.text)
        if tag == "color":
            assert re.fullmatch(r"[0-9a-f]{8}", element.text)


def test_kml_is_read_by_gdal_to_the_centimetre(tmp_path):
    plan = crooked()
    (path,) = write_handoff(plan, tmp_path / "route.kml")
    stops = pyogrio.read_dataframe(path, layer="stops")
    assert apart_m(stops.get_coordinates()[["x", "y"]], plan.route.stops_lonlat()) < CM
    assert stops.plant.astype(int).tolist() == plan.route.plant.tolist()
    line = pyogrio.read_dataframe(path, layer=plan.title)
    drawn = line[line.geom_type == "LineString"].get_coordinates()[["x", "y"]]
    assert apart_m(drawn, plan.route.line_lonlat()) < CM


def test_a_way_straight_to_one_plant_is_drawn(tmp_path):
    plan = day(rectangle(1, 5), hours=0.02, seed=0, by="naive")
    assert len(plan.route.line_m) == 2
    (path,) = write_handoff(plan, tmp_path / "route.kml")
    line = pyogrio.read_dataframe(path, layer=plan.title)
    drawn = line[line.geom_type == "LineString"].get_coordinates()[["x", "y"]]
    assert apart_m(drawn, plan.route.line_lonlat()) < CM


def test_kml_asks_nobody_for_a_picture(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.kml")
    assert "href" not in path.read_text("utf-8")


def test_each_stop_is_drawn_by_a_style_of_the_file(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.kml")
    root = ET.parse(path).getroot()  # noqa: S314 - written a line above
    icons = {
        one.get("id") for one in root.iter(f"{KML}Style") if one.find(f"{KML}IconStyle") is not None
    }
    stops = [one for one in root.iter(f"{KML}Placemark") if one.find(f"{KML}Point") is not None]
    assert len(stops) >= len(plan.route)
    assert all(one.findtext(f"{KML}styleUrl", "")[1:] in icons for one in stops)
