"""All that a sampler may know, what it answers, and what its time costs."""

from __future__ import annotations

from abc import abstractmethod
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from operator import index
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Protocol, TypeAlias

import numpy as np

from fieldmon.compute.arrays import as_seen
from fieldmon.compute.wording import counted
from fieldmon.plot.travel import GATE, robot_clock, travel_s

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.infestation.tracing.tracing import Traces
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles, Clock

    WouldFind: TypeAlias = NDArray[np.bool_] | NDArray[np.uint8]

NEVER = -1


class InspectionTimes(NamedTuple):
    """How long a plant may be inspected, the shortest time first.

    Parameters
    ----------
    stop_s
        ``(t,)`` seconds of the whole stop.
    detects
        ``(t,)`` chance that so long an inspection finds what is there.
    """

    stop_s: NDArray[np.float64]
    detects: NDArray[np.float64]

    def __repr__(self) -> str:
        pairs = zip(self.stop_s.tolist(), self.detects.tolist(), strict=True)
        return f"<InspectionTimes: {', '.join(f'{s:g} s {d:.0%}' for s, d in pairs)}>"


class Stops(NamedTuple):
    """The plants that a sampler inspects, in order.

    Parameters
    ----------
    plant
        ``(k,)`` int32.
    arrive_s
        ``(k,)`` seconds since the start, on arrival.
    time
        ``(k,)`` uint8 which of its `InspectionTimes` each plant gets; None: the only one.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> fm.Stops(np.array([4, 5], np.int32), np.array([60.0, 103.0]))
    <Stops: 2 plants>
    """

    plant: NDArray[np.int32]
    arrive_s: NDArray[np.float64]
    time: NDArray[np.uint8] | None = None

    def __repr__(self) -> str:
        return f"<Stops: {counted(len(self.plant), 'plant')}>"


def resting_place(robot: Robot, trail: NDArray[np.int32]) -> int:
    """Return where a day begins after the last one's `trail`: `GATE`, or the plant it ended at."""
    return GATE if robot.returns or not len(trail) else int(trail[-1])


