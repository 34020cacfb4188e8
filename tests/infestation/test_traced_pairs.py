"""A belief that learns how insects spread: in worlds that were made without it."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.origins import ANYWHERE, AT_START, BY_EDGE, JUMPED
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.pest_in_weather import PestInWeather
from fieldmon.infestation.spread import Spread
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.pests.pest import Movement, Pest
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
N = 400
FLAT = np.full(N, 0.02)
EVERY = np.arange(N, dtype=np.int32)
LEARNING, QUIET = Learning(detection=0.84), Spread(0.3, "one")


def seen(belief, infested, learning=LEARNING, days=1):
    """Inspect every plant for some days, by draws of seed 1; finds are treated."""
    rng, left = np.random.default_rng(1), infested.copy()
    for _ in range(days):
        found = left & (rng.random(N) < learning.detection)
        belief = belief.learn(EVERY, found, learning)
        left &= ~found
        belief = belief.overnight(QUIET)
    return belief


@pytest.mark.parametrize("to", ["one", "each"])
def test_chances_stay_chances_and_their_origins_add_up(to):
    infested = np.zeros(N, np.bool_)
    infested[[40, 41, 42, 60, 61, 222, 390]] = True
    belief = TracedPairs.of(GRID, FLAT)
    for found in (infested, np.zeros(N, np.bool_)):
        belief = belief.learn(EVERY[::3], found[::3], LEARNING)
        belief = belief.overnight(Spread(0.3, to))
        assert ((belief.chance > 0.0) & (belief.chance < 1.0)).all()
        assert belief.shares.sum(axis=1) == pytest.approx(1.0, abs=1e-4)
        start, other = GRID.adjacent
        p, q = np.repeat(belief.chance, np.diff(start)), belief.chance[other]
        assert (belief.pair_chance <= np.minimum(p, q) + 1e-9).all()
        assert (belief.pair_chance >= np.maximum(p + q - 1.0, 0.0) - 1e-9).all()
        assert belief.doubt > 0.0


def test_a_suspicion_that_proves_wrong_says_nothing_of_plants_that_were_not_suspected():
    suspected = (EVERY % 20 < 10) & (EVERY < 200)
    first = TracedPairs.of(GRID, np.where(suspected, 0.1, 0.01))
    assert first.at_start == pytest.approx([10.0, 3.0])
    clean = np.flatnonzero(suspected).astype(np.int32)[::2]
    belief = first.learn(clean, np.zeros(clean.size, np.bool_), LEARNING)
    inside = np.setdiff1d(np.flatnonzero(suspected), clean)
    assert belief.chance[inside].mean() < 0.3 * 0.1
    # farther than neighbours, only jumps that may be (12 %) tell a little
    far = (EVERY % 20 > 13) | (EVERY > 260)
    assert belief.chance[far] == pytest.approx(first.chance[far], rel=0.05)


def test_a_suspicion_of_all_alike_is_learnt_of_all():
    first = TracedPairs.of(GRID, FLAT)
    assert first.at_start == pytest.approx([8.0, 0.0])
    clean = EVERY[:200]
    belief = first.learn(clean, np.zeros(200, np.bool_), LEARNING)
    assert belief.chance[260:].mean() < 0.35 * 0.02


def test_a_day_in_clusters_says_that_insects_do_not_jump_and_one_apart_that_they_do():
    apart = np.zeros(N, np.bool_)
    apart[23::37] = True
    together = np.zeros(N, np.bool_)
    together[[21, 22, 41, 42, 150, 151, 170, 171, 305, 306, 325, 326]] = True
    first = TracedPairs.of(GRID, FLAT)
    assert seen(first, together).jumps < 0.5 * first.jumps
    assert seen(first, apart).jumps > 0.9


def test_a_find_raises_plants_beyond_its_neighbours_and_a_clean_day_lowers_them():
    apart = np.zeros(N, np.bool_)
    apart[23::37] = True
    told = seen(TracedPairs.of(GRID, FLAT), apart)
    one = told.learn(np.array([210], np.int32), np.array([True]), LEARNING)
    within = [213, 250, 168]
    pairs = PairApproximation(GRID, told.chance, told.pair_chance)
    without = pairs.learn(np.array([210], np.int32), np.array([True]), LEARNING)
    assert (one.chance[within] > 1.05 * without.chance[within]).all()


def test_finds_beyond_what_was_told_raise_the_arrivals():
    rng, belief = np.random.default_rng(5), TracedPairs.of(GRID, np.full(N, 1e-4))
    for _ in range(8):
        belief = belief.learn(EVERY, rng.random(N) < 0.02, LEARNING).overnight(Spread(0.0))
    assert belief.counts.scale[[ANYWHERE, BY_EDGE]].max() > 2.0


def test_a_treatment_leaves_its_share():
    belief = TracedPairs.of(GRID, FLAT)
    after = belief.treated(np.full(N, 0.25))
    assert after.chance == pytest.approx(0.005)
    assert after.pair_chance == pytest.approx(belief.pair_chance / 16.0)


def test_a_plot_of_one_plant_is_believed_in_too():
    belief = TracedPairs.of(rectangle(1, 1), np.array([0.1]))
    after = belief.learn(np.array([0], np.int32), np.array([True]), LEARNING).overnight(QUIET)
    assert 0.0 < after.chance[0] < 0.1


def test_a_day_moves_the_chance_of_jumping_as_bayes_rule_does_and_counts_it_once():
    """Two ways to stand are as good as out of the question, so the rule fits on a line."""
    row, looked_at = rectangle(1, 40), np.array([5, 4, 6], np.int32)
    told = TracedPairs.of(row, np.full(40, 0.02))
    shares = np.zeros_like(told.shares)
    shares[:, [AT_START, JUMPED]] = 0.6, 0.4
    told = replace(told, shares=shares, evidence=np.array([0.0, -60.0, -60.0, 0.0]))
    after = told.learn(looked_at, np.array([True, False, False]), LEARNING)
    # two plants beside a find are clean; side by side half of those that others did not infest
    # would be, apart 15 % (the pair knows 98 % of that), and each counts half
    clean = [1.0 - 0.84 * (0.02 + 0.98**2 * each) for each in (0.5, 0.15)]
    # and nothing is settled for good: the other two keep exp(-6) of the likeliest
    others = 0.24 * np.exp(-6.0) * clean[1]
    jumps = 0.12 * clean[1] / (0.64 * clean[0] + 0.12 * clean[1] + others)
    assert told.jumps == pytest.approx(0.12 / 0.76)
    assert after.jumps == pytest.approx(jumps)
    # no find is traced so far: of its chance 0.6 stays, and 0.4 goes with the chance of jumping
    scale = after.counts.scale / told.counts.scale
    wanted = 0.02 * (0.6 * scale[AT_START] + 0.4 * scale[JUMPED] * jumps / told.jumps)
    assert after.chance[39] == pytest.approx(wanted, rel=2e-3)


@pytest.mark.parametrize(
    "pest", [None, Pest("mite", movement=Movement("exponential", 0.4, reach_m=6.0))]
)
def test_a_night_that_tells_nothing_apart_brings_the_same_chances(pest):
    first = TracedPairs.of(GRID, FLAT)
    belief = first if pest is None else first.of_pest(pest)
    told = untold = seen(belief, np.arange(N) % 41 == 0)
    spread = Spread(0.1) if pest is None else PestInWeather(pest).spread(0, GRID.frame)
    for _ in range(3):
        told, untold = told.overnight(spread), untold.untold_night(spread)
        np.testing.assert_allclose(untold.chance, told.chance, rtol=1e-12)
        np.testing.assert_allclose(untold.pair_chance, told.pair_chance, rtol=1e-10)


def test_without_arrivals_is_left_what_did_not_come_from_outside():
    belief = TracedPairs.of(GRID, FLAT)
    shares = np.zeros_like(belief.shares)
    shares[:, AT_START], shares[:200, ANYWHERE], shares[:200, AT_START] = 1.0, 0.75, 0.25
    left = replace(belief, shares=shares).without_arrivals
    assert left.chance[:200] == pytest.approx(0.25 * FLAT[:200], rel=1e-6)
    assert left.chance[200:] == pytest.approx(FLAT[200:], rel=1e-6)
