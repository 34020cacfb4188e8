"""Task data as the PyPI package isoxml reads it, whose classes are made from the standard."""

import io
import os
import re
import zipfile
from dataclasses import fields, is_dataclass
from decimal import Decimal
from importlib.resources import files
from itertools import product
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import shapely
from isoxml.converter.np_grid import to_numpy_array
from isoxml.converter.shapely_geom import ShapelyConverterV3, ShapelyConverterV4
from isoxml.util.isoxml_io import isoxml_from_path
from lxml import etree
from shapely import MultiPolygon, Point

from fieldmon.errors import SettingError
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.writers.isoxml import isoxml_taskdata
from fieldmon.io.writers.zone_cells import zone_cells

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
    assert partfield.area == round(area_m2(PLOT)) > 40_000
    assert convert.to_shapely_polygon(partfield.polygons[0]).equals_exact(PLOT.geoms[0], 1e-8)
    assert data.products[0].designator == "soap"


def read(made, folder):
    """Return task data and its binary files, as the package reads them."""
    with zipfile.ZipFile(io.BytesIO(made)) as archive:
        archive.extractall(folder)
    return isoxml_from_path(folder / "TASKDATA" / "TASKDATA.XML")


@pytest.mark.parametrize("version", [3, 4])
@pytest.mark.parametrize("kind", [1, 2])
def test_another_reader_finds_the_grid_and_each_cell_of_it(tmp_path, version, kind):
    cells = zone_cells(PLOT, ZONES, 4.0, kind)
    data, files = read(isoxml_taskdata("a", PLOT, cells, 250.5, "soap", version=version), tmp_path)
    (task,) = data.tasks
    (grid,) = task.grids
    values = to_numpy_array(files[grid.filename], grid)
    assert grid.filelength == len(files[grid.filename])
    rate = 1 if kind == 1 else 2_505_000
    assert (values == np.where(cells.sprayed, rate, 0)).all()
    # its first cell is the south-western one
    lon = float(grid.minimum_east_position) + (np.arange(values.shape[1]) + 0.5) * float(
        grid.cell_east_size
    )
    lat = float(grid.minimum_north_position) + (np.arange(values.shape[0]) + 0.5) * float(
        grid.cell_north_size
    )
    inside = shapely.contains_xy(shapely.union_all(ZONES), *np.meshgrid(lon, lat))
    assert (inside == (values > 0)).mean() > 0.999
    of_zone = {zone.code: zone for zone in task.treatment_zones}
    if kind == 1:
        assert of_zone[1].process_data_variables[0].process_data_value == 2_505_000
    else:
        assert grid.treatment_zone_code == 1
        assert of_zone[1].process_data_variables[0].process_data_ddi == b"\x00\x01"


def breaches(element):
    """Yield what of an element the standard's schema forbids, as the classes made of it say."""
    for one in fields(element):
        value, where = getattr(element, one.name), f"{type(element).__name__}.{one.name}"
        if value is None and one.metadata.get("required"):
            yield f"{where} is missing"
        for part in value if isinstance(value, list) else [value]:
            if is_dataclass(part):
                yield from breaches(part)
            elif part is not None and not allowed(part, one.metadata):
                yield f"{where} is {part!r}, not {dict(one.metadata)}"


def allowed(value, rule):
    """Return whether a value keeps the rules of its attribute."""
    if isinstance(value, str):
        short = len(value) <= rule.get("max_length", len(value))
        return short and ("pattern" not in rule or re.fullmatch(rule["pattern"], value))
    if not isinstance(value, int | float | Decimal):
        return True
    digits = rule.get("fraction_digits", 99)
    exact = not isinstance(value, Decimal) or -value.as_tuple().exponent <= digits
    return rule.get("min_inclusive", value) <= value <= rule.get("max_inclusive", value) and exact


@pytest.mark.parametrize("version", [3, 4])
@pytest.mark.parametrize("kind", [None, 1, 2])
def test_all_attributes_are_as_the_schemas_classes_demand(tmp_path, version, kind):
    """The package's classes are made from the standard's schema and hold its rules."""
    zones = ZONES if kind is None else zone_cells(PLOT, ZONES, 4.0, kind)
    made = isoxml_taskdata("x" * 60, PLOT, zones, 99_999.0, "y" * 60, version=version)
    data, _ = read(made, tmp_path)
    assert list(breaches(data)) == []


def schemas():
    """Return the standard's own schemas there are: 4.3, and any of version 3 that is told of.

    The former is as the PyPI package isoxml-writer has it. FIELDMON_ISOXML_3 is the path of the
    other, ``ISO11783_TaskFile_V3-3.xsd``, which no package has.
    """
    packaged = files("isoxml_writer") / "ISOXML_schema" / "ISO11783_TaskFile_V4-3.xsd"
    told = os.environ.get("FIELDMON_ISOXML_3")
    return {4: str(packaged)} | ({3: told} if told else {})


