"""How many are still infested, and is the plot clean."""

import itertools

import numpy as np
import pytest
from scipy.stats import binom

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation import plot_estimate
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs.pairs import PairApproximation, pair_chances
from fieldmon.infestation.plot_estimate import (
    PlotEstimate,
    doubted_level,
    draw_fields,
    drawn_numbers,
    estimate_of,
    estimate_plot,
)
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle
from tests.infestation.ancestry.enumerated import Enumerated

GRID = rectangle(20, 20)


def test_for_independent_plants_it_is_the_binomial():
    chance = np.full(400, 0.03)
    ahead = estimate_plot(GRID, chance, pair_chances(chance, GRID, clustering=0.0))
    assert ahead.expected == pytest.approx(12.0)
    assert ahead.low == pytest.approx(binom.ppf(0.05, 400, 0.03), abs=1)
    assert ahead.high == pytest.approx(binom.ppf(0.95, 400, 0.03), abs=1)
    assert ahead.chance_clean == pytest.approx(0.97**400, rel=1e-6)


def test_a_chance_of_clean_too_small_for_a_number_is_not_none_unless_one_is_known():
    chance = np.full(400, 0.9)
    ahead = estimate_plot(GRID, chance, pair_chances(chance, GRID, clustering=0.0))
    assert "the chance that the plot is clean is under 1 %" in ahead.sentence()
    assert ahead.beside(1).chance_clean == 0.0


def test_for_a_row_of_plants_the_chance_of_clean_is_that_of_the_chain():
    row = rectangle(1, 5)
    belief = PairApproximation.of(row, np.full(5, 0.2), clustering=0.6)
    pair_chance = belief.pair_chance[0]
    total = 0.0
    for state in itertools.product([0, 1], repeat=5):
        p = 0.2 if state[0] else 0.8
        for one, other in itertools.pairwise(state):
            table = {
                (1, 1): pair_chance,
                (1, 0): 0.2 - pair_chance,
                (0, 1): 0.2 - pair_chance,
                (0, 0): 0.6 + pair_chance,
            }
            p *= table[one, other] / (0.2 if one else 0.8)
        total += p * (sum(state) == 0)
    assert estimate_plot(row, belief.chance, belief.pair_chance).chance_clean == pytest.approx(
        total, rel=1e-6
    )


@pytest.mark.parametrize("clustering", [0.0, 0.3, 0.7])
def test_fields_of_a_row_are_drawn_as_often_as_all_its_states_say(clustering):
    row = rectangle(1, 6)
    belief = PairApproximation.of(row, np.linspace(0.1, 0.5, 6), clustering)
    on = [row.adjacent.start[i] + (i > 0) for i in range(5)]
    truth = Enumerated.chain(belief.chance, belief.pair_chance[on])
    fields = np.zeros((6000, 6), np.bool_)
    believed = belief.chance, belief.pair_chance
    draw_fields(believed, row.adjacent, RandomStreams(4).key("fields"), fields)
    share = np.bincount(fields @ (1 << np.arange(6)), minlength=64) / len(fields)
    allowed = 5.0 * np.sqrt(truth.weight / len(fields)) + 3.0 / len(fields)
    assert (np.abs(share - truth.weight) <= allowed).all()


def test_plants_that_stand_together_make_the_number_less_sure_and_clean_more_likely():
    chance = np.full(400, 0.01)
    alone = estimate_plot(GRID, chance, pair_chances(chance, GRID, clustering=0.0))
    together = estimate_plot(GRID, chance, pair_chances(chance, GRID, clustering=0.7))
    assert together.expected == alone.expected
    assert together.high - together.low > alone.high - alone.low
    assert together.chance_clean > 2 * alone.chance_clean


def test_the_same_question_has_the_same_answer_and_a_surer_interval_is_wider():
    chance = np.full(400, 0.05)
    assert estimate_plot(GRID, chance) == estimate_plot(GRID, chance)
    sure, rough = estimate_plot(GRID, chance, sure=0.99), estimate_plot(GRID, chance, sure=0.5)
    assert sure.low < rough.low <= rough.high < sure.high


def test_the_fields_of_a_map_are_drawn_once_and_those_of_another_anew(monkeypatch):
    grid, maps, draw = rectangle(5, 7), [], plot_estimate._drawn
    monkeypatch.setattr(plot_estimate, "_drawn", lambda *of: maps.append(of) or draw(*of))
    first, again = (estimate_plot(grid, np.full(35, 0.0123)) for _ in range(2))
    assert first == again
    assert len(maps) == 1
    assert estimate_plot(grid, np.full(35, 0.2)).high > first.high
    assert len(maps) == 2


