"""A find speaks for those within reach: by the formula, and never twice."""

import numpy as np
import pytest

from fieldmon.infestation.clustering import no_evidence
from fieldmon.infestation.pairs import pair_chances
from fieldmon.infestation.reach import RADIUS
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.infestation.tracing import Raised, Traces, rescale_traced, trace
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
