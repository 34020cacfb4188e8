"""What a night does to pairs: laws that hold whatever the shortcut taken."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.pair_nights import (
    _escape_any,
    _escape_four,
    _find_local_density,
    night_of_pairs,
)
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.plot.layout import rectangle

GRID = rectangle(9, 9)
N = len(GRID)
START, NEIGHBOUR = GRID.adjacent
OWN = np.repeat(np.arange(N), np.diff(START))
seeds = st.integers(0, 10_000)


def believed(seed, clustering=0.25):
    chance = np.random.default_rng(seed).random(N) ** 3
    belief = PairApproximation.of(GRID, chance, clustering)
    return belief.chance, belief.pair_chance


@given(seeds, st.floats(0.0, 1.0))
def test_a_plant_with_four_neighbours_comes_out_the_same_the_short_way(seed, rate):
    now = believed(seed)
    density = np.empty(N)
    _find_local_density(now, density, GRID.linked)
    rule = ((rate, 0.5 * rate), bool(seed % 2), 0.001 * (seed % 3))
    short, long = (np.full(len(NEIGHBOUR), np.nan) for _ in range(2))
    for i in np.flatnonzero(np.diff(START) == 4)[:5].astype(np.uint64):
        room = np.empty((3, 4))
        one = _escape_four.py_func(i, now, (None, density, short), GRID.linked, rule)
        other = _escape_any.py_func(i, now, (None, density, long), GRID.linked, (room, rule))
        assert one == pytest.approx(other, rel=1e-12)
    np.testing.assert_allclose(short, long, rtol=1e-12)


@given(seeds)
def test_a_night_without_spread_or_arrivals_changes_nothing(seed):
    now = believed(seed)
    chance, pair_chance = night_of_pairs(now, GRID.linked, Spread(0.0))
    np.testing.assert_allclose(chance, now[0], atol=1e-12)
    np.testing.assert_allclose(pair_chance, now[1], atol=1e-9)


@given(seeds, st.floats(0.0, 0.2))
def test_arrivals_come_to_each_plant_by_itself(seed, arrivals):
    now = believed(seed)
    chance, pair_chance = night_of_pairs(now, GRID.linked, Spread(0.0, arrivals_per_day=arrivals))
    np.testing.assert_allclose(chance, 1.0 - (1.0 - now[0]) * (1.0 - arrivals), atol=1e-6)
    p, q = now[0][OWN], now[0][NEIGHBOUR]
    neither = (1.0 - p - q + now[1]) * (1.0 - arrivals) ** 2
    after = chance[OWN] + chance[NEIGHBOUR] - 1.0 + neither
    np.testing.assert_allclose(pair_chance, np.maximum(after, 0.0), atol=1e-5)


@pytest.mark.parametrize(("to", "share"), [("each", 0.4), ("one", 0.1), ("all", 0.4)])
def test_a_lone_infested_plant_infests_its_neighbours_with_the_rate(to, share):
    chance = np.full(N, 1e-6)
    chance[40] = 1.0
    now = PairApproximation.of(GRID, chance, 0.0)
    after, pair_after = night_of_pairs((now.chance, now.pair_chance), GRID.linked, Spread(0.4, to))
    beside = NEIGHBOUR[START[40] : START[41]]
    assert after[beside] == pytest.approx(share, abs=1e-3)
    assert after[40] == pytest.approx(1.0, abs=1e-4)
    assert pair_after[START[40] : START[41]] == pytest.approx(after[beside], abs=1e-4)
    far = np.setdiff1d(np.arange(N), [40, *beside])
    assert (after[far] < 1e-4).all()


@given(seeds, st.floats(0.0, 1.0), st.floats(0.0, 0.6))
def test_pairs_of_the_morning_fit_their_plants_and_lie_the_same_both_ways(seed, rate, clustering):
    now = believed(seed, clustering)
    chance, pair_chance = night_of_pairs(now, GRID.linked, Spread(rate, arrivals_per_day=0.001))
    p, q = chance[OWN], chance[NEIGHBOUR]
    assert (pair_chance <= np.minimum(p, q)).all()
    assert (pair_chance >= np.maximum(p + q - 1.0, 0.0) - 1e-12).all()
    assert (chance >= now[0] - 1e-12).all()
    np.testing.assert_allclose(pair_chance, pair_chance[GRID.linked.back], atol=1e-12)


def test_a_plot_of_one_plant_has_a_night_too():
    grid = rectangle(1, 1)
    belief = PairApproximation.of(grid, np.array([0.3]))
    after = belief.overnight(Spread(0.5, arrivals_per_day=0.1))
    assert after.chance == pytest.approx([1.0 - 0.7 * 0.9])


def test_the_density_about_a_plant_is_the_mean_chance_of_its_neighbours_given_that_it_is_infested():
    chance, both = believed(3)
    density = np.empty(N)
    _find_local_density((chance, both), density, GRID.linked)
    given_it = both / chance[OWN]
    for i in range(N):
        assert density[i] == pytest.approx(given_it[i == OWN].mean())
    _find_local_density((chance, chance[OWN]), density, GRID.linked)  # they share one fate
    assert density == pytest.approx(1.0)


def test_what_goes_along_the_row_does_not_go_across():
    one = np.full(len(GRID), 1e-6)
    middle = len(GRID) // 2
    one[middle] = 0.9
    pairs = PairApproximation.of(GRID, one, clustering=0.0)
    believed = pairs.chance, pairs.pair_chance
    evenly, _ = night_of_pairs(believed, GRID.linked, Spread(0.4, "one"))
    along, _ = night_of_pairs(believed, GRID.linked, Spread(0.4, "one"), 0.8)
    start, other = GRID.adjacent
    beside = other[start[middle] : start[middle + 1]]
    in_row = GRID.row[beside] == GRID.row[middle]
    assert in_row.any()
    assert along[beside[in_row]] == pytest.approx(1.6 * evenly[beside[in_row]], rel=1e-3)
    assert along[beside[~in_row]] == pytest.approx(0.4 * evenly[beside[~in_row]], rel=1e-3)
