"""How a robot turns that cannot turn on the spot: by an arc, or by arcs ahead and back in turn."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.spatial import cKDTree
    from shapely.geometry.base import BaseGeometry

    Float = NDArray[np.float64]

_MOST_ARCS = 9
# a change of gear costs as much as so many metres
_SHUNT_M = 1.5
_STEP_M = 0.05
# a robot's outline is looked at so often on its way to a turn and from it
_LOOKS_M = 0.2
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
        return f"<Piece {'ahead' if self.forward else 'back'}, {length_m(self.line_m):.2f} m>"

    def moved(self, yaw: float, by_m: Float) -> Piece:
        """Return the same turned about the origin, then shifted."""
        on_m = None if self.on_m is None else _turned(self.on_m, yaw) + by_m
        return self._replace(line_m=_turned(self.line_m, yaw) + by_m, on_m=on_m)


class TurningRoom(NamedTuple):
    """What a robot needs to turn, and what stands in its way.

    Parameters
    ----------
    radius_m
        Of its least turn, at the middle of the driven axle.
    corners_m
        ``(4, 2)`` of its outline, a rectangle, as it stands at the origin and heads along x.
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
        (back, right), (front, left) = self.corners_m.min(axis=0), self.corners_m.max(axis=0)
        reach_m = float(np.hypot(*np.abs(self.corners_m).max(axis=0))) + self.apart_m
        middle = (line_m.min(axis=0) + line_m.max(axis=0)) / 2
        near = self.plants.query_ball_point(
            middle, float(np.hypot(*(line_m - middle).T).max()) + reach_m
        )
        if not near:
            return True
        away = self.plants.data[near] - line_m[:, None]
        cos, sin = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
        ahead = cos * away[:, :, 0] + sin * away[:, :, 1]
        beside = cos * away[:, :, 1] - sin * away[:, :, 0]
        off_x = np.maximum(np.maximum(back - ahead, ahead - front), 0.0)
        off_y = np.maximum(np.maximum(right - beside, beside - left), 0.0)
        return bool(np.hypot(off_x, off_y).min() >= self.apart_m)


class Turn(NamedTuple):
    """A turn at a corner.

    Parameters
    ----------
    begins_m, ends_m
        Where it begins and ends, metres from the corner along the way as the robot heads.
    arcs
        What is driven.
    yaw
        How the robot heads at the end.
    cost_m
        What is chosen by: metres, and what changes of gear are worth.
    """

    begins_m: float
    ends_m: float
    arcs: list[Piece]
    yaw: float
    cost_m: float


def best_turn(
    corner: Float, yaw: float, error: float, room: TurningRoom, *, ahead: bool = True
) -> Turn | None:
    """Return the cheapest turn at a corner that has room; None: no turn has.

    Parameters
    ----------
    corner
        ``(2,)`` where it is.
    yaw
        How the robot heads as it comes.
    error
        By how much the way turns there, radians: what lies ahead of the robot to what lies ahead
        on the way, to the left above 0.
    ahead
        Whether it comes ahead; else backwards.

    Examples
    --------
    >>> import numpy as np
    >>> from scipy.spatial import cKDTree
    >>> from fieldmon.plot.turning import TurningRoom, best_turn
    >>> box = np.array([[-0.2, -0.3], [0.6, -0.3], [0.6, 0.3], [-0.2, 0.3]])
    >>> room = TurningRoom(1.0, box, cKDTree(np.array([[9.0, 9.0]])), 0.3)
    >>> best_turn(np.zeros(2), 0.0, np.pi / 2, room).arcs
    [<Piece ahead, 1.57 m>]
    """
    for turn in _turns(error, room.radius_m, ahead=ahead):
        if _fits(corner, yaw, turn, room):
            arcs = [one.moved(yaw, corner) for one in turn.arcs]
            return turn._replace(arcs=arcs, yaw=turn_of(yaw + turn.yaw))
    return None


@lru_cache(maxsize=64)
def _turns(error: float, radius_m: float, *, ahead: bool) -> tuple[Turn, ...]:
    """Return all turns at a corner of an angle, the cheapest first; it is the origin, yaw 0."""
    turns = [
        _turn(total, (arcs, first), radius_m, (ahead, on))
        for total, on in ((error, True), (turn_of(error + math.pi), False))
        for arcs in range(1, _MOST_ARCS + 1)
        for first in (1, -1)
    ]
    return tuple(sorted(turns, key=lambda one: one.cost_m))


def _turn(total: float, shunts: tuple[int, int], radius_m: float, legs: tuple[bool, bool]) -> Turn:
    """Return a turn by an angle in so many arcs, the first in a gear, each the other way back.

    `legs` are whether the robot comes ahead, and whether it goes on ahead.
    """
    arcs, first = shunts
    bend, each = math.copysign(1.0, total), total / arcs
    at, heading, gear, pieces = np.zeros(2), 0.0, first, []
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
    come, leave = (np.array([math.cos(a), math.sin(a)]) for a in (0.0, total))
    begins_m, ends_m = np.linalg.solve(np.stack([come, -leave], axis=1), -at).tolist()
    moved = [one.moved(0.0, begins_m * come) for one in pieces]
    # what lies beyond the corner is driven twice
    beyond_m = begins_m if legs[0] else -begins_m, -ends_m if legs[1] else ends_m
    gears = [legs[0], *(one.forward for one in pieces), legs[1]]
    changes = sum(before != after for before, after in pairwise(gears))
    cost = abs(total) * radius_m + 2.0 * sum(max(m, 0.0) for m in beyond_m)
    return Turn(begins_m, ends_m, moved, total, cost + _SHUNT_M * changes)


def _fits(corner: Float, yaw: float, turn: Turn, room: TurningRoom) -> bool:
    """Tell whether a turn touches no plant, the ways from the corner and to it included."""
    come, leave = (np.array([math.cos(a), math.sin(a)]) for a in (0.0, turn.yaw))
    lines, yaws = [], []
    for far_m, axis, heads in ((turn.begins_m, come, 0.0), (turn.ends_m, leave, turn.yaw)):
        along = np.linspace(0.0, far_m, 2 + int(abs(far_m) / _LOOKS_M))
        lines.append(along[:, None] * axis)
        yaws.append(np.full(len(along), heads))
    heading = 0.0
    for arc in turn.arcs:
        turned = arc.bend * length_m(arc.line_m) * (1.0 if arc.forward else -1.0)
        lines.append(arc.line_m)
        yaws.append(heading + turned * np.linspace(0.0, 1.0, len(arc.line_m)))
        heading += turned
    line = _turned(np.concatenate(lines), yaw) + corner
    return room.holds(line) and room.allows(line, np.concatenate(yaws) + yaw)


def turn_of(angle: float) -> float:
    """Return an angle as a turn of half a circle at most."""
    return math.atan2(math.sin(angle), math.cos(angle))


def length_m(line_m: Float) -> float:
    """Return how long a line ``(k, 2)`` is."""
    return float(np.hypot(*np.diff(line_m, axis=0).T).sum())


def _turned(line_m: Float, yaw: float) -> Float:
    """Return points ``(k, 2)`` turned about the origin."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y = line_m.T
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)


def _left(angle: Float) -> Float:
    """Return the unit vectors ``(k, 2)`` to the left of headings."""
    return np.stack([-np.sin(angle), np.cos(angle)], axis=1)
