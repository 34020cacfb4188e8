"""What whoever drives is asked for, and what it tells: one plant at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.monitoring.estimates.asked_day import PlantToInspect
    from fieldmon.plot.travel import Aisles

    Float = NDArray[np.float64]


class Errand(NamedTuple):
    """A plant to drive to and to look at.

    Parameters
    ----------
    number
        Of the day, from 1.
    stop
        The plant, and how long to look.
    line_m
        ``(k, 2)`` the way from where the robot stands, metres of the plot's frame.
    ahead
        What comes after it if nothing is found: plants, each with the way to it.
    stop_s
        Seconds of those at the plant that are charged for stopping.
    """

    number: int
    stop: PlantToInspect
    line_m: Float
    ahead: tuple[tuple[int, Float], ...] = ()
    stop_s: float = 0.0

    def __repr__(self) -> str:
        return f"<Errand {self.number}: row {self.stop.row}, plant {self.stop.number}>"

    @property
    def look_s(self) -> float:
        """Return the seconds of looking: whoever drives also stops, and so takes as charged."""
        return max(self.stop.inspect_s - self.stop_s, 0.0)


class Visit(NamedTuple):
    """What came of an errand.

    Parameters
    ----------
    found
        Whether the plant is infested; None: it could not be inspected.
    done_s
        Seconds since the day began, by the robot's clock, when it was done; None: as charged.
    strayed_m
        The furthest it was from its way.
    touched
        Plants that it touched on the way.
    stuck
        Why the robot moves no more today, in a sentence; "" where it does.
    there
        Whether it got there: what nobody stood before is no inspection.
    over_m
        How far its outline reached over the plot's boundary, or into a hole or a no-go area.
    there_s
        Seconds since the day began, by the robot's clock, when it got there; None: nobody told.
    """

    found: bool | None
    done_s: float | None = None
    strayed_m: float = 0.0
    touched: frozenset[int] = frozenset()
    stuck: str = ""
    there: bool = True
    over_m: float = 0.0
    there_s: float | None = None

    def done_at_s(self, stop: PlantToInspect) -> float:
        """Return when a plant was done: as told, or as charged where nobody told it."""
        return stop.done_s if self.done_s is None else self.done_s


class DrivingRobot(Protocol):
    """Whoever drives a day; see `fieldmon.drive.day.drive_day`."""

    def begin(self, aisles: Aisles, at_m: Float, gone_s: float) -> None:
        """Stand at a place ``(2,)`` of a plot, so many seconds after the day began."""
        ...

    def visit(self, errand: Errand) -> Visit:
        """Drive to a plant and look at it; return when that is done."""
        ...

    def home(self, line_m: Float) -> Visit | None:
        """Drive back to the gate along a line; None: as charged."""
        ...


class DayToDrive(Protocol):
    """A day that is asked for the next plant and told what was seen there."""

    @property
    def at(self) -> int:
        """Return where the robot stands: a plant, or -1 for the gate."""
        ...

    @property
    def gone_s(self) -> float:
        """Return the seconds of the day that are gone."""
        ...

    def ask(self) -> PlantToInspect | None:
        """Return the plant to inspect next; None where the day's hours allow no other."""
        ...

    def ahead(self, n: int) -> list[int]:
        """Return up to n plants that follow the one asked for if nothing is found."""
        ...

    def tell(self, found: bool | None, at_s: float | None = None) -> None:  # noqa: FBT001 - a result
        """Say what was seen at the plant that was asked for, and when."""
        ...

    def leave(self) -> None:
        """Go to no plant any more: what was asked for is not driven to."""
        ...
