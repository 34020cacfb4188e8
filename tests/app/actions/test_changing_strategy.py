"""Who works in a season is changed from now on, and back."""

from dataclasses import replace
from datetime import date, timedelta

import numpy as np
import pytest

from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.planning.members import TeamMember
from fieldmon.plot.robot import Robot, scout
from tests.app.driving import go, metric, opened, press, tap, texts_of, until

BEGINS = date(2026, 11, 16)


def test_numbers_of_a_program_that_no_slider_has_leave_the_page_whole(season_app, season):
    for hours, look_s in ((17.0, 22.5), (3, 40)):
        project, settings = season(), season().settings
        robot = replace(settings.robot, hours=hours, look_s=look_s)
        project.change(replace(settings, robot=robot), settings)
        go(season_app, "today")
        assert not season_app.exception
        assert hours_box(season_app).value == float(hours)
        assert not [one for one in season_app.button if one.key == "change_setup"]


def test_a_day_that_was_missed_is_given_its_hours_and_one_that_was_worked_keeps_them(
    season_app, season
):
    days = [BEGINS + timedelta(days=k) for k in range(3)]
    for day in (days[0], days[2]):
        one = Inspections.of(np.array([3]), np.array([0]), np.datetime64(day))
        season().record(one, "file")
    season_app.run()
    hours_box(season_app).set_value(1.5).run()
    press(season_app, "Use from now on")
    assert "Mon 16 Nov stays as it was planned" in season_app.success[0].value
    season_app.date_input[0].set_value(days[1]).run()
    assert season().planned_by(days[1]).robot.hours == 2.0
    tap(season_app, "plan_as_now")
    assert season().planned_by(days[1]).robot.hours == 1.5
    hours_box(season_app).set_value(1.0).run()
    press(season_app, "Use from now on")
    assert season_app.success[0].value.startswith("Tue 17 Nov goes by this too")
    assert [season().planned_by(day).robot.hours for day in days[:2]] == [2.0, 1.0]


def test_another_n_than_usual_is_said_and_another_sampler_goes_without_it(season_app, season):
    project, settings = season(), season().settings
    every_third = replace(settings, sampler="bouncy", sampler_settings={"every": 3})
    project.change(every_third, settings)
    go(season_app, "today")
    assert "every second plant; but here N is 3, not 2" in texts_of(season_app)
    hours_box(season_app).set_value(1.0).run()
    press(season_app, "Use from now on")
    assert season().settings.sampler_settings == {"every": 3}
    for name in ("adaptive", "snake"):
        box = next(one for one in season_app.selectbox if one.label == texts.SAMPLER)
        box.set_value(name).run()
        assert not season_app.exception
        press(season_app, "Use from now on")
        assert (season().settings.sampler, season().settings.sampler_settings) == (name, {})


def hours_box(app):
    return next(one for one in app.slider if one.key.startswith("hours "))


def test_changes_of_settings_are_taken_back_one_by_one(season_app, season):
    go(season_app, "record")
    assert not [one for one in season_app.button if one.key == "undo_change"]
    settings = season().settings
    for hours in (1.0, 3.0):
        hours_box(season_app).set_value(hours).run()
        press(season_app, "Use from now on")
    assert "Changed last: hours 3." in texts_of(season_app).replace("\u00a0", " ")
    press(season_app, "Take back")
    said = season_app.success[0].value.replace("\u00a0", " ")
    assert said == "The last change was taken back: hours 3 (now 1 again)."
    assert season().settings.robot.hours == 1.0
    press(season_app, "Take back")
    assert season().settings == settings
    assert not [one for one in season_app.button if one.key == "undo_change"]


def test_a_strategy_in_use_is_that_of_the_season_and_says_so(season_app, season):
    go(season_app, "compare")
    season_app.multiselect(key="strategy_samplers").set_value(["naive"])
    season_app.number_input(key="seeds").set_value(1)
    season_app.number_input(key="n_days").set_value(2).run()
    season_app.button(key="run").click().run()
    until(lambda: len(season_app.run().table))
    press(season_app, "Use this strategy")
    assert season_app.success[0].value == "Naive · 2 h · 40 s is in use now."
    assert season().settings.sampler == "naive"


def test_a_robot_gives_way_to_a_scout_in_a_season_and_comes_back(season_app, season):
    def who(app):
        return next(one for one in app.segmented_control if (one.key or "").startswith("who "))

    go(season_app, "record")
    assert who(season_app).value == "Robot"
    who(season_app).set_value("Scout on foot").run()
    press(season_app, "Use from now on")
    assert not season_app.exception
    assert season().settings.robot == scout().with_hours(2.0)  # hours are the plot's
    assert who(season_app).value == "Scout on foot"
    hours_box(season_app).set_value(1.0).run()
    press(season_app, "Use from now on")
    assert season().settings.robot == scout().with_hours(1.0)
    who(season_app).set_value("Robot").run()
    press(season_app, "Use from now on")
    assert season().settings.robot == Robot(hours=1.0)


