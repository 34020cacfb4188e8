"""One loop for every robot: ask for a plant, drive there, look, tell, and again."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.held_signals import stops_wait
from fieldmon.compute.wording import counted
from fieldmon.drive.errand import Errand
from fieldmon.plot.travel import GATE, robot_clock, travel_s

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.drive.errand import DayToDrive, DrivingRobot, Float, Visit
    from fieldmon.monitoring.estimates.asked_day import PlantToInspect
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles

#: plants of the plan after the one asked for that a robot is told of
_AHEAD = 2
# a day that ends so many seconds after its hours is late
_LATE_S = 30.0
# who drives so many times longer is not as planned
_SLOW = 1.1
# ways that are charged less say nothing of how fast a robot drives
_LEAST_DRIVE_S = 1.0


class DrivenStop(NamedTuple):
    """A plant that was driven to.

    Parameters
    ----------
    stop
        As it was asked for.
    visit
        What came of it.
    charged_s, driven_s
        Seconds from the stop before it until this one was done: as charged, and as driven.
    """

    stop: PlantToInspect
    visit: Visit
    charged_s: float
    driven_s: float

    @property
    def drive_s(self) -> float:
        """Seconds of driving to it that are charged."""
        return self.charged_s - self.stop.inspect_s

    @property
    def slowness(self) -> float:
        """How many times longer than charged it drove; where nobody told, as the whole stop took.

        That is where the robot did not say when it got there.
        """
        done_s, there_s = self.visit.done_s, self.visit.there_s
        if done_s is None or there_s is None:
            return self.driven_s / self.charged_s
        return (self.driven_s - (done_s - there_s)) / self.drive_s


@dataclass(eq=False)
class DrivenDay:
    """A day as it was driven.

    Parameters
    ----------
    stops
        In order.
    home_charged_s, home_driven_s
        Seconds of the way back to the gate.
    home_line_m
        ``(k, 2)`` that way, metres of the plot's frame; None: there was none.
    late_s
        Seconds by which the day went past its hours; 0: none.
    home
        What came of it; None: there was none, or as charged.
    broken
        What broke it off, in a sentence; "": nothing.
    ends
        How often somebody asked for its end: no other plant is asked for.
    begun_s
        The second of a season's day from which its seconds count; None: as planned.
    """

    stops: list[DrivenStop] = field(default_factory=list)
    home_charged_s: float = 0.0
    home_driven_s: float = 0.0
    home_line_m: Float | None = None
    late_s: float = 0.0
    home: Visit | None = None
    broken: str = ""
    ends: int = 0
    begun_s: float | None = None

    def __repr__(self) -> str:
        return f"<DrivenDay: {counted(len(self.stops), 'stop')}, {self.found} found>"

    @property
    def slowness(self) -> float:
        """How many times longer than charged it drives, at least 1: half its driving took more.

        A pause on one way says nothing of others.
        """
        took = [(one.slowness, one.drive_s) for one in self.stops if one.drive_s >= _LEAST_DRIVE_S]
        if not took:
            return 1.0
        ratio, charged = np.array(sorted(took)).T
        gone = np.cumsum(charged)
        return max(1.0, float(ratio[np.searchsorted(gone, gone[-1] / 2)]))

    @property
    def visits(self) -> list[Visit]:
        """What came of every errand, the way home included."""
        return [one.visit for one in self.stops] + ([] if self.home is None else [self.home])

    @property
    def found(self) -> int:
        """Plants found infested."""
        return sum(one.visit.found is True for one in self.stops)

    @property
    def skipped(self) -> int:
        """Plants that could not be inspected."""
        return sum(one.visit.found is None for one in self.stops)

    @property
    def touched(self) -> frozenset[int]:
        """Plants that were touched."""
        return frozenset().union(*(one.touched for one in self.visits))

    @property
    def stuck(self) -> list[str]:
        """Why the robot did not get somewhere, a sentence each."""
        return [one.stuck for one in self.visits if one.stuck]

    @property
    def charged_s(self) -> float:
        """Seconds of the day as charged."""
        return sum(one.charged_s for one in self.stops) + self.home_charged_s

    @property
    def driven_s(self) -> float:
        """Seconds of the day as driven."""
        return sum(one.driven_s for one in self.stops) + self.home_driven_s

    @property
    def strayed_m(self) -> float:
        """The furthest that the robot was from its way."""
        return max((one.strayed_m for one in self.visits), default=0.0)

    @property
    def over_m(self) -> float:
        """How far its outline reached over the plot's boundary, or into a hole or no-go area."""
        return max((one.over_m for one in self.visits), default=0.0)


