"""A season of several: who did what, and the rest of a day planned for all."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import time, timedelta
from threading import Barrier
from time import sleep

import numpy as np
import pytest

from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.settings.settings import as_json, from_json
from fieldmon.planning.meetings import meetings
from fieldmon.planning.members import TeamMember, Teamwork, team_of
from fieldmon.plot.robot import Robot, scout
from tests.monitoring.seasons import BEGINS, ROBOT, a_season, state
from tests.monitoring.working import started, team_day_by_day

TWO = team_of(2, Robot(hours=0.7))


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    """Make a season of two with the routes of its first day; once."""
    path = tmp_path_factory.mktemp("team") / "season.gpkg"
    season = a_season(path, team=TWO)
    season.plan_each(BEGINS)
    return path


@pytest.fixture
def season(planned, tmp_path):
    """Give a copy of that season."""
    copy = tmp_path / "season.gpkg"
    copy.write_bytes(planned.read_bytes())
    return Season(copy)


def done(season, who, n, found=()):
    """Return what one of the team found on the first plants of its route."""
    plants = season.kept_route(BEGINS, who)[:n]
    result = np.where(np.isin(np.arange(n), found), FOUND, CLEAN)
    names = np.full(n, who, object)
    return Inspections.of(plants, result, np.datetime64(BEGINS, "D"), who=names)


def test_each_of_a_team_has_a_route_of_its_own_and_nobody_meets(season):
    days = season.plan_each(BEGINS, keep=False)
    stops = np.concatenate([day.route.plant for day in days])
    assert len(np.unique(stops)) == len(stops) > 0
    assert meetings([day.route for day in days], np.zeros(2)) == []
    assert [day.route.notes.who for day in days] == ["robot-1", "robot-2"]
    for who, day in zip(("robot-1", "ROBOT-2"), days, strict=True):
        assert (season.kept_route(BEGINS, who) == day.route.plant).all()
        assert (season.plan(BEGINS, keep=False, who=who).route.plant == day.route.plant).all()


def test_the_file_says_whose_each_route_is(season):
    with season.store.reading() as db:
        said = db.execute("SELECT who, revision FROM routes ORDER BY fid").fetchall()
    assert said == [("robot-1", 1), ("robot-2", 1)]


def test_the_rest_of_a_day_is_planned_for_all_from_where_each_stands(season):
    both = [done(season, "robot-1", 4), done(season, "robot-2", 7, [6])]
    for results in both:
        season.record(results)
    first, second = season.plan_each(BEGINS)
    for results, day in zip(both, (first, second), strict=True):
        assert day.scene.at == results.plant[-1]
        assert day.scene.seconds_left < TWO[0].robot.day_s - len(results) * ROBOT.visit_s
    seen = np.concatenate([results.plant for results in both])
    assert not np.isin(np.concatenate([first.route.plant, second.route.plant]), seen).any()
    # the find is news to the one that did not make it, too
    assert (first.scene.chance == second.scene.chance).all()


def test_aisles_stay_with_who_had_them_unless_the_stated_gain_is_there(season):
    steady = replace(season.settings, teamwork=Teamwork(least_gain=1e9))
    season.change(steady, season.settings)
    aisle = season.plot.grid.corridor[season.plot.grid.row]
    before = [set(aisle[season.kept_route(BEGINS, one.name)]) for one in TWO]
    season.record(done(season, "robot-2", 8, range(8)), "two")
    after = [set(aisle[day.route.plant]) for day in season.plan_each(BEGINS)]
    assert not after[0] & before[1]
    assert not after[1] & before[0]


def test_who_joins_takes_no_aisle_that_the_first_has_unless_the_stated_gain_is_there(tmp_path):
    two, steady = team_of(2, Robot(hours=1.3)), Teamwork(least_gain=1e9)
    season = a_season(tmp_path / "season.gpkg", team=two[:1], teamwork=steady)
    season.plan_each(BEGINS)
    aisle = season.plot.grid.corridor[season.plot.grid.row]
    begun = set(aisle[season.kept_route(BEGINS, "robot-1")])
    season.change(replace(season.settings, team=two), season.settings)
    _, joined = season.plan_each(BEGINS, keep=False)
    assert len(joined.route)
    assert not begun & set(aisle[joined.route.plant])


def test_who_joins_when_all_aisles_are_given_out_has_some_and_keeps_them(tmp_path):
    """Hours are long enough for two to inspect all: a third finds nothing more, but it is there."""
    three = team_of(3, Robot(hours=12))
    season = a_season(tmp_path / "season.gpkg", team=three[:2])
    season.plan_each(BEGINS, time(8))
    season.change(replace(season.settings, team=three), season.settings)
    days = season.plan_each(BEGINS, time(10))
    stops = [len(day.route) for day in days]
    assert sum(stops) == season.plot.n_plants
    assert min(stops) > sum(stops) / 4
    again = [day.route.plant.tolist() for day in season.plan_each(BEGINS, time(10))]
    assert again == [day.route.plant.tolist() for day in days]


def test_what_nobody_of_the_team_did_is_known_and_moves_nobody(season):
    stray = done(season, "robot-1", 3)
    season.record(replace(stray, who=np.full(3, "Ann", object)), "a visitor")
    first, _ = season.plan_each(BEGINS)
    assert first.scene.at == -1
    assert not np.isin(stray.plant, first.route.plant).any()


def test_each_is_believed_by_its_own_eyes(tmp_path):
    blind, sharp = (Robot(hours=0.7, detection=chance) for chance in (0.05, 1.0))
    team = (TeamMember("blind", blind), TeamMember("sharp", sharp))
    season = a_season(tmp_path / "season.gpkg", team=team)
    season.plan_each(BEGINS)
    before = season.morning(BEGINS)
    left = []
    for who in ("blind", "sharp"):
        results = done(season, who, 3)
        season.record(results, who)
        left.append((season.evening(BEGINS)[results.plant] / before[results.plant]).max())
    assert left[0] > 0.8
    # a find of a sure eye leaves what may have come in the night before
    assert left[1] < 0.02


def test_a_team_is_kept_as_it_was_chosen(tmp_path):
    team = (
        TeamMember("wheels", Robot(hours=0.6)),
        TeamMember("Ann", scout().with_hours(0.8), gate=(35.1504, 30.3601), starts_s=600.0),
    )
    work = Teamwork(contact_s=900.0, least_gain=0.25)
    season = a_season(tmp_path / "season.gpkg", team=team, teamwork=work)
    again = Season(season.path).settings
    assert (again.team, again.teamwork) == (team, work)
    assert from_json(as_json(again)) == again
    days = season.plan_each(BEGINS)
    starts = [day.route.notes.start for day in days]
    assert starts[1] - starts[0] == timedelta(minutes=10)
    assert np.hypot(*(days[0].route.line_m[0] - days[1].route.line_m[0])) > 5.0


def test_who_is_not_of_the_team_has_no_route(season):
    with pytest.raises(SettingError, match=r"must be named \(robot-1, robot-2\), but it is 'Ann'"):
        season.plan(BEGINS, who="Ann")


def test_a_team_of_namesakes_is_refused(season):
    twins = (TeamMember("a"), TeamMember("A"))
    with pytest.raises(SettingError, match="different names"):
        replace(season.settings, team=twins)


def test_a_season_whose_team_was_tampered_with_is_refused(season):
    parts = as_json(season.settings)
    with pytest.raises(FileProblem, match="settings must be as fieldmon wrote them"):
        from_json({**parts, "team": '{"members": [{"name": "x"}]}'})


def test_what_two_found_recorded_at_once_is_as_if_recorded_one_after_the_other(season, tmp_path):
    files = [done(season, who, 4, found=[k]) for k, who in enumerate(("robot-1", "robot-2"))]
    in_turn = []
    for order in (files, files[::-1]):
        other = tmp_path / f"{order[0].who[0]}_first.gpkg"
        other.write_bytes(season.path.read_bytes())
        for file in order:
            Season(other).record(file)
        in_turn.append(Season(other).evening(BEGINS))
    begin = Barrier(2)

    def record(file):
        begin.wait()
        Season(season.path).record(file)

    with ThreadPoolExecutor(2) as both:
        list(both.map(record, files))
    with season.store.reading() as db:
        rows = db.execute("SELECT who, plant FROM inspections").fetchall()
    known = [(who, int(p)) for one in files for who, p in zip(one.who, one.plant, strict=True)]
    assert sorted(map(tuple, rows)) == sorted(known)
    # the second one's plants are learnt from after the first one's, whoever that was
    once = Season(season.path).evening(BEGINS)
    assert any(once == pytest.approx(turn, rel=1e-9) for turn in in_turn)


def test_a_team_that_was_killed_at_work_goes_on_from_a_whole_file(season):
    """Plans and records of two, killed half-way: what is there holds together, and goes on."""
    process = started(team_day_by_day, season.path)
    while len(Season(season.path).batches()) < 3:
        assert process.is_alive()
        sleep(0.01)
    process.kill()
    process.join()
    n = state(season.path)
    assert n >= 3
    on = last_date(Season(season.path)) + timedelta(days=1)
    one, other = (Season(season.path).plan_each(on, keep=False) for _ in range(2))
    assert [d.route.plant.tolist() for d in one] == [d.route.plant.tolist() for d in other]
