"""Coordinate systems: named, guessed from where data would land, and turned into degrees."""

import re

import numpy as np
import pyproj
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.options import ReadOptions
from fieldmon.io.parse.crs import (
    ask_for_crs,
    candidates,
    code_of,
    km_between,
    system,
    transformation_from,
    utm_zone,
)

PARAN = (35.15, 30.36)
ITM = (207_000.0, 470_000.0)  # about Paran, new Israeli grid


@pytest.mark.parametrize(
    ("text", "code"), [("EPSG:2039", "EPSG:2039"), ("2039", "EPSG:2039"), ("WGS84", "EPSG:4326")]
)
def test_a_system_is_named_by_its_code_or_its_name(text, code):
    assert code_of(system(text)) == code


def test_metres_from_the_middle_of_the_earth_are_refused():
    with pytest.raises(FileProblem, match=r"WGS 84 counts metres from the middle.*EPSG:4326"):
        transformation_from(system("EPSG:4978"), (4_500_000.0, 3_200_000.0))


@pytest.mark.parametrize("text", ["EPSG:999999", "somewhere", "x" * 200])
def test_an_unknown_system_is_a_question(text):
    with pytest.raises(ChoiceNeeded, match="EPSG:2039") as asked:
        system(text)
    assert asked.value.option == "crs"
    assert len(str(asked.value)) < 200


def test_degrees_of_wgs84_stay_as_they_are_and_nothing_is_said():
    for name in ("EPSG:4326", "OGC:CRS84"):
        way = transformation_from(system(name), PARAN)
        xy = np.array([PARAN])
        assert way.lonlat(xy) is xy
        assert way.messages() == []


@given(st.floats(34.3, 35.8), st.floats(29.6, 33.2))
def test_a_grid_of_metres_lands_where_proj_says_and_its_accuracy_is_told(lon, lat):
    crs = system("EPSG:32636")
    xy = pyproj.Transformer.from_crs(4326, crs, always_xy=True).transform(lon, lat)
    way = transformation_from(crs, xy)
    assert way.lonlat(np.array([xy]))[0] == pytest.approx((lon, lat), abs=1e-9)
    (said,) = way.messages()
    assert "UTM zone 36N (EPSG:32636)" in said.sentence
    assert said.severity in {Severity.SEEN, Severity.DOUBTFUL}


@pytest.mark.parametrize(
    ("code", "at", "first"),
    [
        (27700, (451_000.0, 291_000.0), "EPSG:27700"),
        (31370, (150_000.0, 170_000.0), "EPSG:31370"),
        (28992, (155_000.0, 463_000.0), "EPSG:28992"),
        (23030, (500_000.0, 4_500_000.0), "EPSG:23030"),
        (4314, (9.0, 50.0), None),
    ],
)
def test_a_datum_without_a_known_name_is_doubted_with_the_systems_that_project_alike(
    code, at, first
):
    known = pyproj.CRS(code).to_wkt("WKT1_ESRI")
    nameless = re.sub(r'(PROJCS|GEOGCS|DATUM)\["[^"]+"', r'\1["unknown"', known)
    (said,) = transformation_from(system(nameless), at).messages()
    assert said.severity is Severity.DOUBTFUL
    assert "some 100 m beside" in said.sentence
    if first is None:
        assert "crs=EPSG:2039" in said.sentence
        assert said.remedy is None
    else:
        assert (said.remedy.option, said.remedy.value) == ("crs", first)


@pytest.mark.parametrize(("code", "at"), [(2039, ITM), (28992, (155_000.0, 463_000.0))])
def test_a_nameless_grid_left_with_wgs84_as_its_datum_is_doubted_as_those_of_mapinfo(code, at):
    grid = pyproj.CRS(code)
    left = pyproj.crs.ProjectedCRS(grid.coordinate_operation, "unnamed").to_wkt()
    (said,) = transformation_from(system(left), at).messages()
    assert said.severity is Severity.DOUBTFUL
    assert f"EPSG:{code} ({grid.name})" in said.sentence


def test_a_grid_of_ones_own_on_wgs84_is_not_doubted():
    own = pyproj.CRS("+proj=tmerc +lat_0=30.3 +lon_0=35.1 +k=1 +x_0=1000 +y_0=1000 +datum=WGS84")
    (said,) = transformation_from(own, (1000.0, 1000.0)).messages()
    assert said.severity is Severity.SEEN


def test_the_height_of_a_compound_system_is_left_aside():
    assert transformation_from(system("EPSG:4326+5773"), PARAN).transformer is None


def test_a_way_is_looked_for_once_for_the_same_data():
    found = transformation_from(system("EPSG:2039"), ITM)
    assert transformation_from(system("2039"), ITM) is found
    assert transformation_from(system("EPSG:2039"), (ITM[0], 600_000.0)) is not found


def test_candidates_near_a_place_are_sorted_by_how_near_they_bring_the_data():
    found = candidates(ITM, near=(35.1, 30.3))
    assert found[0].code == "EPSG:2039"
    assert [c.km_away for c in found] == sorted(c.km_away for c in found)
    for one in found:
        assert one.km_away == pytest.approx(km_between((35.1, 30.3), (one.lon, one.lat)))


def test_candidates_of_a_country_are_systems_used_there():
    codes = [c.code for c in candidates(ITM, country="Israel")]
    assert codes[0] == "EPSG:2039"
    assert "EPSG:27700" not in codes


def test_systems_that_bring_the_data_into_the_open_sea_come_last():
    gauss_krueger_3 = (3_427_751.0, 5_485_275.0)
    assert candidates(gauss_krueger_3)[0].code == "EPSG:31467"
    question = ask_for_crs(np.array([gauss_krueger_3]), ReadOptions(), "It does not say.")
    assert "near=LON,LAT" in str(question)


def test_small_numbers_may_be_degrees():
    assert candidates(PARAN)[0].code == "EPSG:4326"


def test_a_zone_number_before_the_easting_is_understood():
    found = candidates((32_500_000.0, 5_500_000.0), near=(9.0, 49.6))
    assert any(c.code in {"EPSG:25832", "EPSG:4647"} for c in found)


def test_the_question_says_where_the_data_would_lie():
    question = ask_for_crs(np.array([ITM]), ReadOptions(near=(35.1, 30.3)), "It does not say.")
    assert (question.option, question.choices[0]) == ("crs", "EPSG:2039")
    assert "It does not say. The coordinates are around 207000, 470000." in str(question)
    assert "km from the plot or place nearby" in str(question)


def test_what_fits_no_usual_system_is_said():
    question = ask_for_crs(np.array([[1e12, 1e12]]), ReadOptions(), "It does not say.")
    assert question.choices == ()
    assert "none of the usual ones fits" in str(question)


def test_the_zone_of_a_utm_system_is_its_number():
    assert utm_zone(system("EPSG:32636")) == 36
    assert utm_zone(system("EPSG:2039")) is None


def test_kilometres_are_geodesic():
    assert km_between(PARAN, (35.15, 31.36)) == pytest.approx(110.86, abs=0.05)
