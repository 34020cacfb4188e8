"""The way of a robot that cannot turn on the spot: arcs and shunts at the corners of its line."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.plot.turning import Piece, TurningRoom, best_turn, length_m, turn_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]

# a corner softer than this is driven without a turn of its own
_SOFT_RAD = math.radians(20.0)
_NO_WAY_M = 0.02
#: bends are driven at so much of the speed, before a robot sets out it steers for so long, and so
#: much speed it gains or loses in a second
IN_BENDS, STEERS_S, GATHERS_M_S2 = 0.6, 0.5, 0.5
#: and each corner takes so much more, as it straightens up (simulated drives, see
#: docs/physical_simulation)
CORNER_S = 0.3


def way_of(line_m: Float, yaw: float, room: TurningRoom) -> tuple[list[Piece], Float | None]:
    """Return the way along a line of a robot that heads so, and the corner that has no room.

    At a corner it takes the shortest of: one arc; three, five, seven or nine arcs ahead and back in
    turn; the same with the last one back, to go on backwards. Which of them touch no plant is
    tried with the robot's outline. Where none fits the way ends.

    Examples
    --------
    >>> import numpy as np
    >>> from scipy.spatial import cKDTree
    >>> from fieldmon.plot.steered_way import way_of
    >>> from fieldmon.plot.turning import TurningRoom
    >>> box = np.array([[-0.2, -0.3], [0.6, -0.3], [0.6, 0.3], [-0.2, 0.3]])
    >>> room = TurningRoom(1.0, box, cKDTree(np.array([[9.0, 9.0]])), 0.3)
    >>> way_of(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]), 0.0, room)
    ([<Piece ahead, 9.57 m>], None)
    """
    way = _Way(yaw, room)
    for stretch in stretches(line_m):
        if not way.take(stretch):
            return merged(way.pieces), stretch[0]
    way.end(0.0)
    return merged(way.pieces), None


def driven_s(pieces: list[Piece], room: TurningRoom, speed_m_s: float) -> float:
    """Return the seconds that pieces take a simulated robot: bends are slower, gears cost stops.

    Parameters
    ----------
    pieces
        As `way_of` has them.
    room
        Of the robot.
    speed_m_s
        How fast it drives straight on.
    """
    bends_m = straight_m = 0.0
    for one in pieces:
        bend_m = room.radius_m * _bends_rad(one)
        bends_m += bend_m
        straight_m += length_m(one.line_m) - bend_m
    stop_s = STEERS_S + IN_BENDS * speed_m_s / GATHERS_M_S2
    return (bends_m / IN_BENDS + straight_m) / speed_m_s + (len(pieces) - 1) * stop_s


def is_straight(piece: Piece) -> bool:
    """Tell whether a piece has no bend to speak of."""
    return _bends_rad(piece) < _SOFT_RAD


def _bends_rad(piece: Piece) -> float:
    """Return by how much a piece bends in all, to either side."""
    heading = np.unwrap(np.arctan2(*np.diff(piece.line_m, axis=0).T[::-1]))
    return float(np.abs(np.diff(heading)).sum())


def merged(pieces: list[Piece]) -> list[Piece]:
    """Return pieces with those of one gear that follow each other as one."""
    kept: list[Piece] = []
    for one in pieces:
        if kept and kept[-1].forward == one.forward:
            line = np.concatenate([kept[-1].line_m, one.line_m[1:]])
            kept[-1] = one._replace(line_m=line, bend=kept[-1].bend)
        else:
            kept.append(one)
    return kept


class _Way:
    """A way in the making: pieces, and the stretch that is driven on until its end is known."""

    def __init__(self, yaw: float, room: TurningRoom) -> None:
        self.pieces: list[Piece] = []
        self._yaw, self._room = yaw, room
        self._line: Float | None = None
        self._from_m, self._forward = 0.0, True

    def take(self, stretch: Float) -> bool:
        """Turn into a stretch, and go on along it; False: there is no room to turn."""
        error, begins_m = turn_of(_heading(stretch[:2]) - self._yaw), 0.0
        if min(abs(error), math.pi - abs(error)) > _SOFT_RAD:
            turn = best_turn(stretch[0], self._yaw, error, self._room, ahead=self._forward)
            if turn is None:
                self.end(0.0)
                return False
            if self._line is None:
                # it stands at the corner: what lies behind it is the stretch it came by
                behind = stretch[0] - [math.cos(self._yaw), math.sin(self._yaw)]
                self._line, self._from_m = np.stack([behind, stretch[0]]), 1.0
            self.end(turn.begins_m)
            self.pieces += turn.arcs
            self._yaw, begins_m = turn.yaw, turn.ends_m
        else:
            self.end(0.0)
        self._forward = abs(turn_of(_heading(stretch[:2]) - self._yaw)) <= math.pi / 2
        self._line, self._from_m = stretch, begins_m if self._forward else -begins_m
        self._yaw = turn_of(_heading(stretch[-2:]) + (0.0 if self._forward else math.pi))
        return True

    def end(self, beyond_m: float) -> None:
        """Drive the stretch to so far ahead of its end, as the robot heads; backwards if less."""
        if self._line is None:
            return
        line = self._line
        ends_m = length_m(line) + (beyond_m if self._forward else -beyond_m)
        if abs(ends_m - self._from_m) < _NO_WAY_M:
            return
        low, high = sorted((self._from_m, ends_m))
        length = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
        inner = line[(length > low + 1e-6) & (length < high - 1e-6)]
        part = np.concatenate([[at_length(line, low)], inner, [at_length(line, high)]])
        along = ends_m > self._from_m
        self.pieces.append(Piece(part if along else part[::-1], self._forward == along))


def _heading(step_m: Float) -> float:
    (a, b), (c, d) = step_m.tolist()
    return math.atan2(d - b, c - a)


def stretches(line_m: Float) -> list[Float]:
    """Return a line cut at its hard corners; points of no way are left out."""
    line = np.asarray(line_m, float)
    line = line[np.append(True, np.hypot(*np.diff(line, axis=0).T) > 1e-3)]
    if len(line) < 2:
        return []
    step = np.diff(line, axis=0)
    heading = np.arctan2(step[:, 1], step[:, 0])
    turn = np.abs((np.diff(heading) + np.pi) % (2 * np.pi) - np.pi)
    cuts = [0, *(np.flatnonzero(turn > _SOFT_RAD) + 1).tolist(), len(line) - 1]
    return [line[a : b + 1] for a, b in pairwise(cuts)]


def at_length(line: Float, gone_m: float) -> tuple[float, float]:
    """Return a point so far along a line, or straight on beyond its end."""
    step = np.diff(line, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    before = np.append(0.0, np.cumsum(length))
    i = int(np.clip(np.searchsorted(before, gone_m, "right") - 1, 0, len(length) - 1))
    x, y = line[i] + step[i] / length[i] * (gone_m - before[i])
    return float(x), float(y)
