"""What boxes of who works say and is not used yet is there again after a reload, until it is."""

import json

import pytest
import streamlit as st

from app.state import strategy_boxes
from tests.app.driving import boxed, opened, plot_name, press, tap, texts_of, word_of

SEASON = "Gate 2026"


def reloaded(app, season=SEASON):
    """Return a new session at the address at which this one stands after a run more, as any is."""
    return opened(season, files=word_of(app.run())).run()


def test_hours_and_a_team_that_are_not_used_yet_outlive_a_reload(season_app, season):
    boxed(season_app.slider, "hours").set_value(1.0).run()
    again = reloaded(season_app)
    assert boxed(again.slider, "hours").value == 1.0
    assert season().settings.robot.hours == 2.0
    assert "first use what you changed" in texts_of(again)
    boxed(again.segmented_control, "who").set_value("Team").run()
    boxed(again.text_input, "team_name").set_value("Ann").run()
    boxed(again.time_input, "team_start").set_value(None)
    tap(again, "team_add_scout")
    third = reloaded(again)
    names = [one.value for one in third.text_input if one.key.startswith("team_name ")]
    assert names == ["Ann", "robot 2", "scout 1"]
    press(third, "Use from now on")
    assert [one.name for one in season().settings.team] == names
    assert "files" not in third.run().query_params, "nothing waits to be used any more"
    tap(third, "undo_change")
    assert boxed(third.slider, "hours").value == 2.0, "what was said before was not said since"


def test_who_works_on_a_plot_that_no_season_keeps_outlives_a_reload(app):
    app.segmented_control(key="who").set_value("Scout on foot").run()
    app.slider(key="hours Scout on foot").set_value(3.0).run()
    again = reloaded(app, season=None)
    assert plot_name(again) == plot_name(app)
    assert again.segmented_control(key="who").value == "Scout on foot"
    assert again.slider(key="hours Scout on foot").value == 3.0


@pytest.mark.usefixtures("session")
def test_a_box_that_was_emptied_is_empty_after_a_reload(session):
    show = {"place": "here", "key": "robot_width here", "counts": 0.8}
    with strategy_boxes.all_of("here"):
        strategy_boxes.show(st.number_input, "Width", 0.1, 10.0, **show)
    assert strategy_boxes.said() == {}
    session["robot_width here"] = None
    written = json.dumps(strategy_boxes.said())
    session.clear()
    strategy_boxes.take(json.loads(written))
    assert strategy_boxes.said() == {"robot_width here": ["here", 0.8, None]}
    with strategy_boxes.all_of("here"):
        pass
    assert strategy_boxes.said() == {}, "it is shown no more: other settings count"
