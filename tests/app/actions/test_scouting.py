"""Scout mode: each tap is kept at once and can be taken back."""

from dataclasses import replace
from datetime import UTC, date, datetime

import numpy as np

from app.actions import scouting
from app.state.choices import WHOSE_DAY
from app.words import texts
from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.planning.members import TeamMember
from fieldmon.plot import local_clock
from fieldmon.plot.grid import plant_numbers
from tests.app.driving import go, map_of, opened, tap, texts_of


def place(app):
    """Return where the next plant is said to be."""
    return next(one.value for one in app.markdown if one.value.startswith("## "))


def test_each_tap_of_the_scout_is_kept_at_once_and_the_route_goes_on(season_app, season):
    go(season_app, "scout")
    assert not len(season().kept_route(date(2026, 11, 16))), "to look at a plant keeps no plan"
    tap(season_app, "scout_clean")
    route = season().kept_route(date(2026, 11, 16))
    assert len(route) > 100
    season_app.number_input(key="scout_count").set_value(7)
    tap(season_app, "scout_found")
    tap(season_app, "scout_skip")
    done = season().history.inspections
    assert done.plant[:2].tolist() == route[:2].tolist()
    assert done.result.tolist() == [0, 1, 2]
    assert (np.diff(done.second) > 0).all()
    assert season_app.number_input(key="scout_count").value is None
    # after a reload it goes on where the scout stood
    assert place(go(opened("Gate 2026"), "scout")) == place(season_app)
    # a plant that is gone, too, until that is taken back
    tap(season_app, "scout_gone")
    history = season().history
    assert np.flatnonzero(history.gone(0)).tolist() == history.inspections.plant[3:].tolist()
    assert [one.value for one in season_app.caption if one.value.endswith(": gone")]
    tap(season_app, "scout_undo")
    assert not season().history.gone(0).any()


def test_a_tap_that_was_answered_says_nothing_of_a_plant_again(season_app, season, monkeypatch):
    go(season_app, "scout")
    tap(season_app, "scout_clean")
    with monkeypatch.context() as patch:  # a page as it was drawn before that tap
        patch.setattr(scouting, "taps", lambda: 0)
        season_app.run()
    tap(season_app, "scout_clean")
    assert len(season().history.inspections) == 1
    tap(season_app, "scout_clean")
    assert len(season().history.inspections) == 2


def test_the_scout_takes_the_last_tap_back(season_app, season):
    go(season_app, "scout")
    tap(season_app, "scout_clean")
    before = place(season_app)
    tap(season_app, "scout_found")
    assert place(season_app) != before
    tap(season_app, "scout_undo")
    assert place(season_app) == before
    assert season().history.inspections.result.tolist() == [0]
    season().undo()
    season_app.button(key="scout_undo").click().run()
    assert season_app.error[0].value == texts.UNDONE_BEFORE


def test_a_scout_takes_back_what_is_said_beside_the_button_and_nobody_elses(season_app, season):
    go(season_app, "scout")
    tap(season_app, "scout_found")
    kept = season()
    numbered = plant_numbers(kept.plot.grid, kept.history.inspections.plant)
    said = f"Last: row {numbered.line[0]}, plant {numbered.number[0]}: found"
    assert said in [one.value for one in season_app.caption]
    others = Inspections.of(np.array([7, 9]), np.array([0, 0]), np.datetime64("2026-11-16"))
    kept.record(others.take(slice(1)), "scout mode", "Ben")
    go(season_app, "scout")
    assert said in [one.value for one in season_app.caption]
    tap(season_app, "scout_undo")
    assert season().history.inspections.plant.tolist() == [7]
    # what is left is Ben's
    assert not [one for one in season_app.button if one.key == "scout_undo"]


def test_a_tap_of_another_day_is_not_taken_back_here(season_app, season):
    kept = season()
    before = Inspections.of(np.array([7]), np.array([0]), np.datetime64("2026-11-17"))
    kept.record(before, "scout mode")
    go(season_app, "scout")
    assert not [one for one in season_app.button if one.key == "scout_undo"]


def test_one_hour_more_is_one_however_late_it_is(season_app, season):
    project, settings = season(), season().settings
    project.change(replace(settings, robot=settings.robot.with_hours(2.0)), settings)
    seconds = np.array([6 * 3600.0 + 120.0, 17 * 3600.0 + 1320.0])
    worked_on = Inspections.of(np.array([6, 7]), np.array([0, 0]), np.datetime64("2026-11-16"),
                               second=seconds)  # fmt: skip
    project.record(worked_on, "scout mode")
    go(season_app, "scout")
    assert "Done for today" in texts_of(season_app)
    tap(season_app, "scout_hour")
    assert "Done for today" not in texts_of(season_app)
    assert season().settings.robot.hours == 12.5
    tap(season_app, "scout_clean")


