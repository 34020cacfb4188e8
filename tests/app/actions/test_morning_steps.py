"""The morning's buttons: the plan is kept, the route goes along, the report is there."""

from dataclasses import replace
from datetime import UTC, date, datetime

import numpy as np
import pytest

from app.actions import handing_out, morning_steps
from app.state import chosen_day, widget_memory
from app.state.choices import WHOSE_DAY
from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.planning.members import team_of
from fieldmon.plot import local_clock
from fieldmon.plot.robot import Robot
from tests.app.chosen import in_season
from tests.app.driving import boxed, go, headline, opened, press, tap, texts_of
from tests.monitoring.seasons import BEGINS, a_season, logged_at


def test_without_a_season_one_button_begins_it(app):
    assert app.button(key="do_begin").label == texts.STEP_BUTTONS["begin"]
    app.button(key="do_begin").click().run()
    assert "has begun" in app.success[0].value
    assert app.selectbox(key="season").value == "Gate 2026"


def test_a_plan_is_kept_once_it_is_used_and_ticked_with_what_is_left_of_it(season_app, season):
    def plan():
        (said,) = [one.value for one in season_app.markdown if texts.STEPS["plan"] in one.value]
        return said

    kept, first = season(), date(2026, 11, 16)
    assert not len(kept.kept_route(first))
    tap(season_app, "do_plan")
    n = len(kept.kept_route(first))
    assert n > 100
    assert texts.PLAN_USED.format(day="Mon 16 Nov") in season_app.success[0].value
    assert f"{n:,} plants" in plan()
    done = kept.kept_route(first)[:5]
    kept.record(Inspections.of(done, np.zeros(5, np.int8), np.datetime64(first)))
    season_app.run()
    assert f"{n:,} plants, " in plan()
    assert f"; {n - 5:,} left" in plan()


def test_a_route_taken_as_a_file_is_the_one_whose_stops_are_recorded(season_app, season):
    def sign(step):
        (said,) = [one.value for one in season_app.markdown if texts.STEPS[step] in one.value]
        return said

    tap(season_app, "do_plan")
    kept, first = season(), date(2026, 11, 16)
    given_out = kept.kept_route(first)
    assert sign("plan").startswith(":green")
    shorter = replace(kept.settings, robot=replace(kept.settings.robot, hours=1.0))
    kept.change(shorter, kept.settings)
    season_app.run()
    assert not sign("plan").startswith(":green")
    assert f"given out before: {len(given_out):,} plants" in sign("plan")
    handing_out.give_out(in_season(kept))
    season_app.run()
    assert sign("plan").startswith(":green")
    assert len(season().kept_route(first)) < len(given_out)


def test_a_day_that_is_done_says_what_was_found(season_app, season):
    kept, first = season(), date(2026, 11, 16)
    plants = np.arange(40)
    results = np.zeros(40, np.int8)
    results[:3] = 1
    late = np.linspace(6 * 3600, 18.1 * 3600, 40)
    kept.record(Inspections.of(plants, results, np.datetime64(first), second=late))
    season_app.run()
    assert headline(season_app) == "Done on Mon 16 Nov: 3 found on 40 plants."
    assert texts.TODAY_OVER in texts_of(season_app)


def test_the_next_day_of_a_day_is_its_own_though_that_is_done_too(season_app, season):
    days = [date(2026, 11, 16), date(2026, 11, 17)]
    plants, late = np.arange(40), np.linspace(6 * 3600, 18.1 * 3600, 40)
    for day in days:
        results = Inspections.of(plants, np.zeros(40, np.int8), np.datetime64(day), second=late)
        season().record(results, str(day))
    keys = []
    for day in days:
        season_app.date_input(key="day Gate 2026").set_value(day).run()
        keys += [one.key for one in season_app.button if "next_day" in one.key]
    assert len(set(keys)) == 2, "or a second press of the first would be one of the second"
    tap(season_app, keys[1])
    assert season_app.date_input(key="day Gate 2026").value == date(2026, 11, 18)


