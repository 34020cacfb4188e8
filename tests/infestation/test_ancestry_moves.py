"""Moves leave an ancestry of finds in order."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry_moves import Weights
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.drawn_ancestry import DrawnSums, draw_ancestries
from fieldmon.infestation.infestations import Infestations
from fieldmon.infestation.jump_landing import landing_of
from fieldmon.plot.layout import rectangle


@pytest.mark.parametrize("delay", [0, 2])
def test_an_ancestry_holds_together(delay):
    """Parents begin before their children and end no sooner; nobody hangs on nothing."""
    rng = np.random.default_rng(4)
    plot = rectangle(12, 12)
    landing, mornings = landing_of(plot), 9
    kernel = np.einsum("k,kij->ij", np.full(8, 0.125), landing.kernels)
    made = Infestations.empty(120)
    plants = rng.choice(144, 30, replace=False)
    last_find = np.full(144, -1)
    for place, plant in enumerate(plants):
        made.plant[place], made.ends[place] = plant, rng.integers(3, mornings - 1)
        made.begins[place], made.found[place] = made.ends[place], True
        made.there[place], last_find[plant] = True, made.ends[place]
        made.seen[place] = made.ends[place]
    lasting = np.exp(-rng.uniform(0.0, 2.0, (144 + made.plant.size, mornings)).astype(np.float32))
    roots = np.full((144, mornings), 1e-4, np.float32)
    sends = np.full(mornings, 0.3)
    so_far = np.cumsum(kernel) / kernel.sum()
    grown = np.minimum(np.arange(mornings) + delay, mornings - 1)
    grown[:4] = np.arange(4)
    grown_by = np.searchsorted(grown, np.arange(mornings), side="right") - 1
    world = Weights(landing.cells, kernel, so_far, sends, roots, 3, -1, grown, grown_by, lasting)
    at, drawn = np.full(144, NOBODY), DrawnSums.none(mornings, 144, len(kernel))
    draw_ancestries(made, at, world, last_find, (2, 50, 10), drawn)
    there = np.flatnonzero(made.there)
    children = np.bincount(made.parent[there] + 1, minlength=121)[1:]
    assert (made.children[there] == children[there]).all()
    assert (made.found[there] | (children[there] > 0)).all()
    for i in there:
        assert made.earliest[i] <= made.begins[i] <= made.seen[i] <= made.ends[i]
        if made.parent[i] != NOBODY:
            parent = made.parent[i]
            assert made.there[parent]
            assert grown[made.begins[parent]] < made.begins[i] <= made.ends[parent]
    hidden = there[~made.found[there]]
    assert len(hidden) > 0
    assert (at[made.plant[hidden]] == hidden).all()
    assert np.count_nonzero(at != NOBODY) == len(hidden)
    assert "30 found" in repr(made)
    assert repr(drawn).startswith("<Drawn: ")
