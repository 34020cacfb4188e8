"""Along pieces of a way by pure pursuit, with a steered axle: ahead, back, and ahead again."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from shapely import MultiLineString

from fieldmon.drive.pursuit import REACH_M, LineToFollow, Whole
from fieldmon.plot.steered_way import IN_BENDS, STEERS_S, is_straight
from fieldmon.plot.turning import turn_of

if TYPE_CHECKING:
    from fieldmon.drive.pursuit import Pace
    from fieldmon.plot.turning import Piece

# a piece with a bend is followed more closely than a straight one, which is driven more calmly
_LOOK_AHEAD_M, _STRAIGHT_M = 0.5, 0.6
_SLOWEST_M_S = 0.03


class SteeredPursuit(Whole):
    """Follows pieces of a way, each in its gear, and stops at the end of each.

    Parameters
    ----------
    pieces
        As `way_of` has them.
    pace
        How fast; turns are as sharp as the wheels allow.
    sharpest
        Bend of the sharpest turn, 1/m.
    """

    def __init__(self, pieces: list[Piece], pace: Pace, sharpest: float) -> None:
        self._pieces, self._pace, self._sharpest = pieces, pace, sharpest
        self._lines = [LineToFollow(one.line_m, one.on_m) for one in pieces]
        self._whole = MultiLineString([one.line_m for one in pieces]) if pieces else None
        self._ahead_m = [_STRAIGHT_M if is_straight(one) else _LOOK_AHEAD_M for one in pieces]
        self._k, self._stood_s = 0, 0.0

    @property
    def done(self) -> bool:
        """Whether the robot stands at the end of the way."""
        return self._k >= len(self._pieces)

    def command(
        self, xy_m: tuple[float, float], yaw: float, v: float, dt: float
    ) -> tuple[float, float]:
        """Return the speed (below 0: backwards) and the bend to drive, 1/m, for a step.

        Parameters are those of `Pursuit.command`; the place is the middle of the driven axle.
        """
        if self.done:
            return 0.0, 0.0
        piece, line = self._pieces[self._k], self._lines[self._k]
        gone_m, left_m = line.place(xy_m)
        gear = 1.0 if piece.forward else -1.0
        if left_m < REACH_M:
            self._k, self._stood_s = self._k + 1, 0.0
            return 0.0, 0.0
        aim = np.subtract(line.aim(gone_m + self._ahead_m[self._k]), xy_m)
        heading = yaw if piece.forward else yaw + math.pi
        alpha = turn_of(math.atan2(aim[1], aim[0]) - heading)
        bend = gear * 2.0 * math.sin(alpha) / max(float(np.hypot(*aim)), 0.1)
        bend = max(-self._sharpest, min(self._sharpest, bend))
        if self._stood_s < STEERS_S:
            self._stood_s += dt
            return 0.0, piece.bend or bend
        return gear * self._speed(abs(v), bend, left_m, dt), bend

    def _speed(self, v: float, bend: float, left_m: float, dt: float) -> float:
        # what only corrects noise is no bend
        sharp = min(max(4.0 * abs(bend) / self._sharpest - 1.0, 0.0), 1.0)
        share = 1.0 - (1.0 - IN_BENDS) * sharp
        limit = math.sqrt(2.0 * self._pace.gathers_m_s2 * max(left_m - REACH_M / 2, 0.0))
        faster = v + self._pace.gathers_m_s2 * dt
        speed = min(self._pace.speed_m_s * share, limit, faster)
        return max(speed, _SLOWEST_M_S if left_m < 0.1 else 0.0)
