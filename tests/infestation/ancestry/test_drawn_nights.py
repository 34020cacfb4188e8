"""A night that was drawn of late is not drawn again, and is to the last bit what it was."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.ancestry import drawn_nights
from fieldmon.infestation.ancestry.ancestry import Ancestry
from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight
from fieldmon.infestation.ancestry.drawn_nights import overnight_once
from fieldmon.infestation.ancestry.kept_ancestry import arrays_of
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Pest
from tests.infestation.ancestry.ancestries import FLAT, GRID, MIDDLE

NIGHT = ToldNight(0.3)


@pytest.fixture
def drawn(monkeypatch):
    """Return a list that grows with each night that is drawn; none is yet."""
    nights = []

    def counted(of, night):
        nights.append(night)
        return overnight(of, night)

    monkeypatch.setattr(drawn_nights, "overnight", counted)
    drawn_nights._kept.cache_clear()
    return nights


def evening(grid=GRID):
    known = Ancestry.of(grid, FLAT)
    return known.learn(np.array([MIDDLE, 0], np.int32), np.array([True, False]), np.full(2, 0.8))


def test_the_same_is_drawn_once_whoever_read_the_plot(drawn):
    alone, its_chance = overnight(evening(), NIGHT)
    for grid in (GRID, replace(GRID)):
        told, chance = overnight_once(evening(grid), NIGHT)
        assert told.grid is grid
        assert chance.tobytes() == its_chance.tobytes()
        arrays, expected = arrays_of(told), arrays_of(alone)
        assert all(arrays[name].tobytes() == expected[name].tobytes() for name in expected)
    assert len(drawn) == 1


def test_of_large_plots_nothing_is_kept(drawn, monkeypatch):
    monkeypatch.setattr(drawn_nights, "KEPT_PLANTS", len(GRID) - 1)
    for _ in range(2):
        overnight_once(evening(), NIGHT)
    assert len(drawn) == 2


@pytest.mark.parametrize(
    ("of", "night"),
    [
        (replace(evening(), start=0.5 * FLAT), NIGHT),
        (replace(evening(), new=(MIDDLE, 5)), NIGHT),
        (replace(evening(), pest=Pest("mite")), NIGHT),
        (replace(evening(), new_left=(MIDDLE,)), NIGHT),
        (replace(evening(), hiding=np.array([0.7, 0.3, 0.0, 0.0])), NIGHT),
        (evening(), NIGHT._replace(sends=0.31)),
        (evening(), NIGHT._replace(arrive=(0.01, 0.02))),
        (evening(replace(GRID, row_spacing_m=2.0 * GRID.row_spacing_m)), NIGHT),
    ],
)
def test_what_differs_in_anything_is_drawn_anew(drawn, of, night):
    overnight_once(evening(), NIGHT)
    overnight_once(of, night)
    assert len(drawn) == 2


@pytest.mark.parametrize("pest", [None, Pest("mite")])
def test_the_evening_in_hindsight_and_the_morning_after_it_are_told_by_the_same_draws(drawn, pest):
    first = TracedPairs.of(GRID, FLAT)
    belief = first if pest is None else first.of_pest(pest)
    spread = Spread(0.1) if pest is None else PestInWeather(pest).spread(0, GRID.frame)
    plants = np.array([MIDDLE, 0, 5], np.int32)
    told = belief.learn(plants, plants == MIDDLE, Learning(0.84))
    for _ in range(2):
        told.in_hindsight(spread)
        told.overnight(spread)
    assert len(drawn) == 1 + len(told.others)


def test_a_night_of_which_nothing_is_to_be_drawn_is_not_kept(drawn):
    for _ in range(2):
        assert overnight_once(Ancestry.of(GRID, FLAT), NIGHT)[1] is None
    assert len(drawn) == 2
