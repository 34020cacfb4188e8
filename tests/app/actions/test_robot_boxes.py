"""The robot's width and times are said in the app, and count where a day is planned."""

from dataclasses import replace

import pytest

from app.words import texts
from tests.app.driving import apart, go, press, row_box

TIMES = texts.ROBOT_TIMES_LABEL


def test_a_robot_too_wide_for_the_aisles_is_said_and_a_narrow_one_planned(app):
    app.number_input(key="robot_width").set_value(4.0).run()
    assert "but the widest here is" in app.error[0].value
    app.number_input(key="robot_width").set_value(0.6).run()
    assert not app.error
    assert any("plants reach 0.25 m" in apart(one.value) for one in app.caption)
    go(app, "plot")
    row_box(app, "half_canopy").set_value(1.8).run()
    go(app, "today")
    assert "wide as it is" in app.error[0].value


def test_a_robot_that_cannot_turn_on_the_spot_is_charged_its_turns(app):
    assert app.number_input(key="robot_turns").disabled
    app.number_input(key="robot_width").set_value(0.6).run()
    app.number_input(key="robot_turns").set_value(4.5).run()
    assert not app.exception
    said = [one.value for one in app.caption if "a row change takes" in one.value]
    assert said
    assert "a row change takes 9 s" not in said[0]


def test_the_thesis_s_times_inspect_other_plants_than_those_of_simulated_drives(app):
    def stops():
        return next(one.value for one in app.metric if one.label.startswith("Plants to inspect"))

    said = "a row change takes 9 s more, as in simulated drives"
    assert any(said in one.value for one in app.caption)
    before = stops()
    app.selectbox(key="robot_times").set_value("thesis").run()
    assert not any("a row change takes" in one.value for one in app.caption)
    assert stops() != before


def test_a_season_keeps_the_width_and_the_times(season_app, season):
    before = season().settings.robot
    width = next(one for one in season_app.number_input if one.label.startswith("Width"))
    width.set_value(0.7)
    next(one for one in season_app.selectbox if one.label == TIMES).set_value("thesis")
    season_app.run()
    press(season_app, "Use from now on")
    assert not season_app.exception
    assert season().settings.robot == replace(before, width_m=0.7).with_times("thesis")


def test_times_set_by_a_command_stay_unless_they_are_changed(season_app, season):
    open_season = season()
    settings = open_season.settings
    own = replace(settings.robot, row_change_s=11.0, width_m=0.5812)
    open_season.change(replace(settings, robot=own), settings)
    season_app.run()
    times = next(one for one in season_app.selectbox if one.label == TIMES)
    assert times.value == "own"
    assert not [one for one in season_app.button if one.key == "change_setup"]
    assert season().settings.robot.width_m == pytest.approx(0.5812)
