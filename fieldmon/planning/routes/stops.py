"""From a drive on a ladder to stops in order on the plot itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.planning.routes.frontier import (
    END_LEFT,
    END_LEFT_AND,
    END_RIGHT,
    END_RIGHT_AND,
    FROM_BOTH,
    FROM_LEFT,
    FROM_RIGHT,
    GATE_CLOSED,
    GATE_OPEN,
    LEFT_BACK,
    ONCE,
    RIGHT_BACK,
    TWICE,
)
from fieldmon.planning.routes.passes import Passes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.routes.priced import Drawn, Priced
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_HOME = (-1, 0)
_THROUGH = (ONCE, TWICE, LEFT_BACK, RIGHT_BACK)
_FROM_LEFT = (FROM_LEFT, FROM_BOTH, END_RIGHT_AND)
_FROM_RIGHT = (FROM_RIGHT, FROM_BOTH, END_LEFT_AND)


def stops_of(priced: Priced, drawn: Drawn, price: Float, robot: Robot) -> Int:
    """Return the plants of a drive on the ladder in the order of one way to drive it."""
    path = _passes(priced, drawn, robot).walk(_HOME)
    chosen = _Chosen(priced, drawn, price, robot)
    stops: list[Int] = []
    for before, node in zip([None, *path], path, strict=False):
        if node[1] == 2:
            stops.append(chosen.end(node[0]))
            continue
        if before is not None and before[0] == node[0] and node != _HOME:
            stops.append(chosen.through(node[0], up=node[1] == 1))
        stops.append(chosen.excursion(*node))
    return np.concatenate(stops) if stops else np.empty(0, np.int64)


class _Chosen:
    """The plants of each aisle that are visited, each handed out once."""

    def __init__(self, priced: Priced, drawn: Drawn, price: Float, robot: Robot) -> None:
        self.priced, self.drawn, self.price, self.robot = priced, drawn, price, robot
        self.done: set[tuple[int, int]] = set()

    def _plants(self, k: int, side: int) -> Int:
        """Return those reached from the left (0) or the right (1), from the left on."""
        # the gate's ways are of its stubs
        if (k, side) in self.done or k == self.priced.ladder.gate:
            return np.empty(0, np.int64)
        self.done.add((k, side))
        ladder, cut = self.priced.ladder, self.drawn.cut[k]
        first, end = ladder.start[k], ladder.start[k + 1]
        place = np.arange(first, cut[0]) if side == 0 else np.arange(cut[1], end)
        sides = int(cut[2 + side])
        good = self.priced.reward[place] > self.price[k] * self.priced.costs.stop_s
        good &= np.where(ladder.upper[place], sides & 2, sides & 1) > 0
        chosen: Int = place[good]
        return chosen

    def excursion(self, k: int, side: int) -> Int:
        """Return the plants of an aisle that is entered and left by one end."""
        if k < 0 or self.drawn.way[k] not in (_FROM_LEFT, _FROM_RIGHT)[side]:
            return np.empty(0, np.int64)
        if k in self.priced.parts:
            return self._of_part(k, ends=False)
        place = self._plants(k, side)
        if self.priced.ladder.hangs[k]:
            # both ends are one place: what is reached from either
            place = np.concatenate([place, self._plants(k, 1 - side)])
        place = place if side == 0 else place[::-1]
        upper = self.priced.ladder.upper[place]
        if not upper.all() and upper.any():
            # one side on the way in, the other on the way out
            place = np.concatenate([place[upper], place[~upper][::-1]])
        return self.priced.ladder.plant[place]

    def _of_part(self, k: int, *, ends: bool) -> Int:
        """Return the plants of a part that hangs on the ladder."""
        if (k, 0) in self.done:
            return np.empty(0, np.int64)
        self.done.add((k, 0))
        return self.priced.parts[k].stops(float(self.price[k]), ends=ends)

    def through(self, k: int, *, up: bool) -> Int:
        """Return the plants of an aisle that is driven from end to end."""
        if self.drawn.way[k] not in _THROUGH:
            return np.empty(0, np.int64)
        return self._in_line(k, self._plants(k, 0), up=up)

    def end(self, k: int) -> Int:
        """Return the plants of an aisle in which the day ends."""
        if k in self.priced.parts:
            return self._of_part(k, ends=True)
        from_left = self.drawn.way[k] in (END_LEFT, END_LEFT_AND)
        place = self._plants(k, 0 if from_left else 1)
        if self.priced.ladder.hangs[k]:
            place = np.sort(np.concatenate([place, self._plants(k, 1 if from_left else 0)]))
        return self._in_line(k, place, up=from_left)

    def _in_line(self, k: int, place: Int, *, up: bool) -> Int:
        """Return plants of both sides as they come, or a side after the other if that is less."""
        ladder, costs = self.priced.ladder, self.priced.costs
        place = place if up else place[::-1]
        upper = ladder.upper[place]
        turns_s = np.count_nonzero(upper[1:] != upper[:-1]) * costs.turn_s
        if turns_s > costs.turn_s + 2.0 * costs.metre_s * ladder.across_m[k]:
            place = np.concatenate([place[upper], place[~upper]])
        return ladder.plant[place]


def _passes(priced: Priced, drawn: Drawn, robot: Robot) -> Passes:
    """Return the passes of a drive as edges between ladder nodes; (k, 2) is an end within k."""
    made = Passes()
    for k, way in enumerate(drawn.way.tolist()):
        for side in range(2):
            made.link((k, side), (k + 1, side), int(drawn.passes[k, side]))
        if k == priced.ladder.gate:
            stubs = (GATE_CLOSED if robot.returns else GATE_OPEN)[way]
            for side in range(2):
                made.link(_HOME, (k, side), stubs[side])
        elif way in _THROUGH:
            made.link((k, 0), (k, 1), 2 if way == TWICE else 1)
            if way in (LEFT_BACK, RIGHT_BACK):
                made.link((k, 1 if way == LEFT_BACK else 0), (k, 2), 1)
        elif way in (END_LEFT, END_LEFT_AND):
            made.link((k, 0), (k, 2), 1)
        elif way in (END_RIGHT, END_RIGHT_AND):
            made.link((k, 1), (k, 2), 1)
    return made
