"""A small plot, a day on it, and somebody who looks."""

import numpy as np
import pytest

from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles


@pytest.fixture(scope="session")
def plot():
    grid = rectangle(8, 12, Planting(row_spacing_m=3.0, plant_spacing_m=1.5))
    return Plot(Field("square", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))


@pytest.fixture(scope="session")
def robot():
    return Robot(hours=0.3, width_m=0.58, length_m=0.8, stop_s=1.13, row_change_s=7.0)


@pytest.fixture
def monitor(plot, robot):
    chance = np.random.default_rng(3).uniform(0.005, 0.3, len(plot.grid))
    return Monitor(plot, robot=robot, chance=chance)
