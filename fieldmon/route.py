"""The day's route: stops in order with their times, and the line that is driven."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.aisles import Aisles
    from fieldmon.samplers.scene import Scene
    from fieldmon.workday import Workday


@dataclass(frozen=True, eq=False)
class Route:
    """A day's route, as it is driven.

    Parameters
    ----------
    aisles
        The plot it runs through.
    plant
        ``(k,)`` int32 plants in order.
    arrive_s, leave_s
        ``(k,)`` seconds since the start of the route.
    chance
        ``(k,)`` believed chance of infestation at each stop.
    line_m
        ``(m, 2)`` the driven line, metres of the plot's frame. It crosses no row of plants.
    line_stop
        ``(k,)`` the vertex of the line at which each stop is made.
    line_s
        ``(m,)`` seconds since the start at each vertex on arrival.
    end_s
        Seconds at the end of the line.
    """

    aisles: Aisles
    plant: NDArray[np.int32]
    arrive_s: NDArray[np.float64]
    leave_s: NDArray[np.float64]
    chance: NDArray[np.float64]
    line_m: NDArray[np.float64]
    line_stop: NDArray[np.int64]
    line_s: NDArray[np.float64]
    end_s: float

    def __len__(self) -> int:
        """Return the number of stops."""
        return len(self.plant)

    @cached_property
    def drive_m(self) -> float:
        """Length of the driven line."""
        return float(np.hypot(*np.diff(self.line_m, axis=0).T).sum())

    @property
    def expected_finds(self) -> float:
        """Infested plants on the route, as believed; not all of them would be seen."""
        return float(self.chance.sum())

    def line_lonlat(self) -> NDArray[np.float64]:
        """Return the driven line in degrees, ``(m, 2)``."""
        return self.aisles.grid.frame.lonlat(self.line_m)

    def stops_lonlat(self) -> NDArray[np.float64]:
        """Return the plants' own positions in degrees, ``(k, 2)``."""
        return self.aisles.grid.lonlat(self.plant)


def route_of(scene: Scene, work: Workday) -> Route:
    """Return the route of a working day that began as `scene` says.

    Its seconds are those the workday charged; its line is the one whose length they were charged
    for, leg by leg: from where the robot stands to each stop, and back to the gate if it returns.
    """
    places = [scene.at, *work.plant.tolist()] + ([-1] if scene.robot.returns and len(work) else [])
    arrive_s = np.append(work.arrive_s, work.end_s)[: len(places) - 1]
    leave_s = np.append(0.0, work.arrive_s + scene.robot.visit_s)
    lines, seconds, stops, vertices = [], [], [], 0
    for leg, (a, b) in enumerate(pairwise(places)):
        line = scene.aisles.path(a, b)
        lines.append(line)
        seconds.append(_spread_over(line, float(leave_s[leg]), float(arrive_s[leg])))
        vertices += len(line)
        stops.append(vertices - 1)
    return Route(
        aisles=scene.aisles,
        plant=work.plant,
        arrive_s=work.arrive_s,
        leave_s=leave_s[1:],
        chance=scene.chance[work.plant],
        line_m=np.concatenate(lines) if lines else np.empty((0, 2)),
        line_stop=np.array(stops[: len(work)], np.int64),
        line_s=np.concatenate(seconds) if seconds else np.empty(0),
        end_s=work.end_s,
    )


def _spread_over(line: NDArray[np.float64], start_s: float, end_s: float) -> NDArray[np.float64]:
    """Return the seconds at each vertex of a leg, at even speed from start to end."""
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
    share = way / way[-1] if way[-1] > 0 else np.linspace(0.0, 1.0, len(way))
    return np.asarray(start_s + share * (end_s - start_s))
