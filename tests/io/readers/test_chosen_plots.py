"""Which plots of a file are wanted."""

import pytest
from shapely import Polygon

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plots import plots_of
from tests.io.readers.plot_layers import ONE, THREE, TWO, layer_of, names_of, square
from tests.io.tables_of_cells import sentences


@pytest.mark.parametrize(
    ("wanted", "name"),
    [("Gate", "Gate"), ("gat", "Gate"), (2, "Pond"), ("2", "Pond"), ("POND", "Pond")],
)
def test_one_plot_is_chosen_by_its_name_a_part_of_it_or_its_number(wanted, name):
    layer = layer_of([ONE, TWO], name=["Gate", "Pond"])
    (field,) = plots_of(layer, PlotOptions(feature=wanted)).value
    assert field.name == name
    assert field.boundary.equals({"Gate": ONE, "Pond": TWO}[name])


@pytest.mark.parametrize(
    ("wanted", "offered"),
    [
        ("Moon", ("Gate 1", "Gate 2", "Pond")),
        ("gate", ("Gate 1", "Gate 2")),
        ("4", None),
        ("0", None),
    ],
)
def test_a_name_that_fits_none_or_several_is_asked_back(wanted, offered):
    layer = layer_of([ONE, TWO, THREE], name=["Gate 1", "Gate 2", "Pond"])
    with pytest.raises(ChoiceNeeded) as asked:
        plots_of(layer, PlotOptions(feature=wanted))
    assert asked.value.option == "feature"
    assert asked.value.choices == (offered or ("Gate 1", "Gate 2", "Pond"))


def test_a_plot_called_by_a_number_goes_before_the_number():
    layer = layer_of([ONE, TWO], name=["2", "1"])
    read = plots_of(layer, PlotOptions(feature=2))
    assert names_of(read) == ["2"]
    said = "2 was taken as the plot's name; number 2 of the list is '1'."
    assert said in sentences(read)
    in_order = layer_of([ONE, TWO], name=["1", "2"])
    assert "taken as the plot's name" not in sentences(plots_of(in_order, PlotOptions(feature=2)))


def test_the_number_of_a_plot_is_its_place_among_those_that_can_be_used():
    flat = Polygon([(35, 30), (35.1, 30), (35.2, 30)])
    file = layer_of([flat, square(0), flat, square(1)], name=["a", "b", "c", "7"])
    assert [f.name for f in plots_of(file, PlotOptions()).value] == ["b", "7"]
    for wanted, name in (("1", "b"), ("2", "7"), ("7", "7"), ("b", "b")):
        read = plots_of(file, PlotOptions(feature=wanted))
        assert [f.name for f in read.value] == [name]
    with pytest.raises(ChoiceNeeded, match="There are 2 plots, but none is called '3'"):
        plots_of(file, PlotOptions(feature="3"))
    tens = layer_of([square(0), square(1)], name=["(10)", "(20)"])
    with pytest.raises(ChoiceNeeded, match=r"none is called '0': several have it .* from 1"):
        plots_of(tens, PlotOptions(feature="0"))
