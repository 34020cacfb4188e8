"""One working day: drive, inspect, learn, drive on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.compute.random_streams import coin_bits, coin_limit
from fieldmon.compute.wording import counted
from fieldmon.plot.travel import GATE, travel_s
from fieldmon.samplers.base import InspectionTimes

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler, Scene, Stops


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
    stop_s, detects
        ``(k,)`` seconds that each stop takes, and its chance to find what is there.
    end_s
        Seconds at the end: after the last stop, or back at the gate if the robot returns.
    """

    plant: NDArray[np.int32]
    arrive_s: NDArray[np.float64]
    found: NDArray[np.bool_]
    stop_s: NDArray[np.float64]
    detects: NDArray[np.float64]
    end_s: float

    def __repr__(self) -> str:
        inspected = f"{counted(len(self), 'plant')} inspected"
        finds = counted(int(np.count_nonzero(self.found)), "find")
        return f"<Workday: {inspected}, {finds}, {self.end_s / 3600:.2f} h>"

    def __len__(self) -> int:
        """Return the number of plants inspected."""
        return len(self.plant)


def plan_day(scene: Scene, sampler: Sampler) -> Workday:
    """Return the rest of the day as it goes if nothing is found."""
    return work_day(scene, sampler, np.zeros(len(scene.chance), np.bool_))


def work_day(
    scene: Scene, sampler: Sampler, would_find: NDArray[np.bool_] | NDArray[np.uint8]
) -> Workday:
    """Return the rest of the day, given what an inspection of each plant ``(n,)`` would find.

    `would_find` is as :meth:`Sampler.walk` wants it, and :func:`luck` draws it.
    """
    looks = looks_of(scene.robot, sampler)
    stops = sampler.walk(scene, would_find)
    first, k = would_find[stops.plant], len(stops.plant)
    if len(looks.stop_s) == 1 or stops.look is None:
        found = first.view(np.uint8) == 1
        stop_s, detects = np.full(k, looks.stop_s[0]), np.full(k, looks.detects[0])
    else:
        found = (first > 0) & (first <= stops.look + 1)
        stop_s, detects = looks.stop_s[stops.look], looks.detects[stops.look]
    end_s = _end_s(scene, stops, float(stop_s[-1])) if k else 0.0
    return Workday(stops.plant, stops.arrive_s, found, stop_s, detects, end_s)


def looks_of(robot: Robot, sampler: Sampler) -> InspectionTimes:
    """Return the looks that a sampler chooses from; most have the robot's."""
    # asking whether it is an instance of the protocol takes as long as a day's drive
    chosen: Callable[[Robot], InspectionTimes] | None = getattr(sampler, "looks", None)
    if chosen is not None:
        return chosen(robot)
    return InspectionTimes(np.array([robot.visit_s]), np.array([robot.detects]))


def luck(infested: NDArray[np.bool_], looks: InspectionTimes, key: np.uint64) -> NDArray[np.uint8]:
    """Draw ``(n,)`` the first look, from 1, that would find what is on each plant today; 0: none.

    A longer look finds what a shorter one does.
    """
    first, where = np.zeros(len(infested), np.uint8), np.flatnonzero(infested)
    for k in range(len(looks.detects) - 1, -1, -1):
        _look(where, coin_limit(float(looks.detects[k])), key, (first, np.uint8(k + 1)))
    return first


def outcomes(infested: NDArray[np.bool_], detection: float, key: np.uint64) -> NDArray[np.bool_]:
    """Draw ``(n,)`` what an inspection of each plant would find today: nothing on clean plants."""
    found = np.zeros(len(infested), np.bool_)
    seen = found.view(np.uint8), np.uint8(1)
    _look(np.flatnonzero(infested), coin_limit(detection), key, seen)
    return found


@loop
def _look(
    infested: NDArray[np.intp],
    limit: np.uint64,
    key: np.uint64,
    found: tuple[NDArray[np.uint8], np.uint8],
) -> None:
    """Note a value for those of the infested plants that a look would find."""
    noted, value = found
    for i in infested:
        if coin_bits(key, i) < limit:
            noted[i] = value


def _end_s(scene: Scene, stops: Stops, last_stop_s: float) -> float:
    end_s = float(stops.arrive_s[-1]) + last_stop_s
    if scene.robot.returns:
        end_s += travel_s(scene.aisles.travel, scene.clock, int(stops.plant[-1]), GATE)
    return end_s
