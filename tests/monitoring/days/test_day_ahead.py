"""What is left of a day, for whoever leaves now."""

from dataclasses import replace
from datetime import time

import numpy as np
import pytest

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.day_ahead import (
    DayAhead,
    WorkPart,
    inside,
    plan_ahead,
    planned_again,
    route_ahead,
    work_hours,
)
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.photos_asked import ask_photo
from fieldmon.planning.members import team_of
from fieldmon.plot import local_clock
from fieldmon.plot.robot import Robot
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def season(path):
    return Season(path)


def test_it_is_the_route_given_out_without_what_was_clean_until_something_is_found(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    given = route_ahead(fresh, BEGINS).plant
    told(fresh, "", given[:3], 21_700.0)
    for left in (route_ahead(fresh, BEGINS), plan_ahead(fresh, BEGINS).route):
        assert 0 < len(left) <= len(given) - 3, "some took longer than is charged for"
        assert left.plant.tolist() == given[3 : len(left) + 3].tolist()
        assert left.end_s <= fresh.scene(BEGINS).seconds_left + 1.0
    fresh.record(Inspections.of(given[3:4], np.ones(1, np.int8), BEGINS), "f")
    found = fresh.plan(BEGINS, keep=False).route.plant.tolist()
    assert found != given[4:].tolist()
    assert plan_ahead(fresh, BEGINS).route.plant.tolist() == found
    assert fresh.kept_route(BEGINS).tolist() == given.tolist(), "who only looks gives none out"
    assert route_ahead(fresh, BEGINS).plant.tolist() == found
    assert fresh.kept_route(BEGINS).tolist() == found


def test_who_is_alone_on_the_plot_has_the_route_and_hours_of_the_season_whoever_worked(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    dana = WorkPart(name="Dana")
    scouts.let_in(fresh, "Dana")
    given = route_ahead(fresh, BEGINS, dana).plant
    for plants, who in ((given[:4], "Dana"), (given[4:9], "")):
        results = np.arange(len(plants)) % 4 == 3
        fresh.record(Inspections.of(plants, results.astype(np.int8), BEGINS), "f", who)
    season, phone = plan_ahead(fresh, BEGINS), route_ahead(fresh, BEGINS, dana)
    assert phone.plant.tolist() == season.route.plant.tolist()
    assert work_hours(fresh, BEGINS, dana).left_s == season.scene.seconds_left
    again = planned_again(fresh, BEGINS, dana, season.scene.seconds_left + 60.0)
    assert again.plant.tolist() == phone.plant.tolist()


def test_a_day_that_was_worked_to_its_end_by_one_gives_another_nothing_more(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    dana, day_s = WorkPart(name="Dana"), fresh.settings.robot.day_s
    scouts.let_in(fresh, "Dana")
    given = route_ahead(fresh, BEGINS, dana).plant
    fresh.record(Inspections.of(given[:2], np.zeros(2, np.int8), BEGINS), "f", "Dana")
    results = (np.arange(len(given) - 2) % 9 == 0).astype(np.int8)
    fresh.record(Inspections.of(given[2:], results, BEGINS), "robot.csv")
    assert len(route_ahead(fresh, BEGINS, dana)) == 0
    assert len(planned_again(fresh, BEGINS, dana, day_s)) == 0
    kept = fresh.planned_and_done(BEGINS)
    assert (kept.planned, kept.left) == (len(given), 0)
    assert kept.hours <= fresh.settings.robot.hours


def test_a_day_that_runs_is_cut_at_its_end_by_the_clock_for_all_alike(tmp_path, monkeypatch):
    fresh = a_season(tmp_path / "fresh.gpkg")
    dana, day_s = WorkPart(name="Dana"), fresh.settings.robot.day_s
    scouts.let_in(fresh, "Dana")
    given = route_ahead(fresh, BEGINS, dana)
    told(fresh, "Dana", given.plant[:1], 6 * 3600.0 + 120.0)
    now = local_clock.local_clock(fresh.plot.field).moment(BEGINS, time(6, 45))
    monkeypatch.setattr(local_clock, "utc_now", lambda: now)
    season, phone = plan_ahead(fresh, BEGINS), route_ahead(fresh, BEGINS, dana)
    assert season.scene.seconds_left == work_hours(fresh, BEGINS, dana).left_s == day_s - 2700.0
    assert season.route.notes.start.time() == time(6, 45)
    assert phone.plant.tolist() == season.route.plant.tolist()
    assert 0 < len(phone) < len(given) - 1
    assert phone.plant.tolist() == given.plant[1 : len(phone) + 1].tolist()
    assert phone.end_s <= day_s - 2700.0


def test_where_none_was_given_out_one_is(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    route = route_ahead(fresh, BEGINS)
    assert len(route) > 20
    assert fresh.kept_route(BEGINS).tolist() == route.plant.tolist()
    again = route_ahead(fresh, BEGINS)
    assert again.plant.tolist() == route.plant.tolist()
    # the same way costs the same, planned or given out
    assert again.arrive_s == pytest.approx(route.arrive_s, abs=1e-6)
    assert again.end_s == pytest.approx(route.end_s, abs=1e-6)


def test_a_part_has_stops_in_its_rows_only_and_is_given_out_to_nobody_else(season):
    given = season.kept_route(BEGINS)
    route = planned_again(season, BEGINS, WorkPart((1, 3)))
    assert inside(season.plant_numbers, (1, 3))[route.plant].all()
    assert len(route)
    assert season.kept_route(BEGINS).tolist() == given.tolist()
    ahead = route_ahead(season, BEGINS, WorkPart((1, 3)))
    assert inside(season.plant_numbers, (1, 3))[ahead.plant].all()


def test_a_part_is_all_plants_of_its_rows_and_no_others(season):
    line = season.plant_numbers.line.tolist()
    for rows in ((1, 3), (2, 2), (4, 400), (3, 2)):
        wanted = [rows[0] <= one <= rows[1] for one in line]
        assert inside(season.plant_numbers, rows).tolist() == wanted
    assert inside(season.plant_numbers, None).all()


def test_the_rest_planned_again_fits_what_is_left_of_the_hours(season):
    done = season.history.inspections.plant
    short = planned_again(season, BEGINS, seconds_left=900)
    assert 0 < short.end_s <= 900
    assert not np.isin(short.plant, done).any()
    assert len(planned_again(season, BEGINS, seconds_left=0)) == 0


def test_the_hours_of_each_run_from_the_first_inspection_of_that_person(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    day_s, plants = fresh.settings.robot.day_s, fresh.plan(BEGINS).route.plant
    late = np.array([15.5, 16.5]) * 3600.0
    first_s = fresh.plan(BEGINS).route.leave_s[0]
    fresh.record(Inspections.of(plants[:2], np.zeros(2, np.int8), BEGINS, second=late), "f", "Ann")
    rows = (1, int(fresh.plant_numbers.line.max()))
    ann, ben = (work_hours(fresh, BEGINS, WorkPart(rows, who)) for who in ("Ann", "Ben"))
    assert ann.left_s == pytest.approx(day_s - 3600 - first_s)
    assert ben.left_s == day_s
    assert work_hours(fresh, BEGINS) == work_hours(fresh, BEGINS, WorkPart(name="Ben")) == ann
    fresh.record(Inspections.of(plants[2:3], np.zeros(1, np.int8), BEGINS), "f", "Cem")
    assert 0 < work_hours(fresh, BEGINS, WorkPart(rows, "Cem")).left_s < day_s
    assert len(planned_again(fresh, BEGINS, WorkPart((1, 3), "Ben"), day_s)), "though it is evening"


def test_nothing_is_left_where_all_was_inspected(season):
    everything = np.arange(len(season.plot.grid))
    season.record(
        Inspections.of(everything, np.zeros(len(everything), np.int8), BEGINS), confirmed=True
    )
    assert len(route_ahead(season, BEGINS)) == 0


def test_each_of_a_team_has_the_route_that_the_teams_plan_gives(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    alone = fresh.settings
    team = tuple(
        replace(one, name=name)
        for one, name in zip(team_of(2, alone.robot), ("Ann", "Ben"), strict=True)
    )
    fresh.change(replace(alone, team=team), alone)
    ann, ben = (route_ahead(fresh, BEGINS, WorkPart(name=name)) for name in ("ann", "Ben"))
    assert len(ann)
    assert len(ben)
    assert not set(ann.plant) & set(ben.plant)
    short = planned_again(fresh, BEGINS, WorkPart(name="Ben"), seconds_left=1200)
    assert 0 < short.end_s <= 1200


def told(season, who, plants, from_s):
    """Record that somebody found plants clean, a minute each."""
    second = from_s + 60.0 * np.arange(len(plants))
    done = Inspections.of(plants, np.zeros(len(plants), np.int8), BEGINS, second=second)
    season.record(done, "f", who)


def begins_at(season, route):
    """Return the plant whose place in its aisle is nearest to where a way begins."""
    return int(np.hypot(*(season.plot.grid.xy_m - route.line_m[0]).T).argmin())


def test_each_scout_has_a_whole_day_in_their_own_rows_and_goes_on_from_where_they_stand(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg", robot=Robot(hours=0.7))
    ann, dan = WorkPart((1, 8), "Ann"), WorkPart((11, 19), "Dan")
    for part in (ann, dan):
        scouts.let_in(fresh, part.name, part.rows)
    routes = {part: route_ahead(fresh, BEGINS, part) for part in (ann, dan)}
    for part, route in routes.items():
        assert inside(fresh.plant_numbers, part.rows)[route.plant].all()
        assert 0.9 * fresh.settings.robot.day_s < route.end_s <= fresh.settings.robot.day_s
        assert route_ahead(fresh, BEGINS, part).plant.tolist() == route.plant.tolist()
    told(fresh, "Ann", routes[ann].plant[:5], 21_700.0)
    told(fresh, "Dan", routes[dan].plant[:5], 22_000.0)
    line = fresh.plant_numbers.line
    for again in (route_ahead, lambda *of: planned_again(*of, seconds_left=1200.0)):
        for part, route in routes.items():
            rest = again(fresh, BEGINS, part)
            stands = route.plant[4]
            assert line[begins_at(fresh, rest)] == pytest.approx(line[stands], abs=1)
            assert rest.plant[0] in route.plant[5:]
            assert rest.arrive_s[0] < 60.0
    assert work_hours(fresh, BEGINS, ann).left_s == fresh.scene(BEGINS, who="Ann").seconds_left


def test_scouts_with_codes_for_the_same_plants_share_them(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    ann, ben = WorkPart(name="Ann"), WorkPart(name="Ben")
    scouts.let_in(fresh, "Ann")
    alone = route_ahead(fresh, BEGINS, ann)
    assert fresh.kept_route(BEGINS).tolist() == alone.plant.tolist(), "the season's own"
    scouts.let_in(fresh, "Ben")
    routes = [route_ahead(fresh, BEGINS, part) for part in (ann, ben, ann)]
    assert DayAhead.of(fresh, BEGINS).crew(ann) == ("Ann", "Ben")
    assert len(routes[0])
    assert len(routes[1])
    assert not set(routes[0].plant) & set(routes[1].plant)
    assert routes[2].plant.tolist() == routes[0].plant.tolist()
    rest = planned_again(fresh, BEGINS, ben, seconds_left=900.0)
    assert 0 < rest.end_s <= 900.0
    ask_photo(fresh, int(routes[1].plant[3]), "", "Old")
    assert [len(DayAhead.of(fresh, BEGINS).asked_of(part)) for part in (ann, ben)] == [0, 1]


def test_a_code_with_other_rows_is_a_full_day_in_these(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg", robot=Robot(hours=0.7))
    for rows in (None, (1, 8), (11, 19)):
        scouts.let_in(fresh, "Dan", rows)
        route = route_ahead(fresh, BEGINS, WorkPart(rows, "Dan"))
        assert inside(fresh.plant_numbers, rows)[route.plant].all()
        assert 0.9 * fresh.settings.robot.day_s < route.end_s <= fresh.settings.robot.day_s
        again = route_ahead(fresh, BEGINS, WorkPart(rows, "Dan"))
        assert again.plant.tolist() == route.plant.tolist()


def test_who_is_left_alone_has_the_seasons_own_and_who_comes_back_takes_nothing_of_it(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    ann, dan = WorkPart(name="Ann"), WorkPart(name="Dan")
    scouts.let_in(fresh, "Ann")
    alone = route_ahead(fresh, BEGINS, ann).plant.tolist()
    scouts.let_in(fresh, "Dan")
    route_ahead(fresh, BEGINS, dan)
    shared = route_ahead(fresh, BEGINS, ann).plant.tolist()
    assert shared != alone
    scouts.withdraw_key(fresh, "Dan")
    assert route_ahead(fresh, BEGINS, ann).plant.tolist() == alone
    rest = planned_again(fresh, BEGINS, ann).plant
    assert route_ahead(fresh, BEGINS, ann).plant.tolist() == rest.tolist()
    scouts.let_in(fresh, "Dan")
    routes = [route_ahead(fresh, BEGINS, part).plant for part in (dan, ann)]
    assert len(routes[0])
    assert not set(routes[0]) & set(routes[1])


def test_a_name_beside_the_team_has_its_own_rows_or_nothing(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg", team=team_of(2, Robot(hours=0.5)))
    team = {plant for one in (1, 2) for plant in route_ahead(fresh, BEGINS, robot(one)).plant}
    assert len(route_ahead(fresh, BEGINS, WorkPart(name="Anna"))) == 0
    own = route_ahead(fresh, BEGINS, WorkPart((1, 12), "Anna"))
    assert len(own)
    assert inside(fresh.plant_numbers, (1, 12))[own.plant].all()
    assert not {*own.plant} & team


def robot(k):
    return WorkPart(name=f"robot-{k}")


def test_who_begins_in_the_evening_has_the_whole_day_for_the_phone_and_for_the_season(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    day_s, plants = fresh.settings.robot.day_s, fresh.plan(BEGINS).route.plant
    assert fresh.work(BEGINS).begun_s == 6 * 3600.0
    told(fresh, "Ann", plants[:3], 20.5 * 3600.0)
    left_s = work_hours(fresh, BEGINS, WorkPart(name="Ann")).left_s
    assert day_s - 300.0 < left_s < day_s
    today = fresh.plan(BEGINS)
    assert today.scene.seconds_left == left_s
    assert len(today.route)
    assert today.route.notes.start.time() == time(20, 32)
    later = fresh.plan(BEGINS, time(21, 2), keep=False).scene.seconds_left
    assert later == pytest.approx(left_s - 1800.0, abs=1.0)


def test_a_route_by_the_clock_runs_from_the_start_that_the_settings_say(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    route = fresh.plan(BEGINS).route
    told(fresh, "", route.plant[:1], 6 * 3600.0 + route.leave_s[0] + 200.0)
    assert fresh.work(BEGINS).begun_s == 6 * 3600.0


def test_no_plant_in_an_aisle_that_another_of_the_team_has_is_ones_own(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg", team=team_of(2))
    one, other = (day.route.plant for day in fresh.plan_each(BEGINS))
    ahead = DayAhead.of(fresh, BEGINS)
    aisle = fresh.plot.grid.corridor[fresh.plot.grid.row]
    for name, mine, theirs in (("robot-1", one, other), ("robot-2", other, one)):
        own = ahead.in_own_aisles(WorkPart(name=name))
        assert own[mine].all()
        assert not own[np.isin(aisle, np.setdiff1d(aisle[theirs], aisle[mine]))].any()
        assert own[~np.isin(aisle, aisle[theirs])].all()


def test_who_shares_rows_has_no_plant_in_an_aisle_of_the_others(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    for name in ("Ann", "Ben"):
        scouts.let_in(fresh, name)
    ann, ben = (route_ahead(fresh, BEGINS, WorkPart(name=name)).plant for name in ("Ann", "Ben"))
    own = DayAhead.of(fresh, BEGINS).in_own_aisles(WorkPart(name="Ann"))
    assert own[fresh.kept_route(BEGINS, "Ann")].all()
    assert not own[np.setdiff1d(ben, ann)].any()
