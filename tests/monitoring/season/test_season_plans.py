"""A season's days are planned from all that is known, and their routes are kept."""

from dataclasses import replace
from datetime import date, datetime, time, timedelta

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes.earlier_settings import settings_on
from fieldmon.monitoring.days.day_ahead import WorkPart, route_ahead
from fieldmon.monitoring.days.kept_routes import kept_last, planned_only
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.monitoring.settings.shift_work import Besides
from fieldmon.planning.members import person_key, team_of
from fieldmon.planning.wishes import Wishes
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.travel import GATE
from tests.monitoring.seasons import (
    BEGINS,
    ROBOT,
    a_plot,
    a_season,
    all_on,
    clock_on,
    on,
    some_records,
    some_results,
)


def test_planning_half_way_starts_where_the_robot_stands_with_the_hours_that_are_left(season):
    whole = season.plan(BEGINS)
    results = some_results(season, n=8)
    season.record(results, "the morning")
    rest = season.plan(BEGINS)
    assert rest.scene.at == results.plant[-1]
    gone_s = whole.route.arrive_s[7] + ROBOT.visit_s
    assert rest.scene.seconds_left == pytest.approx(ROBOT.day_s - gone_s, abs=1e-6)
    assert not np.isin(rest.route.plant, results.plant).any()
    later = season.plan(BEGINS, time(7, 15))
    assert later.scene.seconds_left == ROBOT.day_s - 75 * 60
    assert len(later.route) < len(rest.route)
    with season.store.reading() as db:
        kept = db.execute("SELECT day, revision, starts FROM routes ORDER BY fid").fetchall()
    assert [(day, revision) for day, revision, _ in kept] == [(0, 1), (0, 2), (0, 3)]
    assert kept[2][2] == "2026-04-06T07:15:00"


def test_the_time_of_the_last_result_is_the_time_of_day(season):
    results = some_results(season, n=3)
    timed = Inspections.of(
        results.plant, results.result, results.date[0], second=np.array([22000.0, 21700.0, 21900.0])
    )
    season.record(timed, "phone")
    rest = season.plan(BEGINS)
    assert rest.scene.at == results.plant[0]  # the one inspected last, not the one listed last
    assert rest.scene.seconds_left == ROBOT.day_s - 400.0


def night_of(season, day, who=""):
    """Record all of the route that somebody has, at its times; return when it began and ended."""
    (route,) = (
        one.route for one in season.plan_each(on(day)) if one.route.notes.who == (who or None)
    )
    begins = route.notes.start
    moments = np.datetime64(begins) + np.round(route.leave_s).astype("timedelta64[s]")
    days = moments.astype("datetime64[D]")
    noted = Inspections.of(
        route.plant, np.full(len(route), CLEAN), days,
        second=(moments - days) / np.timedelta64(1, "s"), who=np.full(len(route), who, object),
    )  # fmt: skip
    season.record(noted, f"{who} {day}")
    return begins, moments[-1].item()


@pytest.mark.parametrize(("returns", "late_s"), [(True, None), (False, None), (False, 2400.0)])
def test_each_night_of_a_season_has_its_own_begin_and_all_its_hours(tmp_path, returns, late_s):
    """Those before went past midnight, too. With `late_s` two of a team, one so much later."""
    robot, starts = replace(ROBOT, hours=1.0, returns=returns), time(23, 30)
    season = a_season(tmp_path / "nights.gpkg", robot=robot, starts=starts)
    late = {"": 0.0}
    if late_s is not None:
        one, other = team_of(2, robot)
        team = (one, replace(other, starts_s=late_s))
        season.change(replace(season.settings, team=team), season.settings)
        late = {"robot-1": 0.0, "robot-2": late_s}
    for day in range(2):
        for who, after_s in late.items():
            scene = season.scene(on(day), who=who)
            assert scene.seconds_left == robot.day_s
            assert (scene.at == GATE) == (returns or day == 0)
            begins, ends = night_of(season, day, who)
            assert begins == datetime.combine(on(day), starts) + timedelta(seconds=after_s)
            assert ends.date() == on(day + 1)
            done = season.work(on(day), who).inspections.plant
            assert done.tolist() == season.kept_route(on(day), who).tolist()
            assert season.scene(on(day), who=who).seconds_left < 300.0
        held = season.planned_and_done(on(day))
        assert (held.left, held.added) == (0, 0)


