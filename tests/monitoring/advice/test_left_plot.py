"""How far an answer goes that leaves a plot: until when, where, and on how many inspections."""

from datetime import timedelta
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.infestation.insects.jump_reach import RADIUS
from fieldmon.monitoring.advice.left_plot import FewInspected, InspectAgain, NotReached
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.plot.layout import rectangle
from tests.monitoring.seasons import BEGINS


@pytest.mark.parametrize(
    ("n", "level", "enough"), [(32, 0.05, 27), (100_000, 0.05, 55), (32, 1e-7, None)]
)
def test_enough_clean_plants_are_no_more_than_there_are(n, level, enough):
    few = FewInspected.of((1, n), AdviceSettings(level), 0.84, None)
    assert (few and few.enough) == enough


@pytest.mark.parametrize(("infested", "nights"), [(3.9, 1), (4.0, 3), (6.5, None)])
def test_it_is_inspected_again_by_the_first_morning_that_may_be_above(infested, nights):
    # of the day itself the verdict speaks
    ahead = SimpleNamespace(high=np.array([9, 4, 4, 6]), nights=3)
    by = None if nights is None else BEGINS + timedelta(days=nights)
    again = InspectAgain.of(ahead, BEGINS, infested)
    assert again == InspectAgain(by, 3)
    assert ("for 3 nights at least" in again.sentence()) == (by is None)


def test_plants_out_of_reach_of_all_inspections_are_counted():
    grid = rectangle(1, 101)
    reach_m = RADIUS * np.sqrt(grid.row_spacing_m * grid.plant_spacing_m)
    away_m = np.abs(grid.xy_m[:, 0] - grid.xy_m[0, 0])
    away = NotReached.of(grid, np.array([0, 0]))
    assert away.reach_m == pytest.approx(reach_m)
    assert away.share == np.mean(away_m >= reach_m)
    assert NotReached.of(grid, np.zeros(0, int)).share == 1.0
    assert NotReached.of(grid, np.arange(101)).sentences() == []
