"""Charged: the season simulator, stop for stop and second for second."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.insects import Insects
from fieldmon.infestation.insects.spread import Spread
from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start

SPREAD, SEED = Spread(rate_per_day=0.2, arrivals_per_day=0.001), 5


@pytest.mark.parametrize("name", ["adaptive", "naive", "dynamic"])
@pytest.mark.parametrize("returns", [True, False])
def test_a_season_driven_as_charged_is_the_simulated_one(plot, name, returns):
    robot = Robot(hours=0.4, returns=returns)
    chance = np.random.default_rng(1).uniform(0.005, 0.3, len(plot.grid))
    start = Start(np.random.default_rng(2).random(len(chance)) < chance, chance)
    settings = SimulationSettings(n_days=3, spread=SPREAD)
    simulated = simulated_days(
        plot.aisles, robot, sampler(name), start, settings, RandomStreams(SEED)
    )
    monitor = Monitor(plot, name, robot, chance, BeliefSettings(spread=SPREAD), SEED)
    detects = sampler(name).inspection_times(robot).detects
    insects = Insects(plot.grid, start, detects, SPREAD, RandomStreams(SEED))
    found = 0
    for each in simulated:
        assert np.array_equal(insects.infested, each.infested)
        with monitor.day() as day:
            driven = drive_day(day, plot.aisles, (robot, ChargedRobot(insects.look)))
        assert [one.stop.plant for one in driven.stops] == each.work.plant.tolist()
        assert [one.stop.arrive_s for one in driven.stops] == each.work.arrive_s.tolist()
        assert [one.visit.found for one in driven.stops] == each.work.found.tolist()
        assert driven.charged_s == pytest.approx(each.work.end_s, abs=1e-6)
        assert driven.driven_s == driven.charged_s
        found += driven.found
        monitor.night()
        insects.pass_night()
    assert found > 3
