"""What knowing the weather brings: both meet the same insects, in weather of a known shape."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.studies import weather_known
from fieldmon.studies.weather_known import (
    CARRIED,
    SHAPES,
    paired_seasons,
    season_weather,
    usual_weather,
    worth_of_weather,
)


def test_a_shape_changes_its_week_and_its_wind_and_nothing_else():
    streams = RandomStreams(1)
    usual, hot, wind = (
        season_weather(SHAPES[name], streams, 20)
        for name in ("as usual", "heat wave", "steady wind")
    )
    warmer = hot.high_c - usual.high_c
    assert np.flatnonzero(warmer).tolist() == list(range(4, 11))
    assert warmer[4:11] == pytest.approx(9.0)
    assert (wind.high_c == usual.high_c).all()
    assert (wind.wind_speed_m_s == 5.0).all()
    assert usual_weather().high_c.tolist() == [28.0]


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(weather_known, "_SIDE", 20)
    weather_known._aisles.cache_clear()
    yield
    weather_known._aisles.cache_clear()


@pytest.mark.usefixtures("small")
def test_seasons_are_paired_and_the_same_again():
    one, again = (paired_seasons(CARRIED, SHAPES["heat wave"], 3, 4) for _ in range(2))
    assert (one.knows, one.averages) == (again.knows, again.averages)
    assert len(one.held) == len(one.held_by_averages) == 4
    # on the first morning nothing is known yet of the weather
    assert one.held[0] == one.held_by_averages[0]


@pytest.mark.usefixtures("small")
def test_a_pest_is_found_as_its_file_says():
    shy = replace(CARRIED, detection=0.05)
    one, other = (paired_seasons(pest, SHAPES["as usual"], 3, 3).knows for pest in (CARRIED, shy))
    assert other > one


@pytest.mark.usefixtures("small")
def test_what_it_brings_is_said_with_an_interval():
    (worth,) = worth_of_weather(range(3), ["steady wind"], n_days=3)
    assert worth.ratio.low <= worth.ratio.mean <= worth.ratio.high
    assert worth.sentence().startswith("steady wind ")
    ratio = worth.ratio
    said = f"season by season x {ratio.mean:.2f} ({ratio.low:.2f} to {ratio.high:.2f}, 95 %)"
    assert said in worth.sentence()
    with pytest.raises(SettingError, match="must be one of as usual"):
        worth_of_weather(range(1), ["hail"])
