"""Where a robot that cannot turn on the spot has room to turn at row ends, and what it takes."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.plot.steered_way import CORNER_S, driven_s, way_of
from fieldmon.plot.turning import TurningRoom, best_turn, turn_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.turning import Piece

    Float = NDArray[np.float64]
    Mask = NDArray[np.bool_]

# a steered robot's driven axle is its rear one: so much of its length from its rear (our choice)
_REAR = 1.0 / 6.0
_SAME_M = 1e-6
# what a row change takes is a mean over the ends of so many rows, evenly spread
_SAMPLED_ROWS = 60
#: to the right and to the left of a lane, as it runs to its high end
SIDES = (-1.0, 1.0)


class TurningCircle(NamedTuple):
    """What a robot that cannot turn on the spot needs.

    Parameters
    ----------
    radius_m
        Of its least turn, at the middle of the driven axle.
    width_m, length_m
        Its size.
    apart_m
        How far its outline must keep off the middle of plants.
    """

    radius_m: float
    width_m: float
    length_m: float
    apart_m: float

    def room(self, grid: PlantGrid) -> TurningRoom:
        """Return its room among the plants of a plot, whose boundary its axle stays within."""
        rear, side = -_REAR * self.length_m, self.width_m / 2
        front = rear + self.length_m
        corners = np.array([[rear, -side], [front, -side], [front, side], [rear, side]])
        shapely.prepare(grid.ground_m)
        return TurningRoom(self.radius_m, corners, grid.tree, self.apart_m, grid.ground_m)


class EndTurns(NamedTuple):
    """How a robot turns from the lanes of a plot into the headlands, and back.

    Parameters
    ----------
    room
        ``(r, 2, 2)`` whether it can at the low and the high end of each row's lane, to the right
        and to the left of the lane, as it runs to its high end.
    ways
        How it changes to the next lane at some hundred of these ends, if it can: pieces.
    change_m
        How long such a change is by its corners.
    of
        Its room.
    """

    room: Mask
    ways: tuple[list[Piece], ...]
    change_m: float
    of: TurningRoom

    def __repr__(self) -> str:
        return f"<EndTurns: room at {int(self.room.any(axis=2).sum())} of {self.room[..., 0].size}>"

    def row_change_s(self, speed_m_s: float) -> float | None:
        """Return what a change to the next lane takes on average, beside its metres by corners.

        None where no change was found.
        """
        if not self.ways:
            return None
        each_s = [driven_s(way, self.of, speed_m_s) for way in self.ways]
        change_s = float(np.mean(each_s)) - self.change_m / speed_m_s + 2.0 * CORNER_S
        return max(change_s, 0.0)


def lane_ends(grid: PlantGrid) -> tuple[Float, Float]:
    """Return the low and the high end of each row's lane, and how it runs there, ``(r, 2, 2)``.

    Both are in metres; the second has a length of 1 and points to the high end.
    """
    if grid.aisles_m is None or grid.aisle is None:
        y = np.broadcast_to(grid.lane_y_m[:, None], grid.lane_x_m.shape)
        ahead = np.broadcast_to([1.0, 0.0], (grid.n_rows, 2, 2))
        return np.stack([grid.lane_x_m, y], axis=2), ahead
    aisle, at_m = np.repeat(grid.aisle, 2), grid.lane_x_m.ravel()
    points = grid.aisles_m.points(aisle, at_m).reshape(-1, 2, 2)
    return points, grid.aisles_m.ahead(aisle, at_m).reshape(-1, 2, 2)


@lru_cache(maxsize=8)
def end_turns(grid: PlantGrid, circle: TurningCircle) -> EndTurns:
    """Return where such a robot has room to turn between lanes and headlands of a plot."""
    room = circle.room(grid)
    points, ahead = lane_ends(grid)
    # so far in a lane that no turn begins there
    deep_m = 3.0 * circle.radius_m + 2.0 * circle.length_m
    rooms, ways = np.zeros((grid.n_rows, 2, 2), np.bool_), []
    every = math.ceil(grid.n_rows / _SAMPLED_ROWS)
    known: dict[tuple[int, ...], tuple[bool, ...]] = {}
    for row in range(grid.n_rows):
        for end in range(2):
            point, out = points[row, end], ahead[row, end] * (1.0 if end else -1.0)
            # rows on either side of an aisle have the same lane
            key = (end, *np.round(np.append(point, out) / _SAME_M).astype(np.int64).tolist())
            if key not in known:
                known[key] = tuple(_turns_to(point, out, side, end, room) for side in SIDES)
                for side in np.flatnonzero(known[key]) if row % every == 0 else ():
                    to = grid.row_spacing_m * _to_side(out, SIDES[side], end)
                    line = np.stack([-deep_m * out, 0.0 * out, to, to - deep_m * out]) + point
                    way, stuck = way_of(line, math.atan2(out[1], out[0]), room)
                    if stuck is None:
                        ways.append(way)
            rooms[row, end] = known[key]
    return EndTurns(rooms, tuple(ways), 2.0 * deep_m + grid.row_spacing_m, room)


def _turns_to(point: Float, out: Float, side: float, end: int, room: TurningRoom) -> bool:
    """Tell whether a robot can turn out of a lane to a side, and come from there into it."""
    to = _to_side(out, side, end)
    yaw = math.atan2(out[1], out[0])
    turn = turn_of(math.atan2(to[1], to[0]) - yaw)
    if best_turn(point, yaw, turn, room) is None:
        return False
    return best_turn(point, math.atan2(-to[1], -to[0]), -turn, room) is not None


def _to_side(out: Float, side: float, end: int) -> Float:
    """Return where a side of a lane is, as it runs to its high end, for who leaves it there."""
    left: Float = np.array([-out[1], out[0]]) * (1.0 if end else -1.0)
    return side * left
