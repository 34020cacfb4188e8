"""The three samplers on real maps of plants: the map is the truth, and its dates are the spread."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams, coin_table
from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs.independent_plants import learn, overnight
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.planning.workday import draw_detections
from fieldmon.samplers import sampler
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Experiment, Memory, in_settings, run
from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles
    from fieldmon.simulation.experiment import Progress
    from fieldmon.studies.plant_maps import PlantMap

    Floats = NDArray[np.float64]
    _MapAndSampler = tuple[PlantMap, Aisles, str]

SHARES_PCT = np.arange(0.0, 101.0, 5.0)
_LEAST = 0.01


@dataclass(frozen=True)
class MapRules:
    """How the maps are inspected.

    Parameters
    ----------
    robot
        Who inspects, and for how many hours a date.
    spread
        What the chance map takes to happen between dates; the map itself is what happens.
    recorded_share
        Share of the plants infested on the first date that a record points to.
    """

    robot: Robot
    spread: Spread
    recorded_share: float = 0.2

    def __post_init__(self) -> None:
        if not 0.0 <= self.recorded_share <= 1.0:
            raise SettingError(
                f"recorded_share must be a share in 0..1, but it is {self.recorded_share}."
            )


@dataclass(frozen=True)
class MapMeasure:
    """Percent found of the infested plants of a date, after visiting a share of all plants.

    NaN where no day got that far, and where no plant is infested.
    """

    map: str
    date: str
    infested: int
    sampler: str
    visited_pct: float
    mean: float
    low: float
    high: float
    seeds: int


def run_maps(
    maps: Sequence[PlantMap],
    rules: MapRules,
    seeds: int = 20,
    seed: int = 1,
    progress: Progress | None = None,
) -> list[MapMeasure]:
    """Inspect each map on one working day a date; all samplers meet the same draws.

    What is found is taken out: later dates hold the map's infested plants without it.
    """
    laid = [(each, each.aisles()) for each in maps]

    def simulate(setting: _MapAndSampler, seeds: range) -> list[MapMeasure]:
        plants, aisles, name = setting
        found = [inspect(plants, aisles, name, rules, RandomStreams(k)) for k in seeds]
        return _rows(plants, name, np.stack(found))

    experiment = Experiment(
        settings=[(*one, name) for one in laid for name in SAMPLERS],
        seeds=range(seed, seed + seeds),
        simulate=simulate,
    )
    made: Memory[list[MapMeasure]] = Memory()
    with executor.threads() as workers:
        run(experiment, workers, made, in_settings(progress, seeds))
    return [row for chunk in experiment.chunks() for row in made[chunk.key]]


def inspect(
    plants: PlantMap, aisles: Aisles, name: str, rules: MapRules, streams: RandomStreams
) -> Floats:
    """Return percent found after each of `SHARES_PCT` visited, ``(d, shares)``; NaN if not reached.

    Of the plants infested on a date and not found on earlier ones; 100 if there are none. Plants of
    unknown state are not visited, and count in no share.
    """
    robot, grid = rules.robot, aisles.grid
    belief = _believed_from_records(plants, aisles, rules, streams)
    last = np.full(len(grid), NEVER, np.int32)
    gone = np.zeros(len(grid), np.bool_)
    curves = np.empty((len(plants.dates), len(SHARES_PCT)))
    trail = np.empty(0, np.int32)
    for day in range(len(plants.dates)):
        truth = plants.infested[day] & ~gone
        key = streams.key("inspect", day)
        would_find = draw_detections(truth, np.array([robot.detects]), key) > 0
        scene = Scene(
            aisles=aisles,
            robot=robot,
            chance=belief,
            last_inspected=np.where(plants.known[day], last, np.int32(day)),
            day=day,
            seconds_left=robot.day_s,
            trail=trail,
            key=streams.key("sampler", day),
        )
        trail = sampler(name).walk(scene, would_find).plant
        found = would_find[trail]
        curves[day] = _curve(
            found, int(np.count_nonzero(truth)), int(np.count_nonzero(plants.known[day]))
        )
        last[trail] = day
        gone[trail[found]] = True
        evening = learn(belief, grid, trail, found, Learning(detection=robot.detects))
        belief = overnight(evening, grid, rules.spread)
    return curves


def _believed_from_records(
    plants: PlantMap, aisles: Aisles, rules: MapRules, streams: RandomStreams
) -> Floats:
    """Return what records of some plants of the first date make believed, ``(n,)``."""
    first = plants.infested[0]
    told = first & (coin_table(streams.key("records"), len(first)) < rules.recorded_share)
    recorded = np.flatnonzero(told).astype(np.int32)
    base = np.full(len(first), _LEAST)
    finds = np.ones(len(recorded), np.bool_)
    heard = learn(base, aisles.grid, recorded, finds, Learning(treated=False))
    heard[recorded] = PriorSettings().at_record
    return heard


def _curve(found: NDArray[np.bool_], infested: int, n: int) -> Floats:
    """Return percent found after each share of all plants was visited, ``(shares,)``."""
    so_far = np.concatenate([[0], np.cumsum(found)])
    visits = np.round(SHARES_PCT / 100.0 * n).astype(int)
    reached = visits < len(so_far)
    curve = np.full(len(SHARES_PCT), np.nan)
    part = so_far[visits[reached]]
    curve[reached] = 100.0 * part / infested if infested else 100.0
    return curve


def _rows(plants: PlantMap, name: str, found: Floats) -> list[MapMeasure]:
    table = []
    for day, date in enumerate(plants.dates):
        infested = int(np.count_nonzero(plants.infested[day]))
        for k, share in enumerate(SHARES_PCT):
            # of none, no share is found
            ours = summary_statistics(found[: len(found) if infested else 0, day, k])
            table.append(
                MapMeasure(
                    plants.name,
                    date,
                    infested,
                    name,
                    float(share),
                    ours.mean,
                    ours.low,
                    ours.high,
                    ours.replicates,
                )
            )
    return table