ODD_NAMES = ["", " ", "כרם 7 & <ב>", "a\x07b\x00c", "\ud800\ufffe", "😀" * 40, "tab\tend\n", "'\""]


@pytest.mark.parametrize("version", schemas())
@pytest.mark.parametrize("kind", [None, 1, 2])
def test_it_is_valid_against_the_standards_own_schema_whatever_the_names(version, kind):
    schema = etree.XMLSchema(etree.parse(schemas()[version]))
    for zones, name in product([ZONES, ZONES[:1]], ["x" * 60, *ODD_NAMES]):
        areas = zones if kind is None else zone_cells(PLOT, zones, 4.0, kind)
        made = isoxml_taskdata(name, PLOT, areas, 99_999.0, name, version=version)
        task_data = document(made)
        schema.assertValid(task_data)
        task_data.find("PFD").set("C", "z" * 40)
        assert not schema.validate(task_data)


def document(made):
    """Return the XML of task data."""
    with zipfile.ZipFile(io.BytesIO(made)) as archive:
        return etree.fromstring(archive.read("TASKDATA/TASKDATA.XML"))


def test_a_breach_of_the_schema_would_be_seen(tmp_path):
    made, _ = read(isoxml_taskdata("a", PLOT, ZONES, 1.0, ""), tmp_path)
    made.partfields[0].designator = "z" * 40
    made.tasks[0].id = "T1"
    assert len(list(breaches(made))) == 2


def test_where_the_tractor_does_not_know_where_it_is_nothing_is_sprayed():
    made = zipfile.ZipFile(io.BytesIO(isoxml_taskdata("a", PLOT, ZONES, 1.0, "")))
    root = ET.fromstring(made.read("TASKDATA/TASKDATA.XML"))  # noqa: S314 - our own
    task = root.find("TSK")
    assert [task.get(code) for code in "HIJ"] == ["0", "0", "0"]


def test_a_name_that_is_too_long_keeps_the_number_at_its_end():
    made = isoxml_taskdata("lleida_apricot_orchards_epsg25831 (14)", PLOT, ZONES, 1.0, "water")
    task = zipfile.ZipFile(io.BytesIO(made)).read("TASKDATA/TASKDATA.XML").decode()
    assert '"lleida_apricot_orcha..25831 (14)"' in task


def test_names_are_shortened_and_cleaned_and_the_same_map_is_the_same_file():
    made = isoxml_taskdata("x" * 60 + "\x07", PLOT, ZONES, 1.0, "\x00a")
    assert made == isoxml_taskdata("x" * 60, PLOT, ZONES, 1.0, "a")
    assert b"x" * 33 not in zipfile.ZipFile(io.BytesIO(made)).read("TASKDATA/TASKDATA.XML")


def test_there_is_no_version_five():
    with pytest.raises(SettingError, match="version 3 or 4"):
        isoxml_taskdata("a", PLOT, ZONES, 1.0, "", version=5)


LONG, BYTE, WHOLE = (-(2**31), 2**31 - 1), (0, 254), (0, 2**32 - 2)
NAME = 32  # letters at most
NORTH, EAST = (-90.0, 90.0), (-180.0, 180.0)
CELL, ALL = (0.0, 1.0), (0, 2**32 - 1)
# facts read in the standard's schema of version 3.3: of each element what it may hold, how often
# at least, and each attribute, upper case where it is required: letters at most, limits, a pattern
VERSION_3 = {
    "ISO11783_TaskData": (
        {"PDT": 0, "PFD": 0, "TSK": 0, "VPN": 0},
        {
            "VersionMajor!": "3", "VersionMinor!": "3", "ManagementSoftwareManufacturer!": NAME,
            "ManagementSoftwareVersion!": NAME, "DataTransferOrigin!": "1|2",
        },
    ),
    "PDT": ({}, {"A!": r"PDT-?\d+", "B!": NAME}),
    "PFD": ({"PLN": 0}, {"A!": r"PFD-?\d+", "B": NAME, "C!": NAME, "D!": WHOLE}),
    "PLN": ({"LSG": 1}, {"A!": "[1-8]", "B": NAME, "C": WHOLE, "D": BYTE}),
    "LSG": ({"PNT": 2}, {"A!": "[1-8]", "B": NAME, "C": WHOLE, "D": WHOLE, "E": BYTE}),
    "PNT": ({}, {"A!": "1|2", "B": NAME, "C!": NORTH, "D!": EAST, "E": LONG, "F": BYTE}),
    "TSK": (
        {"TZN": 0, "GRD": 0},
        {
            "A!": r"TSK-?\d+", "B": NAME, "E": r"PFD-?\d+", "G!": "[1-4]",
            "H": BYTE, "I": BYTE, "J": BYTE,
        },
    ),
    "TZN": ({"PLN": 0, "PDV": 0}, {"A!": BYTE, "B": NAME, "C": BYTE}),
    "PDV": ({}, {"A!": "[0-9A-F]{4}", "B!": LONG, "C": r"PDT-?\d+", "E": r"VPN-?\d+"}),
    "GRD": (
        {},
        {
            "A!": NORTH, "B!": EAST, "C!": CELL, "D!": CELL, "E!": ALL, "F!": ALL,
            "G!": r"GRD\d{5}", "H": WHOLE, "I!": "1|2", "J": BYTE,
        },
    ),
    "VPN": (
        {},
        {"A!": r"VPN-?\d+", "B!": LONG, "C!": (1e-9, 1e8), "D!": (0, 7), "E": NAME},
    ),
}  # fmt: skip
REFERS = re.compile(r"(PDT|PFD|VPN)-?\d+")


