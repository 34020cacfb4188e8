"""Lengths and areas: in English as the library writes them, else as the language does."""

from datetime import date

import pytest

from app.words.units import LENGTHS, UnitsInLanguage, hours, usual
from fieldmon.compute import units as library


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("value_m", [0.0, 0.25, 3.0, 999.4, 1234.5, 1609.344, 98_765.0])
def test_english_is_what_the_library_writes(length, value_m):
    own, its = UnitsInLanguage(length), library.Units(length)
    assert own.metres(value_m, 1) == its.metres(value_m, 1)
    assert own.square(1e3 * value_m) == its.square(1e3 * value_m)
    assert own.lengths() == its.lengths()
    assert own.of_library == its


def test_units_and_numbers_are_those_of_the_language(speaking):
    speaking("he")
    assert usual("he").square(12_345_000.0) == "12,345.00 דונם"
    speaking("es")
    assert UnitsInLanguage().metres(1234.5) == "1,23 km"
    assert hours(7.25) == "7,2 h"
    assert UnitsInLanguage().lengths()[0] == (0.1, "0,1 m")


def test_a_day_on_an_axis_has_no_year_and_the_order_of_the_language():
    on = date(2026, 11, 16)
    assert UnitsInLanguage().short_day(on) == "11-16"
    assert usual("he").short_day(on) == "16.11"
    assert usual("es").short_day(on) == "16/11"
