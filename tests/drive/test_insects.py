"""Insects: seen on what they are on, gone once found."""

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.drive.insects import Insects
from fieldmon.infestation.insects.spread import Spread
from fieldmon.monitoring.estimates.asked_day import PlantToInspect
from fieldmon.simulation.start import Start


def stop_at(plant, detects=1.0):
    return PlantToInspect(plant, 1, 1, (0.0, 0.0), 0.0, 40.0, detects)


def insects(plot, detects=(1.0,), spread=None):
    infested = np.arange(len(plot.grid)) % 3 == 0
    start = Start(infested, np.full(len(infested), 0.3))
    return Insects(plot.grid, start, np.array(detects), spread, RandomStreams(4))


def test_a_sure_look_finds_what_is_there_and_nothing_else(plot):
    some = insects(plot)
    before = some.infested.copy()
    assert [some.look(stop_at(k)) for k in range(20)] == before[:20].tolist()
    assert not some.infested[:20].any()
    assert np.array_equal(some.infested[20:], before[20:])


def test_a_longer_look_finds_what_a_shorter_one_does(plot):
    short = insects(plot, (0.3, 0.9))
    long = insects(plot, (0.3, 0.9))
    seen = [(short.look(stop_at(k, 0.3)), long.look(stop_at(k, 0.9))) for k in range(60)]
    assert all(by_long for by_short, by_long in seen if by_short)
    assert sum(by_long for _, by_long in seen) > sum(by_short for by_short, _ in seen)


def test_those_that_were_missed_spread_at_night(plot):
    some = insects(plot, spread=Spread(rate_per_day=1.0))
    before = some.infested.sum()
    some.pass_night()
    assert some.infested.sum() > before
