"""Pairs of plants: exact where it can be, close to the simulated insects where it cannot."""

import itertools

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.plot.layout import rectangle

ROW = rectangle(1, 5)


def chain(p, pair_chance):
    """Return the chance of every state of a row of five plants with equal pairs."""
    table = {
        (1, 1): pair_chance,
        (1, 0): p - pair_chance,
        (0, 1): p - pair_chance,
        (0, 0): 1 - 2 * p + pair_chance,
    }
    states = {}
    for state in itertools.product([0, 1], repeat=5):
        chance = p if state[0] else 1 - p
        for one, other in itertools.pairwise(state):
            chance *= table[one, other] / (p if one else 1 - p)
        states[state] = chance
    return states


@pytest.mark.parametrize("found", [True, False])
@pytest.mark.parametrize("plant", [0, 2, 4])
def test_in_a_row_what_a_look_teaches_is_bayes_rule_for_the_whole_row(plant, found):
    belief = PairApproximation.of(ROW, np.full(5, 0.1), clustering=0.5)
    states = chain(0.1, belief.pair_chance[0])
    said = {1: 0.84 if found else 0.16, 0: 0.0 if found else 1.0}
    after = {state: chance * said[state[plant]] for state, chance in states.items()}
    wanted = np.array(
        [sum(c for s, c in after.items() if s[i]) / sum(after.values()) for i in range(5)]
    )
    settings = Learning(detection=0.84, treated=False)
    looks = np.array([plant], np.int32), np.array([found])
    # more than three plants away nothing is heard; the excess that a find or none shows stays
    heard = np.abs(np.arange(5) - plant) <= 3
    learnt = belief.learn(*looks, settings)
    assert learnt.chance[heard] == pytest.approx(wanted[heard], abs=2e-5)


def test_a_clean_look_lowers_the_plants_about_it_and_a_find_raises_them():
    grid = rectangle(9, 9)
    belief = PairApproximation.of(grid, np.full(81, 0.05))
    for found, sign in ((True, 1), (False, -1)):
        after = belief.learn(np.array([40], np.int32), np.array([found]), Learning())
        change = (after.chance - belief.chance) * sign
        assert (change[[31, 39, 41, 49]] > 0.01).all()
        assert (change[[22, 30, 32, 38]] > 0.001).all()
        assert change[[0, 8, 72, 80]] == pytest.approx(0.0)


def test_a_treated_find_is_clean():
    grid = rectangle(9, 9)
    after = PairApproximation.of(grid, np.full(81, 0.05)).learn(
        np.array([40], np.int32), np.array([True]), Learning()
    )
    assert after.chance[40] < 1e-5


@pytest.mark.parametrize("to", ["each", "one", "all"])
def test_after_one_night_from_independent_plants_the_map_is_the_simulated_share(to):
    grid = rectangle(6, 7)
    spread = Spread(0.4, to, arrivals_per_day=0.01)
    start = np.linspace(0.02, 0.3, len(grid))
    rng = np.random.default_rng(2)
    share = np.mean(
        [
            night(grid, rng.random(len(grid)) < start, spread, RandomStreams(s).key("spread"))
            for s in range(8000)
        ],
        axis=0,
    )
    after = PairApproximation.of(grid, start, clustering=0.0).overnight(spread)
    assert after.chance == pytest.approx(share, abs=0.025)


@pytest.mark.parametrize(("rate", "to"), [(0.3, "one"), (0.3, "each"), (0.8, "each")])
def test_a_lone_infestation_grows_as_fast_as_simulated_ones(rate, to):
    grid = rectangle(41, 41)
    n, middle = len(grid), 20 * 41 + 20
    truth = []
    for seed in range(60):
        infested = np.zeros(n, bool)
        infested[middle] = True
        for day in range(6):
            infested = night(
                grid, infested, Spread(rate, to), RandomStreams(seed).key("spread", day)
            )
        truth.append(infested.sum())
    known = np.full(n, 1e-6)
    # one infestation somewhere: the belief does not know where
    unknown = np.full(n, 1.0 / n)
    sizes = {}
    for name, belief in (
        ("pairs", PairApproximation.of(grid, unknown, 0.0)),
        ("mean field", IndependentPlants(grid, np.maximum(unknown, known))),
    ):
        for _ in range(6):
            belief = belief.overnight(Spread(rate, to))  # noqa: PLW2901 - night after night
        sizes[name] = belief.chance.sum()
    assert sizes["pairs"] == pytest.approx(np.mean(truth), rel=0.25)
    assert sizes["mean field"] > 1.2 * np.mean(truth)


def test_many_nights_of_fast_spread_end_with_every_plant_infested_and_no_chance_outside_0_to_1():
    grid = rectangle(15, 15)
    belief = PairApproximation.of(grid, np.full(225, 0.01))
    for _ in range(40):
        belief = belief.overnight(Spread(0.8, "each", arrivals_per_day=0.001))
        assert ((belief.chance > 0) & (belief.chance < 1)).all()
        assert (belief.pair_chance >= 0).all()
    assert belief.chance.min() > 0.99


def test_finds_that_stand_alone_teach_that_infested_plants_do():
    grid = rectangle(30, 30)
    belief = PairApproximation.of(grid, np.full(900, 0.05))
    alone = np.zeros(900, bool)
    alone[np.arange(3, 900, 47)] = True
    plants = np.arange(600, dtype=np.int32)
    after = belief.learn(plants, alone[:600], Learning())
    one, two = 850, 851
    start, other = grid.adjacent
    e = start[one] + np.flatnonzero(other[start[one] : start[one + 1]] == two)[0]
    before = belief.pair_chance[e] / belief.chance[one]
    assert after.pair_chance[e] / after.chance[one] < 0.5 * before


def test_beliefs_stay_as_they_were():
    grid = rectangle(9, 9)
    belief = PairApproximation.of(grid, np.full(81, 0.05))
    chance, pair_chance = belief.chance.copy(), belief.pair_chance.copy()
    belief.learn(np.array([40], np.int32), np.array([True]), Learning()).overnight(Spread())
    assert (belief.chance == chance).all()
    assert (belief.pair_chance == pair_chance).all()
