"""Seasons of all contenders on the same insects, and what came of each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Any, ClassVar

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.plot.robot import EVERYWHERE_M_S
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.paired_seasons import paired
from fieldmon.simulation.season import simulated_days
from fieldmon.studies.outcome_table import finite
from fieldmon.studies.samplers.contenders import (
    CLAIRVOYANT,
    CONTENDERS,
    NAMES,
    OF_PESTS,
    SOME,
    Misinformed,
    Oracle,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fieldmon.simulation.experiment import Experiment
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulatedDay
    from fieldmon.simulation.start import Start
    from fieldmon.studies.samplers.contenders import Added, Contender
    from fieldmon.studies.samplers.scenarios import Scenario

    Setting = tuple[Scenario, Added | None]
    Key = tuple[str, int] | tuple[str, int, str]

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
    kinds: ClassVar[tuple[Callable[[str], Any], ...]] = (str, int, str, *(finite,) * len(MEASURES))

    @property
    def key(self) -> Key:
        """Return the chunk that it is of: scenario and seed, and the contender if it was added."""
        usual = self.scenario, self.seed
        return usual if self.contender in NAMES else (*usual, self.contender)


def study_of(
    scenarios: Sequence[Scenario], seeds: range, added: Sequence[Added] = ()
) -> Experiment[Setting, list[SeasonOutcome]]:
    """Return the study of some scenarios: all contenders meet a scenario and seed in one chunk.

    Each that is added has chunks of its own, before them: what it answers wrongly is said at once.
    A chunk's key is the scenario's name and the seed, and what was added.
    """
    settings: list[Setting] = [*product(scenarios, added), *((one, None) for one in scenarios)]

    def key(setting: Setting, seeds: range) -> Key:
        scenario, one = setting
        usual = scenario.name, seeds.start
        return usual if one is None else (*usual, one.called)

    return paired(settings, seeds, _of_setting, key)


def _of_setting(setting: Setting, seed: int) -> list[SeasonOutcome]:
    """Return what a season comes to for all contenders, or for one that is added."""
    scenario, added = setting
    if added is None:
        return outcomes(scenario, seed)
    streams, contender = RandomStreams(seed), added.contender()
    days = season(scenario, contender, scenario.draw_start(streams), streams)
    return [_outcome(scenario, seed, contender.name, season_metrics(days))]


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
        robot = replace(robot, speed_m_s=EVERYWHERE_M_S, row_change_s=0.0)
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
