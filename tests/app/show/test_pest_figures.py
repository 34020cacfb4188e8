"""A pest's figures are shown with their sources, whoever wrote its file."""

from dataclasses import replace

import pytest
import streamlit as st

from app.show import pest_figures
from app.words import language, texts
from fieldmon.io.packaged import pest_names
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.pests.pest import Citation, Movement, Pest, Stage
from tests.app.test_hostile_texts import LEADS, NAMES


@pytest.fixture
def said(monkeypatch):
    """Collect what is shown."""
    lines = []
    for way in ("markdown", "caption"):
        monkeypatch.setattr(st, way, lines.append)
    monkeypatch.setattr(st, "dataframe", lambda table, **_: lines.append(table.to_csv()))
    return lines


@pytest.mark.parametrize("name", pest_names())
def test_every_pest_that_comes_along_has_words_of_the_page_in_each_language(name, said):
    pest = shipped_pest(name)
    names = [stage.name for stage in pest.stages]
    for code in language.LANGUAGES:
        language.use(code)
        told = [pest_figures.title(pest), *map(pest_figures.stage_name, names)]
        assert (told == [pest.title, *names]) is (code == language.ENGLISH)
        assert "English" not in "".join(told)
    language.use(language.ENGLISH)
    pest_figures.show(pest)
    shown = "\n".join(said)
    assert all(one.source in shown and one.doubt in shown for one in pest.citations)
    assert pest.not_found.strip() in shown


def test_rain_wind_latency_and_entry_are_told(said):
    pest_figures.show(shipped_pest("strawberry-anthracnose"))
    pest_figures.show(shipped_pest("whitefly"))
    shown = "\n".join(said)
    assert texts.PEST_WITH_WIND in shown
    assert "only in hours with 0.2 mm of rain or more" in shown
    assert "after 7 days" in shown
    assert "0.002 a day at the edge" in shown
    assert "adults on a leaf" in shown


def test_rain_is_told_of_days_where_the_pest_is_not_simulated_by_the_hour(said):
    pest_figures.show(Pest("own", movement=Movement(least_rain_mm=2.0)))
    assert "- It moves only on days with 2 mm of rain or more." in said


def test_a_rate_that_the_file_does_not_say_is_called_assumed(said):
    pest_figures.show(Pest("own"))
    assert said == [
        "- It goes to each plant beside it with a chance of 0.02 a day.",
        f"- {texts.PEST_RATE_ASSUMED}",
    ]


@pytest.mark.parametrize("words", NAMES)
def test_a_pest_of_ones_own_is_called_as_its_file_says_and_leads_nowhere(said, words):
    pest = Pest(
        "own", title=words, species=words, not_found=words, count_means=words,
        stages=(Stage(words, 10, 100),), citations=(Citation("movement", words, words),),
    )  # fmt: skip
    named = [pest_figures.title(pest), pest_figures.stage_name(words)]
    pest_figures.show(replace(pest, stages=()))
    for line in [*named, *said]:
        assert not LEADS.search(line.replace("**", "")), line