def drive_day(
    day: DayToDrive,
    aisles: Aisles,
    who: tuple[Robot, DrivingRobot],
    watch: Callable[[DrivenStop, Errand], None] | None = None,
    driven: DrivenDay | None = None,
) -> DrivenDay:
    """Drive what is left of a day.

    Parameters
    ----------
    day
        Asked for plants and told of them.
    aisles
        The ways that the robot can drive.
    who
        The robot's numbers, by which seconds are charged, and whoever drives.
    watch
        Told of every stop once it is told to the day.
    driven
        Where it is noted, which stays where the day breaks off; None: in one of its own.

    A robot that is stuck ends the day; of a plant that it did not get to nothing is told. One that
    drives slower than charged goes home as much sooner.

    Examples
    --------
    >>> import fieldmon as fm
    >>> from fieldmon.drive.charged_robot import ChargedRobot
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> robot = fm.Robot(hours=1)
    >>> with fm.Monitor(plot, robot=robot).day() as day:
    ...     driven = drive_day(day, plot.aisles, (robot, ChargedRobot(lambda stop: False)))
    >>> driven.charged_s == driven.driven_s, driven.touched
    (True, frozenset())
    """
    robot, driver = who
    worked = aisles.worked_by(robot)
    clock = robot_clock(worked, robot.day_s)
    driven = DrivenDay() if driven is None else driven
    driver.begin(aisles, place_m(aisles, day.at), day.gone_s)
    while not driven.ends and (stop := day.ask()) is not None:
        at, since_s = day.at, day.gone_s
        back_s = travel_s(aisles.travel, clock, stop.plant, GATE) if robot.returns else 0.0
        drive_s, slow = travel_s(aisles.travel, clock, at, stop.plant), driven.slowness
        ends_s = since_s + slow * (drive_s + back_s) + stop.inspect_s
        if slow > 1.0 and ends_s > robot.day_s + (_LATE_S if slow < _SLOW else 0.0):
            day.leave()
            break
        plants = [stop.plant, *day.ahead(_AHEAD)]
        after = tuple((b, aisles.path(a, b)) for a, b in pairwise(plants))
        line_m = way_m(aisles, at, stop.plant)
        errand = Errand(len(driven.stops) + 1, stop, line_m, after, worked.stop_s)
        visit = driver.visit(errand)
        charged_s = drive_s + stop.inspect_s
        driven_s = charged_s if visit.done_s is None else visit.done_s - since_s
        with stops_wait():  # or a season has a plant that tables and bag lack
            if visit.there:
                day.tell(visit.found, visit.done_s)
            driven.stops.append(DrivenStop(stop, visit, charged_s, driven_s))
            if watch is not None:
                watch(driven.stops[-1], errand)
        if visit.stuck:
            return driven
    if robot.returns and driven.stops and day.at != GATE:
        home_charged_s = travel_s(aisles.travel, clock, day.at, GATE)
        _drive_home(day, aisles, driver, driven, home_charged_s)
    late_s = day.gone_s + driven.home_driven_s - robot.day_s
    driven.late_s = late_s if driven.stops and late_s > _LATE_S else 0.0
    return driven


def _drive_home(
    day: DayToDrive, aisles: Aisles, driver: DrivingRobot, driven: DrivenDay, charged_s: float
) -> None:
    """Drive back to the gate, and note it; it takes as long as charged unless the driver says."""
    driven.home_charged_s = charged_s
    driven.home_line_m = way_m(aisles, day.at, GATE)
    since_s, home = day.gone_s, driver.home(driven.home_line_m)
    driven.home, driven.home_driven_s = home, charged_s
    if home is not None and home.done_s is not None:
        driven.home_driven_s = home.done_s - since_s


def place_m(aisles: Aisles, at: int) -> Float:
    """Return where a robot stands at a plant, or at the gate (-1), ``(2,)``."""
    here: Float = aisles.gate_m if at < 0 else aisles.stop_m[at]
    return here


def way_m(aisles: Aisles, a: int, b: int) -> Float:
    """Return the line ``(k, 2)`` from plant a to plant b, without points of no way."""
    line = aisles.path(a, b)
    moves = np.hypot(*np.diff(line, axis=0).T) > 1e-6
    kept: Float = line[np.append(True, moves)]
    return kept
