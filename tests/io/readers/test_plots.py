"""Many plots of a file: few words, and numbers that stay."""

import numpy as np
import pytest
from shapely import Polygon, box

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import Layer
from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plots import plots_of
from tests.io.tables_of_cells import column

TIE = Polygon([(35, 30), (35.002, 30.002), (35.002, 30), (35, 30.002)])


def layer(*areas, **columns):
    cells = {name: column(values) for name, values in columns.items()}
    return Layer("file", cells, column(list(areas)), "OGC:CRS84")


def square(i):
    return box(36 + i / 100, 30, 36.002 + i / 100, 30.002)


def test_what_holds_for_many_plots_is_one_line_with_their_number():
    read = plots_of(layer(*[TIE] * 50, square(0)), PlotOptions())
    grave = [str(m) for m in read.messages if m.severity in {"repaired", "doubtful"}]
    assert len(grave) == 2
    assert grave[0].startswith("repaired: 50 shapes were not valid and were repaired; the first is")
    assert grave[1].startswith("doubtful: 49 plots have the same outline as another; the first is")


def test_the_number_of_a_plot_is_its_place_among_those_that_can_be_used():
    flat = Polygon([(35, 30), (35.1, 30), (35.2, 30)])
    file = layer(flat, square(0), flat, square(1), name=["a", "b", "c", "7"])
    assert [f.name for f in plots_of(file, PlotOptions()).value] == ["b", "7"]
    for wanted, name in (("1", "b"), ("2", "7"), ("7", "7"), ("b", "b")):
        read = plots_of(file, PlotOptions(feature=wanted))
        assert [f.name for f in read.value] == [name]
    with pytest.raises(ChoiceNeeded, match="There are 2 plots, but none is called '3'"):
        plots_of(file, PlotOptions(feature="3"))


def test_plots_are_named_by_the_column_that_says_anything():
    empty = ["", ""]
    read = plots_of(layer(square(0), square(1), Name=empty, f_name=["N", "S"]), PlotOptions())
    assert [f.name for f in read.value] == ["N", "S"]
    read = plots_of(layer(square(0), Name=["x"], f_name=["N"]), PlotOptions())
    assert [f.name for f in read.value] == ["x"]


def test_spacings_of_columns_come_with_their_plot():
    file = layer(square(0), square(1), name=["a", "b"], row_spacing=[4.0, None], bearing=[0, 70])
    a, b = plots_of(file, PlotOptions()).value
    assert (a.row_spacing_m, a.row_bearing_deg, a.plant_spacing_m) == (4.0, 0.0, None)
    assert (b.row_spacing_m, b.row_bearing_deg) == (None, 70.0)
    assert np.isfinite(a.row_spacing_m)
