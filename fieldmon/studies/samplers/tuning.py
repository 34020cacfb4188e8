"""Dynamic's open choices, searched for those that lose the least."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Experiment, Memory, run
from fieldmon.simulation.metrics import season_metrics
from fieldmon.studies.samplers.contenders import Contender
from fieldmon.studies.samplers.scenarios import Scenario
from fieldmon.studies.samplers.seasons import season

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.simulation.experiment import Progress

    Choice = tuple[float, float]

CHOICES = tuple(product((0.01, 0.03, 0.06, 0.12, 0.25, 0.5, 0.75), (0.03, 0.1, 0.3, 1.0)))
# none of the study's own seeds, which count from 0
SEEDS = range(1000, 1005)


def tuning_scenarios() -> list[Scenario]:
    """Return the scenarios in which choices are tried: unlike each other, from the study."""
    return [
        Scenario("B"),
        Scenario("C"),
        Scenario("C", Spread(0.8, "one")),
        Scenario("B", start="scattered"),
        Scenario("C", start="scattered"),
        Scenario("B", start="edge", prior="edge"),
        Scenario("B", prior="records 5 %"),
    ]


def losses(
    scenarios: Sequence[Scenario], seeds: range, progress: Progress | None = None
) -> dict[Choice, float]:
    """Return the loss of each choice of (suspicious, at_once).

    The loss is the geometric mean over scenarios of the mean over seeds of infested plant-days.
    """
    experiment = Experiment(list(product(CHOICES, scenarios)), seeds, _plant_days)
    made: Memory[list[float]] = Memory()
    with executor.threads() as workers:
        run(experiment, workers, made, progress)
    means: dict[Choice, list[float]] = {choice: [] for choice in CHOICES}
    for chunk in experiment.chunks():
        means[chunk.setting[0]].append(float(np.mean(made[chunk.key])))
    return {choice: float(np.exp(np.mean(np.log(each)))) for choice, each in means.items()}


def _plant_days(setting: tuple[Choice, Scenario], seeds: range) -> list[float]:
    """Return the infested plant-days of a choice's seasons, ``(seeds,)``."""
    choice, scenario = setting
    contender, lost = Contender("dynamic", Dynamic(*choice)), []
    for streams in map(RandomStreams, seeds):
        days = season(scenario, contender, scenario.draw_start(streams), streams)
        lost.append(float(season_metrics(days).infested_plant_days))
    return lost
