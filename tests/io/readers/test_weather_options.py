"""What is chosen about weather is checked when it is chosen."""

from datetime import datetime

import pytest
from shapely import MultiPolygon, box

from fieldmon.errors import SettingError
from fieldmon.io.readers.weather_options import WeatherOptions
from fieldmon.plot.field import Field


def test_units_and_zones_that_are_none_are_refused():
    with pytest.raises(SettingError, match="must be m/s, km/h, mph or kn, but it is 'C'"):
        WeatherOptions(wind_unit="C")
    with pytest.raises(SettingError, match="time zone must be named"):
        WeatherOptions(zone="Mars/Olympus")
    with pytest.raises(SettingError, match=r"The time now must be .* but it is 'soon'"):
        WeatherOptions(now="soon")
    with pytest.raises(SettingError, match="Rain must be each or running, but it is 'total'"):
        WeatherOptions(rain_is="total")
    assert WeatherOptions(now="2026-11-18").now == datetime(2026, 11, 18)
    assert WeatherOptions().choose("rain_unit", "in").unit("rain") == "in"


def test_days_begin_by_the_plots_clock_unless_another_is_told():
    field = Field("square", MultiPolygon([box(35.15, 30.36, 35.151, 30.361)]))
    assert WeatherOptions().on(field).zone == "Asia/Jerusalem"
    assert WeatherOptions(zone="UTC").on(field).zone == "UTC"
