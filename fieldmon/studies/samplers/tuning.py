"""Dynamic's open choices, searched for those that lose the least."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.spread import Spread
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.simulation.metrics import figures
from fieldmon.studies.samplers.scenarios import Cell
from fieldmon.studies.samplers.seasons import Contender, season

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

CHOICES = tuple(product((0.01, 0.03, 0.06, 0.12, 0.25, 0.5, 0.75), (0.03, 0.1, 0.3, 1.0)))
# none of the study's own seeds, which count from 0
SEEDS = range(1000, 1005)


def tuning_cells() -> list[Cell]:
    """Return the situations in which choices are tried: unlike each other, from the study."""
    return [
        Cell("B"),
        Cell("C"),
        Cell("C", Spread(0.8, "one")),
        Cell("B", start="scattered"),
        Cell("C", start="scattered"),
        Cell("B", start="edge", prior="edge"),
        Cell("B", prior="records 5 %"),
    ]


def losses(
    cells: Sequence[Cell], seeds: Sequence[int]
) -> Iterator[tuple[tuple[float, float], float]]:
    """Yield each choice of (suspicious, at_once) with its loss.

    The loss is the geometric mean over cells of the mean over seeds of infested plant-days.
    """
    for choice in CHOICES:
        rival = Contender("dynamic", Dynamic(*choice))
        means = [np.mean([_plant_days(cell, rival, seed) for seed in seeds]) for cell in cells]
        yield choice, float(np.exp(np.mean(np.log(means))))


def _plant_days(cell: Cell, rival: Contender, seed: int) -> float:
    chance = RandomStreams(seed)
    days = season(cell, rival, cell.begin(chance), chance)
    return float(figures(days).infested_plant_days)
