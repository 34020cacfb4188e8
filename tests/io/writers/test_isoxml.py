"""Task data as the PyPI package isoxml reads it, whose classes are made from the standard."""

import io
import zipfile
from xml.etree import ElementTree as ET

import pytest
import shapely
from isoxml.converter.shapely_geom import ShapelyConverterV3, ShapelyConverterV4
from isoxml.util.isoxml_io import isoxml_from_path
from shapely import MultiPolygon, Point

from fieldmon.errors import SettingError
from fieldmon.io.writers.isoxml import isoxml_taskdata

PLOT = MultiPolygon([shapely.box(35.15, 30.36, 35.152, 30.362)])
RING = shapely.difference(
    Point(35.151, 30.361).buffer(4e-4, 8), Point(35.151, 30.361).buffer(2e-4, 8)
)
ZONES = [MultiPolygon([RING]), MultiPolygon([shapely.box(35.15, 30.36, 35.1502, 30.3601)])]
CONVERTERS = {3: ShapelyConverterV3, 4: ShapelyConverterV4}


@pytest.mark.parametrize("version", [3, 4])
def test_another_reader_finds_the_zones_with_their_holes_and_the_rate(tmp_path, version):
    made = isoxml_taskdata("כרם", PLOT, ZONES, 250.5, "soap", version=version)
    with zipfile.ZipFile(io.BytesIO(made)) as archive:
        archive.extractall(tmp_path)
    data, _ = isoxml_from_path(tmp_path / "TASKDATA" / "TASKDATA.XML")
    (task,) = data.tasks
    none, zones = task.treatment_zones
    (value,) = zones.process_data_variables
    assert value.process_data_ddi == b"\x00\x01"
    assert value.process_data_value == 2_505_000
    assert none.process_data_variables[0].process_data_value == 0
    convert = CONVERTERS[version]()
    read = shapely.union_all([convert.to_shapely_polygon(one) for one in zones.polygons])
    assert read.symmetric_difference(shapely.union_all(ZONES)).area < 1e-5 * read.area
    (partfield,) = data.partfields
    assert partfield.designator == "כרם"
    assert convert.to_shapely_polygon(partfield.polygons[0]).equals_exact(PLOT.geoms[0], 1e-8)
    assert data.products[0].designator == "soap"


def test_where_the_tractor_does_not_know_where_it_is_nothing_is_sprayed():
    made = zipfile.ZipFile(io.BytesIO(isoxml_taskdata("a", PLOT, ZONES, 1.0, "")))
    root = ET.fromstring(made.read("TASKDATA/TASKDATA.XML"))  # noqa: S314 - our own
    task = root.find("TSK")
    assert [task.get(code) for code in "HIJ"] == ["0", "0", "0"]


def test_names_are_cut_and_cleaned_and_the_same_map_is_the_same_file():
    made = isoxml_taskdata("x" * 60 + "\x07", PLOT, ZONES, 1.0, "\x00a")
    assert made == isoxml_taskdata("x" * 60, PLOT, ZONES, 1.0, "a")
    assert b"x" * 33 not in zipfile.ZipFile(io.BytesIO(made)).read("TASKDATA/TASKDATA.XML")


def test_there_is_no_version_five():
    with pytest.raises(SettingError, match="version 3 or 4"):
        isoxml_taskdata("a", PLOT, ZONES, 1.0, "", version=5)
