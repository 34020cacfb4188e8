"""Vector files that GDAL reads: layers as they are, shapefiles by their own evidence."""

from contextlib import contextmanager

import geopandas as gpd
import pandas as pd
import pyogrio
import pytest
from shapely import Point, box

from fieldmon.errors import FileProblem
from fieldmon.io.formats.gdal import list_layers, read_layer, read_mapinfo, read_shapefile
from fieldmon.io.import_report import Severity
from fieldmon.io.sandbox import limits
from tests.io.tables_of_cells import sentences

FRAME = gpd.GeoDataFrame(
    {"name": ["צפון", None], "n": [1.5, 2.0], "at": pd.to_datetime(["2026-04-06", None])},
    geometry=[Point(207_000, 470_000), Point(207_010, 470_010)],
    crs=2039,
)


@pytest.fixture
def package(tmp_path):
    path = tmp_path / "x.gpkg"
    FRAME.to_file(path, layer="traps")
    FRAME[["name", "geometry"]].iloc[:0].to_file(path, layer="none")
    pyogrio.write_dataframe(pd.DataFrame({"a": [1]}), path, layer="notes", append=True)
    return path


def test_layers_are_listed_with_what_they_hold(package):
    listed = {layer.name: layer.geometry_type for layer in list_layers(package, "x")}
    assert listed == {"traps": "Point", "none": "Unknown", "notes": None}


def test_a_layer_comes_with_its_cells_its_shapes_and_its_system(package):
    layer = read_layer(package, "x", "traps")
    assert layer.columns["name"].tolist() == ["צפון", None]
    assert layer.columns["n"].tolist() == [1.5, 2.0]
    assert str(layer.columns["at"][0]).startswith("2026-04-06")
    assert [g.equals(p) for g, p in zip(layer.geometry, FRAME.geometry, strict=True)] == [True] * 2
    assert layer.crs == "EPSG:2039"
    assert read_layer(package, "x", "notes").geometry is None
    assert len(read_layer(package, "x", "none")) == 0


def test_more_features_than_may_be_are_refused(package, monkeypatch):
    monkeypatch.setattr(limits, "FEATURES", 1)
    with pytest.raises(FileProblem, match="1 features at most"):
        read_layer(package, "x", "traps")


# --- shapefiles --------------------------------------------------------------------------------


@pytest.fixture
def shapefile(tmp_path):
    FRAME[["name", "n", "geometry"]].to_file(tmp_path / "x.shp", encoding="cp1255")
    return tmp_path / "x.shp"


@contextmanager
def restoring():
    """Let GDAL make an index anew, as it may in the reading process."""
    pyogrio.set_gdal_config_options({"SHAPE_RESTORE_SHX": "YES"})
    yield
    pyogrio.set_gdal_config_options({"SHAPE_RESTORE_SHX": None})


def test_letters_are_read_by_their_own_evidence_whatever_the_cpg_says(shapefile):
    for stated in ("1255", "UTF-8", "ISO-8859-1", None):
        cpg = shapefile.with_suffix(".cpg")
        cpg.unlink(missing_ok=True)
        if stated:
            cpg.write_text(stated)
        assert read_shapefile(shapefile, "x", None).columns["name"].tolist()[0] == "צפון"


def test_an_encoding_told_by_hand_is_taken(shapefile):
    assert read_shapefile(shapefile, "x", "cp1252").columns["name"][0] != "צפון"


@pytest.mark.parametrize(
    ("part", "says", "severity"),
    [(".shx", "index", Severity.REPAIRED), (".dbf", "table", Severity.SEEN)],
)
def test_a_part_that_is_missing_is_said_and_the_shapes_come_in(shapefile, part, says, severity):
    shapefile.with_suffix(part).unlink()
    with restoring():
        layer = read_shapefile(shapefile, "x", None)
    assert len(layer) == 2
    said = layer.messages[0]
    assert (said.severity, says in said.sentence) == (severity, True)


def test_a_system_that_cannot_be_understood_is_left_and_said(shapefile):
    shapefile.with_suffix(".prj").write_text('PROJCS["broken')
    layer = read_shapefile(shapefile, "x", None)
    assert layer.crs is None or "broken" not in layer.crs
    assert len(layer) == 2
    assert layer.crs is not None or "(.prj) cannot be understood" in sentences(layer)


def test_areas_come_in_as_areas(tmp_path):
    gpd.GeoDataFrame({"n": [1]}, geometry=[box(0, 0, 1, 1)], crs=4326).to_file(tmp_path / "a.fgb")
    (shape,) = read_layer(tmp_path / "a.fgb", "a", None).geometry
    assert shape.equals(box(0, 0, 1, 1))


def test_columns_of_a_mapinfo_table_whose_names_were_cut_within_a_letter_are_read(tmp_path):
    """As QGIS 3.22 writes long names in Hebrew: half letters, or a name that ends in one."""
    frame = gpd.GeoDataFrame(
        {"name": ["north"], "one": [3.0], "two": [4.0], "three": [5.0], "b": 6.0, "four": 7.0},
        geometry=[box(35.15, 30.36, 35.152, 30.362)], crs=4326,
    )  # fmt: skip
    path = tmp_path / "plots.tab"
    pyogrio.write_dataframe(frame, path, driver="MapInfo File")
    said = path.read_bytes()
    cut = {b"one": b"a\xd7_\xd7__\xd7", b"two": b"a\xd7_", b"three": "שורות_ב".encode() + b"\xd7",
           b"four": b"b\xd7_"}  # fmt: skip
    for name, half in cut.items():
        said = said.replace(b" " + name + b" ", b" " + half + b" ")
    path.write_bytes(said)
    layer = read_mapinfo(path, "plots")
    cells = [layer.columns[name][0] for name in ("name", "a", "שורות_ב", "b")]
    assert cells == ["north", 3.0, 5.0, 6.0]
    assert len(layer.columns) == 6
    (said,) = layer.messages
    assert said.severity is Severity.REPAIRED
    assert "cut in the midst of a letter are read as 'a', 'a" in said.sentence
