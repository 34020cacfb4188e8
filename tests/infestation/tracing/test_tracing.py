"""A find speaks for those within reach: by the formula, and never twice."""

from itertools import product

import numpy as np
import pytest

from fieldmon.infestation.cells import Cells
from fieldmon.infestation.insects.jump_reach import RADIUS
from fieldmon.infestation.pairs.clustering import no_evidence
from fieldmon.infestation.pairs.pairs import pair_chances
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.infestation.tracing.tracing import Raised, Traces, rescale_traced, trace
from fieldmon.plot.layout import rectangle

GRID = rectangle(9, 11)
N, FIND = 99, 49
CHANCE = np.linspace(0.01, 0.05, N)


def traced(chance, jumps=0.4, unseen=2.0):
    """Trace a find; return chances, pairs, and the traces."""
    belief = TracedPairs.of(GRID, chance)
    traces = belief.traces.own()
    traces.unseen[:] = unseen
    after = chance.copy(), pair_chances(chance, GRID, 0.25)
    trace.py_func(after, GRID.linked, traces, (FIND, chance[FIND], jumps), Raised.of(N))
    return *after, traces


def test_plants_are_raised_by_what_they_may_have_got_from_the_find_and_it_from_them():
    after, _, traces = traced(CHANCE)
    kernel, cells = traces.kernel, traces.cells
    for j in (0, 38, 48, 51, 98):
        y, x = np.divmod(cells.of_plant[j], 11) - np.array(np.divmod(FIND, 11))
        to, back = kernel[y + RADIUS, x + RADIUS], kernel[RADIUS - y, RADIUS - x]
        parent = min(CHANCE[j] / CHANCE[FIND], 1.0) * back
        more = 0.4 * (1.0 - CHANCE[FIND]) * 2.0 * (to + parent)
        assert after[j] == pytest.approx(CHANCE[j] + (1.0 - CHANCE[j]) * more)
        assert traces.from_afar[j] == pytest.approx(1.0 - CHANCE[j] / after[j])
    assert after[FIND] == CHANCE[FIND]


def test_pairs_stay_possible():
    after, pair_chance, _ = traced(CHANCE)
    start, other = GRID.adjacent
    p, q = np.repeat(after, np.diff(start)), after[other]
    assert (pair_chance <= np.minimum(p, q) + 1e-12).all()
    assert (pair_chance >= np.maximum(p + q - 1.0, 0.0) - 1e-12).all()


def test_a_find_that_was_expected_is_no_news():
    known = CHANCE.copy()
    known[FIND] = 0.9
    assert (traced(known)[0] == known).all()


def test_where_nothing_is_traced_nothing_changes():
    after = CHANCE.copy(), pair_chances(CHANCE, GRID, 0.25)
    find = FIND, CHANCE[FIND], 1.0
    assert trace.py_func(after, GRID.linked, Traces.none(N), find, Raised.of(N)) == 0
    assert (after[0] == CHANCE).all()


def test_what_jumps_brought_can_be_taken_back():
    after, pair_chance, traces = traced(CHANCE)
    rescale_traced.py_func((after, pair_chance), GRID.linked, traces.from_afar, 0.0)
    assert after == pytest.approx(CHANCE, rel=1e-3)
    assert traces.from_afar == pytest.approx(0.0)


def test_no_evidence_is_no_certainty():
    assert 0.0 < TracedPairs.of(GRID, CHANCE).jumps < 0.5
    assert Traces.none(N).evidence.tolist() == no_evidence().tolist() == [0.0] * 4


SMALL = rectangle(3, 4)


def small_traces(seed):
    """Return traces on cells of a plant or two, by a kernel that is the same no way round."""
    rng = np.random.default_rng(seed)
    of_plant = np.array([0, 0, 1, 2, 3, 3, 4, 5, 6, 7, 8, 8])  # on 3 by 3 cells
    start = np.searchsorted(of_plant, np.arange(10))
    cells = Cells(of_plant, start, np.arange(12), np.array([3, 3]), np.array([3.0, 3.0]))
    kernel, afar = rng.random((3, 3)) / 9, rng.random(12)
    return Traces.none(12)._replace(
        cells=cells, kernel=kernel, unseen=rng.uniform(0.0, 4.0, 12), from_afar=afar
    )


@pytest.mark.parametrize(("seed", "find"), [*product(range(3), range(12))])
def test_each_plant_within_reach_is_raised_by_an_infestation_of_its_own_and_pairs_with_it(
    seed, find
):
    traces, jumps = small_traces(seed), 0.7
    rng = np.random.default_rng(seed)
    chance = rng.uniform(0.01, 0.6, 12)
    believed = chance.copy(), pair_chances(chance, SMALL, 0.25)
    told, raised = (believed[0].copy(), believed[1].copy()), Raised.of(12)
    afar, p = traces.from_afar.copy(), chance[find]
    n = trace.py_func(believed, SMALL.linked, traces, (find, p, jumps), raised)
    start, other = SMALL.adjacent
    y, x = np.divmod(traces.cells.of_plant, 3)
    wanted = []
    # cell after cell
    for j in range(12) if p <= 0.5 else ():
        away = y[j] - y[find], x[j] - x[find]
        if j == find or max(map(abs, away)) > 1:
            continue
        to, back = traces.kernel[1 + away[0], 1 + away[1]], traces.kernel[1 - away[0], 1 - away[1]]
        got = traces.unseen[j] * to + min(chance[j] / p, 1.0) * traces.unseen[find] * back
        more = min(jumps * (1.0 - p) * got, 0.9)
        told[0][j] = 1.0 - (1.0 - chance[j]) * (1.0 - more)
        for e in range(start[j], start[j + 1]):  # the other one is infested without regard to it
            told[1][e] += more * (told[0][other[e]] - told[1][e])
            told[1][SMALL.linked.back[e]] = told[1][e]
        afar[j] = (afar[j] * chance[j] + told[0][j] - chance[j]) / told[0][j]
        wanted.append((j, told[0][j] - chance[j]))
    assert believed[0] == pytest.approx(told[0])
    assert believed[1] == pytest.approx(told[1])
    assert traces.from_afar == pytest.approx(afar)
    assert raised.plant[:n].tolist() == [j for j, _ in wanted]
    assert raised.by[:n] == pytest.approx([by for _, by in wanted])


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0, 2.5])
def test_what_jumps_brought_counts_so_many_times_as_much_and_the_rest_as_before(ratio):
    chance = np.linspace(0.02, 0.3, 12)
    afar = np.linspace(0.0, 0.9, 12)
    believed = chance.copy(), pair_chances(chance, SMALL, 0.25)
    was, share = believed[1].copy(), afar.copy()
    rescale_traced.py_func(believed, SMALL.linked, share, ratio)
    parts = chance * (1.0 - afar), chance * afar * ratio
    assert believed[0] == pytest.approx(parts[0] + parts[1])
    assert share * believed[0] == pytest.approx(parts[1])
    assert believed[1] == pytest.approx(believed[1][SMALL.linked.back])
    start, other = SMALL.adjacent
    own = np.repeat(np.arange(12), np.diff(start))
    if ratio <= 1.0:  # what is not there is not there with another either
        less = believed[0] / chance
        assert believed[1] == pytest.approx(was * less[own] * less[other])
    else:
        assert (believed[1] >= was).all()
        assert (believed[1] <= np.minimum(believed[0][own], believed[0][other])).all()
