"""Shapes as text in a table: which column, which coordinate system, what is broken."""

import numpy as np
import pytest
import shapely
from shapely import box

from fieldmon.errors import FileProblem
from fieldmon.io.formats.wkt import with_shapes
from tests.io.tables_of_cells import sentences, table

SQUARE = box(35.15, 30.36, 35.152, 30.362)
METRES = "POLYGON ((2e5 4e5, 2.1e5 4e5, 2.1e5 4.1e5, 2e5 4e5))"


def test_the_column_of_shapes_becomes_the_geometry_and_the_others_stay():
    layer = with_shapes(table(name=["a", "b"], geom=[SQUARE.wkt, None]), None)
    assert layer.geometry[0].equals(SQUARE)
    assert layer.geometry[1] is None
    assert list(layer.columns) == ["name"]
    assert layer.crs == "OGC:CRS84"
    assert "they name no coordinate system" in sentences(layer).lower()


@pytest.mark.parametrize(
    ("cell", "stated", "crs"),
    [
        (METRES, None, None),
        (METRES, "EPSG:2039", "EPSG:2039"),
        (f"SRID=2039;{METRES}", "EPSG:28191", "EPSG:2039"),
        (f"srid=0; {METRES}", None, None),
    ],
)
def test_the_system_is_that_of_the_cells_else_that_beside_the_table_else_open(cell, stated, crs):
    assert with_shapes(table(wkt=[cell]), stated).crs == crs


@pytest.mark.parametrize("cells", [["POINT"], ["a", SQUARE.wkt], [""], ["POLYGON of mine (1)x"]])
def test_a_table_without_a_column_of_shapes_stays_as_it_is(cells):
    layer = table(name=cells)
    assert with_shapes(layer, None) is layer


def test_open_rings_are_closed_and_broken_shapes_are_counted():
    opened = SQUARE.wkt.rpartition(",")[0] + "))"
    layer = with_shapes(table(wkt=[opened, "POLYGON ((1 2, 3))"]), None)
    assert np.isclose(layer.geometry[0].area, SQUARE.area)
    said = sentences(layer)
    assert "1 feature did not end where it began" in said
    assert "1 shape cannot be understood" in said


@pytest.mark.parametrize(
    ("cell", "crs"),
    [
        (SQUARE.wkb_hex, "OGC:CRS84"),
        ("\\x" + shapely.to_wkb(SQUARE, hex=True, byte_order=0).lower(), "OGC:CRS84"),
        (shapely.to_wkb(shapely.force_3d(SQUARE), hex=True, flavor="iso"), "OGC:CRS84"),
        (shapely.to_wkb(shapely.set_srid(SQUARE, 2039), hex=True, include_srid=True), "EPSG:2039"),
    ],
)
def test_shapes_in_bytes_are_read_as_databases_write_them(cell, crs):
    layer = with_shapes(table(name=["a", "b"], geom=[cell, None]), None)
    assert layer.geometry[0].equals(SQUARE)
    assert layer.geometry[1] is None
    assert layer.crs == crs


def test_other_cells_of_hexadecimal_digits_are_no_shapes():
    for cell in ("01" * 16, "0103000000", "00" * 21, "01E9030000", "1E" * 20):
        table_of_ids = table(id=[cell], lon=[35.15])
        assert with_shapes(table_of_ids, None) is table_of_ids
    torn = with_shapes(table(geom=[SQUARE.wkb_hex, SQUARE.wkb_hex[:40]]), None)
    assert "1 shape cannot be understood; left out." in sentences(torn)


@pytest.mark.parametrize(
    "cell",
    [
        "CURVEPOLYGON(CIRCULARSTRING(0 0, 1 1, 2 0, 1 -1, 0 0))",
        "SRID=4326;MULTISURFACE Z (((0 0 1, 1 0 1, 1 1 1, 0 0 1)))",
        "GEOMETRYCOLLECTION(CIRCULARSTRING(0 0, 1 1, 2 0))",
        "010A000000010000000108000000",
    ],
)
def test_curves_are_refused_with_what_makes_them_straight(cell):
    with pytest.raises(
        FileProblem, match=r"straight edges, but column 'geom' of .* ST_CurveToLine"
    ):
        with_shapes(table(geom=[SQUARE.wkt, cell]), None)
