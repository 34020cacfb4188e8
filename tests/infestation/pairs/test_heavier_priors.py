"""Where far more is infested than was told, a map that was told of more is believed."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.learnt import learnt_from
from fieldmon.infestation.pairs.heavier_priors import (
    TOLD,
    doubt_between,
    heavier_than,
    likeliest,
    odds_times,
    refuted,
)
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.tracing import traced_evening
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(30, 30)
N = len(GRID)
FLAT = np.full(N, 0.01)
QUIET = Spread(0.0)


def inspected(belief, infested, plants, learning=None):
    plants = np.asarray(plants, np.int32)
    return belief.learn(plants, infested[plants], learning or Learning(0.84))


def by_itself(belief, infested, plants, learning=None):
    """Return what a map believes that thinks of no others."""
    plants = np.asarray(plants, np.int32)
    return traced_evening.inspected(
        belief, plants, infested[plants], learning or Learning(0.84)
    ).settled()


def scattered(share, seed=3):
    return np.random.default_rng(seed).random(N) < share


def test_what_may_be_instead_is_more_than_twice_what_was_told():
    few = np.array([True, False]), np.full(2, 0.84)
    assert [one.share for one in heavier_than(0.01, *few)] == [0.05, 0.15, 0.4]
    assert [one.share for one in heavier_than(0.06, *few)] == [0.15, 0.4]
    assert heavier_than(0.3, *few) == ()
    for told in (0.01, 0.06, 0.15):
        weights = np.exp([TOLD, *(one.likely for one in heavier_than(told, *few))])
        assert weights.sum() == pytest.approx(1.0)
    # of three hundred plants in turn: none, one in a hundred, in ten and in two
    for finds, possible in (
        (0, []),
        (3, [0.05]),
        (30, [0.05, 0.15, 0.4]),
        (150, [0.05, 0.15, 0.4]),
    ):
        many = np.arange(300) < finds, np.full(300, 0.84)
        assert [one.share for one in heavier_than(0.01, *many)] == possible, finds


def test_odds_are_multiplied():
    chance = np.array([1e-6, 0.2, 0.5, 1.0 - 1e-6])
    times = odds_times(chance, 3.0)
    assert times / (1.0 - times) == pytest.approx(3.0 * chance / (1.0 - chance))


def test_the_first_of_those_equally_likely_is_believed_and_the_impossible_dropped():
    class Map:
        def __init__(self, likely):
            self.likely = likely

    maps = [Map(-9.0), Map(-3.0), Map(-3.0), Map(-10.1)]
    best, others = likeliest(maps, 5.0)
    assert best is maps[1]
    assert others == (maps[0], maps[2])
    # a find or two may be of one spot to which somebody was sent
    best, others = likeliest(maps, 4.0)
    assert best is maps[0]
    assert others == (maps[1], maps[2])


@pytest.mark.parametrize("share", [0.15, 0.3, 0.6])
def test_a_heavy_infestation_that_nobody_announced_is_believed(share):
    """A third of the plants inspected in every third row."""
    infested = scattered(share)
    plants = np.flatnonzero(GRID.row % 6 == 0)
    evening = inspected(TracedPairs.of(GRID, FLAT), infested, plants)
    left = int(infested.sum() - infested[plants].sum())
    told_only = by_itself(TracedPairs.of(GRID, FLAT), infested, plants)
    assert evening.is_heavier
    assert estimate_of(GRID, evening).low <= left <= estimate_of(GRID, evening).high
    # it was a fraction of it, and nobody was told
    assert told_only.chance.sum() < 0.6 * evening.chance.sum()
    assert "more than told" in {one.name for one in learnt_from(evening, 0.84)}
    (said,) = [one for one in learnt_from(evening, 0.84) if one.name == "more than told"]
    assert said.sentence().startswith("Far more was found than was told: the map goes on as if ")


def test_clusters_where_few_are_infested_are_no_heavy_infestation():
    infested = np.zeros(N, bool)
    infested[(np.hypot(*(GRID.xy_m - GRID.xy_m[465]).T) < 5.0)] = True
    assert 3 <= infested.sum() < 0.03 * N
    evening = inspected(TracedPairs.of(GRID, FLAT), infested, np.arange(0, N, 2))
    assert not evening.is_heavier
    assert "more than told" not in {one.name for one in learnt_from(evening, 0.84)}
    alone = by_itself(TracedPairs.of(GRID, FLAT), infested, np.arange(0, N, 2))
    assert (evening.chance == alone.chance).all()
    assert evening.doubt == alone.doubt


def test_what_leads_may_change_and_each_map_goes_on_by_itself():
    """A dense spot first and then a clean plot: what was told is believed again."""
    infested = np.zeros(N, bool)
    infested[np.arange(0, 30, 2)] = True
    few = inspected(TracedPairs.of(GRID, FLAT), infested, np.arange(8))
    assert not few.is_heavier
    assert few.likely < max(one.likely for one in few.others)
    belief = inspected(few, infested, np.arange(8, 10))
    assert belief.is_heavier
    assert belief.others
    morning = belief.overnight(QUIET)
    assert len(morning.others) == len(belief.others)
    told = [one for one in morning.others if not one.is_heavier]
    alone = next(one for one in belief.others if not one.is_heavier).overnight(QUIET)
    assert (told[0].chance == alone.chance).all()
    later = inspected(morning, np.zeros(N, bool), np.arange(60, 500))
    assert not later.is_heavier


def test_where_a_day_speaks_against_the_map_that_was_left_heavier_ones_are_thought_of_again():
    """A corner that was clean on the first day, of a plot that is full of insects elsewhere."""
    infested = scattered(0.4)
    infested[:300] = False
    first = inspected(TracedPairs.of(GRID, FLAT), infested, np.arange(300)).overnight(QUIET)
    assert first.others == ()
    assert not first.is_heavier
    plants = np.arange(330, 480)
    later = inspected(first, infested, plants)
    left = int(infested.sum() - infested[plants].sum())
    assert later.is_heavier
    assert later.chance.sum() > 0.6 * left > 2.0 * by_itself(first, infested, plants).chance.sum()
    # as likely as it was thought before, and what was found in it counts
    assert first.likely - 3.0 > later.likely > by_itself(first, infested, plants).likely
    # what it goes on with, as if it had been told, is what it is told of the plants not seen yet
    (said,) = [one for one in learnt_from(later, 0.84) if one.name == "more than told"]
    assert 0.2 < said.value < 0.4
    # a day that the map expected speaks for it
    assert inspected(first, np.zeros(N, bool), plants).others == ()


def test_a_day_speaks_against_a_map_that_does_worse_than_one_chance_for_all():
    found = np.arange(20) < 8
    best = 8 * np.log(0.4) + 12 * np.log(0.6)
    assert not refuted(best - 4.9, found)
    assert refuted(best - 5.1, found)
    assert not refuted(-4.9, np.ones(5, bool))
    assert refuted(-5.1, np.ones(5, bool))
    # a find or two may be of one spot, however surprising they are
    for few in (np.zeros(50, bool), np.ones(1, bool), np.arange(50) < 4):
        assert not refuted(-99.0, few)


def test_a_treatment_and_a_pest_count_for_every_map():
    infested = scattered(0.3)
    belief = TracedPairs.of(GRID, FLAT).of_pest(Pest("mite"))
    belief = inspected(belief, infested, np.arange(20))
    maps = (belief, *belief.others)
    assert len(maps) > 1
    assert {one.pest for one in maps} == {belief.pest}
    treated = belief.treated(np.full(N, 0.1))
    for before, after in zip(maps, (treated, *treated.others), strict=True):
        assert after.chance.sum() < 0.2 * before.chance.sum()


def test_while_several_maps_are_possible_the_number_is_in_more_doubt():
    assert doubt_between(np.zeros(2), np.array([10.0, 10.0])) == 0.0
    assert doubt_between(np.zeros(2), np.array([5.0, 20.0])) == pytest.approx(np.log(2.0))
    assert doubt_between(np.array([0.0, -9.0]), np.array([5.0, 20.0])) < 0.02
    infested = scattered(0.1)
    belief = inspected(TracedPairs.of(GRID, FLAT), infested, np.arange(30))
    assert belief.others
    assert belief.doubt > 1.02 * replace(belief, others=()).doubt


def test_what_is_known_for_certain_stays_and_the_rest_is_told_of_more():
    chance = FLAT.copy()
    chance[:5] = 1.0
    first = TracedPairs.of(GRID, chance)
    few = np.array([True]), Learning(0.84)
    for one, told in zip(first._heavier(*few), (0.05, 0.15, 0.4), strict=True):
        assert (one.chance[:5] == first.chance[:5]).all()
        assert one.chance[5:].mean() == pytest.approx(told)
        assert one.at_start.sum() == pytest.approx(one.chance.sum())
    assert TracedPairs.of(GRID, np.ones(N))._heavier(*few) == ()
