"""What is noted of a day while it is driven: the way, the plans, the finds."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.drive.track import Track
from fieldmon.plot.clearance import STRAY_M

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.drive.day import DrivenDay, DrivenStop
    from fieldmon.drive.errand import Errand, Float
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles


# who is so near to the end of a way is there
_THERE_M = 0.15
# places along a way are looked at so far apart; of two, one further on must be that much nearer
_STEP_M, _NEARER = 0.05, 0.01
# who was so near to where a way begins begins there; who moves less between two poses stands
_SAME_M, _STANDS_M = 0.5, 1e-3
_EVERY_S = 0.5


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
    _seen: list[tuple[float, float, float]] = field(default_factory=list, repr=False)
    _since_s: float | None = field(default=None, repr=False)

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

    def see(self, at_s: float, place_m: Float) -> None:
        """Note where a live robot said that it is, ``(2,)`` metres of the plot's frame."""
        self._seen.append((at_s, *place_m.tolist()))

    def note_live(self, stop: DrivenStop, errand: Errand) -> None:
        """Note a stop of a live robot, which drove as it said, and evenly between.

        Where it did not say when it got there, that was as long before it was done as it was to
        look.
        """
        visit = stop.visit
        done_s = visit.done_at_s(stop.stop)
        planned = [errand.line_m, *(line[1:] for _, line in errand.ahead)]
        self.stops.append(Noted(done_s, stop.stop.plant, visit.found, np.concatenate(planned)))
        if visit.there:
            there_s = done_s - errand.look_s if visit.there_s is None else visit.there_s
            if self._since_s is None:  # it may have been waited for
                begin_m = errand.line_m[0]
                waits = [
                    at_s
                    for at_s, x, y in self._seen[:1]
                    if at_s < there_s and np.hypot(*(begin_m - [x, y])) < _SAME_M
                ]
                self._since_s = max([done_s - stop.driven_s, *waits])
            self._drive_as_seen(errand.line_m, there_s, done_s)

    def end(self, driven: DrivenDay) -> None:
        """Note the way home, and what else a live robot said of where it is."""
        if driven.home_line_m is not None and self.stops:
            since_s, home = self.stops[-1].at_s, driven.home
            is_told = home is not None and home.done_s is not None
            done_s = since_s + driven.home_driven_s
            if self._since_s is not None and is_told and home is not None and home.there:
                self._drive_as_seen(driven.home_line_m, done_s, done_s)
            elif home is None and self.track.last_s < done_s - 1.0:
                self._drive_evenly(driven.home_line_m, done_s, done_s)
        for (at_s, x, y), (_, x_2, y_2) in pairwise(self._seen):
            if at_s > self.track.last_s:
                self.track.add(at_s, x, y, float(np.arctan2(y_2 - y, x_2 - x)))
        for at_s, x, y in self._seen[-1:]:
            if at_s > self.track.last_s:
                self.track.add(at_s, x, y, self._last[1])
        self._seen = []

    @property
    def _last(self) -> tuple[Float, float]:
        """Where the robot was last, ``(2,)``, and its heading; NaN before it was anywhere."""
        poses = self.track.poses
        return (poses[-1, 1:3], float(poses[-1, 3])) if len(poses) else (np.full(2, np.nan), 0.0)

    def _drive_as_seen(self, line_m: Float, there_s: float, done_s: float) -> None:
        """Drive along a line by what was said meanwhile; what was off it, was."""
        way = _LineDriven.of(line_m)
        told = [one for one in self._seen if one[0] <= done_s + 1e-6]
        self._seen = self._seen[len(told) :]
        since_s = there_s if self._since_s is None else self._since_s
        self._since_s, self.track.off_m = done_s, STRAY_M
        stood_m, heading = self._last
        is_near = np.hypot(*(stood_m - line_m[0])) < _SAME_M
        knots = [_Knot(since_s, 0.0, stood_m if is_near else line_m[0])]
        end_m = line_m[-1]
        for second, x, y in told:
            place_m = np.array([x, y])
            along_m = way.along(place_m, knots[-1].gone_m)
            if along_m > way.gone_m[-1] - _THERE_M:
                end_m = place_m
            elif second > knots[-1].at_s:
                knots.append(_Knot(second, along_m, place_m))
        there_s = min(max(there_s, knots[-1].at_s), max(done_s, knots[-1].at_s))
        there = _Knot(there_s, float(way.gone_m[-1]), end_m)
        knots += [there, there._replace(at_s=max(done_s, there_s))]
        for a, b in pairwise(knots):
            for second, (x, y), towards in _between(a, b, way, heading):
                heading = towards
                self.track.add(second, x, y, heading)
        x, y = end_m.tolist()
        self.track.add(knots[-1].at_s, x, y, heading)

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


class _Knot(NamedTuple):
    """Where a robot was at a second: after so many metres of its way, and at a place ``(2,)``."""

    at_s: float
    gone_m: float
    place_m: Float


class _LineDriven(NamedTuple):
    """A line ``(k, 2)``, and after how many metres its corners are."""

    line_m: Float
    gone_m: Float

    @classmethod
    def of(cls, line_m: Float) -> _LineDriven:
        steps_m = np.hypot(*np.diff(line_m, axis=0).T)
        return cls(line_m, np.append(0.0, np.cumsum(steps_m)))

    def at(self, gone_m: Float) -> Float:
        """Return the places ``(k, 2)`` after so many metres each."""
        return np.column_stack([np.interp(gone_m, self.gone_m, axis) for axis in self.line_m.T])

    def along(self, place_m: Float, least_m: float) -> float:
        """Return after how many metres a place is, `least_m` or more; the nearest."""
        end_m = max(float(self.gone_m[-1]), least_m)
        gone_m = np.append(np.arange(least_m, end_m, _STEP_M), end_m)
        away_m = np.hypot(*(self.at(gone_m) - place_m).T) + _NEARER * (gone_m - least_m)
        return float(gone_m[np.argmin(away_m)])


def _between(
    a: _Knot, b: _Knot, way: _LineDriven, heading: float
) -> Iterator[tuple[float, tuple[float, float], float]]:
    """Yield seconds, place and heading of an even move, straight unless the way is not.

    `heading` is that of one who stands.
    """
    long_s, across_m = b.at_s - a.at_s, b.place_m - a.place_m
    if long_s <= 0.0:
        return
    at_s = np.arange(a.at_s, b.at_s, _EVERY_S)
    is_straight = b.gone_m - a.gone_m - np.hypot(*across_m) <= STRAY_M
    if not is_straight:
        corners_m = way.gone_m[(way.gone_m > a.gone_m) & (way.gone_m < b.gone_m)]
        corners_s = np.interp(corners_m, [a.gone_m, b.gone_m], [a.at_s, b.at_s])
        at_s = np.unique(np.concatenate([at_s, corners_s]))
    share = ((np.append(at_s, b.at_s) - a.at_s) / long_s)[:, None]
    if is_straight:
        places_m = a.place_m + share * across_m
    else:
        gone_m = a.gone_m + share[:, 0] * (b.gone_m - a.gone_m)
        ends_m = way.at(np.array([a.gone_m, b.gone_m]))
        off_m = a.place_m - ends_m[0] + share * (across_m - (ends_m[1] - ends_m[0]))
        places_m = way.at(gone_m) + off_m
    for k, (dx, dy) in enumerate(np.diff(places_m, axis=0).tolist()):
        heading = heading if np.hypot(dx, dy) < _STANDS_M else float(np.arctan2(dy, dx))
        x, y = places_m[k].tolist()
        yield float(at_s[k]), (x, y), heading
