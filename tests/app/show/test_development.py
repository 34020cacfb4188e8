"""A season's page draws the warmth gathered against the pest's stages."""

from datetime import date
from types import SimpleNamespace

import numpy as np
import pytest
import streamlit as st

from app.show import development
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.pests.development import development as developed
from fieldmon.pests.weather import DAY_S, weather_of

BEGINS, ON = date(2026, 11, 1), date(2026, 11, 10)
MITE = shipped_pest("spider-mite")


def weather(temperature_c, n=12):
    at = np.datetime64(BEGINS, "D") + np.arange(n)
    return weather_of(
        at.astype("datetime64[s]"), DAY_S, temperature_c=np.full(n, float(temperature_c))
    )


def shown(pest, met, on=ON):
    there = None if met is None else developed(pest, met, BEGINS, on)
    settings = SimpleNamespace(pest=pest, weather=met)
    season = SimpleNamespace(settings=settings, development=lambda _: there)
    return SimpleNamespace(open_season=season, on=on, units=UnitsInLanguage())


@pytest.fixture
def said(monkeypatch):
    """Collect what is shown, charts as their specifications."""
    lines = []
    for way in ("markdown", "caption"):
        monkeypatch.setattr(st, way, lines.append)
    monkeypatch.setattr(st, "altair_chart", lambda made, alt: lines.append((alt, made.to_dict())))
    return lines


def test_the_next_generation_and_the_line_against_its_stages_are_shown(said):
    development.show(shown(MITE, weather(22.5)))
    title, sentence, (alt, chart), *notes = said
    assert "Two-spotted spider mite" in title
    assert sentence.startswith("**Next generation around 15 Nov.** 100 degree-days above")
    assert alt == texts.DEGREE_DAYS
    rows = [row for data in chart["datasets"].values() for row in data]
    marks = {row["name"]: row["gathered"] for row in rows if "name" in row}
    assert list(marks) == ["egg", "larva", "protonymph", "generation 1"]
    assert marks["generation 1"] == pytest.approx(146.48)
    # an egg's part of the generation is that of its own degree-days
    assert marks["egg"] == pytest.approx(146.48 * 63.35 / 147.28)
    # the weather ends on the 12th: from then on the line is dashed
    assert sum(bool(row.get("guessed")) for row in rows) > 0
    assert texts.DEVELOPMENT_NOTE in notes


def test_days_filled_in_are_counted(said):
    gap = weather(22.5, 4)
    development.show(shown(MITE, gap))
    assert any("6 of the days so far are filled in" in str(line) for line in said)


def test_cold_no_weather_and_no_stages_are_each_told(said):
    development.show(shown(MITE, weather(5)))
    assert texts.NO_GENERATION in said[1]
    said.clear()
    development.show(shown(MITE, None))
    assert said[-1] == texts.NEEDS_WEATHER
    said.clear()
    development.show(shown(shipped_pest("plum-pox-virus"), weather(20)))
    assert said[-1] == texts.NO_DEVELOPMENT
    said.clear()
    development.show(shown(None, None))
    assert said == []
