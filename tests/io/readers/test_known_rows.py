"""What a plot file says of its rows goes to the plot it is said of."""

import pytest
from shapely import MultiPolygon, box

from fieldmon.io.readers.known_rows import with_known_rows
from fieldmon.plot.field import Field
from tests.io.tables_of_cells import table

FIELDS = tuple(
    Field(name, MultiPolygon([box(5 + k, 45, 5.001 + k, 45.001)])) for k, name in enumerate("ab")
)


def rows_of(field):
    return field.row_bearing_deg, field.row_spacing_m, field.plant_spacing_m


def test_each_plot_gets_what_its_own_line_says():
    layer = table(row_bearing_deg=[10, None], row_spacing=["3,5", "4"], plant_spacing_m=[None, 1.5])
    (a, b), (said,) = with_known_rows(FIELDS, layer, ["a", "b"])
    assert rows_of(a) == (10.0, 3.5, None)
    assert rows_of(b) == (None, 4.0, 1.5)
    for column in layer.columns:
        assert repr(column) in said.sentence


def test_plots_are_told_apart_by_name_where_some_were_left_out():
    layer = table(row_m=[3, 4, 5])
    (b,), _ = with_known_rows(FIELDS[1:], layer, ["x", "b", "a"])
    assert b.row_spacing_m == 4.0


@pytest.mark.parametrize("value", [0, -3, "none", None])
def test_a_spacing_that_is_none_is_not_taken(value):
    (a, _), _ = with_known_rows(FIELDS, table(row_spacing_m=[value, 4]), ["a", "b"])
    assert a.row_spacing_m is None


def test_rows_may_run_north_and_west_of_it():
    (a, b), _ = with_known_rows(FIELDS, table(azimuth=[0, -20]), ["a", "b"])
    assert (a.row_bearing_deg, b.row_bearing_deg) == (0.0, -20.0)


@pytest.mark.parametrize("column", ["Row spacing (m)", "ROW_SPAC_M", "rowSpace", "row dist"])
def test_columns_are_known_however_they_are_written(column):
    (a, _), _ = with_known_rows(FIELDS, table(**{column: [3, 4]}), ["a", "b"])
    assert a.row_spacing_m == 3.0


def test_a_file_that_says_nothing_leaves_plots_as_they_are():
    fields, messages = with_known_rows(FIELDS, table(crop=["vine", "vine"]), ["a", "b"])
    assert fields is FIELDS
    assert messages == []
