"""IPM Decisions' weather is read as its schema has it."""

import json
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.options import Upload
from fieldmon.io.readers.weather import weather_in
from fieldmon.io.readers.weather_json import is_weather_json
from fieldmon.io.readers.weather_options import WeatherOptions
from fieldmon.io.sandbox.workroom import Workroom

#: the first hours of the example in which a service's own documentation shows its answers
EXAMPLE = {
    "timeStart": "2020-04-30T22:00:00Z",
    "timeEnd": "2020-05-01T01:00:00Z",
    "interval": 3600,
    "weatherParameters": [1002, 2001, 3002, 3101],
    "locationWeatherData": [
        {
            "longitude": 10.781989,
            "latitude": 59.660468,
            "altitude": 94,
            "data": [[1.659, 0.2, 90.5, 60], [1.16, 0.4, 91.5, 60], [None, 0.2, 92.4, 60],
                     [0.478, 0.2, 93.2, 60]],
            "qc": [1, 1, 1, 1],
            "length": 4,
            "width": 4,
        }
    ],
}  # fmt: skip


@pytest.fixture
def read(tmp_path):
    def _read(told, **chosen):
        options = WeatherOptions(zone="Europe/Oslo", **chosen)
        data = told if isinstance(told, bytes) else json.dumps(told).encode()
        return weather_in(
            Upload("weather.json", data), options, Workroom(Path(mkdtemp(dir=tmp_path)))
        )

    return _read


def test_the_platforms_own_example_is_read(read):
    weather = read(EXAMPLE).value
    assert weather.at[0] == np.datetime64("2020-04-30T22:00:00")
    assert weather.temperature_c[[0, 1, 3]].tolist() == [1.659, 1.16, 0.478]
    assert weather.rain_mm.tolist() == [0.2, 0.4, 0.2, 0.2]
    assert weather.humidity_pct[0] == 90.5
    assert weather.gaps == 1
    # midnight in Oslo
    assert weather.local_days()[0] == np.datetime64("2020-05-01")


def test_days_with_extremes_and_wind_at_ten_metres_are_read(read):
    days = EXAMPLE | {"interval": 86_400, "weatherParameters": [1003, 1004, 4013, 4011]}
    place = EXAMPLE["locationWeatherData"][0] | {"data": [[2, 9, 3.5, 270], [1, 8, 4, 90]]}
    weather = read(days | {"locationWeatherData": [place]}).value
    assert not weather.hourly
    assert (weather.low_c[0], weather.high_c[0], weather.temperature_c[0]) == (2, 9, 5.5)
    assert (weather.wind_speed_m_s[0], weather.wind_from_deg[0]) == (3.5, 270)


def test_several_places_are_asked_for(read):
    places = EXAMPLE["locationWeatherData"] * 2
    with pytest.raises(ChoiceNeeded, match="2 places") as asked:
        read(EXAMPLE | {"locationWeatherData": places})
    assert asked.value.option == "location"


def test_one_of_several_places_is_taken_when_named(read):
    places = EXAMPLE["locationWeatherData"] * 2
    assert len(read(EXAMPLE | {"locationWeatherData": places}, location="2").value) == 4


def test_failed_quality_control_is_told(read):
    place = EXAMPLE["locationWeatherData"][0] | {"qc": [24, 1, 2, 0]}
    imported = read(EXAMPLE | {"locationWeatherData": [place]})
    assert "quality control doubts the parameters 1002" in str(imported.messages[0])


@pytest.mark.parametrize(
    "broken",
    [{"timeStart": "yesterday"}, {"interval": 0}, {"interval": -3600}, {"interval": 1e300},
     {"interval": "often"}, {"weatherParameters": [1, 2]},
     {"locationWeatherData": None}, {"locationWeatherData": [{"data": [[1]]}]},
     # twice as many hours of one parameter each they are not
     {"locationWeatherData": [{"data": [[1, 2, 3, 4, 5, 6, 7, 8]]}]}],
)  # fmt: skip
def test_what_is_not_of_the_format_is_refused_with_a_sentence(read, broken):
    with pytest.raises(FileProblem, match=r"must (be|hold)"):
        read(EXAMPLE | broken)


def test_the_format_is_known_by_its_first_bytes():
    assert is_weather_json(json.dumps(EXAMPLE).encode())
    assert not is_weather_json(b'{"type": "FeatureCollection"}')
    assert not is_weather_json(b"date,temp\n")
