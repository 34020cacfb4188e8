"""Units of weather are stated, told by values, or asked for; one of something else is refused."""

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.readers.weather_options import WeatherOptions
from tests.io.readers.test_weather import said


@pytest.fixture
def read(read_weather):
    return read_weather


def test_a_wind_without_a_unit_is_left_out_and_told(read):
    imported = read("date,temp,wind\n2026-11-18,20,12\n2026-11-19,21,9")
    assert np.isnan(imported.value.wind_speed_m_s).all()
    assert "wind has no unit" in said(imported)
    assert "wind_unit=km/h" in said(imported)
    told = WeatherOptions(wind_unit="km/h")
    again = read("date,temp,wind\n2026-11-18,20,36\n2026-11-19,21,9", told)
    assert again.value.wind_speed_m_s[0] == pytest.approx(10)


def test_temperatures_without_a_unit_tell_it_or_are_asked_for(read):
    cool = read("date,temp\n2026-11-18,12\n2026-11-19,14")
    assert "read as Celsius" in said(cool)
    warm = read("date,temp\n2026-11-18,72\n2026-11-19,50")
    assert "read as Fahrenheit" in said(warm)
    assert warm.value.temperature_c[1] == pytest.approx(10)
    with pytest.raises(ChoiceNeeded, match="Celsius or Fahrenheit") as asked:
        read("date,temp\n2026-11-18,52\n2026-11-19,44")
    assert asked.value.option == "temperature_unit"
    kept = read("date,temp\n2026-11-18,50\n2026-11-19,41", WeatherOptions(temperature_unit="F"))
    assert kept.value.temperature_c.tolist() == pytest.approx([10, 5])


def test_a_chosen_unit_that_the_file_contradicts_is_said(read):
    table = "date,temp (C),wind (km/h)\n2026-11-18,12,36\n2026-11-19,14,36"
    kelvin = read(table, WeatherOptions(temperature_unit="K", wind_unit="kn"))
    assert "temp (C) was read in 'c', its own unit, and not in 'k'" in said(kelvin)
    assert "wind (km/h) was read in 'km/h', its own unit, and not in 'kn'" in said(kelvin)
    assert kelvin.value.temperature_c.tolist() == [12, 14]
    agreed = read(table, WeatherOptions(temperature_unit="C", wind_unit="km/h", rain_unit="in"))
    assert "its own unit" not in said(agreed)


def test_all_temperatures_without_a_unit_tell_it_together(read):
    """Lows of 4 to 13 °F were Celsius beside highs of 45 to 62 °F."""
    rows = "\n".join(f"2026-01-{day},{day - 10},{day + 42}" for day in range(14, 22))
    imported = read(f"date,Tmin,Tmax\n{rows}")
    assert "Tmin, Tmax have no unit; read as Fahrenheit, for Tmax goes up to 63" in said(imported)
    assert imported.value.low_c[0] == pytest.approx((4 - 32) / 1.8)
    with pytest.raises(ChoiceNeeded, match="Tmin, Tmax have no unit, and what they hold could be"):
        read("date,Tmin,Tmax\n2026-01-14,31,52\n2026-01-15,30,51")
    with pytest.raises(FileProblem, match="Temp and Tmax must be in one unit, but as Fahrenheit"):
        read("date,Temp,Tmax\n2026-07-14,20,77\n2026-07-15,21,78")


@pytest.mark.parametrize(
    ("header", "sentence"),
    [("Temperature (mm)", "must be in C, F or K, but its unit is 'mm'"),
     ("Temp (hPa)", "its unit is 'hpa'"), ("air temp (bananas)", "its unit is 'bananas'")],
)  # fmt: skip
def test_a_unit_of_something_else_is_refused(read, header, sentence):
    with pytest.raises(FileProblem, match=sentence):
        read(f"date,{header}\n2026-11-18,20\n2026-11-19,20")


def test_temperatures_in_tenths_are_asked_for_and_read(read):
    table = "date,temp\n2026-11-18,215\n2026-11-19,-35\n2026-11-20,199"
    with pytest.raises(ChoiceNeeded, match="goes up to 215, which is neither") as asked:
        read(table)
    assert (asked.value.option, asked.value.choices[0]) == ("temperature_unit", "0.1 C")
    told = read(table, WeatherOptions(temperature_unit="0.1 C")).value
    assert told.temperature_c.tolist() == pytest.approx([21.5, -3.5, 19.9])
    named = read(table.replace("temp", "temp (0.1 °F)")).value
    assert named.temperature_c[0] == pytest.approx(-5.833333)
    # a single broken value makes no file one in Fahrenheit
    days = "\n".join(f"2026-10-{day:02d},20" for day in range(1, 31))
    assert "1 value of temperature_c is impossible" in said(
        read(f"date,temp\n{days}\n2026-10-31,215")
    )


def test_kelvin_is_named_first_where_all_of_a_year_would_be_warm_in_tenths(read):
    # the highest of all is said, though it alone would not be believed
    days = "\n".join(f"2026-10-{day:02d},{291 + day % 5}" for day in range(1, 31))
    table = f"date,temp\n2026-09-30,297.5\n{days}"
    with pytest.raises(
        ChoiceNeeded, match=r"no unit and goes up to 297\.5, as temperatures in Kelvin do"
    ) as asked:
        read(table)
    assert asked.value.choices == ("K", "0.1 C", "0.1 F")
    told = read(table, WeatherOptions(temperature_unit="K")).value
    assert told.temperature_c[0] == pytest.approx(24.35)