def goes_along_as_a_file(app, said):
    assert said in texts_of(app)
    formats = app.selectbox(key="format")
    assert formats.value == "gpx"
    assert formats.options[0].endswith(": gpx"), "what most use stands first"
    assert formats.options[-1].endswith(": nav2-pauses")


def test_the_route_of_a_plan_goes_along_as_a_file(app):
    tap(app, "do_send")
    goes_along_as_a_file(app, texts.SEND_ALONE)


def test_recording_is_one_button_away(season_app):
    tap(season_app, "do_record")
    assert boxed(season_app.number_input, "one_row")
    go(season_app, "today")
    assert opened("Gate 2026").get("download_button")


def test_where_no_phone_comes_the_route_is_a_file_and_to_look_at_it_is_not_to_take_it_along(
    season_app,
):
    def sent():
        said = [one.value for one in season_app.markdown if texts.STEPS["send"] in one.value]
        return [one.startswith(":green") for one in said]

    tap(season_app, "do_send")
    goes_along_as_a_file(season_app, texts.INVITE_LOCAL)
    assert sent() == [False]
    season_app.text_input(key="invite_name").set_value("Ann")
    press(season_app, texts.INVITE_BUTTON)
    assert sent() == [True]


def test_a_treatment_is_said_where_nothing_was_inspected_yet(season_app, season):
    season().treat(date(2026, 11, 16), 0.8)
    n = len(season().plot.grid)
    season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, 17)).run()
    said = texts_of(season_app)
    assert f"{n:,} plants were treated on Mon 16 Nov." in said
    assert f"{texts.LAST_VISIT}** {texts.STEP_NO_VISIT}" in said


def test_a_planned_day_that_was_forgotten_is_recorded_from_any_later_day(
    season_app, season, monkeypatch
):
    first = date(2026, 11, 16)
    logged_at(monkeypatch, datetime(2026, 11, 16, 4, tzinfo=UTC))
    season().plan(first)
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2026, 11, 20, 4, tzinfo=UTC))
    season_app.run()
    (said,) = [one.value for one in season_app.markdown if texts.STEP_UNRECORDED in one.value]
    assert texts.STEP_PLANNED_FOR.format(day="Mon 16 Nov") in said
    tap(season_app, "do_look_back")
    assert season_app.date_input(key="day Gate 2026").value == first
    assert boxed(season_app.number_input, "one_row")
    go(season_app, "season")
    season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, 20)).run()
    assert texts.UNRECORDED.format(days="Mon 16 Nov") in [one.value for one in season_app.caption]


@pytest.mark.usefixtures("session")
def test_of_a_team_each_page_has_what_this_one_planned_and_did(tmp_path):
    season = a_season(tmp_path / "s.gpkg", team=team_of(2, Robot(hours=1.0)))
    first, second = (len(one.route) for one in season.plan_each(BEGINS))
    done = season.kept_route(BEGINS, "robot-2")[:6]
    result = (np.arange(6) == 2).astype(np.int8)
    season.record(Inspections.of(done, result, np.datetime64(BEGINS)), "f", "robot-2")
    choices, said = in_season(season, BEGINS), {}
    for name in ("robot-1", "robot-2"):
        widget_memory.put(WHOSE_DAY, name)
        plan = choices.plan()
        said[name] = (
            morning_steps._planned(choices, plan), morning_steps._today(choices, plan),
            chosen_day.inspected_by_shown(choices), len(plan.route),
        )  # fmt: skip
    for name, n, of_it in (("robot-1", first, 0), ("robot-2", second, 6)):
        plan, today, own, now = said[name]
        assert own == (of_it, int(of_it > 0))
        assert plan.startswith(f"{n:,} plants")
        left = n - of_it
        if now == left:
            assert plan.endswith(f"; {left:,} left")
        else:
            assert f": {of_it} done, {left:,} left; " in plan
            assert plan.endswith(f" {now:,}")
        assert ("all together 1 found on 6 plants" in today) == (name == "robot-1")
    assert any(
        now != n for (_, _, _, now), n in zip(said.values(), (first, second - 6), strict=True)
    )
