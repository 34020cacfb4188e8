"""Plots out of a layer, and what comes with them."""

from shapely import Polygon

from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plots import named_areas, plots_of
from tests.io.readers.plot_layers import ANY, ONE, TWO, layer_of, square
from tests.io.tables_of_cells import table


def test_rows_that_the_file_knows_come_with_the_plot_that_is_chosen():
    layer = layer_of([ONE, TWO], name=["a", "b"], row_spacing=[3, 4])
    (field,) = plots_of(layer, PlotOptions(feature="b")).value
    assert field.row_spacing_m == 4.0


def test_a_table_has_no_areas_to_name():
    layer, names = named_areas(table(a=["x"]), ANY)
    assert (len(layer), names) == (0, [])


TIE = Polygon([(35, 30), (35.002, 30.002), (35.002, 30), (35, 30.002)])


def test_what_holds_for_many_plots_is_one_line_with_their_number():
    read = plots_of(layer_of([*[TIE] * 50, square(0)]), PlotOptions())
    grave = [str(m) for m in read.messages if m.severity in {"repaired", "doubtful"}]
    assert len(grave) == 2
    assert grave[0].startswith("doubtful: the outlines of 50 plots cross themselves; the first is")
    assert grave[1].startswith("doubtful: 49 plots have the same outline as another; the first is")


def test_spacings_of_columns_come_with_their_plot():
    file = layer_of(
        [square(0), square(1)], name=["a", "b"], row_spacing=[4.0, None], bearing=[0, 70]
    )
    a, b = plots_of(file, PlotOptions()).value
    assert (a.row_spacing_m, a.row_bearing_deg, a.plant_spacing_m) == (4.0, 0.0, None)
    assert (b.row_spacing_m, b.row_bearing_deg) == (None, 70.0)


def test_plots_keep_what_is_said_of_them_where_others_were_left_out():
    flat = Polygon([(35, 30), (35.1, 30), (35.2, 30)])
    read = plots_of(layer_of([flat, square(0)], name=["x", "b"], row_m=[3, 4]), PlotOptions())
    assert [(f.name, f.row_spacing_m) for f in read.value] == [("b", 4.0)]
