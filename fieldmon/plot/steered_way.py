"""The way of a robot that cannot turn on the spot: arcs and shunts at the corners of its line."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.drive.pursuit import at_length, stretches, turn_of

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.spatial import cKDTree
    from shapely.geometry.base import BaseGeometry

    Float = NDArray[np.float64]

# a corner softer than this is driven without a turn of its own
_SOFT_RAD = math.radians(20.0)
_MOST_ARCS = 9
# a change of gear costs as much as so many metres
_SHUNT_M = 1.5
_STEP_M = 0.05
# a robot's outline is looked at so often on its way to a turn and from it
_LOOKS_M = 0.2
_NO_WAY_M = 0.02
# an arc is known so far beyond its end
_BEYOND_M = 1.0


class Piece(NamedTuple):
    """A part of a way that is driven in one gear.

    Parameters
    ----------
    line_m
        ``(k, 2)`` of the middle of the driven axle.
    forward
        Whether it is driven ahead.
    bend
        How its wheels stand where it begins: 1 over the radius, 1/m, to the left above 0.
    on_m
        ``(j, 2)`` how it would go on beyond its end, to be aimed at; None: straight on.
    """

    line_m: Float
    forward: bool
    bend: float = 0.0
    on_m: Float | None = None

    def __repr__(self) -> str:
        return f"<Piece {'ahead' if self.forward else 'back'}, {_length(self.line_m):.2f} m>"


class TurningRoom(NamedTuple):
    """What a robot needs to turn, and what stands in its way.

    Parameters
    ----------
    radius_m
        Of its least turn, at the middle of the driven axle.
    corners_m
        ``(4, 2)`` of its outline, as it stands at the origin and heads along x.
    plants
        Where plants stand, as a tree.
    apart_m
        How far its outline must keep off the middle of plants.
    area
        In which the middle of its driven axle stays when it turns; None: anywhere.
    """

    radius_m: float
    corners_m: Float
    plants: cKDTree
    apart_m: float
    area: BaseGeometry | None = None

    def __repr__(self) -> str:
        return f"<TurningRoom of {2 * self.radius_m:.1f} m>"

    def holds(self, line_m: Float) -> bool:
        """Tell whether places ``(k, 2)`` lie in its area, or their first already does not."""
        if self.area is None:
            return True
        inside = shapely.intersects_xy(self.area, line_m[:, 0], line_m[:, 1])
        return bool(inside.all() or not inside[0])

    def allows(self, line_m: Float, yaw: Float) -> bool:
        """Tell whether a robot that stands at places ``(k, 2)``, heading so, touches nothing."""
        near = self.plants.query_ball_point(
            line_m.mean(axis=0), float(np.ptp(line_m, axis=0).max()) + 4.0 + self.apart_m
        )
        if not near:
            return True
        cos, sin = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
        x, y = self.corners_m.T
        outline = np.stack(
            [line_m[:, :1] + cos * x - sin * y, line_m[:, 1:] + sin * x + cos * y], axis=2
        )
        swept = shapely.union_all(shapely.polygons(outline))
        posts = shapely.multipoints(self.plants.data[near])
        return bool(shapely.distance(swept, posts) >= self.apart_m)


class _Turn(NamedTuple):
    """A turn at a corner: where it begins and ends, metres along its axes from the corner."""

    begins_m: float
    ends_m: float
    arcs: list[Piece]
    yaw: float
    cost_m: float


def way_of(line_m: Float, yaw: float, room: TurningRoom) -> tuple[list[Piece], Float | None]:
    """Return the way along a line of a robot that heads so, and the corner that has no room.

    At a corner it takes the shortest of: one arc; three, five, seven or nine arcs ahead and back in
    turn; the same with the last one back, to go on backwards. Which of them touch no plant is
    tried with the robot's outline. Where none fits the way ends.

    Examples
    --------
    >>> import numpy as np
    >>> from scipy.spatial import cKDTree
    >>> from fieldmon.drive.turning_circle import TurningRoom, way_of
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
            turn = _best_turn(stretch[0], self._yaw, error, self._room)
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
        ends_m = _length(line) + (beyond_m if self._forward else -beyond_m)
        if abs(ends_m - self._from_m) < _NO_WAY_M:
            return
        low, high = sorted((self._from_m, ends_m))
        length = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
        inner = line[(length > low + 1e-6) & (length < high - 1e-6)]
        part = np.concatenate([[at_length(line, low)], inner, [at_length(line, high)]])
        along = ends_m > self._from_m
        self.pieces.append(Piece(part if along else part[::-1], self._forward == along))


