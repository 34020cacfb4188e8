"""One working day: drive, inspect, learn, drive on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.chance import coin
from fieldmon.compiled import loop
from fieldmon.samplers.scene import travel_s

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.samplers.scene import Sampler, Scene, Stops


@dataclass(frozen=True, eq=False)
class Workday:
    """What was done on one day.

    Parameters
    ----------
    plant
        ``(k,)`` int32, plants in the order inspected.
    arrive_s
        ``(k,)`` seconds since the day began, on arrival.
    found
        ``(k,)`` whether the plant was found infested.
    end_s
        Seconds at the end: after the last stop, or back at the gate if the robot returns.
    """

    plant: NDArray[np.int32]
    arrive_s: NDArray[np.float64]
    found: NDArray[np.bool_]
    end_s: float

    def __len__(self) -> int:
        """Return the number of plants inspected."""
        return len(self.plant)


def plan_day(scene: Scene, sampler: Sampler) -> Workday:
    """Return the rest of the day as it goes if nothing is found."""
    return work_day(scene, sampler, np.zeros(len(scene.chance), np.bool_))


def work_day(scene: Scene, sampler: Sampler, would_find: NDArray[np.bool_]) -> Workday:
    """Return the rest of the day, given what an inspection of each plant ``(n,)`` would find."""
    stops = sampler.walk(scene, would_find)
    return Workday(stops.plant, stops.arrive_s, would_find[stops.plant], _end_s(scene, stops))


def outcomes(infested: NDArray[np.bool_], detection: float, key: np.uint64) -> NDArray[np.bool_]:
    """Draw ``(n,)`` what an inspection of each plant would find today: nothing on clean plants."""
    found = np.empty(len(infested), np.bool_)
    _look(infested, detection, key, found)
    return found


@loop
def _look(
    infested: NDArray[np.bool_], detection: float, key: np.uint64, found: NDArray[np.bool_]
) -> None:
    for i in range(infested.size):
        found[i] = infested[i] and coin(key, i) < detection


def _end_s(scene: Scene, stops: Stops) -> float:
    if len(stops.plant) == 0:
        return 0.0
    end_s = float(stops.arrive_s[-1]) + scene.robot.visit_s
    if scene.robot.returns:
        end_s += travel_s(scene.aisles.ground, scene.clock, int(stops.plant[-1]), -1)
    return end_s
