"""Night and inspection on small plots, against all states that there are."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.ancestry.origins import JUMPED
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.ensemble import Ensemble
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.pairs.clustering import leaning
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.infestation.pairs.pairs import (
    Neighbourhood,
    PairApproximation,
    update_neighbourhood,
)
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle
from tests.infestation.ancestry.enumerated import (
    Enumerated,
    by_adjacency,
    by_kernels,
    chance_within,
    together,
)
from tests.thorough import times

PLOTS = {"row": rectangle(1, 6), "block": rectangle(3, 4), "lone": rectangle(1, 1)}
SPREADS = [Spread(0.3, "each", 0.01), Spread(0.5, "one"), Spread(0.4, "all", 0.02)]
EACH, ONE, ALL = SPREADS


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
    grid, drawn = PLOTS[name], times(500, 2000)
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


# -- jumps by a mixture of kernels


def cells(grid):
    """Return the place of each plant across and along, whole numbers ``(n, 2)``."""
    steps = grid.xy_m[:, ::-1] / (grid.row_spacing_m, grid.plant_spacing_m)
    return np.rint(steps - steps.min(axis=0)).astype(int)


def a_night_by_pencil(belief, truth, spread):
    """Return the enumerated morning after a night in which insects also jump and arrive."""
    grid, reach, scale = belief.grid, belief.reach, belief.counts.scale
    degree = np.diff(grid.adjacent.start).mean()
    sends = spread.rate_per_day * (degree if spread.to != "one" else 1.0)
    beside = min(1.0, 1.0 - belief.jumps * (1.0 - reach.adjacent))
    near = Spread(spread.rate_per_day * beside, spread.to)
    # rows are a little likelier at first to be what the infested stand in
    lean = leaning(belief.evidence)
    sent = sends * belief.jumps * reach.beyond * scale[JUMPED:]
    infects = together(by_adjacency(grid, near, lean), by_kernels(cells(grid), reach.kernels, sent))
    # what arrives where nobody is infested: nothing but arrivals
    nobody = TracedPairs.of(grid, np.full(len(grid), 1e-9))
    return truth.overnight(infects, nobody.overnight(spread).chance)


@pytest.mark.parametrize(
    ("spread", "sick"),
    [(EACH, (0,)), (EACH, (2, 9)), (ONE, (5,)), (ALL, (2, 9))],
    ids=lambda it: getattr(it, "to", None),
)
def test_from_plants_known_to_be_infested_kernels_reach_each_plant_with_its_true_chance(
    spread, sick
):
    grid = PLOTS["block"]
    begin = np.full(12, 1e-7)
    begin[list(sick)] = 1.0 - 1e-7
    belief = TracedPairs.of(grid, begin)
    truth = a_night_by_pencil(belief, Enumerated.of(begin), spread)
    morning = belief.overnight(spread)
    assert morning.chance == pytest.approx(truth.chance, abs=2e-4)
    if spread.to == "each":  # else plants infested by the same one know of each other
        assert morning.pair_chance == pytest.approx(truth.pair_chance(grid), abs=1e-3)


@pytest.mark.parametrize("spread", SPREADS, ids=lambda spread: spread.to)
def test_a_night_with_jumps_from_a_chance_map_has_nearly_the_true_chances(spread):
    grid = PLOTS["block"]
    belief = TracedPairs.of(grid, chances(grid))
    belief = replace(belief, pair_chance=PairApproximation.of(grid, chances(grid), 0.0).pair_chance)
    truth = a_night_by_pencil(belief, Enumerated.of(chances(grid)), spread)
    morning = belief.overnight(spread)
    assert morning.chance == pytest.approx(truth.chance, abs=0.02)
    assert morning.pair_chance == pytest.approx(truth.pair_chance(grid), abs=0.03)


@pytest.mark.parametrize("name", ["row", "block"])
def test_what_each_kernel_brings_is_what_its_table_says_and_back_is_the_same_the_other_way(name):
    grid = PLOTS[name]
    reach, n = TracedPairs.of(grid, chances(grid)).reach, len(grid)
    place, middle = cells(grid), (np.array(reach.kernels.shape[1:]) - 1) // 2
    away = place[None, :] - place[:, None] + middle  # from plant i to plant j
    told = reach.kernels[:, away[..., 0], away[..., 1]]
    for i in range(n):
        brought = reach.brought_by_each(np.eye(n)[i])
        assert brought == pytest.approx(told[:, i], abs=1e-12)
    shares, sent = np.linspace(0.3, 0.05, len(told)), chances(grid)
    mixed = np.einsum("k,kij->ij", shares, told)
    by = reach.mixed(shares)
    assert reach.landed(sent, by) == pytest.approx(sent @ mixed, abs=1e-12)
    assert reach.landed(sent, np.conj(by)) == pytest.approx(mixed @ sent, abs=1e-12)


def test_jumps_on_top_of_neighbours_are_what_a_pencil_says():
    kernels = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.0]]])  # on to the right
    infects = by_kernels(np.array([[0, 0], [0, 1]]), kernels, np.array([0.4]))
    assert infects[0] == pytest.approx([0.0, 1.0 - np.exp(-0.2)])
    assert infects[1] == pytest.approx([0.0, 0.0])
    both = together(infects, by_adjacency(rectangle(1, 2), Spread(0.3)))
    assert chance_within(both[0], 2)[0] == pytest.approx(np.exp(-0.2) * 0.7)
    morning = Enumerated.of([1.0, 0.0]).overnight(both, np.array([0.0, 0.1]))
    assert morning.chance == pytest.approx([1.0, 1.0 - np.exp(-0.2) * 0.7 * 0.9])


@pytest.mark.parametrize("rate", [0.2, 0.4])
@pytest.mark.parametrize("looks", [(3, 5, -4), (3, -4, 5), (-4, 3, 5)])
def test_finds_say_of_the_plant_between_them_that_it_had_so_many_ways_and_no_more(looks, rate):
    """Each find infested it or not: no two finds are two signs of one thing that made them."""
    grid, spread = rectangle(1, 9), Spread(rate, "each")
    first = np.where(np.arange(9) == 4, 0.0, 0.05)
    truth = Enumerated.of(first).overnight(by_adjacency(grid, spread))
    believed = truth.chance, truth.pair_chance(grid)
    near = Neighbourhood.of(9, truth.chance)
    for look in looks:
        result = abs(look), look > 0
        truth = truth.inspected(*result, 0.84)
        update_neighbourhood.py_func(believed, grid.linked, result, (0.84, False), near)
        assert believed[0][4] == pytest.approx(truth.chance[4], abs=0.035)
