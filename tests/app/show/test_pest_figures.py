"""A pest's figures are shown with their sources, whoever wrote its file."""

import pytest
import streamlit as st

from app.show import pest_figures
from app.words import language, texts
from fieldmon.io.readers.pest_file import shipped_names, shipped_pest
from fieldmon.pests.pest import Citation, Movement, Pest


@pytest.fixture
def said(monkeypatch):
    """Collect what is shown."""
    lines = []
    for way in ("markdown", "caption"):
        monkeypatch.setattr(st, way, lines.append)
    monkeypatch.setattr(st, "dataframe", lambda table, **_: lines.append(table.to_csv()))
    return lines


@pytest.mark.parametrize("name", shipped_names())
def test_every_pest_that_comes_along_has_words_of_the_page_in_each_language(name, said):
    pest = shipped_pest(name)
    for code in language.LANGUAGES:
        language.use(code)
        assert pest_figures.title(pest) == texts.PEST_TITLES[name]
        assert all(stage.name in texts.PEST_STAGES for stage in pest.stages)
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
    assert "only in rain of 0.2 mm" in shown
    assert "after 7 days" in shown
    assert "0.002 a day at the edge" in shown
    assert "adults on a leaf" in shown


def test_a_pest_of_ones_own_is_called_as_its_file_says_and_leads_nowhere(said):
    pest = Pest(
        "own", title="My [mite](https://example.org)", movement=Movement(per_day=0.1),
        citations=(Citation("movement", "See ![](https://example.org/x.png)"),),
    )  # fmt: skip
    assert "mite" in pest_figures.title(pest)
    pest_figures.show(pest)
    for line in [pest_figures.title(pest), *said]:
        assert "](http" not in line
        assert "![" not in line
