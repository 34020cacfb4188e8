"""Chances of pairs when those of their plants change: held to what two plants can be."""

import numpy as np
import pytest

from fieldmon.infestation.pairs.pair_changes import pairs_after_arrivals, pairs_scaled
from fieldmon.infestation.pairs.pairs import pair_chances
from fieldmon.plot.layout import rectangle

GRID = rectangle(5, 4)
START, OTHER = GRID.adjacent
OWN = np.repeat(np.arange(20), np.diff(START))


@pytest.fixture
def believed():
    chance = np.random.default_rng(1).uniform(0.05, 0.4, 20)
    return chance, pair_chances(chance, GRID, 0.3)


def test_two_are_clean_after_arrivals_if_they_were_and_nothing_came_to_either(believed):
    chance, together = believed
    arrives = np.random.default_rng(2).uniform(0.0, 0.5, 20)
    after = 1.0 - (1.0 - chance) * (1.0 - arrives)
    both = pairs_after_arrivals(believed, GRID.adjacent, arrives, after)
    clean = 1.0 - chance[OWN] - chance[OTHER] + together
    still_clean = clean * (1.0 - arrives[OWN]) * (1.0 - arrives[OTHER])
    np.testing.assert_allclose(1.0 - after[OWN] - after[OTHER] + both, still_clean)


def test_where_nothing_arrives_pairs_are_what_they_were(believed):
    both = pairs_after_arrivals(believed, GRID.adjacent, np.zeros(20), believed[0])
    np.testing.assert_allclose(both, believed[1])


def test_both_are_as_much_less_likely_as_each_is(believed):
    chance, together = believed
    np.testing.assert_allclose(
        pairs_scaled(together, GRID.adjacent, np.full(20, 0.25), 0.25 * chance), 0.25 * together
    )
    uneven = np.where(np.arange(20) % 2, 0.5, 0.125)
    both = pairs_scaled(together, GRID.adjacent, uneven, uneven * chance)
    mean = np.sqrt(uneven[OWN] * uneven[OTHER])
    assert (both <= together * mean + 1e-15).all()


def test_no_pair_is_likelier_than_either_plant_or_less_likely_than_both_must_be(believed):
    chance, together = believed
    scale = np.random.default_rng(3).uniform(0.01, 2.4, 20)
    scaled = np.clip(chance * scale, 0.0, 0.95)
    both = pairs_scaled(together, GRID.adjacent, scale, scaled)
    p, q = scaled[OWN], scaled[OTHER]
    assert (both <= np.minimum(p, q)).all()
    assert (both >= np.maximum(p + q - 1.0, 0.0)).all()
