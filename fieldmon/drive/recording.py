"""What is noted of a day while it is driven: the way, the plans, the finds."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.drive.track import Track

if TYPE_CHECKING:
    from fieldmon.drive.day import DrivenStop
    from fieldmon.drive.errand import Errand, Float
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles


class Noted(NamedTuple):
    """A stop as it was noted.

    Parameters
    ----------
    at_s
        Seconds since the day began, when it was left.
    plant, found
        The plant, and what was found.
    line_m
        ``(k, 2)`` the way to it and on, as it was planned, metres of the plot's frame.
    """

    at_s: float
    plant: int
    found: bool | None
    line_m: Float

    def __repr__(self) -> str:
        return f"<Noted plant {self.plant} at {self.at_s:.0f} s>"


@dataclass(eq=False)
class Recording:
    """A day's way, and its stops with the plan at each.

    A robot that has no track of its own is taken to drive its lines at even speed.

    Parameters
    ----------
    aisles, robot
        Where and who.
    chance
        ``(n,)`` what was believed in the morning, for pictures.
    """

    aisles: Aisles
    robot: Robot
    chance: Float | None = None
    track: Track = field(default_factory=Track)
    stops: list[Noted] = field(default_factory=list)

    def note(self, stop: DrivenStop, errand: Errand) -> None:
        """Note a stop that was told."""
        planned = [errand.line_m, *(line[1:] for _, line in errand.ahead)]
        asked, visit = stop.stop, stop.visit
        done_s = visit.done_at_s(asked)
        noted = Noted(done_s, asked.plant, visit.found, np.concatenate(planned))
        if self.track.last_s < done_s - asked.inspect_s - 1.0:
            self.take(noted, done_s - asked.inspect_s, errand.line_m)
        else:
            self.stops.append(noted)

    def take(self, noted: Noted, there_s: float, line_m: Float | None = None) -> None:
        """Take in a stop of a robot without a track, reached at a second along its line."""
        self.stops.append(noted)
        self._drive_evenly(noted.line_m if line_m is None else line_m, there_s, noted.at_s)

    def _drive_evenly(self, line_m: Float, there_s: float, done_s: float) -> None:
        step = np.diff(line_m, axis=0)
        way = np.append(0.0, np.cumsum(np.hypot(step[:, 0], step[:, 1])))
        heading = np.arctan2(step[:, 1], step[:, 0])
        begins_s = there_s - way[-1] / self.robot.speed_m_s
        for at_s in np.arange(begins_s, there_s, 0.5):
            gone = (at_s - begins_s) * self.robot.speed_m_s
            x, y = (float(np.interp(gone, way, line_m[:, axis])) for axis in (0, 1))
            k = int(np.clip(np.searchsorted(way, gone, "right") - 1, 0, len(heading) - 1))
            self.track.add(float(at_s), x, y, float(heading[k]))
        x, y = line_m[-1].tolist()
        last = float(heading[-1]) if len(heading) else 0.0
        for at_s in (there_s, done_s):
            self.track.add(float(at_s), x, y, last)