@dataclass(frozen=True, eq=False)
class Scene:
    """A moment of a working day, as whoever plans it can know it; never the truth.

    A sampler of one's own cannot write to its arrays: it changes copies.

    Parameters
    ----------
    aisles
        The plot: plants and the ways between them that the robot can drive.
    robot
        Who inspects.
    chance
        ``(n,)`` believed chance that each plant is infested.
    last_inspected
        ``(n,)`` int32 day on which each plant was inspected last, -1 if it was not. Plants
        in aisles too narrow for the robot seem inspected today, and so do those that are left out
        because nobody could inspect them or because they are known to be infested: nobody is sent
        there.
    day
        Today's number. A plant inspected on this day is not visited again.
    at
        Where the robot stands: a plant, or -1, the gate.
    seconds_left
        What is left of the working day.
    trail
        ``(k,)`` int32 plants of the last working day before today, in order; empty if there was
        none. A sweep goes on where it ends, in its direction.
    key
        64 random bits for samplers that draw, by ``np.random.default_rng(int(scene.key))``.
    pair_chance
        ``(e,)`` believed chance that two plants side by side are both infested, in the order of
        ``grid.adjacent``; None where nothing is believed of pairs.
    traces
        What is believed of how far insects jump; None where nothing is.
    supposed
        Whether results are supposed, as in a plan that takes every plant for clean: from those
        nobody learns how many plants are infested.
    skipped
        ``(n,)`` plants that are left out today because nobody could inspect them when they were
        asked for last; None: there are none.
    flagged
        ``(n,)`` plants that are left out because they were found infested and only flagged, which
        they are still; None: there are none.
    infested
        ``(n,)`` the chances where `chance` is of what inspections can see alone, for files and
        people; None: they are the same.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> scene = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=4)).scene
    >>> scene, round(scene.travel_s(-1, 0), 1)
    (<Scene of day 0: 3,825 plants in 45 rows, 4.00 h left>, 3.6)
    """

    aisles: Aisles
    robot: Robot
    chance: NDArray[np.float64]
    last_inspected: NDArray[np.int32]
    day: int = 0
    at: int = GATE
    seconds_left: float = 0.0
    trail: NDArray[np.int32] = field(default_factory=lambda: np.empty(0, np.int32))
    key: np.uint64 = np.uint64(0)  # noqa: RUF009 - a number, not a call with effects
    pair_chance: NDArray[np.float64] | None = None
    traces: Traces | None = None
    supposed: bool = False
    skipped: NDArray[np.bool_] | None = None
    flagged: NDArray[np.bool_] | None = None
    infested: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        robot = self.aisles.worked_by(self.robot)
        if robot is not self.robot:
            object.__setattr__(self, "robot", robot)
        # whoever makes a scene need not think of it: its ways are those that its robot can drive
        aisles = self.aisles.for_robot(self.robot)
        if aisles.too_narrow.any():
            seen = np.where(aisles.too_narrow, np.int32(self.day), self.last_inspected)
            object.__setattr__(self, "last_inspected", seen)
        object.__setattr__(self, "aisles", aisles)

    def __repr__(self) -> str:
        hours = self.seconds_left / 3600
        return f"<Scene of day {self.day}: {self.grid.counts}, {hours:.2f} h left>"

    @property
    def grid(self) -> PlantGrid:
        """Return the plants."""
        return self.aisles.grid

    @property
    def resume(self) -> int:
        """Return the plant after which a sweep goes on, or -1 if it has not begun."""
        if self.at >= 0:
            return self.at
        return int(self.trail[-1]) if len(self.trail) else NEVER

    @property
    def left_out(self) -> NDArray[np.bool_]:
        """Return which plants are left out of what is planned, `skipped` or `flagged`, ``(n,)``."""
        out = np.zeros(len(self.last_inspected), np.bool_)
        for mask in (self.skipped, self.flagged):
            if mask is not None:
                out |= mask
        return out

    def are_open(self, plants: NDArray[np.integer]) -> NDArray[np.bool_]:
        """Return which plants ``(k,)`` a route given out may lead to still.

        Those that are left out only of what is planned: who gave it out wished for them.
        """
        opened: NDArray[np.bool_] = self.last_inspected[plants] != self.day
        opened |= self.left_out[plants]
        return opened

    def seen(self) -> Scene:
        """Return the same scene, whose arrays cannot be written to."""
        same = copy(self)
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                object.__setattr__(same, name, as_seen(value))
        if self.traces is not None:
            object.__setattr__(same, "traces", self.traces.seen())
        return same

    @cached_property
    def clock(self) -> Clock:
        """Return the robot's numbers for the rest of the day."""
        return robot_clock(self.robot, self.seconds_left)

    def travel_s(self, i: int, j: int) -> float:
        """Return the seconds from plant i to plant j, either of which may be -1, the gate.

        Raise `SettingError` if one is no plant.
        """
        travel = self.aisles.travel
        n = len(travel.x_m)
        try:
            known = GATE <= index(i) < n and GATE <= index(j) < n
        except TypeError:
            known = False
        if not known or bool in (type(i), type(j)):
            raise self.aisles.no_place(i, j)
        return travel_s(travel, self.clock, i, j)

    def walked(self, walk: Callable[..., int], *arrays: object) -> Stops:
        """Return the stops of a compiled walk through the rest of the day.

        It is handed the travel table, the clock, `arrays` of its own and room for as many stops
        as the time left or the plants allow, and returns how many it made.
        """
        stops = self.room(self.robot.visit_s)
        k = walk(self.aisles.travel, self.clock, *arrays, stops)
        return Stops(stops.plant[:k], stops.arrive_s[:k])

    def room(self, stop_s: float) -> Stops:
        """Return room for as many stops of at least `stop_s` each."""
        room = min(len(self.grid), int(self.seconds_left // stop_s) + 1)
        return Stops(np.empty(room, np.int32), np.empty(room, np.float64))


class Sampler(Protocol):
    """Decides which plants come next.

    Samplers derive from this class and have its defaults.

    Attributes
    ----------
    reads_chance
        Whether it reads the chances of a scene. For one that does not, nothing is believed: its
        scene holds the chances of the first morning, and no chances of pairs.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> class First(fm.Sampler):
    ...     def walk(self, scene, would_find):
    ...         return fm.Stops(np.array([0]), np.array([scene.travel_s(scene.at, 0)]))
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> fm.plan_day(plot, on="2026-11-18", sampler=First()).route.plant.tolist()
    [0]
    """

    reads_chance: ClassVar[bool] = True

    def inspection_times(self, robot: Robot) -> InspectionTimes:
        """Return the times from which it chooses at each plant: most have only the robot's own."""
        return InspectionTimes(np.array([robot.visit_s]), np.array([robot.detects]))

    @abstractmethod
    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops from here to the end of the day, in a `scene`.

        A sampler may read an entry only when it has driven to that plant and inspected it: each
        plant follows from what those before it showed. One of somebody's own is asked several times
        a day, to see that it does.

        Parameters
        ----------
        scene
            What is known when the day goes on: where one stands, the seconds left, chances.
        would_find
            ``(n,)`` for each plant from which of the sampler's inspection times on an inspection
            today would find it infested, counted from 1; 0: none would. Where there is one time
            only, that is whether it would.

        Returns
        -------
        Stops
            Plants in the order of their inspections, and when one arrives at each.
        """
