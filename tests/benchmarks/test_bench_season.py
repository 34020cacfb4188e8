"""Seasons and plans on the thesis's scenario C: 91 x 91 plants, 25 days of 12 h."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start

AISLES = Aisles.of(rectangle(91, 91))
N = len(AISLES.grid)


@pytest.mark.parametrize("name", sorted(SAMPLERS))
def test_season_of_scenario_c(benchmark, name):
    start = Start(RandomStreams(1).of("start").random(N) < 0.02, np.full(N, 0.02))
    settings = SimulationSettings(n_days=25, spread=Spread(0.1))

    def season():
        walk = simulated_days(AISLES, Robot(), sampler(name), start, settings, RandomStreams(2))
        return [day.detection_pct for day in walk]

    assert len(benchmark(season)) == 25


@pytest.mark.parametrize("name", sorted(SAMPLERS))
def test_plan_and_route_of_a_day_on_scenario_c(benchmark, name):
    scene = Scene(
        aisles=AISLES,
        robot=Robot(),
        chance=RandomStreams(1).of("prior").beta(0.3, 3.0, N).clip(1e-6, 1 - 1e-6),
        last_inspected=np.full(N, NEVER, np.int32),
        seconds_left=Robot().day_s,
    )
    route = benchmark(lambda: route_of(scene, plan_work(scene, sampler(name))))
    assert len(route) > 200


def test_night_on_scenario_c(benchmark):
    infested = RandomStreams(1).of("start").random(N) < 0.1
    after = benchmark(night, AISLES.grid, infested, Spread(0.5), RandomStreams(1).key("spread"))
    assert after.sum() > infested.sum()