def places_of(app):
    """Return where in the panel, from its top, the hours, the sentence and the seconds stand."""
    shown = list(app.main)
    at = {
        "hours": lambda one: one.type == "slider" and one.label == "Working hours",
        "sentence": lambda one: one.type == "markdown" and one.value.startswith("Inspect "),
        "seconds": lambda one: one.type == "slider" and one.label == "Seconds at a plant",
    }
    return {name: next((k for k, one in enumerate(shown) if is_it(one)), None)
            for name, is_it in at.items()}  # fmt: skip


def test_other_hours_stand_above_the_day_s_sentence_and_count_once_they_are_used(
    season_app, season
):
    at = places_of(season_app)
    assert at["hours"] < at["sentence"] < at["seconds"], "they are changed every day"
    hours_box(season_app).set_value(1.0).run()
    shown = list(season_app.main)
    use = next(k for k, one in enumerate(shown) if getattr(one, "key", "") == "change_setup")
    assert at["hours"] < use < places_of(season_app)["sentence"]
    assert season().settings.robot.hours == 2.0
    # a plan of other hours than the slider says is not handed on
    assert "first use what you changed" in texts_of(season_app)
    for step in ("plan", "send"):
        button = season_app.button(key=f"do_{step}")
        assert (button.disabled, button.proto.type) == (True, "secondary")
    press(season_app, "Use from now on")
    assert season().settings.robot.hours == 1.0
    assert int(metric(season_app, "Plants to inspect").split(" / ")[0]) < 100
    tap(season_app, "do_plan")
    assert season().planned_and_done(BEGINS).hours <= 1.0
    go(season_app, "record")
    at = places_of(season_app)
    assert at["hours"] is not None
    assert at["hours"] < at["seconds"]
    assert hours_box(season_app).value == 1.0


def test_the_hours_of_a_plot_without_a_season_stand_there_too_and_are_kept_elsewhere(app):
    at = places_of(app)
    assert at["hours"] < at["sentence"] < at["seconds"]
    hours_box(app).set_value(3.0).run()
    go(app, "scout")
    assert hours_box(app).value == 3.0
    go(app, "today")
    assert hours_box(app).value == 3.0


@pytest.mark.usefixtures("season_app")
def test_an_earlier_day_goes_by_what_counted_then_and_says_so(season):
    kept = season()
    settings, days = kept.settings, [kept.settings.begins + timedelta(days=k) for k in range(2)]
    clean = np.zeros(3, np.int8)
    kept.record(Inspections.of(np.arange(3), clean, np.datetime64(days[0])))
    kept.change(replace(settings, robot=settings.robot.with_hours(4.0)), settings)
    kept.record(Inspections.of(np.arange(3), clean, np.datetime64(days[1])))
    app = opened("Gate 2026", day=str(days[1]))
    assert hours_box(app).value == 4.0
    few = metric(app, texts.PLANTS_TO_INSPECT)
    app = opened("Gate 2026", day=str(days[0]))
    assert not [one for one in app.slider if one.key.startswith("hours ")]
    assert "what counted then: Adaptive · 2 h · 40 s, from 06:00" in texts_of(app)
    assert metric(app, texts.PLANTS_TO_INSPECT) != few


@pytest.mark.usefixtures("season_app")
def test_an_earlier_day_of_a_team_says_how_each_worked(season):
    kept = season()
    alone, days = kept.settings, [kept.settings.begins + timedelta(days=k) for k in range(2)]
    walks = scout().with_hours(3)
    team = (TeamMember("Ann", alone.robot), TeamMember("Dan", walks, None, 7200.0))
    for day, settings in zip(days, (replace(alone, team=team), alone), strict=True):
        kept.change(settings, kept.settings)
        kept.record(Inspections.of(np.arange(3), np.zeros(3, np.int8), np.datetime64(day)))
    said = texts_of(opened("Gate 2026", day=str(days[0])))
    assert texts.EARLIER_TEAM in said
    assert "Ann\u2069: Adaptive · 2 h · 40 s, from 06:00" in said
    assert f"Dan\u2069: Adaptive · 3 h · {walks.look_s:g} s, from 08:00" in said


def test_of_a_team_each_has_a_row_another_sampler_leaves_all_as_they_are_and_one_works_again(
    season_app, season
):
    before = season().settings
    team = (TeamMember("Ann", before.robot), TeamMember("Dan", scout().with_hours(3), None, 7200.0))
    season().change(replace(before, team=team), before)
    go(season_app, "today")
    starts = [str(one.value) for one in season_app.time_input]
    assert starts == ["06:00:00", "08:00:00"]
    assert not [one for one in season_app.button if one.key == "change_setup"]
    assert not [one for one in season_app.slider if one.key.startswith("hours ")]
    next(one for one in season_app.selectbox if one.label == texts.SAMPLER).set_value("naive").run()
    press(season_app, "Use from now on")
    assert (season().settings.sampler, season().settings.team) == ("naive", team)
    who = next(one for one in season_app.segmented_control if (one.key or "").startswith("who "))
    who.set_value("Robot").run()
    press(season_app, "Use from now on")
    assert season().settings == before.with_sampler("naive")
    press(season_app, next(one.label for one in season_app.button if one.key == "undo_change"))
    assert season().settings.team == team
