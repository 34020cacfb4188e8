"""Many days of a team: the same insects, the same rules, and more of them seen."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.pests.pest import Movement, Pest
from fieldmon.planning.members import TeamMember, Teamwork, team_of
from fieldmon.planning.route import route_of
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from fieldmon.simulation.team_season import ONE, Team, simulated_team_days
from tests.second_by_second import nobody_head_on, nobody_together
from tests.thorough import seeds

GRID = rectangle(20, 20)
PLOT = Plot(Field("even", GRID.frame.geometry_lonlat(GRID.drivable_m)), Aisles.of(GRID))
ROBOT = Robot(hours=1.0)
SETTINGS = SimulationSettings(n_days=3, spread=Spread(0.2))
LONGER = replace(SETTINGS, n_days=5)
SECTIONS = Teamwork(together=False)


def start(seed=3):
    infested = RandomStreams(seed).of("start").random(len(GRID)) < 0.02
    return Start(infested, np.full(len(GRID), 0.02))


def season(name="adaptive", members=2, teamwork=None, seed=3, settings=SETTINGS):
    team = team_of(members, ROBOT) if isinstance(members, int) else members
    works = team, teamwork or Teamwork()
    streams = RandomStreams(seed)
    return list(simulated_team_days(PLOT, works, sampler(name), start(), settings, streams))


@cache
def usual_season(name="adaptive", members=2, teamwork=None, seed=3):
    """Return a season for tests that only look at it."""
    return season(name, members, teamwork, seed)


@pytest.mark.parametrize("teamwork", [Teamwork(), SECTIONS, Teamwork(contact_s=900.0)])
def test_the_same_seed_gives_the_same_season_and_another_another(teamwork):
    one, same, other = (season(teamwork=teamwork, seed=seed) for seed in (3, 3, 4))
    for day, again in zip(one, same, strict=True):
        assert (day.infested == again.infested).all()
        for mine, yours in zip(day.each, again.each, strict=True):
            assert (mine.plant == yours.plant).all()
            assert (mine.arrive_s == yours.arrive_s).all()
    assert any((a.infested != b.infested).any() for a, b in zip(one, other, strict=True))


@pytest.mark.parametrize("name", sorted(set(SAMPLERS) - {"adaptive-looks"}))
def test_a_team_of_one_has_the_season_of_one_alone(name):
    streams = RandomStreams(3)
    alone = simulated_days(PLOT.aisles, ROBOT, sampler(name), start(), SETTINGS, streams)
    for day, other in zip(season(name, members=1), alone, strict=True):
        assert (day.work.plant == other.work.plant).all()
        assert (day.infested == other.infested).all()


@pytest.mark.parametrize("name", ["adaptive", "naive", "snake", "random"])
@pytest.mark.parametrize("teamwork", [Teamwork(), SECTIONS])
def test_the_figures_of_every_day_add_up(name, teamwork):
    found = 0
    for day in usual_season(name, 3, teamwork):
        assert len(day.each) == 3
        assert len(np.unique(day.work.plant)) == len(day.work) == sum(map(len, day.each))
        found += day.found
        assert day.ever_found == found
        assert day.ever_infested == found + day.left
        assert day.worked_s == sum(work.end_s for work in day.each) <= 3 * ROBOT.day_s + 1e-6
        assert day.infested[day.work.plant[day.work.found]].all()


@pytest.mark.parametrize("name", ["adaptive", "dynamic", "snake"])
def test_all_season_nobody_meets_and_the_clock_goes_on(name):
    """Seen second by second, by an oracle that knows nothing of who waits for whom."""
    never = np.full(len(GRID), NEVER, np.int32)
    for day in season(name, 3, Teamwork(contact_s=600.0, passing_m=20.0)):
        scene = Scene(PLOT.aisles, ROBOT, np.zeros(len(GRID)), never, seconds_left=ROBOT.day_s)
        routes = [route_of(scene, work) for work in day.each]
        assert nobody_together(routes, np.zeros(3))
        assert nobody_head_on(routes, np.zeros(3), 20.0)
        assert (np.diff(day.work.arrive_s + day.work.stop_s) >= 0).all()


def test_a_team_meets_the_insects_that_one_alone_does():
    blind = replace(ROBOT, detection=0.0)
    lasts = [season(members=team_of(n, blind))[-1].infested for n in (1, 2, 3)]
    assert (lasts[0] == lasts[1]).all()
    assert (lasts[0] == lasts[2]).all()


def test_those_without_prior_information_keep_to_their_sections_all_season():
    days = usual_season("naive", 2)
    rows = [{int(r) for day in days for r in GRID.row[day.each[k].plant]} for k in range(2)]
    assert not rows[0] & rows[1]
    # each goes on where it stopped the day before
    for k in range(2):
        first, second = (day.each[k].plant for day in days[:2])
        assert not set(first) & set(second)


def test_more_robots_leave_less_behind():
    def lost(n, seed):
        return season_metrics(season(members=n, seed=seed, settings=LONGER)).infested_plant_days

    losses = [np.mean([lost(n, seed) for seed in seeds(2, 4)]) for n in (1, 3)]
    assert losses[1] < 0.7 * losses[0]


def hourly(members, n_days=3, hours=(6.0, 12.0)):
    """Return the days of a team while a pest moves by the hour."""
    movement = Movement("exponential", 2.0, reach_m=6.0, hours=hours, by_hour=True)
    settings = SimulationSettings(
        n_days=n_days, pest=PestInWeather(Pest("quick", movement=movement))
    )
    works = team_of(members, Robot(hours=4.0)), Teamwork()
    streams = RandomStreams(3)
    return list(simulated_team_days(PLOT, works, sampler("adaptive"), start(), settings, streams))


def test_insects_move_while_a_team_works_by_one_clock():
    """What comes by day is there in the evening, and some of it is found on the same day."""
    days = hourly(2)
    assert any((day.evening & ~day.infested).any() for day in days)
    new = [(day.work.found & ~day.infested[day.work.plant]).sum() for day in days]
    assert sum(new) > 0
    at_night = hourly(2, hours=(20.0, 24.0))
    assert not any((day.evening & ~day.infested).any() for day in at_night)


def test_by_the_hour_too_a_team_of_one_has_the_season_of_one_alone():
    team = hourly(1)
    streams, robot = RandomStreams(3), Robot(hours=4.0)
    movement = Movement("exponential", 2.0, reach_m=6.0, hours=(6.0, 12.0), by_hour=True)
    settings = SimulationSettings(n_days=3, pest=PestInWeather(Pest("quick", movement=movement)))
    alone = simulated_days(PLOT.aisles, robot, sampler("adaptive"), start(), settings, streams)
    for one, other in zip(team, alone, strict=True):
        assert (one.work.plant == other.work.plant).all()
        assert (one.evening == other.evening).all()
    for day in hourly(2):
        assert day.ever_found <= day.ever_infested


def test_members_differ_in_hours_gates_and_where_they_rest():
    far = tuple(GRID.lonlat(np.array([len(GRID) - 1]))[0].tolist())
    members = (
        TeamMember("short", ROBOT.with_hours(0.5)),
        TeamMember("stays", replace(ROBOT, returns=False), gate=far, starts_s=600.0),
    )
    first, second = season("naive", members)[:2]
    assert first.each[0].end_s <= 1800.0
    rests = int(first.each[1].plant[-1])
    assert abs(int(second.each[1].plant[0]) - rests) in {1, 20}
    assert second.each[1].arrive_s[0] < 60.0
    # a third of the hours, a third of the rows
    assert GRID.row[first.each[0].plant].max() < 7 <= GRID.row[first.each[1].plant].min()
    assert GATE not in first.work.plant


def test_one_of_a_kind_works_as_ever_and_none_is_no_team():
    streams = RandomStreams(3)
    works = PLOT, ROBOT
    made = season_metrics(ONE.days(works, sampler("naive"), start(), SETTINGS, streams))
    assert made.worked_h[0] == pytest.approx(1.0, abs=0.05)
    two = Team(2).days(works, sampler("naive"), start(), SETTINGS, streams)
    assert season_metrics(two).worked_h[0] > 1.9
    with pytest.raises(SettingError, match="1 robot or more"):
        Team(0)
    with pytest.raises(SettingError, match="1 member or more"):
        season(members=())


@pytest.mark.parametrize("teamwork", [Teamwork(), SECTIONS])
def test_between_visits_none_of_a_team_works(teamwork):
    settings, streams = replace(LONGER, visit_every=3), RandomStreams(3)
    team = team_of(2, ROBOT), teamwork
    days = list(simulated_team_days(PLOT, team, sampler("adaptive"), start(), settings, streams))
    assert [day.visit for day in days] == [0, None, None, 1, None]
    assert [day.worked_s > 0 for day in days] == [len(day.work) > 0 for day in days]
    assert [len(day.work) > 0 for day in days] == [True, False, False, True, False]
    alone = Team(1).days((PLOT, ROBOT), sampler("adaptive"), start(), settings, RandomStreams(3))
    assert [len(day.work) > 0 for day in alone] == [True, False, False, True, False]
