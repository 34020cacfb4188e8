"""Seasons treated by a rule: zones above the threshold, the whole plot, or nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.zones import best_zones, whole_plot
from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.planning.workday import work_day
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.simulation.experiment import Experiment
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import simulated_days
from fieldmon.simulation.statistics import SummaryStatistics, summary_statistics
from fieldmon.simulation.treating import WHOLE, ZONES, TreatmentRule
from fieldmon.studies.outcome_table import finite
from fieldmon.studies.samplers.scenarios import Scenario

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.decisions.zones import Zones
    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.grid import PlantGrid

NOTHING = "nothing"
RULES = (NOTHING, WHOLE, ZONES)
#: a plot is treated from so much on (our choice: what 4 hours a day no longer hold down)
LEVEL = 0.02
_COSTS = TreatmentCosts(per_ha=100.0, per_zone=0.5)
_HOURS, _DAYS = 4.0, 25
_OF_RATIO = ("mean", "low", "high", "q05", "q95")


@dataclass(frozen=True)
class TreatedSeason:
    """What a season came to by a rule: infested plant-days, hectares, and money."""

    scenario: str
    seed: int
    sampler: str
    rule: str
    plant_days: float
    sprayed_ha: float
    spent: float
    cost: float

    columns: ClassVar[tuple[str, ...]] = (
        "scenario", "seed", "sampler", "rule", "plant_days", "sprayed_ha", "spent", "cost"
    )  # fmt: skip
    kinds: ClassVar[tuple[Callable[[str], Any], ...]] = (
        str,
        int,
        str,
        str,
        finite,
        finite,
        finite,
        finite,
    )

    @property
    def key(self) -> tuple[str, int]:
        """Return the chunk that it is of."""
        return self.scenario, self.seed


def treated_scenarios(pest_in_weather: PestInWeather | None = None) -> list[Scenario]:
    """Return 5 ha with clusters, with infested edges, and with scattered infested plants."""
    starts = ("clusters", "edge", "scattered")
    return [
        Scenario("B", start=start, hours=_HOURS, pest_in_weather=pest_in_weather)
        for start in starts
    ]


def study_of_treatments(
    scenarios: Sequence[Scenario], seeds: range, samplers: Sequence[str]
) -> Experiment[Scenario, list[TreatedSeason]]:
    """Return the study: each sampler meets the same insects by every rule."""
    return Experiment(
        settings=scenarios,
        seeds=seeds,
        simulate=lambda scenario, seeds: treated_seasons(scenario, seeds.start, samplers),
        chunk_size=lambda _: 1,
        key=lambda scenario, seeds: (scenario.name, seeds.start),
        seed_by_seed=True,
    )


def treated_seasons(
    scenario: Scenario, seed: int, samplers: Sequence[str], n_days: int = _DAYS
) -> list[TreatedSeason]:
    """Return what a season comes to, by each rule with each sampler."""
    streams = RandomStreams(seed)
    start = scenario.draw_start(streams)
    made = []
    for name in samplers:
        for rule in RULES:
            treating = None if rule == NOTHING else TreatmentRule(
                LEVEL, rule, costs=_COSTS, seed=seed
            )  # fmt: skip
            settings = replace(scenario.settings, n_days=n_days, treating=treating)
            days = simulated_days(
                scenario.aisles, scenario.robot, sampler(name), start, settings, streams
            )
            of = season_metrics(days)
            lost, spent = of.infested_plant_days, float(of.spent.sum())
            money = spent + lost * _COSTS.infested_plant_day
            area = float(of.sprayed_m2.sum()) / 10_000
            made.append(
                TreatedSeason(scenario.name, seed, name, rule, float(lost), area, spent, money)
            )
    return made


def against_nothing(made: Sequence[TreatedSeason], rule: str) -> SummaryStatistics:
    """Return infested plant-days by a rule over those of the same seasons without treatment.

    The geometric mean over the seeds, with its interval of 95 %.

    Parameters
    ----------
    made
        Seasons of one scenario and sampler, by every rule.
    rule
        Which of `RULES`.

    Raises
    ------
    SettingError
        If there is no season by the rule.
    """
    days = {(one.seed, one.rule): max(one.plant_days, 1.0) for one in made}
    seeds = sorted({one.seed for one in made if one.rule == rule})
    if not seeds:
        raise SettingError(
            f"There must be a season treated by the rule {rule!r}, but there is none."
        )
    logs = np.log([days[seed, rule] / days[seed, NOTHING] for seed in seeds])
    of = summary_statistics(logs)
    mean, low, high, q05, q95 = (float(np.exp(getattr(of, name))) for name in _OF_RATIO)
    return replace(of, mean=mean, low=low, high=high, q05=q05, q95=q95)


def known_samplers() -> tuple[str, ...]:
    """Return the samplers that take part: all that look equally long at every plant."""
    return tuple(name for name, kind in SAMPLERS.items() if not kind.chooses_time)


@dataclass(frozen=True)
class AreaAtEqualLeft:
    """What zones spray beside the whole plot where both leave as many infested plants.

    Parameters
    ----------
    start
        Where infested plants stand.
    share
        Area of the zones over the plot's.
    left
        Infested plants that zones leave, over those that the whole plot's treatment leaves.
    by_plant
        Area over the plot's if each plant could be sprayed alone: no zones by this map are smaller.
    all_known
        Area of the zones over the plot's for somebody who knew where insects are.
    """

    start: str
    share: float
    left: float
    by_plant: float
    all_known: float


def area_at_equal_left(
    scenario: Scenario, seed: int, looked_at: float = 0.25, works: float = 0.9
) -> AreaAtEqualLeft:
    """Return how much less zones spray, once a share of the plot was looked at.

    The zones are those of the least area that the map believes to leave no more than half as much
    again as treating the whole plot does; what they really leave is counted on the truth.

    Parameters
    ----------
    scenario, seed
        The plot and its insects.
    looked_at
        Share of the plants that were looked at, as Adaptive drives.
    works
        Chance that treating cleans an infested plant.
    """
    streams = RandomStreams(seed)
    start, grid = scenario.draw_start(streams), scenario.aisles.grid
    evening, truth = _looked(scenario, streams, looked_at).chance, start.infested
    zones = _least_area(grid, evening, Sprayer(), works)
    really = float(np.count_nonzero(truth & ~zones.treated)) + (1 - works) * float(
        np.count_nonzero(truth & zones.treated)
    )
    of_whole = (1 - works) * float(np.count_nonzero(truth))
    return AreaAtEqualLeft(
        scenario.start,
        zones.m2 / zones.plot_m2,
        really / max(of_whole, 1e-9),
        _least_area(grid, evening, Sprayer(0), works).m2 / zones.plot_m2,
        _least_area(grid, truth.astype(float), Sprayer(), works).m2 / zones.plot_m2,
    )


def _least_area(
    grid: PlantGrid, chance: NDArray[np.float64], sprayer: Sprayer, works: float
) -> Zones:
    """Return the smallest zones that leave about as much as treating the whole plot does.

    As the chances have it, and no more than half as much again.
    """
    costs = TreatmentCosts(per_zone=0.0, works=works)
    low, high, zones = 1e-6, 1e6, whole_plot(grid, chance, costs)
    for _ in range(60):
        middle = float(np.sqrt(low * high))
        tried = best_zones(grid, chance, sprayer, replace(costs, per_ha=middle))
        left = tried.outside + (1 - works) * tried.inside
        if left <= 1.5 * (1 - works) * (tried.inside + tried.outside):
            low, zones = middle, tried
        else:
            high = middle
    return zones


def _looked(scenario: Scenario, streams: RandomStreams, share: float) -> Belief:
    """Return what is believed once Adaptive looked at a share of the plants; finds are flagged."""
    start, aisles = scenario.draw_start(streams), scenario.aisles
    n, robot = len(start.infested), replace(scenario.robot, hours=24.0, returns=False)
    shows = start.infested & (streams.of("looked at").random(n) < robot.detects)
    belief: Belief = TracedPairs.of(aisles.grid, start.chance)
    scene = Scene(
        aisles, robot, belief.chance, np.full(n, NEVER, np.int32), seconds_left=1e3 * n,
        pair_chance=belief.pair_chance, traces=belief.traces,
    )  # fmt: skip
    work, most = work_day(scene, Adaptive(), shows), round(share * n)
    learning = Learning(detection=robot.detects, treated=False)
    return belief.learn(work.plant[:most], work.found[:most], learning)
