"""A season simulated in one call is the season that is simulated day by day."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import PlotError, SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.sweeps import Naive
from fieldmon.simulation.library import draw_start, simulate, simulate_days
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start

GRID = rectangle(9, 14)
PLOT = Plot(Field("Square", GRID.frame.geometry_lonlat(GRID.drivable_m)), Aisles.of(GRID))
CHANCE = np.linspace(0.001, 0.1, len(GRID))
ROBOT = Robot(hours=1)
SHORT = SimulationSettings(n_days=4, spread=Spread(0.2))


def test_the_same_seed_infests_the_same_plants_and_another_seed_others():
    one, same, other = (draw_start(PLOT, CHANCE, 0.1, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(one.infested, same.infested)
    assert (one.infested != other.infested).any()
    np.testing.assert_array_equal(one.chance, CHANCE)


def test_the_share_is_met_on_average_and_likelier_plants_are_infested_more_often():
    infested = np.array([draw_start(PLOT, CHANCE, 0.1, seed=seed).infested for seed in range(300)])
    assert infested.mean() == pytest.approx(0.1, rel=0.1)
    half = len(GRID) // 2
    assert infested[:, half:].mean() > 2 * infested[:, :half].mean()


@pytest.mark.parametrize("share", [0.0, 1.0, -0.1])
def test_a_share_of_nobody_or_all_is_refused(share):
    with pytest.raises(SettingError, match=f"above 0 and below 1, but it is {share}"):
        draw_start(PLOT, CHANCE, share)


def test_a_season_is_the_one_that_is_simulated_day_by_day():
    start = draw_start(PLOT, CHANCE, 0.1)
    season = simulate(PLOT, start, "naive", robot=ROBOT, settings=SHORT, seed=5)
    days = [*simulated_days(PLOT.aisles, ROBOT, Naive(), start, SHORT, RandomStreams(5))]
    assert season.found.tolist() == [day.work.found.sum() for day in days]
    assert season.new[0] == start.infested.sum()
    assert len(days) == len(season.left) == 4


def test_each_plant_of_a_season_is_told_day_by_day():
    start = draw_start(PLOT, CHANCE, 0.1)
    season = simulate(PLOT, start, "naive", robot=ROBOT, settings=SHORT, seed=5)
    days = [*simulate_days(PLOT, start, "naive", robot=ROBOT, settings=SHORT, seed=5)]
    infested = np.array([day.infested for day in days])
    assert (infested[0] == start.infested).all()
    assert [day.in_the_evening.sum() for day in days] == season.left.tolist()
    assert [infested[i, day.work.plant[day.work.found]].sum() for i, day in enumerate(days)] == (
        season.found.tolist()
    )


def test_a_sampler_of_ones_own_is_taken_as_one_by_name():
    start = draw_start(PLOT, CHANCE, 0.1)
    named, own = (
        simulate(PLOT, start, who, robot=ROBOT, settings=SHORT) for who in ("naive", Naive())
    )
    for name in ("found", "left", "new"):
        np.testing.assert_array_equal(getattr(named, name), getattr(own, name))


def test_samplers_meet_the_same_insects_and_nobody_finds_more_than_there_are():
    start = draw_start(PLOT, CHANCE, 0.1)
    for name in ("naive", "dynamic"):
        season = simulate(PLOT, start, name, robot=ROBOT, settings=SHORT, seed=2)
        assert season.found.sum() <= season.new.sum()
        assert season.new[0] == start.infested.sum()


def test_a_start_of_another_plot_and_an_unknown_sampler_are_refused():
    other = Start(np.zeros(3, np.bool_), np.full(3, 0.1))
    with pytest.raises(PlotError):
        simulate(PLOT, other, "naive", robot=ROBOT, settings=SHORT)
    with pytest.raises(PlotError):  # before the first day is asked for
        simulate_days(PLOT, other, "naive", robot=ROBOT, settings=SHORT)
    with pytest.raises(SettingError, match="but it is 'best'"):
        simulate(PLOT, draw_start(PLOT, CHANCE), "best", robot=ROBOT, settings=SHORT)
