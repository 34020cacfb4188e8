"""What is ahead, in a sentence with its interval, and the weather that it is made from."""

from types import SimpleNamespace

import numpy as np
import pytest
import streamlit as st

from app.show import forecast
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.infestation.forecast import Forecast

DAYS = np.linspace(10.0, 40.0, 15)


@pytest.fixture
def shown(monkeypatch):
    """Return what is shown of a forecast."""

    def show(weather, measured=0):
        lines, made = [], Forecast(DAYS, DAYS // 2, DAYS * 3, weather, measured)
        monkeypatch.setattr(st, "markdown", lines.append)
        monkeypatch.setattr(st, "caption", lines.append)
        monkeypatch.setattr(st, "altair_chart", lambda chart, **_: lines.append(chart.to_dict()))
        monkeypatch.setattr(forecast.chosen_day, "forecast", lambda _: made)
        forecast.show(SimpleNamespace(day="2026-12-25", units=UnitsInLanguage()))
        return lines[1:]

    return show


def test_the_last_morning_is_said_with_its_interval_and_drawn_by_date(shown):
    chart, said, _ = shown(None)
    assert said == (
        "About 40 plants are infested after 14 nights without inspections (20 to 120 with a "
        "chance of 90\u00a0%); now it is about 10."
    )
    (rows,) = chart["datasets"].values()
    assert (rows[0]["day"], rows[-1]["day"]) == ("25 Dec", "8 Jan")


@pytest.mark.parametrize(
    ("weather", "measured", "said"),
    [
        (None, 0, texts.AHEAD_BASIS["none"]),
        (14, 0, texts.AHEAD_BASIS["forecast"]),
        (14, 14, texts.AHEAD_BASIS["measured"]),
        (0, 0, texts.AHEAD_BASIS["usual"]),
        (5, 0, texts.AHEAD_BASIS["partly"].format(n="5")),
        (5, 5, texts.AHEAD_BASIS["partly_measured"].format(measured="5")),
        (5, 3, texts.AHEAD_BASIS["both"].format(measured="3", n="2")),
        (14, 3, texts.AHEAD_BASIS["both_all"].format(measured="3", n="11")),
    ],
)
def test_the_weather_that_it_is_made_from_is_said(shown, weather, measured, said):
    assert shown(weather, measured)[-1] == said