def _best_turn(corner: Float, yaw: float, error: float, room: TurningRoom) -> _Turn | None:
    """Return the cheapest turn at a corner that has room; None: no turn has."""
    ways = [
        _turn(corner, yaw, total, (arcs, first), room.radius_m)
        for total in (error, turn_of(error + math.pi))
        for arcs in range(1, _MOST_ARCS + 1)
        for first in (1, -1)
    ]
    for way in sorted(ways, key=lambda one: one.cost_m):
        if _fits(corner, yaw, way, room):
            return way
    return None


def _turn(
    corner: Float, yaw: float, total: float, shunts: tuple[int, int], radius_m: float
) -> _Turn:
    """Return a turn by an angle in so many arcs, the first in a gear, each the other way back."""
    arcs, first = shunts
    bend, each = math.copysign(1.0, total), total / arcs
    at, heading, gear, pieces = np.zeros(2), yaw, first, []
    for _ in range(arcs):
        n = max(2, math.ceil(abs(each) * radius_m / (_STEP_M * max(1.0, radius_m))))
        beyond = n + math.ceil(n * _BEYOND_M / (abs(each) * radius_m))
        angles = heading + each * np.arange(beyond + 1) / n
        side = bend * gear * radius_m
        places = at + side * (_left(np.array([heading])) - _left(angles))
        line = places[: n + 1]
        pieces.append(Piece(line, gear > 0, side / radius_m**2, places[n + 1 :]))
        at, heading, gear = line[-1], heading + each, -gear
    # it begins on the axis it comes by and ends on the one it leaves by
    come, leave = (np.array([math.cos(a), math.sin(a)]) for a in (yaw, yaw + total))
    begins_m, ends_m = np.linalg.solve(np.stack([come, -leave], axis=1), -at).tolist()
    by = corner + begins_m * come
    moved = [one._replace(line_m=one.line_m + by, on_m=one.on_m + by) for one in pieces]
    cost = abs(total) * radius_m + max(begins_m, 0.0) * 2 + max(-ends_m, 0.0) * 2
    return _Turn(begins_m, ends_m, moved, turn_of(yaw + total), cost + _SHUNT_M * (arcs - 1))


def _fits(corner: Float, yaw: float, turn: _Turn, room: TurningRoom) -> bool:
    """Tell whether a turn touches no plant, the ways from the corner and to it included."""
    come, leave = (np.array([math.cos(a), math.sin(a)]) for a in (yaw, turn.yaw))
    lines, yaws = [], []
    for far_m, axis, heads in ((turn.begins_m, come, yaw), (turn.ends_m, leave, turn.yaw)):
        along = np.linspace(0.0, far_m, 2 + int(abs(far_m) / _LOOKS_M))
        lines.append(corner + along[:, None] * axis)
        yaws.append(np.full(len(along), heads))
    heading = yaw
    for arc in turn.arcs:
        turned = arc.bend * _length(arc.line_m) * (1.0 if arc.forward else -1.0)
        lines.append(arc.line_m)
        yaws.append(heading + turned * np.linspace(0.0, 1.0, len(arc.line_m)))
        heading += turned
    line = np.concatenate(lines)
    return room.holds(line) and room.allows(line, np.concatenate(yaws))


def _left(angle: Float) -> Float:
    """Return the unit vectors ``(k, 2)`` to the left of headings."""
    return np.stack([-np.sin(angle), np.cos(angle)], axis=1)


def _heading(step_m: Float) -> float:
    (a, b), (c, d) = step_m.tolist()
    return math.atan2(d - b, c - a)


def _length(line_m: Float) -> float:
    return float(np.hypot(*np.diff(line_m, axis=0).T).sum())
