"""The sampler and its settings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.errors import SettingError
from fieldmon.infestation.pairs.clustering import ClusterEstimate, chance_apart, leaning
from fieldmon.infestation.pairs.pairs import Neighbourhood, pair_chances
from fieldmon.infestation.tracing.tracing import Raised, Traces
from fieldmon.samplers.adaptive.arrays import (
    LEAST,
    NOWHERE,
    BeliefArrays,
    BestTours,
    OwnRow,
    RowTours,
)
from fieldmon.samplers.adaptive.day import (
    LEVEL_FINDS,
    SETTLED_FINDS,
    drive_day,
    trust_in_differences,
)
from fieldmon.samplers.adaptive.tours import measure_ways
from fieldmon.samplers.base import InspectionTimes, Sampler, Scene, Stops

if TYPE_CHECKING:
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import WouldFind


@dataclass(frozen=True)
class Adaptive(Sampler):
    """Take the drive through the rows with the most expected finds for its time.

    A plant is worth its chance of infestation times the chance of detection, and more where a
    find would save plants beside it. A find raises the plants beside it, a clean inspection
    lowers them, as far as the belief says that they share their fate; then the rest of the day is
    planned again from where the robot stands. Where the map is flat the drive is a plain sweep.

    Parameters
    ----------
    spares
        How much more than itself a find is worth where all plants beside it are clean.
    beside_find
        Chance that a plant next to a find is infested, where the belief says nothing of pairs.
    chooses_time
        Whether it decides at each plant how long to inspect it, by the robot's table of viewpoints;
        if not, it does so as long as the robot is set to.
    """

    spares: float = 0.5
    beside_find: float = 0.5
    chooses_time: bool = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.spares < np.inf:
            raise SettingError(f"Adaptive's spares must be 0 or more, but it is {self.spares}.")
        if not 0.0 <= self.beside_find <= 1.0:
            raise SettingError(
                f"Adaptive's beside_find must be a chance in 0..1, but it is {self.beside_find}."
            )

    def inspection_times(self, robot: Robot) -> InspectionTimes:
        """Return the times to choose from; raise `SettingError` if the robot's table is unknown."""
        if not self.chooses_time:
            return super().inspection_times(robot)
        if robot.detection is not None:
            raise SettingError(
                "A robot must state what each time of looking detects (viewpoints) if the sampler "
                f"is to choose, but its detection is given outright ({robot.detection})."
            )
        # contiguous, as the one time of others is: the day's loop is compiled once for both
        seconds, detects = np.ascontiguousarray(np.array(robot.viewpoints.steps).T)
        return InspectionTimes(robot.stop_s + seconds, detects)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day."""
        if not (scene.grid.in_rows or self.chooses_time):
            # without rows there are no drives through rows to choose among
            from fieldmon.samplers.dynamic import Dynamic  # noqa: PLC0415 - seldom asked for

            return Dynamic().walk(scene, would_find)
        times = self.inspection_times(scene.robot)
        stops = scene.room(float(times.stop_s[0]))
        taken = np.zeros(len(stops.plant), np.uint8)
        pair_chance = scene.pair_chance
        if pair_chance is None:
            pair_chance = pair_chances(scene.chance, scene.grid, self.beside_find)
        n, n_rows = len(scene.chance), scene.grid.n_rows
        traces = Traces.none(n) if scene.traces is None else scene.traces.own()
        lean = 0.5 if scene.traces is None else leaning(traces.evidence)
        share = float(scene.chance.mean())
        trust = 1.0 if scene.traces is None else trust_in_differences(share, traces.slope_sums)
        finds = SETTLED_FINDS if scene.supposed else LEVEL_FINDS
        belief = BeliefArrays(
            np.maximum(scene.chance, LEAST),
            pair_chance.copy(),
            np.zeros(n),
            Neighbourhood.of(n, None if scene.traces is None else scene.chance),
            np.full(n, NOWHERE),
            np.maximum(scene.chance, LEAST),
            pair_chance.copy(),
            ClusterEstimate.none(n, traces.evidence, lean),
            np.array([1.0, chance_apart(traces.evidence), lean, trust, share]),
            np.array([finds, finds, 1.0]),
            traces,
            Raised.of(n),
        )
        tours = BestTours.of(n_rows)
        measure_ways(scene.aisles.travel, scene.clock, tours.next_s, tours.home_s)
        k = drive_day(
            scene.aisles.travel,
            scene.clock,
            (scene.grid.linked, belief, as_compiled(would_find.view(np.uint8))),
            (RowTours.of(n, n_rows, times.stop_s.size), tours, times, OwnRow.blank()),
            (scene.at, self.spares, scene.last_inspected == scene.day),
            (stops.plant, stops.arrive_s, taken),
        )
        return Stops(stops.plant[:k], stops.arrive_s[:k], taken[:k])
