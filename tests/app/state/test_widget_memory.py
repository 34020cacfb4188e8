"""Widgets keep what was chosen when the page is turned."""

import pytest

from app.state import widget_memory


class Box:
    """Stands for a widget: shows what the session holds, or its own default."""

    def __init__(self, session):
        self.session, self.given, self.form = session, None, None

    def number_input(self, _label, *_limits, key, value=None, step=1, format="%d"):  # noqa: A002, ARG002 - as Streamlit's
        self.given, self.form = value, format
        self.session.setdefault(key, value)
        return self.session[key]

    def selectbox(self, _label, options, *, key, index=None):
        self.given = index
        return self.session.get(key, None if index is None else options[index])


@pytest.fixture
def box(session):
    return Box(session)


def shown(box, page, **settings):
    widget_memory.turn(page)
    return widget_memory.show(box.number_input, "hours", key="hours", **settings)


def test_a_widget_begins_with_its_default_and_keeps_what_was_chosen_on_another_page(box, session):
    assert shown(box, "today", default=8.0) == 8.0
    session["hours"] = 3.0
    assert shown(box, "today", default=8.0) == 3.0
    del session["hours"]  # Streamlit forgets it when the page is turned
    assert shown(box, "map", default=8.0) == 3.0
    assert widget_memory.value("hours") == 3.0


def test_what_was_said_is_kept_though_the_run_was_broken_off_before_its_box(box, session):
    shown(box, "today", default=8.0)
    session["hours"] = 3.0  # and the run is broken off
    widget_memory.turn("map")  # where there is no such box
    del session["hours"]
    assert shown(box, "today", default=8.0) == 3.0


def test_what_a_widget_is_to_begin_with_does_not_override_what_was_chosen(box, session):
    widget_memory.first("hours", None)
    assert shown(box, "today", default=8.0) == 8.0
    widget_memory.first("hours", 5.0)
    assert widget_memory.value("hours") == 8.0
    session.clear()
    widget_memory.first("hours", 5.0)
    assert shown(box, "today", default=8.0) == 5.0


def test_a_widget_s_own_default_is_what_it_began_with_on_this_page(box, session):
    shown(box, "today", default=8.0)
    session["hours"] = 3.0
    shown(box, "today", default=8.0)
    assert box.given == 8.0
    shown(box, "map", default=8.0)
    assert box.given == 3.0


def test_a_box_writes_no_digits_that_nobody_needs(box):
    for limits, step, written in (((0.0, 50.0), 0.5, ("2", "2.5", "0.05")), ((0, 50), 1, "220")):
        for widget in (widget_memory.show, widget_memory.anew):
            widget(box.number_input, "share", *limits, step=step, key="share")
            assert [box.form % value for value in (2.0, 2.5, 0.05)] == list(written)


def test_choices_are_given_by_their_place(box):
    widget_memory.turn("today")
    options = ["a", "b", "c"]
    widget_memory.show(box.selectbox, "which", options, key="which", default="b")
    assert box.given == 1
    widget_memory.show(box.selectbox, "other", options, key="other", default="gone")
    assert box.given is None


def test_values_of_widgets_by_the_first_word_of_their_keys_are_changed(session):
    for key, value in (("row_spacing a", 4.0), ("row_spacing b", None), ("hours", 8.0)):
        widget_memory.first(key, value)
    session["row_spacing a"] = 6.0
    widget_memory.change(("row_spacing",), lambda metres: metres / 2)
    assert session["row_spacing a"] == 3.0
    assert widget_memory.value("row_spacing a") == 3.0
    assert widget_memory.value("row_spacing b") is None
    assert widget_memory.value("hours") == 8.0


def test_values_are_carried_over_to_keys_of_another_name(session):
    widget_memory.first("row_spacing old 1", 4.0)
    widget_memory.first("hours", 8.0)
    session["row_spacing old 1"] = 6.0
    widget_memory.carry("old", "new")
    assert widget_memory.value("row_spacing new 1") == 6.0
    assert widget_memory.value("row_spacing old 1") == 6.0
    assert widget_memory.value("hours") == 8.0
