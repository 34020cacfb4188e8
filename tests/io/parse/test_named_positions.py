"""Records that name a plot, or a row and a plant, lie where these are."""

import numpy as np
import pytest
from shapely import MultiPolygon, Point, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.options import ReadOptions, RecordOptions
from fieldmon.io.parse.positions import located
from fieldmon.io.readers.places import NamedPlaces, Plants
from fieldmon.plot.field import Field
from tests.io.tables_of_cells import table

ANY = ReadOptions()
GATE = Field("Gate", MultiPolygon([box(35.15, 30.36, 35.152, 30.362)]))
POND = Field("Pond", MultiPolygon([box(35.16, 30.36, 35.162, 30.362)]))
VINES = Plants(
    np.array([[35.15, 30.36], [35.151, 30.36]]), np.array(["1", "2"]), np.array(["7", "7"])
)


def test_records_that_name_plants_lie_on_them():
    found = located(table(row=["2", "1"], plant=["7", "7"]), ANY, NamedPlaces(plants=VINES))
    np.testing.assert_array_equal(found.lonlat, VINES.lonlat[[1, 0]])


def test_a_row_alone_is_no_place_and_plants_are_asked_for_where_none_are_known():
    with pytest.raises(ChoiceNeeded) as asked:
        located(table(row=["1"], plant=["7"], plot=["Gate"]), ANY, NamedPlaces())
    assert (asked.value.option, asked.value.choices) == ("plants", ("Gate",))


def test_records_that_name_a_plot_lie_on_it_and_know_no_better():
    found = located(table(plot=["Pond", "Gate"]), ANY, NamedPlaces((GATE, POND)))
    for field, place, off_m in zip((POND, GATE), found.lonlat, found.accuracy_m, strict=True):
        assert field.boundary.contains(Point(place))
        assert 50 < off_m < 200


def test_rows_of_two_plots_are_asked_apart_where_the_plants_are_of_one():
    places = NamedPlaces(plants=VINES)
    layer = table(plot=["a", "b"], row=["1", "1"], plant=["7", "7"])
    with pytest.raises(ChoiceNeeded) as asked:
        located(layer, ANY, places)
    assert (asked.value.option, asked.value.choices) == ("where", ("plot=a", "plot=b"))
    told = located(layer, ANY.naming(plot=""), places)
    np.testing.assert_array_equal(told.lonlat, VINES.lonlat[[0, 0]])


def test_rows_are_those_of_the_plot_that_is_said_by_hand():
    places = NamedPlaces((GATE, POND), plants_of={"Gate": VINES})
    found = located(table(row=["1"], plant=["7"]), RecordOptions(plot="Gate"), places)
    np.testing.assert_array_equal(found.lonlat, VINES.lonlat[:1])
    assert found.plot.tolist() == ["Gate"]


def test_names_that_nobody_knows_are_left_out_and_refused_where_none_is_left():
    places = NamedPlaces(plants=VINES)
    found = located(table(row=["1", "9"], plant=["7", "7"]), ANY, places)
    assert len(found.lonlat) == len(found.layer) == 1
    with pytest.raises(FileProblem, match=r"but none does.*9/7"):
        located(table(row=["9"], plant=["7"]), ANY, places)
