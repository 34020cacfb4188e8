"""Coordinates are put on the earth, or asked for, but never taken for what they are not."""

import re

import numpy as np
import pyproj
import pytest
import shapely
from shapely import Point

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.options import ReadOptions
from fieldmon.io.parse.georeference import place, place_geometry

PARAN = np.array([[35.15, 30.36], [35.151, 30.361]])
NOTHING = ReadOptions()


def projected(crs, lonlat=PARAN):
    x, y = pyproj.Transformer.from_crs(4326, crs, always_xy=True).transform(*lonlat.T)
    return np.stack([x, y], axis=1)


@pytest.mark.parametrize("crs", ["EPSG:32636", "EPSG:2039", "EPSG:3857"])
def test_metres_become_degrees_with_the_system_stated_or_named(crs):
    xy = projected(crs)
    for placed in (
        place(xy, crs, NOTHING),
        place(xy, None, ReadOptions(crs=crs)),
        place(xy, "EPSG:27700", ReadOptions(crs=crs)),
    ):
        np.testing.assert_allclose(placed.lonlat, PARAN, atol=2e-8)


def test_a_system_named_by_hand_goes_before_the_stated_one_and_that_is_said():
    for stated, own in (
        ("EPSG:2039", " instead of the file's own, Israel 1993 / Israeli TM Grid."),
        ("EPSG:32636", "."),
        ("no system at all", "."),
    ):
        placed = place(projected("EPSG:32636"), stated, ReadOptions(crs="EPSG:32636"))
        said = f"The coordinate system named by hand, EPSG:32636, was used{own}"
        assert said in [str(m.sentence) for m in placed.messages]


def test_without_a_system_it_is_a_question():
    with pytest.raises(ChoiceNeeded, match="does not say") as asked:
        place(projected("EPSG:2039"), None, ReadOptions(country="Israel"))
    assert asked.value.choices[0] == "EPSG:2039"


def test_degrees_in_the_wrong_order_are_offered_to_be_exchanged():
    lonlat = np.array([[121.0, 24.0], [121.1, 24.1]])
    with pytest.raises(ChoiceNeeded, match="wrong order") as asked:
        place(lonlat[:, ::-1], "EPSG:4326", NOTHING)
    assert (asked.value.option, asked.value.choices) == ("swap_axes", ("yes",))
    exchanged = place(lonlat[:, ::-1], "EPSG:4326", ReadOptions(swap_axes=True))
    np.testing.assert_array_equal(exchanged.lonlat, lonlat)


@pytest.mark.parametrize("crs", ["EPSG:32636", "EPSG:2039"])
def test_northings_that_come_first_are_offered_to_be_exchanged(crs):
    northing_first = projected(crs)[:, ::-1]
    placed = place(northing_first, crs, NOTHING)
    (doubt,) = [one for one in placed.messages if one.severity is Severity.DOUBTFUL]
    assert "with easting and northing exchanged it lies within, at 35.15" in doubt.sentence
    assert (doubt.remedy.option, doubt.remedy.choices) == ("swap_axes", ("yes",))
    exchanged = place(northing_first, crs, NOTHING.choose("swap_axes", "yes"))
    np.testing.assert_allclose(exchanged.lonlat, PARAN, atol=2e-8)
    assert "exchanged" not in " ".join(one.sentence for one in exchanged.messages[1:])
    wrongly = place(projected(crs), crs, ReadOptions(swap_axes=True))
    (doubt,) = [one for one in wrongly.messages if one.severity is Severity.DOUBTFUL]
    assert doubt.remedy.choices == ("no",)


def test_northings_that_come_first_are_seen_by_a_place_nearby_where_their_system_fits_both_ways():
    lonlat = np.array([[-8.6, 40.6], [-8.599, 40.601]])
    northing_first = projected("EPSG:3763", lonlat)[:, ::-1]
    near = ReadOptions(near=(-8.6, 40.6))
    (doubt,) = [
        one
        for one in place(northing_first, "EPSG:3763", near).messages
        if one.severity is Severity.DOUBTFUL
    ]
    assert "with easting and northing exchanged" in doubt.sentence
    assert doubt.remedy.choices == ("yes",)
    northing_first = projected("EPSG:32636")[:, ::-1]
    with pytest.raises(ChoiceNeeded, match="wrong order") as asked:
        place(northing_first, "EPSG:32636", ReadOptions(near=(35.15, 30.36)))
    assert asked.value.option == "swap_axes"


def test_some_that_lie_nowhere_are_named_and_no_order_is_advised():
    half = np.array([[35.1, 30.3], [35.1, 303.2]])
    for xy, options in ((half, NOTHING), (half[:, ::-1], ReadOptions(swap_axes=True))):
        with pytest.raises(FileProblem, match=r"1 of 2 positions lie nowhere .*: .*303\.2"):
            place(xy, "EPSG:4326", options)


def test_metres_called_degrees_are_a_question_for_the_system():
    with pytest.raises(ChoiceNeeded, match="are no degrees") as asked:
        place(projected("EPSG:2039"), "EPSG:4326", ReadOptions(near=(35.1, 30.3)))
    assert asked.value.choices[0] == "EPSG:2039"


