"""What a better route changes in a season: infested plant-days beside Adaptive, seed by seed.

`best` plans from the gate and knows nothing of what will be found. So that planning is compared
with planning, Adaptive takes part twice: as it is, planning again after every find, and held to
its plan of the morning. The best route is followed whatever is found.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.planning.routes.best_route import best
from fieldmon.plot.travel import travel_s
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import Sampler, Scene, Stops
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import simulated_days
from fieldmon.studies.samplers.contenders import Contender

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fieldmon.samplers.base import WouldFind
    from fieldmon.studies.samplers.scenarios import Scenario

    Float = NDArray[np.float64]

# how much more than itself a find is worth where all plants beside it are clean, as in Adaptive
_SPARES = 0.5
AS_IT_IS, MORNING, BEST = "adaptive", "adaptive, morning's plan", "best route, morning's plan"
#: seasons of one seed
OF_EACH_SEED = 3


class PairedSeason(NamedTuple):
    """Infested plant-days and plants found, of one season."""

    who: str
    seed: int
    infested_plant_days: float
    found: int


class MorningAdaptive(Sampler):
    """Adaptive bound to the plan it makes before anything is found."""

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the day."""
        return Adaptive(_SPARES).walk(scene, np.zeros(len(would_find), np.bool_))


class BestRouteSampler(Sampler):
    """Follow the best route for the finds expected, each worth what Adaptive takes it to be."""

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the day; what they find changes nothing before tomorrow."""
        reward = np.where(scene.last_inspected == scene.day, 0.0, worth(scene))
        route = best(scene.aisles, reward, scene.robot, scene.seconds_left)
        return Stops(route.plant, _arrivals(scene, route.plant, len(would_find)))


def worth(scene: Scene) -> Float:
    """Return what a stop at each plant is expected to be worth, ``(n,)``."""
    near = scene.grid.adjacent
    count = np.diff(near.start)
    owner = np.repeat(np.arange(len(count)), count)
    clean = np.bincount(owner, 1.0 - scene.chance[near.plant], len(count))
    spared = _SPARES * clean / np.maximum(count, 1)
    return scene.chance * scene.robot.detects * (1.0 + spared)


def seasons(scenario: Scenario, seeds: range, hours: float = 12.0) -> Iterator[PairedSeason]:
    """Yield the seasons of all three for one seed after the other, on days of so many hours."""
    contenders = (
        Contender(AS_IT_IS, Adaptive(_SPARES)),
        Contender(MORNING, MorningAdaptive()),
        Contender(BEST, BestRouteSampler()),
    )
    for seed in seeds:
        streams = RandomStreams(seed)
        start = scenario.draw_start(streams)
        for who in contenders:
            settings = replace(scenario.settings, believe=who.believe)
            robot = scenario.robot.with_hours(hours)
            made = season_metrics(
                simulated_days(scenario.aisles, robot, who.sampler, start, settings, streams)
            )
            yield PairedSeason(
                who.name, seed, float(made.infested_plant_days), int(made.found.sum())
            )


def season_sentences(made: list[PairedSeason]) -> list[str]:
    """Return the means, and the difference from Adaptive with its 95 % interval."""
    by = {
        who: np.array([one.infested_plant_days for one in made if one.who == who])
        for who in (AS_IT_IS, MORNING, BEST)
    }
    sentences = []
    for who, values in by.items():
        found = np.mean([one.found for one in made if one.who == who])
        sentences.append(f"{who}: {values.mean():.1f} infested plant-days, {found:.1f} found")
        if who != AS_IT_IS:
            more = values - by[AS_IT_IS]
            mean, half = more.mean(), 1.96 * more.std(ddof=1) / np.sqrt(len(more))
            sentences.append(f"  {mean:+.1f} ({mean - half:+.1f} to {mean + half:+.1f})")
    return sentences


def _arrivals(scene: Scene, plant: NDArray[np.int32], n: int) -> Float:
    """Return the seconds at arrival."""
    arrive_s, now_s, at = np.empty(min(len(plant), n)), 0.0, scene.at
    for k, stop in enumerate(plant.tolist()):
        now_s += travel_s(scene.aisles.travel, scene.clock, at, stop)
        arrive_s[k] = now_s
        now_s, at = now_s + scene.robot.visit_s, stop
    return arrive_s
