"""Weather is hours or days that nobody can change, by the clock of their place."""

from datetime import date

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.pests.weather import DAY_S, HOUR_S, weather_of


def hours(first, n):
    return np.datetime64(first, "s") + 3600 * np.arange(n)


def test_days_begin_by_the_clock_of_the_place():
    weather = weather_of(
        hours("2026-11-17T21:00", 26), HOUR_S, "Asia/Jerusalem", temperature_c=np.arange(26.0)
    )
    by_day = dict(weather.by_day())
    assert [*by_day] == [date(2026, 11, 17), date(2026, 11, 18), date(2026, 11, 19)]
    assert by_day[date(2026, 11, 18)].temperature_c.tolist() == list(range(1, 25))


def test_gaps_count_what_is_missing_between_the_first_and_the_last():
    known = np.array([1.0, np.nan, np.nan, 4.0, np.nan])
    assert weather_of(hours("2026-11-18", 5), HOUR_S, temperature_c=known).gaps == 2
    assert weather_of(hours("2026-11-18", 2), HOUR_S).gaps == 0


def test_a_day_of_extremes_has_their_middle_as_its_mean():
    weather = weather_of(
        hours("2026-11-18", 1), DAY_S, low_c=np.array([4.0]), high_c=np.array([10.0])
    )
    assert weather.temperature_c.tolist() == [7.0]
    assert np.isnan(weather.rain_mm).all()


def test_a_part_is_what_begins_in_it():
    weather = weather_of(hours("2026-11-18", 5), HOUR_S, temperature_c=np.arange(5.0))
    part = weather.between(np.datetime64("2026-11-18T01"), np.datetime64("2026-11-18T03"))
    assert part.temperature_c.tolist() == [1.0, 2.0]
    assert (len(part), part.hourly, repr(part)) == (
        2, True, "Weather(2 hours from 2026-11-18T01:00:00 UTC)"
    )  # fmt: skip


def test_nobody_changes_weather_that_was():
    given = np.arange(3.0)
    weather = weather_of(hours("2026-11-18", 3), HOUR_S, temperature_c=given)
    given[:] = 99
    assert weather.temperature_c.tolist() == [0.0, 1.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        weather.temperature_c[0] = 99


def test_arrays_of_other_lengths_and_steps_are_refused():
    with pytest.raises(SettingError, match="one temperature_c for each of its 3 times"):
        weather_of(hours("2026-11-18", 3), HOUR_S, temperature_c=np.arange(2.0))
    with pytest.raises(SettingError, match="by hours or days"):
        weather_of(hours("2026-11-18", 3), 1800)


def test_each_entry_has_a_time_of_its_own_in_any_order():
    at = hours("2026-11-18", 3)
    assert len(weather_of(at[::-1].copy(), HOUR_S)) == 3
    with pytest.raises(SettingError, match="one entry of each time, but there are 2 of 2026-11-18"):
        weather_of(at[[0, 1, 0]], HOUR_S)
    with pytest.raises(SettingError, match="when it begins, but of 1 of 3 it does not"):
        weather_of(np.append(at[:2], np.datetime64("NaT")), HOUR_S)


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("temperature_c", 288.15, "temperature_c must be from -70 to 60, .* it is 288.15. .* unit"),
        ("high_c", 79.0, "high_c must be from -70 to 60"),
        ("low_c", -np.inf, "low_c .* it is -inf"),
        ("wind_speed_m_s", -1.0, "wind_speed_m_s must be from 0 to 100"),
        ("wind_from_deg", 400.0, "wind_from_deg must be from 0 to 360"),
        ("rain_mm", -1.0, "rain_mm must be from 0 to 2000, but at 2026-11-18T01:00:00 it is -1"),
        ("humidity_pct", 400.0, "humidity_pct must be from 0 to 100"),
    ],
)
def test_weather_that_no_place_has_is_refused_for_it_is_in_another_unit(name, value, said):
    at = hours("2026-11-18", 3)
    with pytest.raises(SettingError, match=said):
        weather_of(at, HOUR_S, **{name: np.array([np.nan, value, 5.0])})
    assert len(weather_of(at, HOUR_S, **{name: np.array([np.nan, 0.0, 60.0])})) == 3


def test_no_low_is_above_its_high():
    extremes = {"low_c": np.array([9.0, 21.0]), "high_c": np.array([np.nan, 20.0])}
    with pytest.raises(SettingError, match="at 2026-11-18T01:00:00 they are 21 and 20"):
        weather_of(hours("2026-11-18", 2), HOUR_S, **extremes)