def test_the_time_now_may_be_past_midnight_where_the_work_is(season):
    season.change(replace(season.settings, starts=time(23)), season.settings)
    assert season.scene(BEGINS, time(0, 15)).seconds_left == ROBOT.day_s - 75 * 60
    assert season.scene(BEGINS, time(12)).seconds_left == ROBOT.day_s
    start = season.plan(BEGINS, time(0, 15)).route.notes.start
    assert start == datetime.combine(on(1), time(0, 15))


def test_a_stray_result_late_in_the_evening_takes_nothing_of_the_next_morning(season):
    late = some_results(season, n=1)
    late = Inspections.of(late.plant, late.result, late.date[0], second=np.array([82_800.0]))
    season.record(late, "by hand")
    early = Inspections.of(np.array([7]), np.array([CLEAN]), np.datetime64(on(1)),
                           second=np.array([22_000.0]))  # fmt: skip
    season.record(early, "phone")
    assert season.scene(on(1)).seconds_left == ROBOT.day_s - 400.0


def test_a_plant_that_could_not_be_inspected_is_left_alone_today_and_comes_back(season):
    results = some_results(season, n=2)
    season.record(Inspections.of(results.plant[:1], np.array([0]), results.date[0]), "phone")
    before = season.evening(BEGINS)[results.plant[1]]
    season.record(Inspections.of(results.plant[1:], np.array([SKIPPED]), results.date[0]), "phone")
    assert season.evening(BEGINS)[results.plant[1]] == before
    assert season.history.states(0)[results.plant[1]] == -1
    assert results.plant[1] not in season.plan(BEGINS).route.plant
    assert season.history.last_inspected(0)[results.plant[1]] == -1


def test_planning_twice_keeps_one_route(season):
    one, other = season.plan(BEGINS), season.plan(BEGINS)
    assert np.array_equal(one.route.plant, other.route.plant)
    assert np.array_equal(season.kept_route(BEGINS), one.route.plant)
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM routes").fetchone() == (1,)


def test_a_date_of_no_season_is_a_sentence(season):
    with pytest.raises(SettingError, match="began on 2026-04-06"):
        season.plan(date(2026, 4, 1))


def test_the_time_now_is_a_time_or_a_sentence(season):
    with pytest.raises(SettingError, match="must be a time, but it is 'noon'"):
        season.plan(BEGINS, "noon")
    said, meant = (season.plan(BEGINS, now, keep=False) for now in ("07:00", time(7)))
    assert said.scene.seconds_left == meant.scene.seconds_left


def test_an_earlier_day_is_planned_by_what_counted_then(season, monkeypatch):
    clock_on(monkeypatch, 0)
    first = season.settings
    season.plan(on(0))
    season.record(some_results(season, n=3))
    before = season.plan(on(0), keep=False)
    longer = replace(first, robot=first.robot.with_hours(3.0), sampler="naive")
    season.change(longer, first)
    assert season.planned_by(on(0)) == longer  # the last day goes on by what counts now
    season.record(some_results(season, day=2, n=3))
    assert season.planned_by(on(0)) == first
    assert season.planned_by(on(1)) == first  # nothing was planned or recorded of it
    assert season.planned_by(on(2)) == longer
    again = season.plan(on(0), keep=False)
    assert again.scene.robot == first.robot
    assert np.array_equal(again.route.plant, before.route.plant)
    assert again.route.notes.sampler == first.sampler
    assert season.plan(on(2), keep=False).scene.robot.hours == 3.0


def test_a_forgotten_day_is_planned_by_what_counts_now_if_that_is_asked_for(season):
    first, team = season.settings, team_of(2)
    season.change(replace(first, team=team), first)
    season.record(some_results(season, n=3))
    season.change(first, season.settings)
    season.record(some_results(season, day=2, n=3))
    assert season.planned_by(on(1)).team == team
    with season.as_now(on(1)):
        assert season.planned_by(on(1)) == first
        assert season.planned_by(on(0)).team == team
        season.plan(on(1))
    assert season.planned_by(on(1)) == first, "it goes on by the plan that is kept"


