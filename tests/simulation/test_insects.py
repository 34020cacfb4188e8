"""Insects of a season: a rule of nights, or a pest in its weather, by the night or by the hour."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.pests.pest import Movement, Pest, Stage
from fieldmon.planning.workday import Workday
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.samplers.base import InspectionTimes, Stops
from fieldmon.simulation.insects import NightInsects, PestInsects
from fieldmon.simulation.season import (
    RunningSeason,
    SimulationSettings,
    morning_beliefs,
    simulated_days,
)
from fieldmon.simulation.start import Start
from tests.thorough import seeds

AISLES = Aisles.of(rectangle(12, 12))
GRID, N = AISLES.grid, 144
EGG = Stage("egg", 12.5, 40.0, visible=False, mobile=False)
MITE = Pest("mite", stages=(EGG,), movement=Movement("exponential", 0.6, reach_m=6.0))
BY_HOUR = replace(MITE, movement=replace(MITE.movement, by_hour=True))


def at(*plants):
    infested = np.zeros(N, bool)
    infested[list(plants)] = True
    return infested


def key(number):
    return RandomStreams(1).key("spread", number)


def season(pest, who="naive", n_days=4, hours=4.0, seed=1):
    streams = RandomStreams(seed)
    start = Start(streams.of("start").random(N) < 0.1, np.full(N, 0.1))
    settings = SimulationSettings(n_days=n_days, pest=PestInWeather(pest))
    robot = Robot(hours=hours)
    return list(simulated_days(AISLES, robot, sampler(who), start, settings, streams))


def test_a_rule_of_nights_hides_what_is_new_for_its_nights():
    def rule(grid, infested, key):
        return night(grid, infested, Spread(1.0), key)

    insects = NightInsects(GRID, at(40), rule, hidden_nights=2)
    assert insects.pass_night(np.empty(0, np.int32), 0, key(0)) == 4
    assert [int(insects.showing(day).sum()) for day in (1, 2, 3)] == [1, 1, 5]
    assert insects.pass_night(np.array([40], np.int32), 1, key(1)) == 9


def test_the_hours_of_a_day_and_of_its_night_are_each_passed_once():
    insects = PestInsects(GRID, at(*range(0, N, 9)), PestInWeather(BY_HOUR))
    none = np.empty(0, np.int32)
    for _ in range(9):
        insects.pass_hour(none, 0, key(0))
    insects.pass_night(none, 0, key(0))
    alone = PestInsects(GRID, at(*range(0, N, 9)), PestInWeather(BY_HOUR))
    alone.pass_night(none, 0, key(0))
    assert (insects.infested == alone.infested).all()
    assert insects.infested.sum() > 16


def test_nothing_comes_of_a_plant_whose_insects_were_destroyed():
    insects = PestInsects(GRID, at(40), PestInWeather(BY_HOUR))
    assert insects.pass_night(np.array([40], np.int32), 0, key(0)) == 0
    assert insects.infested.sum() == 0


@pytest.mark.parametrize("pest", [MITE, BY_HOUR])
@pytest.mark.parametrize("who", ["naive", "adaptive"])
def test_a_season_of_a_pest_adds_up_and_is_the_same_again(pest, who):
    days, again = season(pest, who), season(pest, who)
    assert [day.work.plant.tolist() for day in days] == [day.work.plant.tolist() for day in again]
    for before, after in pairwise(days):
        assert after.ever_infested - before.ever_infested >= 0
        assert after.ever_found == before.ever_found + after.found
    for day in days:
        assert len(set(day.work.plant.tolist())) == len(day.work)


class _Waits:
    """A sampler that looks at one plant, late in the day."""

    reads_chance = False

    def __init__(self, plant, second):
        self.plant, self.second = plant, second

    def inspection_times(self, robot):
        return InspectionTimes(np.array([robot.visit_s]), np.array([1.0]))

    def walk(self, _scene, _would_find):
        return Stops(np.array([self.plant], np.int32), np.array([self.second]))


def found_at(second):
    """Look at a plant beside an infested one so late on the first day; share of finds."""
    pest = Pest("fast", movement=Movement("adjacent", 0.9, hours=(8.0, 10.0), by_hour=True))
    settings = SimulationSettings(n_days=1, pest=PestInWeather(pest))
    found = []
    for seed in seeds(20, 40):
        start = Start(at(40), np.full(N, 0.01))
        who, streams = _Waits(41, second), RandomStreams(seed)
        (day,) = simulated_days(AISLES, Robot(), who, start, settings, streams)
        found.append(day.found)
    return np.mean(found)


def test_while_the_robot_works_insects_move_in_their_hours():
    """Work begins at six; they move from eight to ten."""
    assert found_at(1.5 * 3600) == 0.0
    assert 0.4 < found_at(3.1 * 3600) < 0.9
    assert found_at(8 * 3600) == pytest.approx(0.9, abs=0.15)


def test_the_day_is_worked_anew_where_one_of_a_team_would_find_what_is_new():
    """The other detects nothing, so nothing changes for it."""
    pest = Pest("fast", movement=Movement("adjacent", 1.0, hours=(8.0, 10.0), by_hour=True))
    settings = SimulationSettings(n_days=1, pest=PestInWeather(pest))
    start = Start(at(40), np.full(N, 0.01))
    on_its_way = RunningSeason(AISLES, Robot(), sampler("naive"), start, settings)
    one, walked = np.ones(1), []

    def walk(would_find):
        found = np.array([would_find[1][41] > 0])
        walked.append(bool(found[0]))
        return Workday(np.array([41], np.int32), one * 8 * 3600.0, found, one, one, 9 * 3600.0), ()

    day = on_its_way.by_hour(0, walk, [np.zeros(1), one], (key(0), key(1)))
    assert walked[0] is False
    assert walked[-1] is True
    assert day.found == 1


@pytest.mark.parametrize(
    ("end_s", "passed"), [(3599.5, 0), (3600.0, 1), (7199.5, 1), (7200.0, 2), (25 * 3600.0, 24)]
)
def test_an_hour_has_passed_once_somebody_worked_for_it_whole(end_s, passed):
    start = Start(at(40), np.full(N, 0.01))
    settings = SimulationSettings(n_days=1, pest=PestInWeather(BY_HOUR))
    on_its_way = RunningSeason(AISLES, Robot(), sampler("naive"), start, settings)
    hours, pass_hour = [], on_its_way.insects.pass_hour
    on_its_way.insects.pass_hour = lambda *of: hours.append(of[0].tolist()) or pass_hour(*of)
    one = np.ones(1)
    work = Workday(np.array([40], np.int32), one * 3600.0, one > 0, one * 9.0, one, end_s)
    on_its_way.by_hour(0, lambda _: (work, ()), [one], (key(0), key(1)))
    assert len(hours) == passed
    # a plant reached as the second hour begins is found in the second
    assert hours == [[], [40], *[[]] * 22][:passed]


def test_the_evening_counts_what_came_by_day():
    for day in season(BY_HOUR, "naive", n_days=3):
        assert day.left == int(day.evening.sum())
    early = replace(BY_HOUR, movement=replace(BY_HOUR.movement, hours=(6.0, 7.0), per_day=3.0))
    assert any((day.evening & ~day.infested).any() for day in season(early, n_days=2))


def test_the_map_believes_of_the_pest_that_there_is_unless_told_of_another():
    def ages_of(**told):
        start = Start(at(40), np.full(N, 0.01))
        kept = morning_beliefs(GRID, Robot(), start, SimulationSettings(**told), chooses_time=False)
        return kept.on(0).cohorts is not None

    pest_in_weather = PestInWeather(Pest("slow", movement=Movement("adjacent", 0.1)))
    assert ages_of(pest=pest_in_weather)
    assert ages_of(believed_pest=pest_in_weather)
    assert not ages_of()


def test_without_hidden_nights_what_is_new_shows_the_next_morning():
    def rule(grid, infested, key):
        return night(grid, infested, Spread(1.0), key)

    insects = NightInsects(GRID, at(40), rule)
    insects.pass_night(np.empty(0, np.int32), 0, key(0))
    assert insects.showing(1).sum() == insects.infested.sum() == 5


def test_a_map_that_is_told_no_rate_goes_by_the_pest_s_nights():
    pest_in_weather = PestInWeather(Pest("slow", movement=Movement("adjacent", 0.1)))
    settings = SimulationSettings(pest=pest_in_weather)
    assert settings.believed_night(GRID)(3) == pest_in_weather.spread(3, GRID.frame)
    told = SimulationSettings(pest=pest_in_weather, believed_spread=Spread(0.3))
    assert told.believed_night(GRID)(3) == Spread(0.3)


def world(answers):
    """Return a season's settings with insects that do what a function says."""
    return SimulationSettings(own_night=lambda _, infested, __: answers(infested))


def test_a_world_may_write_into_what_it_is_given_and_insects_may_die():
    def comes_and_goes(infested):
        infested[0], infested[5] = False, True
        return infested

    infested = np.zeros(N, bool)
    infested[[0, 1]] = True
    insects = world(comes_and_goes).insects(GRID, infested)
    assert insects.pass_night(np.empty(0, np.int32), 0, np.uint64(1)) == 1
    assert np.flatnonzero(insects.infested).tolist() == [1, 5]


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        (lambda _: None, "must be an array of True and False, but it is None"),
        (lambda _: int("x"), r"must run, but it ends in ValueError: .* \(test_insects.py, line \d"),
        (lambda infested: infested.astype(float), "but it is an array of float64"),
        (lambda infested: infested[:-1], r"must have the shape \(144,\), but it has \(143,\)"),
    ],
)
def test_a_world_that_does_not_say_who_is_infested_is_refused(answers, said):
    insects = world(answers).insects(GRID, np.zeros(N, bool))
    with pytest.raises(SettingError, match=said):
        insects.pass_night(np.empty(0, np.int32), 0, np.uint64(1))
