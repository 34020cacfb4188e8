"""Which plant a record belongs to, and what is said where that cannot be told."""

from dataclasses import replace

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon, box

from fieldmon.infestation.records import PRESENT, Records
from fieldmon.io.import_report import Remedy, Severity, guessed
from fieldmon.io.readers.nearby import (
    near_plot,
    of_plot,
    on_plants,
    records_on_plot,
    without_corners,
)
from fieldmon.io.readers.places import NamedPlaces, Plants
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting

GRID = rectangle(6, 10, Planting(row_spacing_m=3.0, plant_spacing_m=1.5))


def records(offset_m, accuracy_m=np.nan):
    lonlat = GRID.frame.lonlat(GRID.xy_m[[7]] + offset_m)
    accuracy = np.full(1, accuracy_m)
    return Records.of(lonlat, np.array([PRESENT]), accuracy_m=accuracy)


def test_the_corners_of_the_plot_are_no_records_where_a_file_holds_both():
    field = Field("a", GRID.frame.geometry_lonlat(MultiPolygon([box(-40, -40, 40, 40)])))
    corners = np.array(field.boundary.geoms[0].exterior.coords[:4])
    lonlat = np.concatenate([GRID.lonlat(np.arange(5)), corners])
    found = Records.of(lonlat, np.full(9, PRESENT))
    kept, (said,) = of_plot(found, field)
    np.testing.assert_array_equal(kept.lonlat, lonlat[:5])
    assert (said.severity, said.sentence[:9]) == (Severity.DROPPED, "4 records")
    for some in (found.take(np.arange(8)), found.take(np.arange(5, 9))):
        assert len(of_plot(some, field)[0]) == len(some)
    beside = replace(field, boundary=shapely.transform(field.boundary, lambda xy: xy + 0.001))
    kept, (said,) = without_corners(found, (field, beside))
    assert (len(kept), said.sentence) == (
        5, "4 records are the corners of plots and were left out."
    )  # fmt: skip


def test_a_record_at_its_plant_needs_no_words():
    assert on_plants(records((0.4, 0.3)), GRID) == []
    assert on_plants(records((0.4, 0.3), 1.0), GRID) == []


def test_a_record_between_everything_lies_on_no_plant_unless_its_accuracy_reaches():
    beyond = (0.0, -(GRID.xy_m[7, 1] - GRID.xy_m[:, 1].min()) - 5.0)
    (said,) = on_plants(records(beyond), GRID)
    assert said.severity == Severity.DOUBTFUL
    assert "1 record lies on no plant: 5 m from the nearest" in said.sentence
    (said,) = on_plants(records(beyond, 4.0), GRID)
    assert said.severity == Severity.SEEN
    assert "placed to 4 m while plants stand 1.5 m apart" in said.sentence


def test_places_of_a_grid_carry_the_labels_that_people_count():
    places = NamedPlaces.of((), GRID)
    numbered = plant_numbers(GRID)
    for line, number in ((1, 1), (3, 7), (6, 10)):
        (i,) = np.flatnonzero((numbered.line == line) & (numbered.number == number))
        (j,) = np.flatnonzero(
            (places.plants.row == str(line)) & (places.plants.plant == str(number))
        )
        np.testing.assert_array_equal(places.plants.lonlat[j], GRID.lonlat(np.array([i]))[0])


def test_both_faces_of_a_vine_have_one_place():
    faces = rectangle(6, 10, Planting(faces=2))
    assert len(NamedPlaces.of((), faces).plants) == 60


def test_measured_plants_keep_the_names_of_their_file():
    measured = Plants(np.zeros((2, 2)), np.array(["1", "1"]), np.array(["A", "B"]))
    assert NamedPlaces.of((), GRID, measured).plants is measured
    unnamed = Plants(np.zeros((2, 2)), np.array(["", ""]), np.array(["", ""]))
    assert len(NamedPlaces.of((), GRID, unnamed).plants) == 60


def test_a_remedy_is_printed_as_it_is_typed_and_offers_every_choice():
    remedy = Remedy("where", "species=T. urticae", "Only T. urticae", ("species=B. tabaci",))
    finding = guessed("2 species are mixed.", "species", remedy)
    assert finding.line("--record-option") == (
        "guessed: species: 2 species are mixed. "
        '(Only T. urticae: --record-option "where=species=T. urticae")'
    )
    assert remedy.choices == ("species=T. urticae", "species=B. tabaci")
    assert Remedy("date_order", "mdy", "Read month first").setting == "date_order=mdy"


@given(
    st.lists(
        st.tuples(st.floats(-0.02, 0.02), st.floats(-0.02, 0.02), st.floats(0, 2000)),
        min_size=1,
        max_size=20,
    ),
    st.sampled_from((0.0, 60.0, -75.0)),
    st.sampled_from((35.0, 179.999)),
)
def test_records_on_a_plot_are_those_that_are_measured_to_be(places, lat, lon):
    plot = Field("x", MultiPolygon([box(lon, lat, lon + 0.0005, lat + 0.0005)]))
    lonlat = np.array([(lon + dx, lat + dy) for dx, dy, _ in places])
    accuracy = np.array([a for *_, a in places])
    records = Records.of(lonlat, np.full(len(places), PRESENT), accuracy_m=accuracy)
    expected = near_plot(records, plot).inside
    np.testing.assert_array_equal(records_on_plot(records, plot).lonlat, expected.lonlat)
