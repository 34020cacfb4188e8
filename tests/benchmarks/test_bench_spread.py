"""Nights of kernels: a long one on 100 489 plants, both ways to sum, and a wind not met before."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.forecast import forecast
from fieldmon.infestation.insects.colonies import Colonies
from fieldmon.infestation.insects.dispersal import Dispersal
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.io.readers.pest_file import pest_of
from fieldmon.pests.pest import Movement, Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(317, 317)
N = len(GRID)
LONG, KEY = DistanceKernel("cauchy", 9.0), RandomStreams(1).key("spread")


def infested(share):
    return RandomStreams(1).of("start").random(N) < share


@pytest.mark.parametrize("share", [0.001, 0.01, 0.1])
def test_night_of_a_long_kernel_on_100_489_plants(benchmark, share):
    dispersal, sick = Dispersal.of(GRID, LONG), infested(share)
    after = benchmark(lambda: sick | dispersal.reached(np.flatnonzero(sick), 0.5, KEY))
    assert after.sum() > sick.sum()


@pytest.mark.parametrize("share", [0.001, 0.01, 0.1])
@pytest.mark.parametrize("by_hour", [False, True])
def test_night_of_a_pest_that_goes_far_on_100_489_plants(benchmark, by_hour, share):
    """A night of one that moves at night, or the 24 hours of whitefly."""
    far = Pest("mite", movement=Movement("cauchy", 0.5, reach_m=15.0))
    pest = pest_of("whitefly") if by_hour else far
    pest_in_weather, before = PestInWeather(pest), Colonies.grown(GRID, pest, infested(share))
    spells = (
        pest_in_weather.hours(0, GRID.frame) if by_hour else [pest_in_weather.night(0, GRID.frame)]
    )

    def night():
        colonies = before
        for turn, spell in enumerate(spells):
            colonies = colonies.after(spell, KEY, turn)
        return colonies.infested

    assert benchmark(night).sum() > before.infested.sum()


@pytest.mark.parametrize("way", ["by_sum", "by_fft"])
@pytest.mark.parametrize("share", [0.001, 0.01])
def test_ways_to_sum_a_long_kernel_on_100_489_plants(benchmark, way, share):
    sum_up = getattr(Dispersal.of(GRID, LONG), way)
    assert benchmark(sum_up, 0.5 * infested(share)).max() > 0.0


def test_a_long_kernel_in_a_new_wind_on_100_489_plants(benchmark):
    sent = 0.5 * infested(0.01)
    landed = benchmark(lambda: Dispersal.of(GRID, LONG, (3.0, -1.0)).landed(sent))
    assert landed.max() > 0.0


@pytest.mark.parametrize("by_hour", [False, True])
def test_25_days_of_a_pest_on_scenario_c(benchmark, by_hour):
    grid = rectangle(91, 91)
    pest = Pest("mite", movement=Movement("cauchy", 0.1, reach_m=6.0, by_hour=by_hour))
    pest_in_weather = PestInWeather(pest)
    start = RandomStreams(1).of("start").random(len(grid)) < 0.02
    days = [
        pest_in_weather.hours(0, grid.frame) if by_hour else [pest_in_weather.night(0, grid.frame)]
    ] * 25
    streams = RandomStreams(1)

    def season():
        colonies = Colonies.grown(grid, replace(pest), start)
        for number, spells in enumerate(days):
            for turn, spell in enumerate(spells):
                colonies = colonies.after(spell, streams.key("spread", number), turn)
        return colonies.infested

    assert benchmark(season).sum() > start.sum()


def test_a_night_of_the_chance_map_of_a_pest_on_scenario_c(benchmark):
    grid = rectangle(91, 91)
    pest_in_weather = PestInWeather(
        Pest("mite", movement=Movement("exponential", 0.3, reach_m=6.0))
    )
    belief = TracedPairs.of(grid, np.full(len(grid), 0.02)).of_pest(pest_in_weather.pest)
    spread = pest_in_weather.spread(0, grid.frame)
    assert benchmark(belief.overnight, spread).chance.sum() > belief.chance.sum()


def test_a_night_of_the_chance_map_of_the_thesis_s_pest_on_scenario_c(benchmark):
    grid = rectangle(91, 91)
    belief = TracedPairs.of(grid, np.full(len(grid), 0.02))
    assert benchmark(belief.overnight, Spread(0.3)).chance.sum() > belief.chance.sum()


def test_a_forecast_of_14_nights_on_scenario_c(benchmark):
    grid = rectangle(91, 91)
    belief = TracedPairs.of(grid, np.full(len(grid), 0.02))
    ahead = benchmark(forecast, belief, grid, [Spread(0.02)] * 14)
    assert ahead.nights == 14