def test_the_last_worked_day_is_an_earlier_one_once_it_is_past(season, monkeypatch):
    first = season.settings
    season.record(some_results(season, n=3))
    season.change(replace(first, robot=first.robot.with_hours(3.0)), first)
    clock_on(monkeypatch, 0)
    assert season.planned_by(on(0)) == season.settings
    clock_on(monkeypatch, 1)
    assert season.planned_by(on(0)) == first
    assert season.planned_by(on(1)) == season.settings


def test_a_day_that_is_planned_again_keeps_the_team_it_was_worked_with(season, monkeypatch):
    clock_on(monkeypatch, 0)
    first, names = season.settings, ("rob1", "Mia")
    team = tuple(replace(one, name=name) for one, name in zip(team_of(2), names, strict=True))
    season.change(replace(first, team=team), first)
    days = season.plan_each(on(0))
    season.record(some_results(season, n=3), "f", "Mia")
    clock_on(monkeypatch, 1)
    later = (replace(team[0], starts_s=3600.0), replace(team[1], name="Noa"), *team_of(1))
    season.change(replace(season.settings, team=later), season.settings)
    for _ in range(2):
        again = season.plan_each(on(0))
        assert [one.route.notes.who for one in again] == [*names]
        assert settings_on(season, on(0)).team == team
        assert season.plan(on(0), who="mia").route.notes.who == "Mia"
    assert np.isin(again[1].route.plant, days[1].route.plant).any()
    assert season.kept_route(on(0), "mia").tolist() == again[1].route.plant.tolist()
    with season.store.reading() as db:
        assert {*kept_last(db, 0)} == {*map(person_key, names)}
    assert season.planned_by(on(1)).team == later


def test_beside_others_the_seasons_robot_goes_on_from_where_it_was(season):
    route = season.plan(on(0), keep=False).route
    for k, who, second in ((0, "", 21_700.0), (5, "Ann", 30_000.0)):
        one = Inspections.of(route.plant[k : k + 1], np.zeros(1, np.int8), np.datetime64(on(0)),
                             second=np.array([second]))  # fmt: skip
        season.record(one, f"file {k}", who)
    alone, beside = (season.plan(on(0), keep=False, who=who) for who in (None, Besides(("ann",))))
    assert (alone.scene.at, beside.scene.at) == (route.plant[5], route.plant[0])
    assert beside.route.notes.start.time() == time(6, 1, 40)
    assert route.plant[5] not in beside.route.plant


def test_a_kept_plan_is_held_to_what_was_done_be_it_that_a_plant_could_not_be_inspected(season):
    assert season.planned_and_done(on(0)) is None
    first = season.plan(on(0))
    n = len(first.route)
    besides = np.setdiff1d(np.arange(len(season.plot.grid)), first.route.plant)[:2]
    done = np.concatenate([first.route.plant[:4], besides.astype(np.int32)])
    results = np.array([CLEAN, CLEAN, CLEAN, SKIPPED, CLEAN, CLEAN], np.int8)
    season.record(Inspections.of(done, results, np.datetime64(on(0))))
    held = season.planned_and_done(on(0))
    assert (held.planned, held.done, held.left, held.added) == (n, 4, n - 4, 2)
    assert held.hours == pytest.approx(first.route.end_s / 3600, abs=1e-3)
    rest = season.plan(on(0))  # what is planned anew takes the place of what was not done
    held = season.planned_and_done(on(0))
    assert (held.planned, held.done) == (len(rest.route) + 4, 4)
    assert ROBOT.hours - 0.2 < held.hours <= ROBOT.hours + 0.01
    assert Season(season.path).planned_and_done(on(1)) is None


def test_planned_days_that_are_over_and_of_which_nothing_is_recorded_are_told(season, monkeypatch):
    for day in (0, 2, 3, 6):
        all_on(monkeypatch, day)
        season.plan(on(day))
    all_on(monkeypatch, 7)
    season.record(some_results(season, n=1, day=2))
    closed = Inspections.of(np.array([3]), np.array([SKIPPED], np.int8), np.datetime64(on(3)))
    assert planned_only(season, on(6)) == (on(0), on(3), on(6))
    season.record(closed)
    assert planned_only(season, on(6)) == (on(0), on(6))
    assert planned_only(season, on(5)) == (on(0),)
    all_on(monkeypatch, 6)
    assert planned_only(season, on(6)) == (on(0),), "the last one is not over"


