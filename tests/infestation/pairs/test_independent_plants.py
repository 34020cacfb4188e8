"""What an inspection teaches, and what a night does to the map."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.pairs.independent_plants import learn, overnight
from fieldmon.plot.layout import rectangle

GRID = rectangle(6, 7)
NO, YES = np.array([False]), np.array([True])


def looked_at(chance, plant, found, **settings):
    plants = np.array([plant], np.int32)
    return learn(np.full(len(GRID), chance), GRID, plants, found, Learning(**settings))


@given(p=st.floats(0.001, 0.999), d=st.floats(0.0, 0.99))
def test_a_clean_look_follows_bayes_rule(p, d):
    after = looked_at(p, 10, NO, detection=d)
    assert after[10] == pytest.approx(p * (1 - d) / (p * (1 - d) + 1 - p))
    assert np.delete(after, 10) == pytest.approx(p)


def test_a_find_raises_the_plants_beside_it_and_no_others():
    after = looked_at(0.01, 24, YES, beside_find=0.3)
    raised = set(np.flatnonzero(after > 0.2))
    assert raised == {23, 25, 17, 31}


def test_a_treated_find_is_clean_and_a_flagged_one_is_certain():
    assert looked_at(0.5, 24, YES, treated=True)[24] < 1e-5
    assert looked_at(0.5, 24, YES, treated=False)[24] > 1 - 1e-5


def test_the_order_of_inspections_does_not_matter():
    plants = np.array([3, 4, 30, 17], np.int32)
    found = np.array([True, False, True, False])
    chance = np.linspace(0.01, 0.9, len(GRID))
    one = learn(chance, GRID, plants, found, Learning())
    other = learn(chance, GRID, plants[::-1], found[::-1], Learning())
    assert (one == other).all()


def test_a_night_raises_every_chance_next_to_a_suspicious_plant():
    chance = np.full(len(GRID), 1e-6)
    chance[24] = 0.8
    after = overnight(chance, GRID, Spread(0.5))
    assert after[[23, 25, 17, 31]] == pytest.approx(0.4, abs=1e-4)
    assert after[24] == pytest.approx(0.8, abs=1e-4)


@pytest.mark.parametrize("to", ["each", "one", "all"])
def test_after_one_night_from_independent_plants_the_map_is_the_simulated_share(to):
    spread = Spread(0.4, to, arrivals_per_day=0.01)
    start = np.linspace(0.02, 0.3, len(GRID))
    rng = np.random.default_rng(2)
    share = np.mean(
        [
            night(GRID, rng.random(len(GRID)) < start, spread, RandomStreams(s).key("spread"))
            for s in range(8000)
        ],
        axis=0,
    )
    assert overnight(start, GRID, spread) == pytest.approx(share, abs=0.025)
