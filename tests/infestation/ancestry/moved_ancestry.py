"""An ancestry of thirty finds after fifty sweeps of moves, for the tests of their parts."""

from typing import NamedTuple

import numpy as np

from fieldmon.infestation.ancestry.ancestry_arrays import Weights
from fieldmon.infestation.ancestry.drawn_ancestry import DrawnSums, draw_ancestries
from fieldmon.infestation.ancestry.infestations import Infestations
from fieldmon.infestation.cell_squares import NOBODY
from fieldmon.infestation.insects.jump_landing import landing_of
from fieldmon.plot.layout import rectangle


class Moved(NamedTuple):
    """The ancestry, its places, those not found by plant, when each has grown, and the sums."""

    made: Infestations
    there: np.ndarray
    at: np.ndarray
    grown: np.ndarray
    drawn: DrawnSums


def moved(delay):
    """Return what has become of thirty finds, `delay` mornings after which each sends something."""
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
    return Moved(made, np.flatnonzero(made.there), at, grown, drawn)
