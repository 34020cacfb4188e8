"""What is ahead grows as it is believed to, and its interval holds what comes."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.colonies import Colonies
from fieldmon.infestation.forecast import Forecast, _tonight, forecast
from fieldmon.infestation.pest_in_weather import PestInWeather
from fieldmon.infestation.plot_estimate import draw_fields
from fieldmon.infestation.spread import Spread
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.pests.pest import Movement, Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(28, 28)


def test_where_nothing_spreads_little_is_added():
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    ahead = forecast(belief, GRID, [Spread(0.0)] * 14)
    assert ahead.expected[0] == pytest.approx(15.7, abs=0.1)
    # the chance map believes in arrivals from outside
    assert ahead.expected[0] < ahead.expected[-1] < ahead.expected[0] + 6.0


def test_each_morning_is_that_of_the_chance_map():
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    ahead = forecast(belief, GRID, [Spread(0.1)] * 3)
    for expected in ahead.expected:
        assert expected == pytest.approx(belief.chance.sum())
        belief = belief.overnight(Spread(0.1))
    assert (ahead.low <= ahead.expected).all()
    assert (ahead.expected <= ahead.high).all()


def test_the_interval_holds_the_number_after_fourteen_nights():
    """Plots drawn from the chance map itself, then simulated: nine in ten, give or take."""
    pest = Pest("mite", movement=Movement("exponential", 0.15, reach_m=6.0))
    pest_in_weather = PestInWeather(pest)
    belief = TracedPairs.of(GRID, np.full(784, 0.02)).of_pest(pest)
    ahead = forecast(belief, GRID, [pest_in_weather.spread(k, GRID.frame) for k in range(14)])
    plots = np.zeros((60, 784), bool)
    believed = belief.chance, belief.pair_chance
    draw_fields(believed, GRID.adjacent, RandomStreams(1).key("fields"), plots)
    held = []
    for seed, infested in enumerate(plots):
        colonies = Colonies.grown(GRID, pest, infested)
        for k in range(14):
            key = RandomStreams(seed).key("spread", k)
            colonies = colonies.after(pest_in_weather.night(k, GRID.frame), key)
        held.append(ahead.low[-1] <= colonies.infested.sum() <= ahead.high[-1])
    assert 0.8 <= np.mean(held) <= 1.0


def test_where_nothing_may_be_nothing_may_come_of_it():
    """A clean plot stays within the interval for 14 nights: what is not there sends nothing out."""
    ahead = forecast(TracedPairs.of(GRID, np.full(784, 5e-4)), GRID, [Spread(0.1)] * 14)
    assert ahead.low.tolist() == [0.0] * 15
    assert ahead.high[-1] > ahead.expected[-1] > 1.0


def test_the_interval_ends_at_the_number_of_plants_and_holds_what_is_expected():
    ahead = forecast(TracedPairs.of(GRID, np.full(784, 0.3)), GRID, [Spread(0.5)] * 14)
    assert ahead.high.max() == 784
    assert (ahead.low < ahead.expected).all()
    assert (ahead.expected <= ahead.high).all()


def test_the_interval_widens_as_nights_go_by():
    ahead = forecast(TracedPairs.of(GRID, np.full(784, 0.02)), GRID, [Spread(0.02)] * 14)
    wide = ahead.high - ahead.low
    assert wide[-1] > wide[7] > wide[0]


@pytest.mark.parametrize(
    ("weather", "basis"),
    [
        (None, "no weather is known"),
        (14, "by the weather forecast"),
        (0, "by the usual weather of the date"),
        (3, "by the weather forecast for 3 nights, then the usual"),
    ],
)
def test_it_says_what_weather_it_is_made_from(weather, basis):
    made = np.linspace(10.0, 40.0, 15)
    ahead = Forecast(made, made / 2, made * 2, weather)
    assert ahead.sentence() == (
        "40 plants infested after 14 nights without inspections (20 to 80 with a chance of 90 %), "
        f"now 10; {basis}"
    )


@pytest.mark.parametrize("inside", [5.0, 40.0])
@pytest.mark.parametrize("arrived", [0.0, 10.0])
@pytest.mark.parametrize("doubt", [0.5, 1.2])
def test_what_is_on_the_plot_is_doubted_by_its_part_of_the_number(inside, arrived, doubt):
    """The variance of whole numbers drawn of it, by the law of total variance."""
    drawn = _tonight(inside, arrived, doubt, np.random.default_rng(1))
    number = inside + arrived
    wanted = (doubt * number) ** 2 * inside / number
    assert drawn.mean() == pytest.approx(inside, rel=0.1)
    assert drawn.var() + drawn.mean() == pytest.approx(wanted, rel=0.25)


def test_where_whole_numbers_vary_more_than_is_doubted_nothing_more_is_drawn():
    assert set(_tonight(4.0, 0.0, 0.4, np.random.default_rng(1)).tolist()) == {4.0}
