"""How plots are called."""

from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plot_names import plot_names
from fieldmon.io.readers.plots import named_areas, plots_of
from tests.io.readers.plot_layers import ANY, ONE, THREE, TWO, layer_of, names_of, square


def test_plots_are_called_as_their_column_says_and_told_apart_where_it_repeats():
    layer = layer_of([ONE, TWO, THREE], name=["Gate", "Gate", "Pond"])
    assert names_of(plots_of(layer, ANY)) == ["Gate (1)", "Gate (2)", "Pond"]
    assert plot_names(layer, None)[0] == named_areas(layer, ANY)[1]


def test_plots_without_names_are_numbered_and_that_is_a_guess():
    imported = plots_of(layer_of([ONE, TWO]), ANY)
    assert names_of(imported) == ["estate (1)", "estate (2)"]
    assert "they are numbered" in imported.of(Severity.GUESSED)[0].sentence
    assert names_of(plots_of(layer_of([ONE]), ANY)) == ["estate"]


def test_a_column_of_names_can_be_chosen():
    layer = layer_of([ONE, TWO], name=["a", "b"], code=["X1", "X2"])
    assert names_of(plots_of(layer, PlotOptions(name_column="code"))) == ["X1", "X2"]


def test_plots_are_named_by_the_column_that_says_anything():
    empty = ["", ""]
    read = plots_of(layer_of([square(0), square(1)], Name=empty, f_name=["N", "S"]), PlotOptions())
    assert [f.name for f in read.value] == ["N", "S"]
    read = plots_of(layer_of([square(0)], Name=["x"], f_name=["N"]), PlotOptions())
    assert [f.name for f in read.value] == ["x"]
