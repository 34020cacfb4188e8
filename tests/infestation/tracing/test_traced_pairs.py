"""A belief that learns how insects spread: in worlds that were made without it."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import ANYWHERE, BY_EDGE
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle
from tests.infestation.tracing.traced_maps import EVERY, FLAT, GRID, LEARNING, QUIET, N, seen


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


def test_a_plot_of_one_plant_is_believed_in_too():
    belief = TracedPairs.of(rectangle(1, 1), np.array([0.1]))
    after = belief.learn(np.array([0], np.int32), np.array([True]), LEARNING).overnight(QUIET)
    assert 0.0 < after.chance[0] < 0.1
