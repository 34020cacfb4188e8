"""How QGIS shows a season without a click."""

import sqlite3
from contextlib import closing
from xml.etree import ElementTree as ET

from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.monitoring.file.qgis_styles import STYLES, add_styles


def test_every_layer_has_a_style_that_is_xml(path):
    with closing(sqlite3.connect(path)) as db:
        styles = db.execute(
            "SELECT f_table_name, styleQML, useAsDefault FROM layer_styles"
        ).fetchall()
        layers = {name for (name,) in db.execute("SELECT table_name FROM gpkg_geometry_columns")}
    assert {name for name, _, _ in styles} | {"places"} == layers
    for _, qml, default in styles:
        assert ET.fromstring(qml).find("renderer-v2") is not None  # noqa: S314 - our own
        assert default == 1


def renderer(layer):
    return ET.fromstring(STYLES[layer]).find("renderer-v2")  # noqa: S314 - our own


def test_every_result_has_a_symbol_of_its_own():
    values = [each.get("value") for each in renderer("inspections").iter("category")]
    assert sorted(values) == sorted([*RESULT_NAMES.values(), "gone"])
    symbols = [each.get("symbol") for each in renderer("inspections").iter("category")]
    assert len(set(symbols)) == len(symbols)


def test_the_classes_of_a_chance_leave_no_gap_from_0_to_1():
    ranges = [
        (float(r.get("lower")), float(r.get("upper"))) for r in renderer("chance").iter("range")
    ]
    assert (ranges[0][0], ranges[-1][1]) == (0.0, 1.0)
    assert [upper for _, upper in ranges[:-1]] == [lower for lower, _ in ranges[1:]]


def test_stops_carry_their_order():
    stops = ET.fromstring(STYLES["stops"])  # noqa: S314 - our own
    assert stops.get("labelsEnabled") == "1"
    assert stops.find("labeling").find(".//text-style").get("fieldName") == '"stop"'


def test_styles_are_added_once_a_layer_and_are_the_default():
    with closing(sqlite3.connect(":memory:")) as db:
        db.execute("CREATE TABLE gpkg_contents (table_name, data_type, identifier)")
        add_styles(db)
        rows = db.execute("SELECT f_table_name, useAsDefault FROM layer_styles").fetchall()
    assert rows == [(layer, 1) for layer in STYLES]
