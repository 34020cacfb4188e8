"""One working day: drive, inspect, learn, drive on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import loop
from fieldmon.compute.random_streams import coin_bits, coin_limit
from fieldmon.compute.wording import counted
from fieldmon.plot.travel import GATE, travel_s

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.samplers.base import Sampler, Scene, Stops, WouldFind


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
    wait_s
        ``(k + 1,)`` seconds waited for others on the way to each stop, and home: on leaving an
        aisle, or at the gate; None: nowhere.
    """

    plant: NDArray[np.int32]
    arrive_s: NDArray[np.float64]
    found: NDArray[np.bool_]
    stop_s: NDArray[np.float64]
    detects: NDArray[np.float64]
    end_s: float
    wait_s: NDArray[np.float64] | None = None

    @classmethod
    def of_nobody(cls) -> Workday:
        """Return the day of somebody who does not come."""
        s = np.empty(0)
        return cls(np.empty(0, np.int32), s, np.empty(0, np.bool_), s, s, 0.0)

    def __repr__(self) -> str:
        inspected = f"{counted(len(self), 'plant')} inspected"
        finds = counted(int(np.count_nonzero(self.found)), "find")
        return f"<Workday: {inspected}, {finds}, {self.end_s / 3600:.2f} h>"

    def __len__(self) -> int:
        """Return the number of plants inspected."""
        return len(self.plant)


def plan_work(scene: Scene, sampler: Sampler) -> Workday:
    """Return the rest of the day as it is planned before anything is seen there."""
    supposed = replace(scene, supposed=True)
    return work_day(supposed, sampler, np.zeros(len(scene.chance), np.bool_))


def work_day(scene: Scene, sampler: Sampler, would_find: WouldFind) -> Workday:
    """Return the rest of the day, given what an inspection of each plant ``(n,)`` would find.

    `would_find` is as :meth:`Sampler.walk` wants it, and :func:`draw_detections` draws it.
    """
    times = sampler.inspection_times(scene.robot)
    stops = sampler.walk(scene, would_find)
    first, k = would_find[stops.plant].view(np.uint8), len(stops.plant)
    time = np.zeros(k, np.uint8) if stops.time is None else stops.time
    found = (first > 0) & (first <= time + 1)
    stop_s = times.stop_s[time]
    end_s = _end_s(scene, stops, float(stop_s[-1])) if k else 0.0
    return Workday(stops.plant, stops.arrive_s, found, stop_s, times.detects[time], end_s)


def draw_detections(
    infested: NDArray[np.bool_], detects: NDArray[np.float64], key: np.uint64
) -> NDArray[np.uint8]:
    """Draw what an inspection of each plant would find today, ``(n,)``.

    It is the number, from 1, of the first of several inspection times that finds what is on the
    plant, and 0 where none does: nothing is found on clean plants. A longer inspection finds what
    a shorter one does.

    Parameters
    ----------
    infested
        ``(n,)`` where there is something to be found.
    detects
        ``(t,)`` the chance to find it, ascending with the inspection time.
    key
        Names the table of coins, see `fieldmon.compute.random_streams.coin`.
    """
    first, where = np.zeros(len(infested), np.uint8), np.flatnonzero(infested)
    for time in range(len(detects) - 1, -1, -1):
        _note_found(where, coin_limit(float(detects[time])), key, (first, np.uint8(time + 1)))
    return first


@loop
def _note_found(
    infested: NDArray[np.intp],
    limit: np.uint64,
    key: np.uint64,
    found: tuple[NDArray[np.uint8], np.uint8],
) -> None:
    """Note a value for those of the infested plants that an inspection would find."""
    noted, value = found
    for i in infested:
        if coin_bits(key, i) < limit:
            noted[i] = value


def _end_s(scene: Scene, stops: Stops, last_stop_s: float) -> float:
    end_s = float(stops.arrive_s[-1]) + last_stop_s
    if scene.robot.returns:
        end_s += travel_s(scene.aisles.travel, scene.clock, int(stops.plant[-1]), GATE)
    return end_s
