"""What is ahead grows as it is believed to, and its interval holds what comes."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.forecast import Forecast, forecast
from fieldmon.infestation.insects.colonies import Colonies
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.plot_estimate import PlotEstimate, draw_fields, estimate_of
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Movement, Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(28, 28)


def test_where_nothing_spreads_little_is_added():
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    ahead = forecast(belief, GRID, [Spread(0.0)] * 14)
    assert ahead.expected[0] == pytest.approx(15.7, abs=0.1)
    # the chance map believes in arrivals from outside
    assert ahead.expected[0] < ahead.expected[-1] < ahead.expected[0] + 6.0


def test_it_begins_with_what_is_known_of_the_evening():
    belief, nights = TracedPairs.of(GRID, np.full(784, 0.02)), [Spread(0.1)] * 3
    usual = forecast(belief, GRID, nights)
    ahead = forecast(belief, GRID, nights, now=PlotEstimate(40.0, 25, 61, 0.0))
    assert (ahead.expected[0], ahead.low[0], ahead.high[0]) == (40.0, 25.0, 61.0)
    # what the nights bring is that of the chance map
    assert ahead.expected[1:] == pytest.approx(usual.expected[1:])


def test_it_holds_where_nothing_comes_from_outside_whatever_the_evening_s_number_is():
    belief, nights = TracedPairs.of(GRID, np.full(784, 0.05)), [Spread(0.02)]
    for expected in np.linspace(10.0, 90.0, 60).tolist():
        ahead = forecast(belief, GRID, nights, now=PlotEstimate(expected, 2, 200, 0.0))
        assert ahead.expected[0] == expected


def test_each_morning_is_that_of_the_chance_map():
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    ahead = forecast(belief, GRID, [Spread(0.1)] * 3)
    for expected in ahead.expected:
        assert expected == pytest.approx(belief.chance.sum())
        belief = belief.overnight(Spread(0.1))
    assert (ahead.low <= ahead.expected).all()
    assert (ahead.expected <= ahead.high).all()


def test_tomorrow_is_the_morning_on_which_the_next_plan_is_made():
    """What the night tells by the ancestry of finds is in it, for arrivals and the others."""
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    plants = np.arange(0, 784, 2, dtype=np.int32)
    evening = belief.learn(plants, np.isin(plants, [30, 34, 90, 400]), Learning())
    nights = [Spread(0.1)] * 3
    ahead = forecast(evening, GRID, nights)
    morning = evening.overnight(nights[0]).chance.sum()
    assert ahead.expected[1] == pytest.approx(morning, rel=1e-6)
    alone = forecast(replace(evening, ancestry=None), GRID, nights)
    assert abs(alone.expected[1] - morning) > 0.1
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
    ("weather", "measured", "basis"),
    [
        (None, 0, "no weather is known"),
        (14, 0, "by the weather forecast"),
        (14, 14, "by the weather measured"),
        (0, 0, "by the usual weather of the date"),
        (3, 0, "by the weather forecast for 3 nights, then the usual"),
        (8, 8, "by the weather measured for 8 nights, then the usual"),
        (8, 7, "by the weather measured for 7 nights and forecast for 1 night, then the usual"),
        (14, 9, "by the weather measured for 9 nights and forecast for 5 nights"),
    ],
)
def test_it_says_what_weather_it_is_made_from(weather, measured, basis):
    made = np.linspace(10.0, 40.0, 15)
    ahead = Forecast(made, made / 2, made * 2, weather, measured)
    assert ahead.sentence() == (
        "40 plants infested after 14 nights without inspections (20 to 80 with a chance of 90 %), "
        f"now 10; {basis}"
    )
    many = Forecast(100 * made, 50 * made, 200 * made, weather, measured).sentence()
    assert many.startswith("4,000 plants infested")
    assert "(2,000 to 8,000 with a chance of 90 %), now 1,000;" in many


def test_it_is_what_a_season_says_on_each_of_these_mornings_if_nobody_comes():
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    plants = np.arange(0, 784, 5, dtype=np.int32)
    belief = belief.learn(plants, np.isin(plants, [30, 400]), Learning())
    nights = [Spread(0.1)] * 9
    ahead = forecast(belief, GRID, nights)
    for night, spread in enumerate(nights, 1):
        belief = belief.overnight(spread)
        now = estimate_of(GRID, belief)
        assert ahead.expected[night] == pytest.approx(now.expected, rel=1e-3)
        assert ahead.low[night] == pytest.approx(now.low, abs=1)
        assert ahead.high[night] == pytest.approx(now.high, rel=0.03, abs=1)


def test_of_plants_that_were_found_and_left_nothing_is_in_doubt():
    belief = TracedPairs.of(GRID, np.full(784, 0.02))
    plants = np.arange(784, dtype=np.int32)
    found = plants % 10 == 0
    flagged = belief.learn(plants, found, Learning(0.99, treated=False))
    ahead = forecast(flagged, GRID, [Spread(0.1)] * 14, found=found)
    assert ahead.low[0] >= found.sum()
    assert ahead.high[0] < found.sum() + 30
    assert (ahead.low >= found.sum()).all()
    assert (ahead.high <= 784).all()


def test_a_frame_has_a_line_for_each_night_this_evening_first():
    ahead = Forecast(np.array([3.0, 4.0]), np.array([1.0, 2.0]), np.array([5.0, 7.0]))
    assert ahead.to_pandas().to_dict("list") == {
        "night": [0, 1], "expected": [3.0, 4.0], "low": [1.0, 2.0], "high": [5.0, 7.0],
    }  # fmt: skip