def test_a_day_planned_to_look_ahead_or_afterwards_is_none_that_lacks_its_records(
    season, monkeypatch
):
    all_on(monkeypatch, 1)
    for day in (2, 3, 4):
        season.plan(on(day))
    all_on(monkeypatch, 3)
    season.record(some_results(season, n=1, day=2))
    season.plan(on(1))
    season.plan(on(6))
    all_on(monkeypatch, 5)
    assert planned_only(season, on(6)) == (), "not what was planned before the finds of day 2"
    all_on(monkeypatch, 7)
    assert planned_only(season, on(6)) == (on(6),), "nothing was recorded since"
    with season.changing() as change:
        change.db.execute("DELETE FROM log")
    assert planned_only(season, on(6)) == (on(1), on(3), on(4), on(6)), "an old file had no log"


@pytest.mark.parametrize(("name", "off_s"), [("", 4200.0), ("", -3600.0), ("Ann", 4200.0)])
def test_the_hours_of_a_day_that_began_late_or_early_are_those_of_its_work(season, name, off_s):
    if name:
        scouts.let_in(season, name)
    first = season.plan(BEGINS).route
    at_s = np.array([6 * 3600 + off_s])
    n, day = len(first), np.datetime64(BEGINS)
    one = Inspections.of(first.plant[:1], np.zeros(1, np.int8), day, second=at_s)
    season.record(one, "phone", name)
    held = season.planned_and_done(BEGINS)
    assert (held.planned, held.hours) == (n, pytest.approx(first.end_s / 3600, abs=1e-3))
    season.plan(BEGINS)
    assert ROBOT.hours - 0.1 < season.planned_and_done(BEGINS).hours <= ROBOT.hours + 0.01


def test_the_plan_of_a_day_is_that_of_those_who_are_out(tmp_path):
    plot = a_plot()
    today = local_clock(plot.field).today()
    settings = MonitoringSettings(today, robot=ROBOT)
    season = Season.create(tmp_path / "out.gpkg", plot, some_records(plot), settings)
    own = season.plan(today).route
    parts = [WorkPart(name=name) for name in ("Ann", "Dan")]
    for part in parts:
        scouts.let_in(season, part.name)
    held = season.planned_and_done(today)
    assert held.planned == len(own), "until something was given to one of them"
    ann, dan = (route_ahead(season, today, part) for part in parts)
    held = season.planned_and_done(today)
    assert (held.planned, held.people) == (len(ann) + len(dan), 2)
    assert held.hours == pytest.approx((ann.end_s + dan.end_s) / 3600, abs=0.01)
    done = Inspections.of(dan.plant[:3], np.zeros(3, np.int8), np.datetime64(today))
    season.record(done, "f", "Dan")
    scouts.withdraw_key(season, "Dan")
    held = season.planned_and_done(today)
    assert (held.planned, held.done, held.people) == (len(ann) + 3, 3, 1)


def test_a_code_for_some_rows_leaves_the_rest_of_the_days_plan_as_it_is(tmp_path):
    season = a_season(tmp_path / "rows.gpkg")
    own = season.plan(BEGINS).route.plant
    line, day = season.plant_numbers.line, np.datetime64(BEGINS)
    rows, last = (int(line[own[0]]),) * 2, int(line.max())
    scouts.let_in(season, "Ann", rows)
    ann = route_ahead(season, BEGINS, WorkPart(rows, "Ann"))
    others = own[line[own] != rows[0]]
    held = season.planned_and_done(BEGINS)
    assert (held.planned, held.people) == (len(ann) + len(others), 2)
    counted = season.planned_and_done(BEGINS, "").hours * len(others) / len(own)
    assert held.hours == pytest.approx(ann.end_s / 3600 + counted, abs=0.01)
    season.record(Inspections.of(others[:2], np.zeros(2, np.int8), day), "typed in")
    held = season.planned_and_done(BEGINS)
    assert (held.done, held.added, held.left) == (2, 0, len(ann) + len(others) - 2)
    # once others have all its rows nobody goes by it
    routes = [ann]
    for name, (low, high) in {"Ben": (1, rows[0] - 1), "Cem": (rows[0] + 1, last)}.items():
        if low <= high:
            scouts.let_in(season, name, (low, high))
            routes.append(route_ahead(season, BEGINS, WorkPart((low, high), name)))
    held = season.planned_and_done(BEGINS)
    assert held.people == len(routes)
    assert held.left == sum(map(len, routes))


