"""A day checks what it is told: that it was asked, what was seen, and its clock."""

import numpy as np
import pytest

from fieldmon.errors import ObservationError, SettingError
from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles


@pytest.fixture
def plot():
    grid = rectangle(12, 20, Planting())
    return Plot(Field("square", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))


def test_the_same_plant_is_asked_for_until_it_is_told_of(plot):
    with Monitor(plot, robot=Robot(hours=1)).day() as day:
        assert day.ask() == day.ask()
        day.tell(found=False)
        with pytest.raises(ObservationError, match="asked for"):
            day.tell(found=False)


def test_a_clock_that_goes_backwards_is_refused(plot):
    with Monitor(plot, robot=Robot(hours=1)).day() as day:
        day.ask()
        day.tell(found=False, at_s=500.0)
        day.ask()
        with pytest.raises(ObservationError, match="go on"):
            day.tell(found=False, at_s=400.0)


def test_the_clock_never_goes_behind_what_is_gone_as_charged(plot):
    day = Monitor(plot, robot=Robot(hours=1)).day()
    day.ask()
    day.tell(found=False)
    gone_s = day.gone_s
    day.ask()
    for at_s in (gone_s - 30.0, np.nan, np.inf):
        with pytest.raises(ObservationError, match="The day's clock must go on"):
            day.tell(found=False, at_s=at_s)
    with pytest.raises(ObservationError, match="stay below 1,000,000,000 s since the day began"):
        day.tell(True, at_s=1e9)
    with pytest.raises(SettingError, match="must be in seconds, but it is '90'"):
        day.tell(found=False, at_s="90")
    assert (day.gone_s, len(day.plants)) == (gone_s, 1)
    day.tell(found=False, at_s=gone_s)
    assert day.gone_s == gone_s
