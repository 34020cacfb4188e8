"""Records that give a position and name a plant are doubted where the two disagree."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, box

from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.formats.layer import Layer
from fieldmon.io.import_report import Severity
from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.placed_twice import PlacedTwice
from fieldmon.io.readers.places import NamedPlaces, labelled
from fieldmon.io.readers.records import records_of
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting

# 30 rows of 20, 3 m and 2 m apart
GRID = rectangle(30, 20, Planting(row_spacing_m=3.0, plant_spacing_m=2.0, row_bearing_deg=90.0))
PLACES = NamedPlaces((), labelled(GRID))
LABEL = plant_numbers(GRID)


def read(moved_m, options=None, of=slice(0, 100), **columns):
    """Return what is said of records of plants whose positions are moved, in a table."""
    plants = np.arange(len(GRID))[of]
    lonlat = GRID.frame.lonlat(GRID.xy_m[plants] + moved_m)
    table = {"lon": lonlat[:, 0], "lat": lonlat[:, 1], "row": LABEL.line[plants],
             "plant": LABEL.number[plants], "count": np.ones(len(plants)), **columns}  # fmt: skip
    layer = Layer("records", {k: np.array(v, dtype=object) for k, v in table.items() if len(v)})
    return records_of(layer, options or RecordOptions(), PLACES)


def twice(read):
    """Return the message of records that are placed twice."""
    (one,) = (one for one in read.messages if isinstance(one, PlacedTwice))
    return one


def doubts(read):
    return twice(read).doubts(PLACES, 3.0)


@pytest.mark.parametrize("accuracy_m", [None, 1.0, 8.0])
def test_ordinary_scatter_raises_no_doubt(accuracy_m):
    spread_m = PriorSettings().accuracy_m if accuracy_m is None else accuracy_m
    moved_m = np.random.default_rng(3).normal(0, spread_m, (600, 2))
    stated = {} if accuracy_m is None else {"accuracy": np.full(600, accuracy_m)}
    told = read(moved_m, of=slice(None), **stated)
    assert doubts(told) == []
    assert str(twice(told)) == (
        "seen: 600 records give positions and name a plant, too: their positions were taken."
    )


def test_records_elsewhere_than_their_plants_are_told_with_the_farthest():
    moved_m = np.zeros((100, 2))
    moved_m[7], moved_m[30] = (42.0, 0.0), (0.0, 30.0)
    (doubt,) = doubts(read(moved_m))
    assert doubt.severity is Severity.DOUBTFUL
    assert doubt.sentence == (
        "2 of 100 records that give a position and name a plant lie elsewhere than that plant, "
        "the farthest 42 m from row 1, plant 8. Their positions were taken: look which is right."
    )
    assert doubt.remedy.setting == "place=plant"
    assert doubt.remedy.choices == ("plant", "position")


@pytest.mark.parametrize(("accuracy_m", "far_m", "is_doubted"), [
    (1.0, 6.5, False), (1.0, 7.5, True), (10.0, 42.5, False), (10.0, 43.5, True),
    (None, 22.5, False), (None, 23.5, True), (0.0, 22.5, False),
])  # fmt: skip
def test_a_record_is_elsewhere_a_spacing_and_four_times_its_accuracy_away(
    accuracy_m, far_m, is_doubted
):
    moved_m = np.zeros((100, 2))
    moved_m[7, 0] = far_m
    stated = {} if accuracy_m is None else {"accuracy": np.full(100, accuracy_m)}
    assert bool(doubts(read(moved_m, **stated))) is is_doubted


def test_where_most_disagree_rows_may_be_counted_otherwise():
    (doubt,) = doubts(read(0.0, row=31 - LABEL.line[:100]))
    assert doubt.sentence.startswith("100 of 100 records")
    assert doubt.sentence.endswith(
        "The file may count rows or plants otherwise than this plot does."
    )
    (few,) = doubts(read(0.0, of=slice(0, 2), row=[29, 29]))
    assert "otherwise" not in few.sentence


@pytest.mark.parametrize("columns", [
    {"row": []}, {"plant": []}, {"plant": ["vine"] * 100}, {"row": ["", "NA"] * 50},
    {"row": ["0"] * 100}, {"row": np.arange(900, 1000)},
])  # fmt: skip
def test_names_of_no_plant_here_say_nothing(columns):
    told = [one for one in read(50.0, **columns).messages if isinstance(one, PlacedTwice)]
    assert [doubt for one in told for doubt in one.doubts(PLACES, 3.0)] == []


def test_records_are_of_the_plots_that_they_name():
    moved_m = np.zeros((100, 2))
    moved_m[[7, 8], 0] = 42.0
    plot = ["Home"] * 100
    plot[8] = "Away"
    told = twice(read(moved_m, plot=plot))
    assert told.plots == ("Away", "Home")
    home = Field("Home", GRID.frame.geometry_lonlat(MultiPolygon([box(-90, -90, 90, 90)])))
    (doubt,) = told.doubts(NamedPlaces((home,), None, {"Home": labelled(GRID)}), 3.0)
    assert doubt.sentence.startswith("1 of 99 records")


def test_only_records_on_a_plot_are_held_against_its_plants():
    area = GRID.frame.geometry_lonlat(MultiPolygon([box(-90, -90, 90, 90)]))
    told = twice(read(0.0))
    assert len(told.on(Field("here", area)).lonlat) == 100
    away = Field("there", shapely.transform(area, lambda xy: xy + np.array([0.01, 0.0])))
    assert len(told.on(away).lonlat) == 0


def test_a_place_is_that_of_the_position_or_of_the_plant_as_it_is_told():
    moved_m = np.full((100, 2), (42.0, 0.0))
    by_position = read(moved_m, RecordOptions(place="position"))
    assert doubts(by_position) == []
    accuracy = {"accuracy": np.full(100, 25.0)}
    by_plant = read(moved_m, RecordOptions(place="plant"), **accuracy)
    assert not any(isinstance(one, PlacedTwice) for one in by_plant.messages)
    xy_m = GRID.frame.xy_m(by_plant.value.lonlat)
    np.testing.assert_allclose(xy_m, GRID.xy_m[:100], atol=1e-6)
    assert np.isnan(by_plant.value.accuracy_m).all()
    np.testing.assert_allclose(GRID.frame.xy_m(by_position.value.lonlat), xy_m + moved_m, atol=1e-6)


def test_points_on_a_map_that_name_plants_are_compared_too():
    lonlat = GRID.lonlat(np.arange(20)) + np.array([0.001, 0.0])
    columns = {"row": np.ones(20, object), "plant": np.arange(1, 21).astype(object),
               "count": np.ones(20, object)}  # fmt: skip
    layer = Layer("points", columns, shapely.points(lonlat), "OGC:CRS84")
    (doubt,) = doubts(records_of(layer, RecordOptions(), PLACES))
    assert doubt.sentence.startswith("20 of 20 records")
    by_plant = records_of(layer, RecordOptions(place="plant"), PLACES)
    np.testing.assert_allclose(by_plant.value.lonlat, GRID.lonlat(np.arange(20)), atol=1e-9)


def test_plants_that_nobody_names_cannot_tell_places():
    with pytest.raises(FileProblem, match="must name plants if place=plant takes these"):
        read(0.0, RecordOptions(place="plant"), plant=[])


def test_other_places_are_refused():
    with pytest.raises(SettingError, match=r"but it is 'row'\. Say position or plant"):
        RecordOptions().choose("place", "row")
    with pytest.raises(SettingError, match=r"take_doubtful=yes takes it\. Leave place out"):
        InspectionOptions().choose("place", "plant")


def test_records_on_a_plot_that_name_another_and_those_that_lie_on_another_are_told():
    area = GRID.frame.geometry_lonlat(MultiPolygon([box(-90, -90, 90, 90)]))
    here = Field("Home", area)
    there = Field("Hill", shapely.transform(area, lambda xy: xy + np.array([0.01, 0.0])))
    plot = ["home"] * 100
    plot[8], plot[9] = "hill", "Elsewhere"
    moved_m = np.zeros((100, 2))
    moved_m[20, 0] = 955.0  # a hundredth of a degree, or nearly
    told = twice(read(moved_m, plot=plot))
    stranger, lost = told.on_wrong_plots(here, (here, there), 3.0)
    assert stranger.sentence == (
        "1 record lies on Home, but names a plant of Hill, the first row 1, plant 9. Its position "
        "was taken: look which is right."
    )
    assert lost.sentence == (
        "1 record names a plant of Home, but lies on Hill, the first row 2, plant 1. Its position "
        "was taken: look which is right."
    )
    assert {one.remedy.setting for one in (stranger, lost)} == {"place=plant"}
    assert told.on_wrong_plots(here, (here,), 3.0) == []
    by_position = twice(read(moved_m, RecordOptions(place="position"), plot=plot))
    assert by_position.on_wrong_plots(here, (here, there), 3.0) == []
