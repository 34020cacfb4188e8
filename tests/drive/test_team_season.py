"""A team's day in a season: asked and told by each, one batch, planned for all after a find."""

import shutil
from dataclasses import replace
from datetime import time

import numpy as np
import pytest

from fieldmon.drive.team_season import TeamSeason
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.monitoring.settings.shift_work import made_by
from fieldmon.monitoring.treating.applications import Application
from fieldmon.planning.members import team_of
from fieldmon.plot.robot import Robot, scout
from tests.drive.test_season_day import ON, SETTINGS, must_check_what_it_is_told, noted


@pytest.fixture(scope="module")
def begun(plot, tmp_path_factory):
    """Return the file of a season of two robots that has just begun."""
    robot = Robot(hours=0.2)
    settings = MonitoringSettings(ON, robot=robot, team=team_of(2, robot))
    return Season.create(tmp_path_factory.mktemp("begun") / "s.gpkg", plot, None, settings).path


@pytest.fixture
def season(begun, tmp_path):
    return Season(shutil.copy(begun, tmp_path / "season.gpkg"))


@pytest.fixture
def team(season):
    return TeamSeason(season, ON)


def test_each_is_asked_for_plants_of_its_own_route(team):
    days = [team.member(name) for name in ("robot-1", "robot-2")]
    asked = [day.ask().plant for day in days]
    assert asked == [team.days[name].route.plant[0] for name in ("robot-1", "robot-2")]
    assert len(set(asked)) == 2
    assert days[0].ask().plant == asked[0]  # the same until it is told


def test_robots_enter_where_people_may_not_be_yet_unless_somebody_of_the_team_walks(team):
    season = team.season
    season.treat(ON, 0.0, application=Application("oil", reentry_hours=48.0, ended=time(5)))
    assert not any(len(day.route) for day in season.plan_each(ON, keep=False))
    assert TeamSeason(season, ON).member("robot-1").ask() is not None
    before = season.settings
    one, other = before.team
    season.change(replace(before, team=(one, replace(other, robot=scout()))), before)
    assert TeamSeason(season, ON).member("robot-1").ask() is None


def test_a_find_by_one_is_planned_for_by_the_other(team):
    one, other = team.member("robot-1"), team.member("robot-2")
    first, errand = one.ask(), other.ask()
    before = team.replanned
    one.tell(found=True)
    assert team.replanned == before + 1
    # who has set out for a plant inspects it, and nobody else does
    assert other.ask() == errand
    assert errand.plant not in [one.ask().plant, *one.ahead(50)]
    assert first.plant not in other.ahead(50)


def test_what_all_tell_is_one_batch_with_each_ones_name(team):
    days = {name: team.member(name) for name in ("robot-1", "robot-2")}
    told = []
    for k in range(6):
        name = f"robot-{1 + k % 2}"
        told.append((days[name].ask().plant, name))
        days[name].tell(found=k == 4)
    held = team.season.history.inspections
    assert sorted(zip(held.plant.tolist(), held.who.tolist(), strict=True)) == sorted(told)
    assert (held.result == FOUND).sum() == 1
    assert [batch.rows for batch in team.season.batches()] == [6]


def test_all_go_on_in_one_batch_after_a_copy_was_merged_into_the_season(team, tmp_path):
    there = Season(shutil.copy(team.season.path, tmp_path / "other.gpkg"))
    there.record(Inspections.of([0], [FOUND], ON), "theirs")
    for name in ("robot-1", "robot-2"):
        day = team.member(name)
        assert day.ask() is not None
        day.tell(found=False)
        if name == "robot-1":
            assert team.season.merge(there).moved
    assert sorted((one.source, one.rows) for one in team.season.batches()) == [
        (team.source, 2),
        ("theirs", 1),
    ]


def test_after_a_crash_each_goes_on_where_it_was_told_of_last(team):
    day = team.member("robot-2")
    plant = day.ask().plant
    day.tell(found=False)
    again = TeamSeason(Season(team.season.path), ON)
    assert again.batch == team.batch
    assert again.member("robot-2").at == plant
    assert again.member("robot-2").gone_s == pytest.approx(day.gone_s, abs=1.0)
    assert again.member("robot-1").at == -1
    assert plant not in again.member("robot-1").ahead(500)


