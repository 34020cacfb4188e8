"""What was changed a moment before a button is pressed counts already."""

from datetime import date
from unittest.mock import Mock

import pytest

from app.actions import acting
from app.state import plot_source, presses, work_day
from app.state.fresh_boxes import FreshBoxes
from tests.app.chosen import a_plot, chosen
from tests.app.driving import boxed, go


def hours(app):
    return next(one for one in app.slider if one.label == "Working hours")


def test_a_season_begins_with_the_hours_chosen_just_before(app, season):
    hours(app).set_value(4.0)
    app.button(key="do_begin").click().run()
    assert not app.exception
    assert "has begun" in app.success[0].value
    assert season().settings.robot.hours == 4.0


def test_a_find_said_of_a_day_is_none_of_the_day_chosen_just_before(season_app, season):
    go(season_app, "record")
    boxed(season_app.number_input, "one_row").set_value(1)
    boxed(season_app.number_input, "one_plant").set_value(1)
    boxed(season_app.segmented_control, "one_result").set_value(1)
    day = next(box for box in season_app.date_input if box.key.startswith("day "))
    day.set_value(date(2026, 11, 17))
    season_app.button(key="record_one").click().run()
    assert not season_app.exception
    assert "must be said" in season_app.error[0].value
    assert not len(season().history.inspections)


@pytest.fixture
def boxes(session):  # noqa: ARG001 - what boxes hold is kept in it
    boxes = FreshBoxes("one", chosen(a_plot()))
    boxes.put("row", 3)
    return boxes


def shown(boxes, action, monkeypatch):
    """Show a button; return what pressing it does."""
    kept = {}
    monkeypatch.setattr(acting.st, "button", lambda _, **settings: kept.update(settings))
    monkeypatch.setattr(acting.st, "rerun", lambda: None)
    acting.at_press(boxes, "Record", action, key="record")
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
    assert (acted, presses.waiting()) == ([3], {})
    press()  # of boxes that are emptied, but in view still
    assert (acted, presses.waiting()) == ([3], {"record": True})
    press = shown(boxes, act, monkeypatch)
    assert (acted, presses.waiting()) == ([3], {})
    boxes.put("row", 4)
    press()
    press()
    boxes.put("row", 5)  # typed into those in view, as the emptied ones came
    shown(boxes, act, monkeypatch)
    assert (acted, presses.waiting()) == ([3, 4, 5], {})


def test_a_press_of_a_page_of_another_day_waits_for_that_of_the_day_chosen(boxes, monkeypatch):
    acted = []
    press = shown(boxes, lambda: acted.append("then"), monkeypatch)
    work_day.choose(plot_source.chosen(), date(2026, 11, 20))
    press()
    assert (acted, presses.waiting()) == ([], {"record": False})
    shown(boxes, lambda: acted.append("now"), monkeypatch)
    assert (acted, presses.waiting()) == (["now"], {})


def test_a_press_that_fails_does_not_wait_and_one_that_is_broken_off_does(boxes, monkeypatch):
    for error, waits in ((ValueError, {}), (KeyboardInterrupt, {"record": False})):
        press = shown(boxes, Mock(side_effect=error), monkeypatch)
        with pytest.raises(error):
            press()
        assert presses.waiting() == waits
