"""Places that records may name."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.readers.places import (
    NamedPlaces,
    Plants,
    by_plant,
    by_plot,
    by_plot_and_plant,
    labelled,
    plots_called,
)
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle

NORTH, SOUTH, EAST = (
    Field(name, MultiPolygon([shapely.box(5.0 + east, 45.0, 5.001 + east, 45.001)]))
    for name, east in (("North 1", 0.0), ("South", 0.01), ("East 2", 0.02))
)
FIELDS = (NORTH, SOUTH, EAST)


def plants(east):
    """Return three plants: 1 and 2 in row 1, 1 in row 2."""
    lonlat = np.array([(5.0 + east + k * 1e-5, 45.0005) for k in range(3)])
    return Plants(lonlat, np.array(["1", "1", "2"]), np.array(["1", "2", "1"]))


def cells(*values):
    return np.array(values, dtype=object)


def test_a_plant_is_known_by_its_row_and_number_and_no_other():
    known = plants(0.0)
    named = by_plant(cells("2", 1, "9", None), cells(1, "2", 1, 1), known)
    np.testing.assert_array_equal(named.lonlat[:2], known.lonlat[[2, 1]])
    assert np.isnan(named.lonlat[2:]).all()
    assert [message.sentence for message in named.messages] == [
        "1 record(s) name 1 plant(s) that are not known: 9/1.",
        "1 record(s) name no plant at all.",
    ]


def test_a_record_that_names_a_plot_is_as_far_off_as_the_plot_is_wide():
    named = by_plot(cells("South", "Moon"), NamedPlaces(FIELDS))
    assert SOUTH.boundary.contains(shapely.Point(named.lonlat[0]))
    assert named.accuracy_m[0] == pytest.approx(np.sqrt(area_m2(SOUTH.boundary) / np.pi))
    assert np.isnan(named.lonlat[1]).all()


def test_rows_are_those_of_the_plot_that_is_named():
    places = NamedPlaces(FIELDS, plants_of={"North 1": plants(0.0), "South": plants(0.01)})
    plot = cells("South", "North 1", "South", "East 2", "Moon", "")
    named = by_plot_and_plant(plot, cells(1, 1, 7, 1, 1, 1), cells(2, 2, 7, 1, 1, 1), places)
    np.testing.assert_array_equal(named.lonlat[0], places.plants_of["South"].lonlat[1])
    np.testing.assert_array_equal(named.lonlat[1], places.plants_of["North 1"].lonlat[1])
    assert np.isnan(named.lonlat[2:]).all()
    assert named.plot.tolist() == ["South", "North 1", "South", "East 2", "", ""]
    assert {(message.feature, message.sentence) for message in named.messages} == {
        (None, "1 record(s) name 1 plot(s) that are not known: Moon."),
        (None, "1 record(s) name no plot at all."),
        (None, "1 record(s) are of 1 other plot(s): East 2."),
        ("South", "1 record(s) name 1 plant(s) that are not known: 7/7."),
    }


def test_plots_are_called_in_any_way_of_writing_but_alike_for_all():
    assert plots_called(["north-1", "SOUTH"], FIELDS) == (NORTH, SOUTH)
    assert plots_called(["2"], (NORTH, EAST)) == (EAST,)
    assert plots_called(["South", "EAST 2"], FIELDS) == (SOUTH,)
    assert plots_called(["Moon"], FIELDS) == plots_called([], FIELDS) == ()


def test_the_only_plots_plants_are_its_own_also_by_its_name():
    grid = rectangle(3, 4)
    places = NamedPlaces.of((NORTH,), grid, plot="North 1")
    assert places.plants_of == {"North 1": places.plants}
    assert NamedPlaces.of((), grid).plants_of == {}
    np.testing.assert_array_equal(labelled(grid).lonlat, places.plants.lonlat)
