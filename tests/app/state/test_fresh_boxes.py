"""What was said of a day stays with its day, its season and its form, until it is kept."""

import json
from dataclasses import replace

import pytest
import streamlit as st

from app.state import fresh_boxes
from app.state.fresh_boxes import FreshBoxes
from tests.app.chosen import a_plot, chosen


@pytest.fixture
def choices():
    return chosen(a_plot())


@pytest.mark.usefixtures("session")
def test_boxes_hold_what_was_said_until_they_are_emptied(choices):
    boxes = FreshBoxes("one", choices)
    assert boxes.said("row") is None
    boxes.put("row", 3)
    FreshBoxes("other", choices).empty()
    FreshBoxes("one", replace(choices, day="2026-11-17")).empty()
    assert boxes.said("row") == 3, "another form, or another day, was kept"
    boxes.empty()
    assert boxes.said("row") is None


@pytest.mark.usefixtures("session")
@pytest.mark.parametrize("other", [{"day": "2026-11-17"}, {"key": "another season"}])
def test_another_day_and_another_season_have_boxes_of_their_own(choices, other):
    boxes = FreshBoxes("one", choices)
    boxes.put("row", 3)
    assert FreshBoxes("one", replace(choices, **other)).said("row") is None
    assert FreshBoxes("two", choices).said("row") is None
    assert FreshBoxes("one", choices).said("row") == 3


@pytest.mark.usefixtures("session")
def test_what_is_not_kept_yet_is_taken_by_another_session_and_nothing_once_it_is(
    choices, monkeypatch
):
    boxes = FreshBoxes("one", choices)
    boxes.empty()
    assert fresh_boxes.unfinished() == {}
    boxes.put("row", 3)
    boxes.put("tapped", (3, 4))
    written = json.loads(json.dumps(fresh_boxes.unfinished()))
    monkeypatch.setattr(st, "session_state", {})
    fresh_boxes.take(written)
    assert (boxes.said("row"), boxes.said("tapped")) == (3, [3, 4])
    boxes.empty()
    assert fresh_boxes.unfinished() == {}
