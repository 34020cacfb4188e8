"""One working day: drive, inspect, learn, drive on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.chance import coin
from fieldmon.compiled import loop
from fieldmon.samplers.scene import ChoosesLook, Looks, travel_s

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.robot import Robot
    from fieldmon.samplers.scene import Sampler, Scene


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
    look = np.zeros(len(stops.plant), np.uint8) if stops.look is None else stops.look
    first = would_find[stops.plant]
    work = Workday(
        plant=stops.plant,
        arrive_s=stops.arrive_s,
        found=(first > 0) & (first <= look + 1),
        stop_s=looks.stop_s[look],
        detects=looks.detects[look],
        end_s=0.0,
    )
    return replace(work, end_s=_end_s(scene, work))


def looks_of(robot: Robot, sampler: Sampler) -> Looks:
    """Return the looks that a sampler chooses from; most have one, the robot's."""
    if isinstance(sampler, ChoosesLook):
        return sampler.looks(robot)
    return Looks(np.array([robot.visit_s]), np.array([robot.detects]))


def luck(infested: NDArray[np.bool_], looks: Looks, key: np.uint64) -> NDArray[np.uint8]:
    """Draw ``(n,)`` the first look, from 1, that would find what is on each plant today; 0: none.

    A longer look finds what a shorter one does.
    """
    first = np.zeros(len(infested), np.uint8)
    for k in range(len(looks.detects) - 1, -1, -1):
        first[outcomes(infested, float(looks.detects[k]), key)] = k + 1
    return first


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


def _end_s(scene: Scene, work: Workday) -> float:
    if not len(work):
        return 0.0
    end_s = float(work.arrive_s[-1] + work.stop_s[-1])
    if scene.robot.returns:
        end_s += travel_s(scene.aisles.ground, scene.clock, int(work.plant[-1]), -1)
    return end_s
