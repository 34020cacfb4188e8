"""What was changed a moment before a button is pressed counts already."""

from datetime import date
from unittest.mock import Mock

import pytest
import streamlit as st

from app.actions import acting, morning_steps
from app.state import button_presses, plot_source, work_day
from app.state.fresh_boxes import FreshBoxes
from app.words import texts
from tests.app.chosen import a_plot, chosen
from tests.app.driving import boxed, go


def hours(app):
    return next(one for one in app.slider if one.label == "Working hours")


def said(app):
    return " ".join(one.value for one in app.warning)


def test_a_season_begins_with_the_hours_chosen_just_before(app, season):
    hours(app).set_value(4.0)
    app.button(key="do_begin").click().run()
    assert not app.exception
    assert "has begun" in app.success[0].value
    assert season().settings.robot.hours == 4.0


def test_a_find_said_of_a_day_is_none_of_the_day_chosen_just_before(season_app, season):
    """Nor is what was typed for that other day earlier, which nobody saw as the press came."""
    go(season_app, "record")
    boxed(season_app.number_input, "one_row").set_value(1)
    boxed(season_app.number_input, "one_plant").set_value(1)
    boxed(season_app.segmented_control, "one_result").set_value(1)
    day = next(box for box in season_app.date_input if box.key.startswith("day "))
    day.set_value(date(2026, 11, 17))
    season_app.button(key="record_one").click().run()
    assert not season_app.exception
    assert "pressed before the plot or the day just chosen was shown" in said(season_app)
    assert not len(season().history.inspections)


@pytest.fixture
def boxes(session):  # noqa: ARG001 - what boxes hold is kept in it
    boxes = FreshBoxes("one", chosen(a_plot()))
    boxes.put("row", 3)
    return boxes


def shown(boxes, action, monkeypatch, **settings):
    """Show a button; return what pressing it does."""
    kept = {}
    monkeypatch.setattr(acting.st, "rerun", lambda: None)
    acting.at_press("Record", action, key="record", boxes=boxes,
                    button=lambda _, **given: kept.update(given), **settings)  # fmt: skip
    return lambda: kept["on_click"](*kept["args"])


def test_a_press_acts_before_the_page_is_drawn_and_a_second_one_only_on_what_was_typed_since(
    boxes, monkeypatch
):
    acted = []

    def act():
        acted.append(boxes.said("row"))
        boxes.empty()

    press = shown(boxes, act, monkeypatch)
    press()
    assert (acted, list(button_presses.waiting())) == ([3], [])
    press()  # of boxes that are emptied, but in view still
    assert (acted, list(button_presses.waiting())) == ([3], ["record"])
    press = shown(boxes, act, monkeypatch)
    assert (acted, list(button_presses.waiting())) == ([3], [])
    boxes.put("row", 4)
    press()
    press()
    boxes.put("row", 5)  # typed into those in view, as the emptied ones came
    shown(boxes, act, monkeypatch)
    assert (acted, list(button_presses.waiting())) == ([3, 4, 5], [])


def test_a_press_that_goes_by_what_is_shown_waits_until_it_is_and_is_done_once(
    session, monkeypatch
):
    acted = []
    press = shown(None, lambda: acted.append("as drawn first"), monkeypatch, at_once=False)
    press()
    press()
    assert (acted, list(button_presses.waiting())) == ([], ["record"])
    shown(None, lambda: acted.append("as drawn now"), monkeypatch, at_once=False)
    assert (acted, list(button_presses.waiting())) == (["as drawn now"], [])
    assert "notice" not in session


@pytest.mark.parametrize("at_once", [True, False])
def test_a_press_of_a_page_of_another_day_does_nothing_and_is_told(
    session, boxes, monkeypatch, at_once
):
    acted = []

    def draw():
        return shown(boxes, lambda: acted.append(1), monkeypatch, at_once=at_once)

    press = draw()
    work_day.choose(plot_source.chosen(), date(2026, 11, 20))
    press()
    draw()
    assert (acted, list(button_presses.waiting())) == ([], [])
    assert session.pop("notice") == ("warning", texts.PRESSED_BEFORE.format(button="Record"))


def test_what_is_chosen_while_a_press_waits_is_not_what_it_was_meant_for(session, monkeypatch):
    acted = []
    shown(None, lambda: acted.append("then"), monkeypatch, at_once=False)()
    work_day.choose(plot_source.chosen(), date(2026, 11, 20))
    shown(None, lambda: acted.append("now"), monkeypatch, at_once=False)
    assert (acted, list(button_presses.waiting()), session["notice"][0]) == ([], [], "warning")


def test_a_second_press_of_what_chose_another_plot_itself_says_nothing(session, monkeypatch):
    days = iter([date(2026, 11, 20), date(2026, 11, 21)])
    press = shown(None, lambda: work_day.choose(plot_source.chosen(), next(days)), monkeypatch)
    press()
    press()
    assert (next(days), session.get("notice")) == (date(2026, 11, 21), None)


def test_a_press_that_fails_does_not_wait_and_one_that_is_broken_off_does(boxes, monkeypatch):
    for error, waits in ((ValueError, []), (KeyboardInterrupt, ["record"])):
        press = shown(boxes, Mock(side_effect=error), monkeypatch)
        with pytest.raises(error):
            press()
        assert list(button_presses.waiting()) == waits


def test_a_season_begins_though_the_run_of_the_press_is_broken_off(app, season, monkeypatch):
    draw, breaks = morning_steps.show, [True]

    def show(choices, plan):
        if breaks and button_presses.waiting():
            breaks.clear()
            st.rerun()
        draw(choices, plan)

    monkeypatch.setattr(morning_steps, "show", show)
    app.button(key="do_begin").click().run()
    assert not breaks
    assert "has begun" in app.success[0].value
    assert season().settings.robot.hours
