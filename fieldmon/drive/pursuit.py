"""Along a line by pure pursuit: ahead or backwards, turning on the spot where the line does."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.plot.steered_way import GATHERS_M_S2, at_length, stretches
from fieldmon.plot.turning import turn_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]

_AIMED_RAD = 0.02
_LOOK_AHEAD_M = 0.6
#: how near the end of a stretch counts as there
REACH_M = 0.03
_TURN_GAIN = 3.0
_SLOWEST_M_S = 0.03


class Pace(NamedTuple):
    """How fast a robot drives, gathers speed and turns.

    Parameters
    ----------
    speed_m_s, turn_rad_s
        At most.
    gathers_m_s2
        Speed gained or lost in a second.
    """

    speed_m_s: float
    turn_rad_s: float = 1.2
    gathers_m_s2: float = GATHERS_M_S2


class Whole:
    """The whole of a way, from which a robot strays."""

    _whole: shapely.Geometry | None

    def off_m(self, xy_m: tuple[float, float]) -> float:
        """Return how far a place is from the way, its turns included."""
        if self._whole is None:
            return 0.0
        return float(shapely.distance(self._whole, shapely.points(xy_m)))


class Pursuit(Whole):
    """Follows one line from its first point to its last, and stops there.

    A robot with two driven wheels drives as well backwards: it turns a right angle at most.

    Parameters
    ----------
    line_m
        ``(k, 2)``, two points or more.
    pace
        How fast.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.drive.pursuit import Pace, Pursuit
    >>> drive = Pursuit(np.array([[0.0, 0.0], [2.0, 0.0]]), Pace(0.5))
    >>> drive.command((0.0, 0.0), yaw=0.0, v=0.0, dt=0.05)
    (0.025, 0.0)
    """

    def __init__(self, line_m: Float, pace: Pace) -> None:
        self._pace, self._stretches = pace, [LineToFollow(one) for one in stretches(line_m)]
        self._k, self._aimed = 0, False
        self._whole = shapely.LineString(line_m) if len(line_m) > 1 else None

    @property
    def done(self) -> bool:
        """Whether the robot stands at the end of the line."""
        return self._k >= len(self._stretches)

    def command(
        self, xy_m: tuple[float, float], yaw: float, v: float, dt: float
    ) -> tuple[float, float]:
        """Return the speed (below 0: backwards) and the turn, radians a second, for a step.

        Parameters
        ----------
        xy_m, yaw
            Where the robot believes to be, and where it points.
        v
            Its speed now.
        dt
            Seconds of the step.
        """
        if self.done:
            return 0.0, 0.0
        line = self._stretches[self._k]
        gone_m, left_m = line.place(xy_m)
        if not self._aimed:
            ahead = line.line_m[1] - line.line_m[0]
            error = self._to_axis(math.atan2(ahead[1], ahead[0]) - yaw)
            if abs(error) > _AIMED_RAD:
                most = self._pace.turn_rad_s
                return 0.0, max(-most, min(most, _TURN_GAIN * error))
            self._aimed = True
            self._gear = 1.0 if self._forward else -1.0
        if left_m < REACH_M:
            self._k, self._aimed = self._k + 1, False
            return 0.0, 0.0
        return self._along(line, (gone_m, left_m), (*xy_m, yaw), abs(v), dt)

    def _along(
        self,
        line: LineToFollow,
        place: tuple[float, float],
        pose: tuple[float, float, float],
        v: float,
        dt: float,
    ) -> tuple[float, float]:
        gone_m, left_m = place
        x, y, yaw = pose
        aim = line.aim(gone_m + _LOOK_AHEAD_M)
        heading = yaw if self._gear > 0 else yaw + math.pi
        alpha = turn_of(math.atan2(aim[1] - y, aim[0] - x) - heading)
        limit = math.sqrt(2.0 * self._pace.gathers_m_s2 * max(left_m - REACH_M / 2, 0.0))
        faster = v + self._pace.gathers_m_s2 * dt
        speed = min(self._pace.speed_m_s * max(math.cos(alpha), 0.1), limit, faster)
        speed = max(speed, _SLOWEST_M_S if left_m < 0.1 else 0.0)
        most = self._pace.turn_rad_s
        bend = 2.0 * speed * math.sin(alpha) / _LOOK_AHEAD_M
        return self._gear * speed, max(-most, min(most, bend))

    def _to_axis(self, error: float) -> float:
        """Return the smaller turn: to point ahead along the line, or backwards."""
        ahead = turn_of(error)
        self._forward = abs(ahead) <= math.pi / 2 + _AIMED_RAD
        return ahead if self._forward else turn_of(error + math.pi)


class LineToFollow:
    """A line, and how far along it a robot is that only goes on.

    Parameters
    ----------
    line_m
        ``(k, 2)``, two points or more, no two the same.
    on_m
        ``(j, 2)`` how it would go on beyond its end, to be aimed at; None: straight on.
    """

    def __init__(self, line_m: Float, on_m: Float | None = None) -> None:
        self.line_m = line_m
        self._length = np.hypot(*np.diff(line_m, axis=0).T)
        self._before = np.append(0.0, np.cumsum(self._length))
        self._from = 0
        self._aims = line_m if on_m is None else np.concatenate([line_m, on_m])

    def place(self, xy_m: tuple[float, float]) -> tuple[float, float]:
        """Return how far along it the robot is, and how far it has yet."""
        line, length, best = self.line_m, self._length, (math.inf, 0.0)
        for i in range(self._from, min(self._from + 4, len(line) - 1)):
            ux, uy = (line[i + 1] - line[i]) / length[i]
            dx, dy = xy_m[0] - line[i, 0], xy_m[1] - line[i, 1]
            along, off = dx * ux + dy * uy, ux * dy - uy * dx
            low = -1e9 if i == 0 else 0.0
            high = 1e9 if i == len(line) - 2 else float(length[i])
            beyond = along - max(low, min(high, along))
            if math.hypot(beyond, off) < best[0] - 1e-9:
                best = (math.hypot(beyond, off), float(self._before[i]) + along)
                self._from = i
        return best[1], float(self._before[-1]) - best[1]

    def aim(self, gone_m: float) -> tuple[float, float]:
        """Return the point so far along it, or beyond its end."""
        return at_length(self._aims, gone_m)
