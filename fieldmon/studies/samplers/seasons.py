"""Seasons of all contenders on the same insects, and what came of each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.paired import paired
from fieldmon.simulation.season import simulated_days
from fieldmon.studies.samplers.contenders import (
    CLAIRVOYANT,
    CONTENDERS,
    OF_PESTS,
    SOME,
    Misinformed,
    Oracle,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fieldmon.simulation.experiment import Experiment
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulatedDay
    from fieldmon.simulation.start import Start
    from fieldmon.studies.samplers.contenders import Contender
    from fieldmon.studies.samplers.scenarios import Scenario

_FAST = 1e6
MEASURES = ("infested_plant_days", "d50", "d80", "inspected", "found", "visited_pct")


@dataclass(frozen=True)
class SeasonOutcome:
    """What a season came to; a level never reached counts as one day more than the season has."""

    scenario: str
    seed: int
    contender: str
    infested_plant_days: float
    d50: float
    d80: float
    inspected: float
    found: float
    visited_pct: float

    # the first and third column are a scenario and a contender, named as in the tables made first
    columns: ClassVar[tuple[str, ...]] = ("cell", "seed", "who", *MEASURES)
    kinds: ClassVar[tuple[type[Any], ...]] = (str, int, str, *(float,) * len(MEASURES))

    @property
    def key(self) -> tuple[str, int]:
        """Return the chunk that it is of: scenario and seed."""
        return self.scenario, self.seed


def study_of(
    scenarios: Sequence[Scenario], seeds: range
) -> Experiment[Scenario, list[SeasonOutcome]]:
    """Return the study of some scenarios: all contenders meet a scenario and seed in one chunk.

    A chunk's key is the scenario's name and the seed.
    """
    return paired(scenarios, seeds, outcomes, lambda one, seeds: (one.name, seeds.start))


def outcomes(scenario: Scenario, seed: int) -> list[SeasonOutcome]:
    """Return what a season comes to for every contender and the clairvoyant.

    With a pest, for those whose map follows it, and without the clairvoyant.
    """
    streams = RandomStreams(seed)
    start = scenario.draw_start(streams)
    made = [
        _outcome(scenario, seed, each.name, season_metrics(season(scenario, each, start, streams)))
        for each in (CONTENDERS if scenario.pest_in_weather is None else OF_PESTS)
        if seed % each.every == 0
    ]
    if seed % SOME or scenario.pest_in_weather is not None:
        return made
    seen = season_metrics(_clairvoyant(scenario, start, streams))
    return [*made, _outcome(scenario, seed, CLAIRVOYANT, seen)]


def season(
    scenario: Scenario, contender: Contender, start: Start, streams: RandomStreams
) -> Iterator[SimulatedDay]:
    """Return the days of a contender's season."""
    robot, sampler = scenario.robot, contender.sampler
    if not contender.drives:
        robot = replace(robot, speed_m_s=_FAST, row_change_s=0.0)
    if scenario.flaw == "detection":
        sampler = Misinformed(sampler)
    settings = replace(scenario.settings, believe=contender.believe)
    return simulated_days(scenario.aisles, robot, sampler, start, settings, streams)


def _clairvoyant(
    scenario: Scenario, start: Start, streams: RandomStreams
) -> Iterator[SimulatedDay]:
    oracle = Oracle(start.infested)
    days = simulated_days(
        scenario.aisles, scenario.robot, oracle, start, scenario.settings, streams
    )
    for day in days:
        yield day
        evening = day.infested.copy()
        evening[day.work.plant[day.work.found]] = False
        key = streams.key("spread", day.number)
        oracle.truth = scenario.settings.night(scenario.aisles.grid, evening, key)


def _outcome(scenario: Scenario, seed: int, contender: str, made: SeasonMetrics) -> SeasonOutcome:
    never = len(made.found) + 1
    n = len(scenario.aisles.grid)
    return SeasonOutcome(
        scenario.name,
        seed,
        contender,
        float(made.infested_plant_days),
        float(made.first_day(50.0) or never),
        float(made.first_day(80.0) or never),
        float(round(made.visited_pct.sum() * n / 100.0)),
        float(made.found.sum()),
        float(made.ever_visited_pct[-1]),
    )
