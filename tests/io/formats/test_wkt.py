"""Shapes as text in a table: which column, which coordinate system, what is broken."""

import numpy as np
import pytest
from shapely import box

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
