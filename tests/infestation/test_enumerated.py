"""Night and inspection on small plots, against all states that there are."""

import itertools

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.ensemble import Ensemble
from fieldmon.infestation.independent import IndependentPlants
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.spread import Spread, night
from fieldmon.plot.layout import rectangle
from tests.infestation.enumerated import Enumerated, by_adjacency

PLOTS = {"row": rectangle(1, 6), "block": rectangle(3, 4), "lone": rectangle(1, 1)}
SPREADS = [Spread(0.3, "each", 0.01), Spread(0.5, "one"), Spread(0.4, "all", 0.02)]


def chances(grid):
    return np.linspace(0.02, 0.3, len(grid))


def test_the_enumeration_itself_is_what_a_pencil_says():
    row = rectangle(1, 2)
    truth = Enumerated.of([0.5, 0.0])
    morning = truth.overnight(by_adjacency(row, Spread(0.4)), 0.1)
    assert morning.weight.sum() == pytest.approx(1.0)
    assert morning.chance == pytest.approx([0.5 + 0.5 * 0.1, 1 - (1 - 0.5 * 0.4) * 0.9])
    found = Enumerated.chain([0.2, 0.2], [0.1]).inspected(0, True, 0.84)
    assert found.chance == pytest.approx([1.0, 0.5])
    thin = Enumerated.of([0.5, 0.4]).thinned([0.5, 1.0])
    assert thin.chance == pytest.approx([0.25, 0.4])


@pytest.mark.parametrize("name", PLOTS)
@pytest.mark.parametrize("spread", SPREADS, ids=lambda spread: spread.to)
def test_simulated_insects_do_in_a_night_what_the_rule_says_and_nothing_else(name, spread):
    grid, drawn = PLOTS[name], 2000
    begin = np.arange(len(grid)) % 3 == 0
    truth = Enumerated.of(begin.astype(float))
    truth = truth.overnight(by_adjacency(grid, spread), spread.arrivals_per_day)
    after = [night(grid, begin, spread, RandomStreams(k).key("spread")) for k in range(drawn)]
    states = np.array(after) @ (1 << np.arange(len(grid)))
    share = np.bincount(states, minlength=len(truth.weight)) / drawn
    assert (share[truth.weight < 1e-12] == 0.0).all()
    allowed = 5.0 * np.sqrt(truth.weight * (1.0 - truth.weight) / drawn) + 4.0 / drawn
    assert (np.abs(share - truth.weight) <= allowed).all()


@pytest.mark.parametrize("name", PLOTS)
@pytest.mark.parametrize("spread", SPREADS, ids=lambda spread: spread.to)
def test_after_a_night_from_independent_plants_every_belief_has_the_true_chances(name, spread):
    grid, chance = PLOTS[name], chances(PLOTS[name])
    truth = Enumerated.of(chance)
    truth = truth.overnight(by_adjacency(grid, spread), spread.arrivals_per_day)
    alone = IndependentPlants(grid, chance).overnight(spread)
    assert alone.chance == pytest.approx(truth.chance, abs=1e-12)
    pairs = PairApproximation.of(grid, chance, 0.0).overnight(spread)
    assert pairs.chance == pytest.approx(truth.chance, abs=0.02)
    assert pairs.pair_chance == pytest.approx(truth.pair_chance(grid), abs=0.03)
    drawn = Ensemble.of(grid, chance, 0.0).overnight(spread)
    assert drawn.chance == pytest.approx(truth.chance, abs=0.12)  # of 300 fields


@pytest.mark.parametrize("found", [True, False])
@pytest.mark.parametrize("detection", [0.84, 0.3])
def test_in_a_row_an_inspection_teaches_what_bayes_rule_says_of_all_states(found, detection):
    grid = rectangle(1, 7)
    belief = PairApproximation.of(grid, np.linspace(0.05, 0.2, 7), clustering=0.4)
    start, neighbour = grid.adjacent
    on = [start[i] + int(np.flatnonzero(neighbour[start[i] : start[i + 1]] == i + 1)[0])
          for i in range(6)]  # fmt: skip
    truth = Enumerated.chain(belief.chance, belief.pair_chance[on])
    assert truth.chance == pytest.approx(belief.chance)
    for plant in range(7):
        learnt = belief.learn(
            np.array([plant], np.int32), np.array([found]), Learning(detection, treated=False)
        )
        known = truth.inspected(plant, found, detection)
        heard = np.abs(np.arange(7) - plant) <= 3
        assert learnt.chance[heard] == pytest.approx(known.chance[heard], abs=1e-4)
        inside = [k for k in range(6) if abs(k - plant) <= 2 and abs(k + 1 - plant) <= 2]
        if not found:  # a find also teaches how close infestations stand: no more this joint state
            both = known.pair_chance(grid)
            for k in inside:
                assert learnt.pair_chance[on[k]] == pytest.approx(both[on[k]], rel=0.15, abs=2e-3)


@pytest.mark.parametrize("kind", [IndependentPlants, PairApproximation.of])
def test_a_treatment_leaves_its_share_of_every_plant_and_of_every_two(kind):
    grid = rectangle(3, 4)
    belief = kind(grid, chances(grid))
    left = np.linspace(0.1, 1.0, len(grid))
    after = belief.treated(left)
    assert after.chance == pytest.approx(np.maximum(belief.chance * left, 1e-6))
    if after.pair_chance is not None:
        start, neighbour = grid.adjacent
        own = np.repeat(np.arange(len(grid)), np.diff(start))
        outlive = left[own] * left[neighbour]
        assert after.pair_chance == pytest.approx(belief.pair_chance * outlive)
        row = rectangle(1, 6)
        begun = PairApproximation.of(row, chances(row))
        on = [row.adjacent.start[i] + (i > 0) for i in range(5)]
        truth = Enumerated.chain(begun.chance, begun.pair_chance[on]).thinned(left[:6])
        assert begun.treated(left[:6]).pair_chance == pytest.approx(truth.pair_chance(row))


@pytest.mark.parametrize("plant", [0, 5, 7])
def test_a_treated_find_is_infested_together_with_none_of_its_neighbours(plant):
    grid = rectangle(3, 4)
    belief = PairApproximation.of(grid, chances(grid), 0.4)
    after = belief.learn(np.array([plant], np.int32), np.array([True]), Learning(treated=True))
    start, neighbour = grid.adjacent
    own = np.repeat(np.arange(len(grid)), np.diff(start))
    with_it = (own == plant) | (neighbour == plant)
    least = np.minimum(after.chance[own], after.chance[neighbour])
    assert with_it.any()
    assert (after.pair_chance[with_it] <= least[with_it] + 1e-12).all()


def test_two_inspections_of_plants_that_know_nothing_of_each_other_come_to_the_same_either_way():
    grid = rectangle(1, 12)
    belief = PairApproximation.of(grid, np.full(12, 0.1), 0.3)
    ways = []
    for order in itertools.permutations(((0, True), (11, False))):
        plants, found = zip(*order, strict=True)
        settings = Learning(0.84, treated=False)
        ways.append(belief.learn(np.array(plants, np.int32), np.array(found), settings).chance)
    assert ways[0] == pytest.approx(ways[1], abs=1e-9)
