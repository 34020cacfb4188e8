"""Degrees as people write them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.io.parse.degrees import all_degrees, degrees, hemispheres, positions_in_cells
from tests.io.tables_of_cells import cells


@given(st.integers(0, 179), st.integers(0, 59), st.floats(0.0, 59.99), st.sampled_from("NSEW"))
def test_degrees_minutes_and_seconds_are_sixtieths(whole, minutes, seconds, letter):
    sign = -1 if letter in "SW" else 1
    value = sign * (whole + minutes / 60 + round(seconds, 2) / 3600)
    for cell in (
        f"{whole}°{minutes}'{seconds:.2f}\"{letter}",
        f"{letter} {whole} {minutes} {seconds:.2f}",
        f"{whole}:{minutes}:{seconds:.2f} {letter}",
    ):
        assert degrees(cell) == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize(
    ("cell", "value"),
    [("30.5", 30.5), ("-30,5", -30.5), ("30.5°", 30.5), ("S 31.25", -31.25), ("-7°30'", -7.5)],
)
def test_decimal_degrees_are_read_with_signs_and_letters(cell, value):
    assert degrees(cell, "," if "," in cell else ".") == value


@pytest.mark.parametrize("cell", ["30°61'0\"", "30°0'75\"", "07.16.5046", "30 15.5 30", "O 7", ""])
def test_what_is_no_coordinate_is_not_guessed(cell):
    assert np.isnan(degrees(cell))


def test_a_column_of_coordinates_may_mix_what_people_write():
    read = all_degrees(cells("30°30'", "30.25", None, "x"))
    np.testing.assert_array_equal(read, [30.5, 30.25, np.nan, np.nan])
    assert hemispheres(["N 30", "35 E", "12"]) == {"N", "E"}
    assert hemispheres(["lon", "north", "east", "S", "N -"]) == set()


@pytest.mark.parametrize(
    ("cell", "lonlat", "is_certain"),
    [
        ("30.36, 35.15", (35.15, 30.36), False),
        ("N 30.36 E 35.15", (35.15, 30.36), True),
        ("E35,15; N30,36", (35.15, 30.36), True),
        ("POINT (35.15 30.36)", (35.15, 30.36), True),
        ("30°21'36\"N 35°9'0\"E", (35.15, 30.36), True),
        ("30.36 35.15", (35.15, 30.36), False),
    ],
)
def test_two_coordinates_in_a_cell_are_told_apart_where_they_can_be(cell, lonlat, is_certain):
    read = positions_in_cells([cell])
    assert read.values[0] == pytest.approx(lonlat)
    assert read.is_certain == is_certain


def test_a_first_number_beyond_90_settles_the_order_of_all_cells():
    read = positions_in_cells(["30.0, 35.0", "120.5, 36.0", "nothing"])
    assert read.values[:2].tolist() == [[30.0, 35.0], [120.5, 36.0]]
    assert read.is_certain
    assert np.isnan(read.values[2]).all()
