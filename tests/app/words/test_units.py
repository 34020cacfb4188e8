"""Lengths and areas: in English as the library writes them, else as the language does."""

from datetime import date

import pytest

from app.words.units import LENGTHS, UnitsInLanguage, hours, usual
from fieldmon.compute import units as library
from tests.app.driving import apart


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("value_m", [0.0, 0.25, 3.0, 999.4, 1234.5, 1609.344, 98_765.0])
def test_english_is_what_the_library_writes(length, value_m):
    own, its = UnitsInLanguage(length), library.Units(length)
    assert apart(own.metres(value_m, 1)) == its.metres(value_m, 1)
    assert apart(own.square(1e3 * value_m)) == its.square(1e3 * value_m)
    assert [(metres, apart(said)) for metres, said in own.lengths()] == its.lengths()
    assert own.of_library == its


def test_units_and_numbers_are_those_of_the_language(speaking):
    speaking("he")
    assert usual("he").square(12_345_000.0) == "12,345.00 דונם"
    speaking("es")
    assert UnitsInLanguage().metres(1234.5) == "1,23\u00a0km", "on one line"
    assert hours(7.25) == "7,2\u00a0h"
    assert UnitsInLanguage().lengths()[0] == (0.1, "0,1\u00a0m")


def test_a_day_on_an_axis_has_no_year_and_the_order_of_the_language(speaking):
    on = date(2026, 11, 6)
    assert UnitsInLanguage().short_day(on) == "6 Nov"
    assert UnitsInLanguage(date_like="11/16/2026").short_day(on) == "Nov 6"
    said = {"he": "6 בנוב׳", "ar": "6 نوفمبر", "es": "6 nov"}
    for code, day in said.items():
        speaking(code)
        assert usual(code).short_day(on) == day


def test_a_day_in_a_sentence_has_its_weekday_and_a_year_only_where_that_is_far_off(speaking):
    on = date(2026, 11, 16)
    assert UnitsInLanguage().said_day(on, date(2027, 1, 2)) == "Mon 16 Nov"
    assert UnitsInLanguage().said_day("2027-03-01", date(2026, 11, 30)) == "Mon 1 Mar 2027"
    assert UnitsInLanguage().said_day(on, date(2028, 1, 2)) == "Mon 16 Nov 2026"
    assert UnitsInLanguage(date_like="11/16/2026").said_day("2026-11-16") == "Mon Nov 16"
    said = {"he": "ב׳ 16 בנוב׳", "ar": "الاثنين 16 نوفمبر", "es": "lun 16 nov"}
    for code, day in said.items():
        speaking(code)
        assert usual(code).said_day(on) == day


def test_a_sentence_of_the_library_says_days_as_the_page_does():
    units = UnitsInLanguage(length="ft")
    said = units.in_sentences(date(2026, 11, 18))
    assert said.day("2026-11-16") == units.said_day("2026-11-16") == "Mon 16 Nov"
    assert said.day(date(2025, 1, 2)) == "Thu 2 Jan 2025"
    assert (said.length, said.area) == (units.length, units.area)