def test_a_code_taken_back_on_a_later_day_changes_no_day_before(tmp_path):
    season = a_season(tmp_path / "out.gpkg")
    parts = [WorkPart(name=name) for name in ("Ann", "Dan")]
    for part in parts:
        scouts.let_in(season, part.name)
    route_ahead(season, BEGINS, parts[0])
    before = season.planned_and_done(BEGINS)
    scouts.withdraw_key(season, "Dan")
    assert season.planned_and_done(BEGINS) == before


def test_the_plans_of_a_team_are_held_to_what_each_and_all_did(tmp_path):
    season = a_season(tmp_path / "team.gpkg", team=team_of(2, ROBOT))
    names = [member.name for member in season.settings.team]
    days = season.plan_each(BEGINS)
    done = days[0].route.plant[:3]
    who = np.full(3, names[0])
    season.record(Inspections.of(done, np.zeros(3, np.int8), np.datetime64(BEGINS), who=who))
    of_all, first, second = (season.planned_and_done(BEGINS, name) for name in (None, *names))
    assert (first.done, second.done, of_all.done) == (3, 0, 3)
    assert first.planned == len(days[0].route)
    assert of_all.planned == first.planned + second.planned


@pytest.mark.parametrize("starts", [time(2), time(9)])
def test_a_day_planned_again_with_another_start_takes_the_hours_of_its_last_plan(tmp_path, starts):
    season = a_season(tmp_path / "again.gpkg")
    season.plan(BEGINS)
    season.change(replace(season.settings, starts=starts), season.settings)
    rest = season.plan(BEGINS).route
    assert season.planned_and_done(BEGINS).hours == pytest.approx(rest.end_s / 3600)


def test_plants_that_could_not_be_inspected_are_in_nobodys_plan_of_the_next_day(tmp_path):
    team = team_of(2, ROBOT)
    for name, choices in (("alone", {}), ("team", {"team": team})):
        season = a_season(tmp_path / f"{name}.gpkg", **choices)
        stops = np.concatenate([one.route.plant for one in season.plan_each(on(0))])
        skipped = np.sort(stops[::3])
        season.record(Inspections.of(skipped, np.full(len(skipped), SKIPPED), np.datetime64(on(0))))
        free = np.setdiff1d(np.arange(len(season.plot.grid)), skipped)
        for day in (1, 2):
            days = season.plan_each(on(day))
            assert all(len(one.route) for one in days)
            parts = [WorkPart(name=one.name) for one in choices.get("team", ())] or [WorkPart()]
            routes = [one.route for one in days]
            routes += [route_ahead(season, on(day), part) for part in parts]
            asked = np.concatenate([route.plant for route in routes])
            assert np.isin(asked, free).all() == (day == 1)
            if day == 1:
                assert np.flatnonzero(days[0].scene.skipped).tolist() == skipped.tolist()


def test_who_wishes_for_a_plant_that_is_left_out_has_it_in_the_plan_and_in_the_route_given_out(
    season,
):
    wanted = season.plan(on(0)).route.plant[:2]
    for day in (0, 2, 5):  # left out for four days more
        seen = Inspections.of(wanted, np.full(2, SKIPPED), np.datetime64(on(day)))
        season.record(seen)
    wishes = Wishes((int(wanted[0]),))
    assert wanted[0] in season.plan(on(6), wishes=wishes).route.plant
    kept = route_ahead(season, on(6))
    assert wanted[0] in kept.plant
    assert wanted[1] not in kept.plant
    seen = Inspections.of(wanted[:1], np.array([SKIPPED]), np.datetime64(on(6)))
    season.record(seen)
    for rest in (season.plan(on(6), wishes=wishes).route, route_ahead(season, on(6))):
        assert wanted[0] not in rest.plant
