"""Lengths, areas and dates as people are used to reading them."""

import numpy as np
import pytest

from fieldmon.compute.units import AREAS_M2, DATES, Units


def test_units_say_what_they_measure():
    feet = Units("ft", "acre", "11/16/2026")
    assert feet.metres(0.3048 * 100) == "100 ft"
    assert feet.metres(1609.344 * 2) == "2.00 mi"
    assert feet.square(4046.8564224) == "1.00 acre"
    assert feet.day("2026-11-16") == "11/16/2026"
    assert Units(area="dunam").square(1000.0) == "1.00 dunam"
    assert [Units().square(m2) for m2 in (0, 12.34, 99, 150, 903, 9996, 123456)] == [
        "0.00 ha", "12.3 m²", "99 m²", "150 m²", "903 m²", "1.00 ha", "12.35 ha",
    ]  # fmt: skip
    small = [Units(area=area).square(12.0) for area in ("dunam", "acre")]
    assert small == ["12 m²", "0.00297 acre"]


@pytest.mark.parametrize("area", AREAS_M2)
def test_an_area_is_written_to_half_a_percent(area):
    for m2 in np.logspace(0, 6, 200):
        written, unit = Units(area=area).square(m2).replace(",", "").split(" ")
        assert float(written) * (AREAS_M2 | {"m²": 1.0})[unit] == pytest.approx(m2, rel=0.00501)


def test_lengths_and_dates_are_said_in_the_chosen_way():
    assert Units().metres(1500.0) == "1.50 km"
    assert {Units(date_like=like).day("2026-11-16") for like in DATES} == set(DATES)


def test_the_scale_bar_is_round_and_fits():
    for unit, factor in (("m", 1.0), ("ft", 0.3048)):
        for room_m in (1.0, 7.0, 33.0, 480.0, 990.0):
            bar_m, text = Units(unit).bar_m(room_m)
            number = bar_m / factor
            assert number == pytest.approx(round(number))
            assert f"{number:.0f}"[0] in "125"
            assert 0.35 * room_m < bar_m <= room_m
            assert text == f"{number:.0f} {unit}"


def test_long_scale_bars_are_in_kilometres_or_miles():
    assert Units("m").bar_m(3000.0) == (2000.0, "2 km")
    assert Units("ft").bar_m(3500.0) == (2 * 1609.344, "2 mi")
    assert Units("m").bar_m(0.01) == (0.1, "0.1 m")
    for unit in ("m", "ft"):
        metres = [length_m for length_m, _ in Units(unit).lengths()]
        assert metres == sorted(metres)