def test_on_a_full_disk_a_tap_says_so_and_counts_for_nothing(season_app, season, monkeypatch):
    def full(self, *_, **more):
        if more.get("keep", True):
            raise FileProblem("There must be room on the disk.")
        return plan(self, *_, **more)

    plan = Season.plan
    go(season_app, "scout")
    with monkeypatch.context() as patch:
        patch.setattr(Season, "plan", full)
        season_app.button(key="scout_found").click().run()
        assert "room on the disk" in season_app.error[0].value
        assert map_of(season_app)["layers"]
    assert not len(season().history.inspections)
    tap(season_app, "scout_found")
    assert not season_app.error
    assert len(season().history.inspections) == 1
    assert len(season().kept_route(date(2026, 11, 16)))


def hours_of_work(hours, who=""):
    """Return two inspections on the first day, hours apart."""
    second = 6 * 3600.0 + np.array([120.0, 3600.0 * hours])
    return Inspections.of(np.array([6, 7]), np.array([0, 0]), np.datetime64("2026-11-16"),
                          second=second, who=np.full(2, who, object))  # fmt: skip


def of_two(season, hours=1.0, late_s=0.0):
    """Make the season that of Ann, as long as it was, and Dan; return its settings."""
    before = season().settings
    dan = TeamMember("Dan", before.robot.with_hours(hours), starts_s=late_s)
    team = (TeamMember("Ann", before.robot), dan)
    season().change(replace(before, team=team), before)
    return season().settings


def choose(app, who):
    app.segmented_control(key=WHOSE_DAY).set_value(who).run()


def test_one_hour_more_is_of_the_one_of_a_team_who_is_chosen(season_app, season):
    settings = of_two(season)
    season().record(hours_of_work(1, "Dan"), "scout mode", "Dan")
    go(season_app, "scout")
    choose(season_app, "Dan")
    assert "Done for today" in texts_of(season_app)
    tap(season_app, "scout_hour")
    assert "Dan\u2069 · 2 h is in use now." in season_app.success[0].value
    ann, dan = season().settings.team
    assert (ann, dan.robot.hours) == (settings.team[0], 2.0)
    assert "Done for today" not in texts_of(season_app)


def test_a_member_s_start_is_said_and_begins_now_alone(season_app, season, monkeypatch):
    settings = of_two(season, late_s=2 * 3600.0)
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2026, 11, 16, 7, 30, tzinfo=UTC))
    go(season_app, "scout")
    choose(season_app, "Dan")
    assert "Work starts at 08:00 by the settings of this season; it is 09:30" in texts_of(
        season_app
    )
    tap(season_app, "begin_now")
    ann, dan = season().settings.team
    assert (ann, dan.starts_s) == (settings.team[0], 3.5 * 3600.0)
    assert season().settings.starts == settings.starts
    assert not [one for one in season_app.button if one.key == "begin_now"]


def test_a_day_that_is_past_gets_no_hour_more(season_app, season, monkeypatch):
    settings = season().settings
    season().change(replace(settings, robot=settings.robot.with_hours(0.5)), settings)
    season().record(hours_of_work(1), "scout mode")
    go(season_app, "scout")
    assert [one for one in season_app.button if one.key == "scout_hour"]
    monkeypatch.setattr(local_clock, "utc_now", lambda: datetime(2026, 11, 17, 7, tzinfo=UTC))
    app = opened("Gate 2026", day="2026-11-16")
    go(app, "scout")
    assert "Nothing to inspect on Mon 16 Nov" in texts_of(app)
    assert not [one for one in app.button if one.key == "scout_hour"]


def test_a_tap_that_contradicts_another_tab_is_asked_about_and_not_lost(season_app, season):
    go(season_app, "scout")
    plant = season().plan(date(2026, 11, 16)).route.plant[:1]
    season().record(Inspections.of(plant, np.array([0]), np.datetime64("2026-11-16")), "other tab")
    tap(season_app, "scout_found")
    assert not season_app.error
    assert "contradicts" in season_app.warning[0].value
    tap(season_app, "holds")
    assert season().history.inspections.result.tolist() == [1]
    assert season().history.inspections.plant.tolist() == plant.tolist()
