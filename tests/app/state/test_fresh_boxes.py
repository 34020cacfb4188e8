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


def shown(boxes, *names, **settings):
    """Show boxes as a page does; return what each holds."""
    return [boxes.show(lambda *_, value=None, **__: value, box=name, **settings) for name in names]


@pytest.mark.usefixtures("session")
def test_what_stays_in_a_box_is_of_its_day_and_nothing_that_waits_to_be_kept(choices):
    boxes, later = FreshBoxes("one", choices), FreshBoxes("one", replace(choices, day="2026-11-17"))
    boxes.put("who", "Dan")
    boxes.put("row", 3)
    shown(boxes, "row")
    shown(boxes, "who", stays=True)
    boxes.empty()
    assert (shown(boxes, "row"), shown(boxes, "who", stays=True)) == ([None], ["Dan"])
    assert shown(later, "who", stays=True) == [None]
    assert not boxes.hold_anything()
    assert not fresh_boxes.said(), "whoever opens the address elsewhere did not say so"
    boxes.put("row", 4)
    kept = [value for _, value in fresh_boxes.said()["boxes"].values()]
    assert sorted(kept, key=str) == [4, "Dan"]
    boxes.empty()
    shown(boxes, "row")
    shown(boxes, "who", stays=True)
    boxes.put("who", "Eve")
    assert boxes.hold_anything()


@pytest.mark.usefixtures("session")
@pytest.mark.parametrize("form", ["one", "treatment of zones"])
def test_what_is_said_while_another_day_is_on_its_way_is_of_that_day(choices, form):
    before, other = FreshBoxes(form, choices), replace(choices, day="2026-11-17")
    after = FreshBoxes(form, other)
    for box, value in {"row": 3, "plant": 4, "stops 12": None}.items():
        before.put(box, value)
    shown(before, "row", "plant", "stops 12")
    fresh_boxes.hold()
    # from boxes still in view
    st.session_state[before.key("row")] = 7
    st.session_state[before.key("stops 12")] = 9
    fresh_boxes.turn(other)
    assert shown(after, "row", "plant") == [7, None]
    assert [before.said(box) for box in ("row", "plant", "stops 12")] == [3, 4, None]
    # the browser sends it once more; what was said since holds
    after.put("row", 8)
    st.session_state[before.key("row")] = 7
    fresh_boxes.turn(other)
    assert shown(after, "row") == [8]
    assert before.said("row") == 3
    # what is said once the day is back is its own again
    fresh_boxes.hold()
    fresh_boxes.turn(choices)
    before.put("row", 5)
    fresh_boxes.turn(choices)
    assert (shown(before, "row"), after.said("row")) == ([5], 8)


@pytest.mark.usefixtures("session")
def test_what_is_said_in_a_box_that_is_just_being_emptied_is_in_the_empty_one(choices):
    boxes = FreshBoxes("one", choices)
    boxes.put("row", 3)
    boxes.put("plant", 4)
    shown(boxes, "row", "plant")
    old = boxes.key("row")
    boxes.empty()
    st.session_state[old] = 7
    fresh_boxes.turn(choices)
    assert shown(boxes, "row", "plant") == [7, None]
    boxes.empty()
    fresh_boxes.turn(choices)
    assert shown(boxes, "row", "plant") == [None, None]


@pytest.mark.usefixtures("session")
def test_what_is_not_kept_yet_is_taken_by_another_session_and_nothing_once_it_is(
    choices, monkeypatch
):
    boxes = FreshBoxes("one", choices)
    boxes.empty()
    assert fresh_boxes.said() == {}
    boxes.put("row", 3)
    boxes.put("tapped", (3, 4))
    written = json.loads(json.dumps(fresh_boxes.said()))
    monkeypatch.setattr(st, "session_state", {})
    fresh_boxes.take(written)
    assert (boxes.said("row"), boxes.said("tapped")) == (3, [3, 4])
    boxes.empty()
    assert fresh_boxes.said() == {}
