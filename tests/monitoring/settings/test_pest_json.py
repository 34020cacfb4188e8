"""A pest and its weather come out of a season's settings as they went in."""

import json

import numpy as np
import pytest

from fieldmon.io.packaged import pest_names
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.settings.pest_json import (
    kept_weather,
    pest_json,
    pest_of_json,
    weather_json,
    weather_of_json,
)
from fieldmon.pests.weather import HOUR_S, weather_of


@pytest.mark.parametrize("name", pest_names())
def test_a_pest_comes_out_as_it_went_in(name):
    pest = shipped_pest(name)
    assert pest_of_json(json.loads(json.dumps(pest_json(pest)))) == pest


def test_weather_comes_out_as_it_went_in_to_a_hundredth():
    at = np.datetime64("2026-11-18", "s") + 3600 * np.arange(4)
    weather = weather_of(
        at, HOUR_S, "Asia/Jerusalem", temperature_c=np.array([1.234, np.nan, 3, 4]),
        wind_from_deg=np.array([0.0, 90, 180, np.nan]), forecast=np.array([0, 0, 1, 1]),
    )  # fmt: skip
    back = weather_of_json(json.loads(json.dumps(weather_json(weather))))
    assert np.allclose(back.temperature_c, [1.23, np.nan, 3, 4], equal_nan=True)
    assert np.allclose(back.wind_from_deg, weather.wind_from_deg, equal_nan=True)
    assert np.isnan(back.rain_mm).all()
    assert (back.at == weather.at).all()
    assert (back.zone, back.step_s) == ("Asia/Jerusalem", HOUR_S)
    assert back.forecast.tolist() == [False, False, True, True]


def test_none_stays_none_and_the_same_text_is_read_once():
    assert pest_of_json(pest_json(None)) is None
    assert kept_weather("null") is None
    at = np.datetime64("2026-11-18", "s") + 3600 * np.arange(2)
    text = json.dumps(weather_json(weather_of(at, HOUR_S, temperature_c=np.array([1.0, 2]))))
    assert kept_weather(text) is kept_weather(text)
