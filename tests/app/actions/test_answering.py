"""A tap on the map answers an import's question, about the file that asked."""

import streamlit as st

from app.actions import answering, bringing_files
from app.show.answers_map import PLACES
from app.state import brought_files
from app.state.tried_answers import TriedAnswer
from app.words import texts
from fieldmon.errors import ChoiceNeeded, PlotError
from tests.app.chosen import a_plot

ANSWERS = (
    TriedAnswer("EPSG:2039", (a_plot().field,), "Asia/Jerusalem"),
    TriedAnswer("EPSG:28191", (a_plot(0.001).field,), "Asia/Jerusalem"),
)


def test_a_tapped_place_is_the_answer_of_the_file_that_asked(session):
    brought_files.ask_about("plot a")
    question = ChoiceNeeded("Which is it?", "crs", ("EPSG:2039", "EPSG:28191"))
    answering.take(question, ANSWERS, PLACES, 1)
    assert brought_files.answers("plot a") == (("crs", "EPSG:28191"),)
    answering.take(question, ANSWERS, "zones", 0)
    answering.take(PlotError("It is no question."), ANSWERS, PLACES, 0)
    assert brought_files.answers("plot a") == (("crs", "EPSG:28191"),)
    assert session


def test_answers_that_lead_to_a_plot_have_buttons_under_their_numbers_on_the_map(monkeypatch):
    nowhere = (TriedAnswer("row=1"), TriedAnswer("row=2"))
    labels = []
    monkeypatch.setattr(st, "button", lambda label, **_: labels.append(label))
    question = ChoiceNeeded("Which?", "crs", ("row=1", "row=2", "EPSG:2039"))
    bringing_files.say(question, "plot a", (*nowhere, ANSWERS[0]))
    assert labels == ["3 · EPSG:2039 · Israel", texts.CHOOSE_BUTTON]