def test_a_team_that_goes_on_follows_what_is_left_of_the_plans_given_out_last(team):
    def left(team):
        days = [team.member(name) for name in ("robot-1", "robot-2")]
        return [(day.ask().plant, *day.ahead(500)) for day in days]

    for name, found in [("robot-1", True), ("robot-2", False), ("robot-1", False)]:
        day = team.member(name)
        day.ask()
        day.tell(found=found)
    again = TeamSeason(Season(team.season.path), ON)
    assert again.goes_on
    assert left(again) == left(team)


def test_each_goes_on_at_the_time_of_its_own_last_result(team):
    plant = int(team.days["robot-2"].route.plant[0])
    team.season.record(noted([plant], 34_200.0, "robot-2"), "by hand")
    again = TeamSeason(team.season, ON)
    for name, earliest in (("robot-1", 6 * 3600.0), ("robot-2", 34_200.0)):
        day = again.member(name)
        day.ask()
        day.tell(found=False)
        last = made_by(team.season.history.on(0), name).second[-1]
        assert earliest < last < earliest + 300.0


def test_an_earlier_day_is_driven_by_the_team_of_then(team):
    season = team.season
    day = team.member("robot-1")
    day.ask()
    day.tell(found=False)
    season.change(replace(season.settings, team=team_of(3)), season.settings)
    again = TeamSeason(season, ON)  # which is past by the plot's clock
    assert [one.name for one in again.team] == ["robot-1", "robot-2"]
    assert again.member("robot-1").at == day.at


def test_past_midnight_each_goes_on_at_its_own_place_and_no_plant_is_given_twice(season):
    season.change(replace(season.settings, starts=time(23, 58)), season.settings)
    names, told = ("robot-1", "robot-2"), []
    for n in (8, 200):  # the second begins again
        team = TeamSeason(Season(season.path), ON)
        days = {name: team.member(name) for name in names}
        for name, at in ((name, one.plant) for one, name in told[-2:]):
            assert days[name].at == at
        for k in range(n):
            if (stop := days[names[k % 2]].ask()) is not None:
                told.append((stop, names[k % 2]))
                days[names[k % 2]].tell(found=k % 8 == 7)
    plants = [stop.plant for stop, _ in told]
    assert len(plants) == len(set(plants)) > 20
    held = season.history.inspections
    assert set(held.date.astype(str)) == {"2026-04-06", "2026-04-07"}
    assert sorted(held.plant.tolist()) == sorted(plants)
    for name in names:
        own = made_by(held, name)
        moments = own.date + own.second.astype("timedelta64[s]")
        assert (np.diff(moments) > np.timedelta64(0)).all()
        assert moments[-1] - moments[0] < np.timedelta64(12, "m")


def test_nobody_is_given_another_plant_once_it_is_stopped(team):
    team.stops = 1
    assert team.member("robot-1").ask() is None


def test_no_way_leads_into_an_aisle_where_another_stays_for_today(team):
    one, other = team.member("robot-1"), team.member("robot-2")
    aisle = int(team.aisle[one.ask().plant])
    team.keeper.enter("robot-2", [aisle])
    team.keeper.end("robot-2")
    team.errands.clear()
    one._asked = None
    left = [one.ask().plant, *one.ahead(500)]
    assert aisle not in {int(team.aisle[plant]) for plant in left}
    assert other.ask() is not None


def test_a_season_without_a_team_is_refused(plot, tmp_path):
    with pytest.raises(SettingError, match="a team"):
        TeamSeason(Season.create(tmp_path / "alone.gpkg", plot, None, SETTINGS), ON)


def test_nothing_is_told_of_a_plant_that_nobody_asked_for(team):
    with pytest.raises(ObservationError, match="asked for"):
        team.member("robot-1").tell(found=False)


def test_what_is_no_result_or_a_clock_that_goes_back_is_refused_and_not_recorded(team):
    must_check_what_it_is_told(team.member("robot-2"))
    assert len(team.season.history.inspections) == 1
