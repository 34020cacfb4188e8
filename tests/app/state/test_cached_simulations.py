"""Simulated days that the app keeps between clicks."""

import numpy as np

from app.state import cached_simulations
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.prior.prior import start_infested
from fieldmon.plot.robot import Robot
from fieldmon.simulation.worker import LaidPlot
from tests.app.chosen import a_plot


def test_a_simulated_season_is_the_one_that_the_library_simulates():
    plot, robot, seed = a_plot(), Robot(hours=1.0), 3
    chance = np.full(len(plot.grid), 0.05)
    days, figures = cached_simulations.simulated_season(
        "test", "dynamic", (4, 0.05, 0.1, 1, seed), robot, LaidPlot(plot, chance)
    )
    assert len(days) == len(figures.found) == 4
    starts = start_infested(chance, 0.05, RandomStreams(seed).of("start"))
    assert days[0].infested.tolist() == starts[plot.grid.vine].tolist()
    assert [day.found for day in days] == figures.found.tolist()