def offends(text, rule):
    """Return whether an attribute breaks its rule: letters, a pattern, limits as whole or not."""
    if isinstance(rule, int):
        return len(text) > rule
    if isinstance(rule, str):
        identifies = REFERS.fullmatch(text) is not None
        return re.fullmatch(rule, text) is None or (identifies and not 4 <= len(text) <= 14)
    plain = r"-?\d+" if isinstance(rule[0], int) else r"-?\d+(\.\d+)?"
    return re.fullmatch(plain, text) is None or not rule[0] <= Decimal(text) <= rule[1]


def breaches_of_version_3(root):
    """Yield what of a document the schema of version 3.3 forbids, in the elements that we use."""
    identified = {one.get("A") for one in root}
    for element in root.iter():
        if element.tag not in VERSION_3:
            yield f"{element.tag} is not known"
            continue
        parts, rules = VERSION_3[element.tag]
        held = [part.tag for part in element]
        yield from (f"{element.tag} holds {tag}" for tag in set(held) - set(parts))
        yield from (
            f"{element.tag} lacks {t}" for t, least in parts.items() if held.count(t) < least
        )
        known = {name.rstrip("!"): rule for name, rule in rules.items()}
        wanted = {name[:-1] for name in rules if name.endswith("!")}
        yield from (f"{element.tag} lacks {name}" for name in wanted - set(element.attrib))
        for name, text in element.attrib.items():
            if name not in known or offends(text, known[name]):
                yield f"{element.tag}/{name} is {text!r}"
            elif REFERS.fullmatch(text) and text not in identified:
                yield f"{element.tag}/{name} refers to {text}, which is not there"


def task_data_3(zones, rate=99_999.0, name="x" * 60):
    """Return the document of version 3."""
    return document(isoxml_taskdata(name, PLOT, zones, rate, "y" * 60, version=3))


@pytest.mark.parametrize("kind", [None, 1, 2])
def test_version_3_keeps_what_the_standards_own_schema_of_it_says(kind):
    zones = ZONES if kind is None else zone_cells(PLOT, ZONES, 4.0, kind)
    for name in ["x" * 60, *ODD_NAMES]:
        root = task_data_3(zones, name=name)
        assert list(breaches_of_version_3(root)) == []
    used = {element.tag for element in root.iter()}
    assert used == set(VERSION_3) - ({"GRD"} if kind is None else set())


@pytest.mark.parametrize(
    ("path", "name", "value", "said"),
    [
        ("PFD", "C", "z" * 33, "PFD/C is"),
        ("PFD", "D", None, "PFD lacks D"),
        ("PFD", "Z", "1", "PFD/Z is"),
        ("TSK", "E", "PFD9", "refers to PFD9"),
        ("TSK", "A", "T1", "TSK/A is 'T1'"),
        ("TSK/TZN", "A", "255", "TZN/A is '255'"),
        ("TSK/TZN/PDV", "B", "1.5", "PDV/B is '1.5'"),
        ("TSK/TZN/PDV", "A", "1", "PDV/A is '1'"),
        ("PFD/PLN/LSG/PNT", "C", "90.1", "PNT/C is '90.1'"),
        ("VPN", "C", "1e-4", "VPN/C is '1e-4'"),
        (".", "VersionMinor", "0", "VersionMinor is '0'"),
    ],
)
def test_a_breach_of_version_3_would_be_seen(path, name, value, said):
    root = task_data_3(ZONES)
    element = root.find(path)
    if value is None:
        del element.attrib[name]
    else:
        element.set(name, value)
    (breach,) = breaches_of_version_3(root)
    assert said in breach


def test_a_line_of_one_point_or_an_element_of_version_4_would_be_seen_in_version_3():
    root = task_data_3(ZONES)
    line = root.find("PFD/PLN/LSG")
    for point in list(line)[1:]:
        line.remove(point)
    etree.SubElement(root, "AFE")
    assert set(breaches_of_version_3(root)) == {
        "LSG lacks PNT", "ISO11783_TaskData holds AFE", "AFE is not known"
    }  # fmt: skip
