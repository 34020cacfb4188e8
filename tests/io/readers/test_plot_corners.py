"""A plot whose corners a table lists."""

import pytest
from shapely import MultiPolygon

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plots import plots_of
from tests.io.readers.plot_layers import ANY, ONE, TWO, corners, names_of
from tests.io.tables_of_cells import sentences, table


def test_a_table_of_corners_in_their_order_is_one_plot_and_that_is_a_guess():
    imported = plots_of(corners(*list(ONE.exterior.coords)[:-1]), ANY)
    (field,) = imported.value
    assert field.boundary.equals(MultiPolygon([ONE]))
    assert "4 positions were taken as the corners" in sentences(imported.of(Severity.GUESSED))


def test_a_table_of_two_plots_asks_which_are_the_corners():
    both = [*list(ONE.exterior.coords)[:-1], *list(TWO.exterior.coords)[:-1]]
    # joined in this order the outlines cross
    both[4], both[5] = both[5], both[4]
    with pytest.raises(ChoiceNeeded) as asked:
        plots_of(corners(*both, part=["a"] * 4 + ["b"] * 4), ANY)
    assert asked.value.option == "where"
    assert set(asked.value.choices) >= {"part=a", "part=b"}


# three rows of eight plants, each row up: through them runs no outline
IN_ROWS = [(5 + 0.0001 * row, 45 + 0.0001 * plant) for row in range(3) for plant in range(8)]
# up, down, up: their line crosses itself nowhere
UP_AND_DOWN = [*IN_ROWS[:8], *IN_ROWS[15:7:-1], *IN_ROWS[16:]]


@pytest.mark.parametrize(
    ("places", "more"),
    [
        (IN_ROWS, {}),
        (IN_ROWS, {"Vine ID": [f"V{k // 2}" for k in range(24)], "variety": ["a", "b"] * 12}),
        (UP_AND_DOWN, {"row": [k // 8 for k in range(24)]}),
    ],
)
def test_plants_in_place_of_a_plot_are_offered_as_plants_and_nothing_else(places, more):
    with pytest.raises(ChoiceNeeded, match="lists 24 positions that are not its corners") as asked:
        plots_of(corners(*places, **more), ANY)
    assert (asked.value.option, asked.value.choices) == ("kind", ("plants",))


def test_a_few_numbered_corners_are_corners_and_so_are_those_that_are_said_to_be():
    at = list(ONE.exterior.coords)[:-1]
    (field,) = plots_of(corners(*at, row=[1, 2, 3, 4]), ANY).value
    assert field.boundary.equals(MultiPolygon([ONE]))
    walked = corners(*IN_ROWS[:8], *IN_ROWS[23:15:-1], *IN_ROWS[8:16], row=["a"] * 16 + ["b"] * 8)
    (field,) = plots_of(walked, PlotOptions(where="row=a")).value
    assert field.boundary.area > 0


def test_a_plot_whose_corners_were_chosen_by_its_name_is_called_so():
    four = table(lon=[5, 5.001, 5.001, 5], lat=[45, 45, 45.001, 45.001], Plot=["East"] * 4)
    (chosen,) = names_of(plots_of(four, PlotOptions(where="Plot=East")))
    (other,) = names_of(plots_of(four, PlotOptions(where="row=East")))
    assert (chosen, other) == ("East", four.name)


def test_corners_that_enclose_nothing_are_refused():
    with pytest.raises((ChoiceNeeded, FileProblem)):
        plots_of(corners((5, 45), (5.001, 45), (5.002, 45)), ANY)
    with pytest.raises(ChoiceNeeded, match="3 to 1000 positions"):
        plots_of(corners((5, 45), (5.001, 45)), ANY)
