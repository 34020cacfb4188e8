"""Strategies are compared on the same insects, seed by seed."""

import numpy as np
import pytest

from app.state.comparison import (
    ComparisonSettings,
    Strategy,
    WatchedComparison,
    curve,
    gains,
    outcomes,
)
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.simulation.worker import LaidPlot
from tests.app.driving import SQUARE, until

SHORT = [Strategy(name, 1.0, 40.0) for name in ("naive", "dynamic")]


@pytest.fixture(scope="module")
def plot():
    return Plot.of(Field("square", SQUARE, gate=(35.15, 30.36)))


def compared(plot, strategies, seeds=4, pest_in_weather=None):
    rng = np.random.default_rng(3)
    chance = np.where(rng.random(len(plot.grid)) < 0.1, 0.5, 0.001)
    settings = ComparisonSettings(
        tuple(strategies), n_days=5, share=0.05, rate=0.1, visit_every=1, seeds=seeds
    )
    running = WatchedComparison(settings, LaidPlot(plot, chance, pest_in_weather), Robot())
    running.start()
    running.wait(180)
    assert running.done == running.total
    return running


@pytest.fixture(scope="module")
def short(plot):
    """Return the seasons of both strategies, compared once."""
    return compared(plot, SHORT).seasons()


def test_a_strategy_compared_with_its_own_twin_differs_by_nothing(plot, short):
    again = compared(plot, SHORT).seasons()
    for strategy in SHORT:
        for one, other in zip(short[strategy], again[strategy], strict=True):
            assert one.left.tolist() == other.left.tolist()


def test_every_strategy_meets_the_same_insects_on_the_first_morning(short):
    starts = [[int(s.new[0]) for s in walked] for walked in short.values()]
    assert starts[0] == starts[1]
    assert len(set(starts[0])) > 1


def test_seasons_of_a_pest_are_its_own_whatever_a_chance_a_night_says(plot, short):
    usual = short[SHORT[0]]
    of_pest = compared(
        plot, SHORT[:1], pest_in_weather=PestInWeather(shipped_pest("whitefly"))
    ).seasons()
    starts = [[int(season.new[0]) for season in made] for made in (usual, of_pest[SHORT[0]])]
    assert starts[0] == starts[1]
    assert [s.left.tolist() for s in usual] != [s.left.tolist() for s in of_pest[SHORT[0]]]


def test_longer_inspections_and_more_hours_lose_less(plot):
    strategies = [Strategy("dynamic", 1.0, 20.0), Strategy("dynamic", 4.0, 40.0)]
    ranked = outcomes(compared(plot, strategies).seasons())
    assert ranked[0].strategy == strategies[1]
    assert ranked[0].behind is None
    assert ranked[1].behind.mean == pytest.approx(ranked[1].loss.mean - ranked[0].loss.mean)


def test_a_stopped_comparison_goes_on_where_it_stood(plot):
    settings = ComparisonSettings(
        tuple(SHORT), n_days=3, share=0.05, rate=0.1, visit_every=1, seeds=200
    )
    running = WatchedComparison(settings, LaidPlot(plot, np.full(len(plot.grid), 0.01)), Robot())
    running.start()
    running.stop()
    running.wait(180)
    part = running.done
    assert part < running.total
    assert not running.running
    running.start()
    until(lambda: running.done > part)
    running.stop()
    running.wait(180)
    assert running.done > part


def test_curves_stay_within_their_interval_and_percent(short):
    walked = next(iter(short.values()))
    mean, low, high = curve(walked)
    assert (low <= mean).all()
    assert (mean <= high).all()
    assert low.min() >= 0
    assert high.max() <= 100


def test_what_more_robots_save_is_taken_for_each_way_to_work(plot):
    strategies = [Strategy(name, 0.5, 40.0, k) for name in ("naive", "dynamic") for k in (1, 2)]
    seasons = compared(plot, [*strategies, Strategy("naive", 0.7, 40.0)]).seasons()
    of_naive, of_dynamic = gains(seasons)
    assert [(gain.fewer, gain.robots) for gain in (*of_naive, *of_dynamic)] == [(1, 2)] * 2
    losses = [
        np.array([s.infested_plant_days for s in seasons[one]]) for one in strategies[:2]
    ]  # fmt: skip
    assert of_naive[0].saved.mean == pytest.approx((losses[0] - losses[1]).mean())
    worked = {o.strategy: o.worked_h for o in outcomes(seasons)}
    assert worked[strategies[1]] > 1.8 * worked[strategies[0]]
