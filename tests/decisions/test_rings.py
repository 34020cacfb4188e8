"""Rings of a knapsack: beside every choice there is, and within what no choice exceeds."""

from itertools import combinations

import numpy as np
import pytest

from fieldmon.decisions.rings import around, best_rings, rings_bound
from fieldmon.plot.layout import rectangle

GRID = rectangle(3, 4)
WIDE = rectangle(9, 9)


def gained(gain, treated):
    return float(gain[treated].sum())


def best_of_all(gain, ring):
    """Try every choice of rings on twelve plants."""
    rings = [set(around(GRID, i, ring).tolist()) for i in range(12)]
    chosen = [
        list(set().union(*some)) for size in range(1, 6) for some in combinations(rings, size)
    ]
    return max(0.0, *(float(gain[plants].sum()) for plants in chosen))


@pytest.mark.parametrize("ring", [1, 2])
def test_what_is_chosen_is_mostly_the_best_of_all_choices_and_the_bound_is_above_it(ring):
    shares = []
    for seed in range(12):
        draws = np.random.default_rng(seed)
        gain = np.where(draws.random(12) < 0.3, draws.random(12), -0.3 * draws.random(12))
        best, made = best_of_all(gain, ring), gained(gain, best_rings(GRID, gain, ring))
        assert made <= best + 1e-9
        assert best <= rings_bound(GRID, gain, ring) + 1e-9
        shares.append(1.0 if best == 0.0 else made / best)
    assert min(shares) > 0.9
    assert sum(share > 1.0 - 1e-9 for share in shares) >= 9


def test_two_plants_that_pay_for_a_ring_together_only_get_it_together():
    gain = np.full(81, -0.1)
    gain[[39, 41]] = 0.3
    assert np.flatnonzero(best_rings(WIDE, gain, 1)).tolist() == [31, 39, 40, 41, 49]
    gain[41] = -0.1
    assert not best_rings(WIDE, gain, 1).any()


def test_rings_that_pay_only_side_by_side_are_added_side_by_side():
    """Each of two costs more than it gains; what they share is paid once."""
    gain = np.full(81, -0.1)
    gain[[38, 42, 30, 32, 48, 50]] = 0.16
    sprayed = best_rings(WIDE, gain, 1)
    assert gained(gain, sprayed) > 0.0
    assert gained(gain, sprayed) <= rings_bound(WIDE, gain, 1) + 1e-9


def test_a_zone_that_costs_more_than_its_ring_gains_is_left():
    gain = np.full(81, -0.1)
    gain[40] = 1.0
    assert best_rings(WIDE, gain, 1, per_zone=0.5).sum() == 5
    assert not best_rings(WIDE, gain, 1, per_zone=0.7).any()


def test_a_ring_is_a_plant_with_its_neighbours_and_theirs():
    assert around(WIDE, 40, 1).tolist() == [31, 39, 40, 41, 49]
    assert len(around(WIDE, 40, 2)) == 13
    assert rings_bound(WIDE, np.full(81, -1.0), 2) == 0.0


def test_single_plants_far_apart_do_not_make_the_bound_pay_for_a_little_of_many_rings():
    """A ring of 13 costs more than one plant is worth: then nothing can be gained at all."""
    gain = np.full(81, -0.1)
    gain[[0, 8, 40, 72]] = 0.4
    assert rings_bound(WIDE, gain, 2) < 0.2