def test_it_says_so_in_a_sentence():
    ahead = estimate_plot(GRID, np.full(400, 0.05))
    assert "About 20 plants" in ahead.sentence()
    assert f"between {ahead.low} and {ahead.high}" in ahead.sentence()
    many = PlotEstimate(5603.7, 1975, 15364, 0.0).sentence()
    assert "About 5,604 plants are still infested (between 1,975 and 15,364);" in many


@pytest.mark.parametrize("sure", [0.0, 1.0, -2.0])
def test_an_impossible_sureness_is_refused(sure):
    with pytest.raises(SettingError, match="between 0 and 1"):
        estimate_plot(GRID, np.full(400, 0.05), sure=sure)


def test_doubt_widens_the_interval_and_does_not_move_the_number():
    grid = rectangle(20, 20)
    chance = np.full(400, 0.05)
    sure, doubted = estimate_plot(grid, chance), estimate_plot(grid, chance, doubt=0.5)
    assert doubted.low < sure.low < sure.high < doubted.high
    assert doubted.expected == sure.expected
    # so many may well be none, where the number is in doubt
    assert sure.chance_clean < doubted.chance_clean < 0.05


def test_no_doubt_makes_more_infested_plants_than_there_are():
    grid = rectangle(20, 20)
    many = estimate_plot(grid, np.full(400, 0.6), doubt=2.0)
    assert 0 <= many.low < many.expected < many.high <= 400


@pytest.mark.parametrize("sure", [0.5, 0.9])
def test_intervals_of_a_few_plants_hold_as_many_whole_numbers_as_they_say(sure):
    draws, held = np.random.default_rng(3), []
    for mean in np.linspace(3.0, 15.0, 25):
        chance = np.full(400, mean / 400)
        alone = np.repeat(chance, np.diff(GRID.adjacent.start)) * chance[GRID.adjacent.plant]
        made = estimate_plot(GRID, chance, alone, sure, doubt=0.5)
        level = draws.permutation(np.tile(doubted_level(0.5), 10))
        number = np.rint(draws.binomial(400, mean / 400, level.size) * level)
        held.append(np.mean((made.low <= number) & (number <= made.high)))
    # a whole number at either end counts with all of its chance
    assert np.mean(held) == pytest.approx(sure, abs=0.07)


@pytest.mark.parametrize("doubt", [0.5, 5.0, 50.0, 500.0])
def test_in_any_doubt_a_plot_that_may_be_infested_all_over_has_an_interval(doubt):
    grid = rectangle(1, 3)
    for chance in (0.3, 0.5, 0.7, 0.9):
        with np.errstate(all="raise", under="ignore"):
            every = estimate_plot(grid, np.full(3, chance), doubt=doubt)
        assert 0 <= every.low <= every.high <= 3


def test_plants_that_were_found_and_left_do_not_make_a_clean_rest_impossible():
    """They were taken to be clean, which made their neighbours certain: a chance of 1e-30."""
    chance, found = np.full(400, 0.004), np.zeros(400, bool)
    found[[110, 113, 205, 305]] = True
    chance[found] = 1.0 - 1e-6
    start, other = GRID.adjacent
    own = np.repeat(np.arange(400), np.diff(start))
    # beside a find one of three is infested, so both of such a pair are
    chance[other[found[own] & ~found[other]]] = 0.3
    both = np.minimum(chance[own], chance[other]) * np.where(found[own] | found[other], 1.0, 0.2)
    numbers, none = drawn_numbers(GRID, (chance, both), ~found)
    assert np.exp(none) == pytest.approx(np.mean(numbers == 0.0), abs=0.03)
    told = PlotEstimate(3.4, 0, 10, 0.16, found=27)
    assert told.sentence() == (
        "About 3 plants are infested (between 0 and 10) beside the 27 that were found and only "
        "flagged; the chance that the plot is clean is 16 %."
    )


def test_of_two_plants_one_of_which_was_found_and_treated_one_can_be_infested():
    two = rectangle(1, 2)
    morning = TracedPairs.of(two, np.full(2, 0.6))
    assert estimate_of(two, morning).high == 2
    evening = morning.learn(np.array([0], np.int32), np.array([True]), Learning())
    assert estimate_of(two, evening).high == 1


def test_plants_as_good_as_clean_count_where_they_are_many():
    many = rectangle(100, 200)
    assert estimate_of(many, TracedPairs.of(many, np.full(20_000, 1e-6)), sure=0.999).high > 0