@pytest.mark.parametrize("crs", ["EPSG:32632", "EPSG:31467", "EPSG:3857"])
def test_degrees_called_metres_are_a_question_for_the_system(crs):
    degrees = np.array([(8.0, 49.5), (8.001, 49.501)])
    with pytest.raises(ChoiceNeeded, match="but its coordinates look like degrees") as asked:
        place(degrees, crs, ReadOptions())
    assert (asked.value.option, asked.value.choices[0]) == ("crs", "EPSG:4326")
    # metres so near to the middle of a grid that lies on land
    assert place(degrees, "EPSG:3763", ReadOptions()).lonlat[0, 1] == pytest.approx(39.67, abs=0.01)


def test_a_zone_number_before_the_eastings_is_taken_off_and_said():
    xy = projected("EPSG:32636") + np.array([36e6, 0.0])
    placed = place(xy, "EPSG:32636", NOTHING)
    np.testing.assert_allclose(placed.lonlat, PARAN, atol=1e-8)
    assert any("zone number 36" in m.sentence for m in placed.messages)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_coordinates_that_are_no_numbers_are_refused(bad):
    with pytest.raises(FileProblem, match="must be numbers"):
        place(np.array([[bad, 30.0]]), "EPSG:4326", NOTHING)


def test_coordinates_where_the_system_does_not_reach_are_refused():
    with pytest.raises(FileProblem, match="is defined"):
        place(np.array([[1e12, 1e12]]), "EPSG:32636", NOTHING)


def test_what_lies_far_from_the_place_named_is_doubtful_and_a_swap_is_offered():
    near = ReadOptions(near=(35.15, 30.36))
    assert not place(PARAN, "EPSG:4326", near).messages
    (said,) = place(PARAN[:, ::-1], "EPSG:4326", near).messages
    assert (said.severity, said.remedy.option) == (Severity.DOUBTFUL, "swap_axes")
    (far,) = place(PARAN + np.array([2.0, 0.0]), "EPSG:4326", near).messages
    assert far.remedy is None
    assert "km from the plot or place nearby" in far.sentence


def test_of_a_utm_zone_that_is_not_that_of_the_place_the_right_one_is_offered():
    near = ReadOptions(near=(35.15, 30.36))
    placed = place(projected("EPSG:32636"), "EPSG:32635", near)
    (said,) = (one for one in placed.messages if one.severity is Severity.DOUBTFUL)
    assert re.search(r"It lies 57\d km .* but \d km from it in UTM zone 36N\.", said.sentence)
    assert said.remedy.setting == "crs=EPSG:32636"


@pytest.mark.parametrize(("decimals", "step_m"), [(3, 111.32), (5, 1.1132), (0, 111_320.0)])
def test_the_step_of_rounding_is_that_of_all_coordinates(decimals, step_m):
    rounded = np.round(PARAN + 0.00012345, decimals)
    assert place(rounded, "EPSG:4326", NOTHING).step_m == pytest.approx(step_m)


def test_coordinates_that_are_not_rounded_have_no_step():
    rough = PARAN + np.random.default_rng(1).random(PARAN.shape) * 1e-3
    assert place(rough, "EPSG:4326", NOTHING).step_m < 1e-3


def test_geometries_move_as_their_coordinates_do_and_stay_what_they_are():
    shapes = np.array([Point(x, y).buffer(50.0) for x, y in projected("EPSG:32636")], object)
    moved, messages = place_geometry(shapes, "EPSG:32636", NOTHING)
    centres = shapely.get_coordinates(shapely.centroid(moved))
    np.testing.assert_allclose(centres, PARAN, atol=1e-7)
    assert [shape.geom_type for shape in moved] == ["Polygon", "Polygon"]
    assert messages
    assert shapely.get_coordinates(shapes[0]).max() > 1e5


def test_which_coordinate_is_the_easting_is_said_where_either_may_be():
    xy = projected("EPSG:27700", np.array([[-1.8, 53.0]]))
    (said,) = (m for m in place(xy, "EPSG:27700", NOTHING).messages if "come first" in m.sentence)
    assert said.severity is Severity.GUESSED
    assert said.sentence.startswith("Eastings were taken to come first: it lies at -1.8000, 53.00")
    assert "With northings first it would lie at -2.8365, 53.6153, where" in said.sentence
    assert said.remedy.setting == "swap_axes=yes"
    for near_or_not, lonlat, crs in (
        (ReadOptions(near=(-1.8, 53.0)), [-1.8, 53.0], "EPSG:27700"),
        (NOTHING, [-5.2, 50.2], "EPSG:27700"),  # the other way it lies in the sea
        (NOTHING, [35.15, 30.36], "EPSG:32636"),
        (NOTHING, [35.15, 30.36], "EPSG:3857"),
    ):
        placed = place(projected(crs, np.array([lonlat])), crs, near_or_not)
        assert "northings first" not in " ".join(m.sentence for m in placed.messages)


def test_negative_northings_of_a_northern_zone_are_said_with_the_southern_zone():
    south = np.array([[18.9, -33.9], [18.901, -33.901]])
    placed = place(projected("EPSG:32634", south), "EPSG:32634", NOTHING)
    np.testing.assert_allclose(placed.lonlat, south, atol=1e-7)
    (said,) = (one for one in placed.messages if "south of the equator" in one.sentence)
    assert "WGS 84 / UTM zone 34S is the usual system" in said.sentence
    assert said.remedy is None
    away = np.array([[28.9, -33.9], [28.901, -33.901]])
    told = place(projected("EPSG:32634", away), "EPSG:32634", NOTHING).messages
    assert not any("south of the equator" in one.sentence for one in told)
