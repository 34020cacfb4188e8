"""What each way of driving an aisle of a ladder is worth at a price of time.

A plant is worth its reward less its stop; the way to it is paid, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop, loop
from fieldmon.planning.routes.frontier import (
    END_LEFT,
    END_LEFT_AND,
    END_RIGHT,
    END_RIGHT_AND,
    FROM_BOTH,
    FROM_LEFT,
    FROM_RIGHT,
    LEFT_BACK,
    N_WAYS,
    NOTHING,
    ONCE,
    RIGHT_BACK,
    TWICE,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.routes.ladders import Ladder
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

#: less than anything is worth
IMPOSSIBLE = -1e300
# no literals: see `frontier`
_SIDES: Any = np.arange(4)
_NONE, _BOTH = _SIDES[0], _SIDES[3]
_UP_TO_HERE, _FROM_HERE = _SIDES[0], _SIDES[1]
_SAME_PLACE_M = 1e-6


class Costs(NamedTuple):
    """What time is spent on: seconds a metre, a stop, a change of aisle and a turn in one."""

    metre_s: float
    stop_s: float
    change_s: float
    turn_s: float

    @classmethod
    def of(cls, robot: Robot) -> Costs:
        """Return a robot's."""
        return cls(1.0 / robot.speed_m_s, robot.visit_s, robot.row_change_s, robot.turn_180_s)


class LadderRoom(NamedTuple):
    """Room for a sweep: worth ``(e, 12)``, cuts, rewards; the best to every state, its reward.

    `of_side` sums what plants gain and hold on each side, of all and of those passed so far.
    """

    worth: Float
    reward: Float
    cut: Int
    best: Float
    held: Float
    choice: Int
    of_side: Float


@inner_loop
def _put(
    room: LadderRoom, k: int, way: int, what: tuple[float, float], cut: tuple[int, int, int, int]
) -> None:
    """Note a way of driving an aisle if it is worth more than the one known."""
    if what[0] > room.worth[k, way]:
        room.worth[k, way], room.reward[k, way] = what
        for c in range(4):
            room.cut[k, way, c] = cut[c]


@loop
def value_ways(
    ladder: Ladder, reward: Float, costs: Costs, state: tuple[float, bool, bool], room: LadderRoom
) -> None:
    """Work out what each way of driving each aisle is worth at a price.

    `state`: the price; whether each way must be one that can be driven just so (if not, it may be
    worth more than that); and whether each way there is must be valued, though none of its plants
    pays at the price. The best drive of all has no use for such a way, but one that must begin
    there may have no other.
    """
    price, feasible, every = state
    room.worth[:] = IMPOSSIBLE
    room.reward[:] = 0.0
    for k in range(ladder.across_m.size):
        if k != ladder.gate:
            _value_through(ladder, reward, costs, (k, price, feasible), room)
            _value_in(ladder, reward, costs, (k, price, every), room)
            if ladder.hangs[k] > 0:
                _hang(room, k, ladder.hangs[k] - 1)


@inner_loop
def _hang(room: LadderRoom, k: int, side: int) -> None:
    """Let an aisle that hangs on a headland be one way in and out, however it is driven."""
    for into in range(2):
        to = (FROM_LEFT, FROM_RIGHT)[side] if into == 0 else (END_LEFT, END_RIGHT)[side]
        best = to
        for way in range(1, N_WAYS):
            if (way >= END_LEFT) == (into == 1) and room.worth[k, way] > room.worth[k, best]:
                best = way
        worth, held = room.worth[k, best], room.reward[k, best]
        for c in range(4):
            room.cut[k, to, c] = room.cut[k, best, c]
        for way in range(1, N_WAYS):
            if (way >= END_LEFT) == (into == 1):
                room.worth[k, way] = IMPOSSIBLE
        room.worth[k, to], room.reward[k, to] = worth, held


@inner_loop
def _value_through(
    ladder: Ladder, reward: Float, costs: Costs, state: tuple[int, float, bool], room: LadderRoom
) -> None:
    """Value an aisle that is driven from end to end, once or twice, or not at all."""
    k, price, feasible = state
    metre, stop, change = price * costs.metre_s, price * costs.stop_s, price * costs.change_s
    first, end = ladder.start[k], ladder.start[k + 1]
    across = metre * ladder.across_m[k]
    gains_of, held_of, turns, before = room.of_side[0], room.of_side[1], 0, -1
    room.of_side[:] = 0.0
    for i in range(first, end):
        if reward[i] > stop:
            side = 1 if ladder.upper[i] else 0
            gains_of[side] += reward[i] - stop
            held_of[side] += reward[i]
            turns += before >= 0 and before != side
            before = side
    _put(room, k, NOTHING, (0.0, 0.0), (first, end, _NONE, _NONE))
    _put(room, k, ONCE, (-across, 0.0), (first, end, _NONE, _NONE))
    _put(room, k, TWICE, (-2.0 * across, 0.0), (first, end, _NONE, _NONE))
    for side in range(2):
        if gains_of[side] > change:
            worth, cut = gains_of[side] - change, (end, end, side + 1, _NONE)
            _put(room, k, ONCE, (worth - across, held_of[side]), cut)
            _put(room, k, TWICE, (worth - 2.0 * across, held_of[side]), cut)
    if turns == 0:
        return
    gains, held, cut = (
        gains_of[0] + gains_of[1] - change,
        held_of[0] + held_of[1],
        (end, end, _BOTH, _NONE),
    )
    turn = price * costs.turn_s
    _put(room, k, TWICE, (gains - 2.0 * across - min(turn, change), held), cut)
    if feasible:
        worth = gains - across - min(turns * turn, turn + 2.0 * across)
        _put(room, k, ONCE, (worth, held), cut)
    else:
        worth = _once(ladder, reward, (k, stop, metre), (turn, min(turn, change)))
        _put(room, k, ONCE, (worth - change - across, held), cut)
        # one side on the way through, the other on the way back to where the day ends
        worth = gains - across - min(turn, change)
        _put(room, k, LEFT_BACK, (worth, held), cut)
        _put(room, k, RIGHT_BACK, (worth, held), cut)


@inner_loop
def _once(
    ladder: Ladder,
    reward: Float,
    state: tuple[int, float, float],
    turns: tuple[float, float],
) -> float:
    """Return the most that plants on both sides can be worth in one pass through their aisle.

    Between stops on different sides the robot turns, or it drives a stretch three times. The best
    so far is kept for the side of the last stop, for none, and for a stretch driven three times.
    """
    k, stop, metre = state
    turn, least = turns
    lower, upper, free, thrice = IMPOSSIBLE, IMPOSSIBLE, 0.0, IMPOSSIBLE
    i, end, at = ladder.start[k], ladder.start[k + 1], 0.0
    while i < end:
        here, below, above = ladder.in_m[i], 0.0, 0.0
        while i < end and ladder.in_m[i] <= here + _SAME_PLACE_M:
            gain = max(reward[i] - stop, 0.0)
            if ladder.upper[i]:
                above += gain
            else:
                below += gain
            i += 1
        if below + above == 0.0:
            continue
        after = thrice - 2.0 * metre * (here - at)
        free = max(free, thrice)
        new_thrice = max(after, max(free, lower, upper) - least) + below + above
        # the last stop here is on the lower side, or on the upper
        new_lower = max(max(lower, free) + below, upper + below - turn)
        new_lower = max(new_lower, max(upper, free) + above + below - turn)
        new_upper = max(max(upper, free) + above, lower + above - turn)
        new_upper = max(new_upper, max(lower, free) + below + above - turn)
        lower, upper = max(lower, new_lower), max(upper, new_upper)
        thrice, at = new_thrice, here
    return max(lower, upper, free, thrice)


@inner_loop
def _left_if_better(
    best: tuple[float, float, int, int], what: tuple[float, float], end: int, sides: int
) -> tuple[float, float, int, int]:
    """Return the best of the plants on the left: worth, reward, up to which plant, which sides."""
    if what[0] > best[0]:
        return what[0], what[1], end, sides
    return best


@inner_loop
def _better_left(
    left: tuple[tuple[float, float, int, int], tuple[float, float, int, int]],
    what: tuple[float, float, float],
    end: int,
    sides: int,
) -> tuple[tuple[float, float, int, int], tuple[float, float, int, int]]:
    """Return the best of the plants on the left, driven back and ended in, with some more."""
    (into, ending), (gains, held, deep) = left, what
    return (
        _left_if_better(into, (gains - 2.0 * deep, held), end, sides),
        _left_if_better(ending, (gains - deep, held), end, sides),
    )


@inner_loop
def _put_from_right(
    room: LadderRoom,
    aisle: tuple[int, int],
    what: tuple[float, float, float],
    at: tuple[int, int],
    left: tuple[tuple[float, float, int, int], tuple[float, float, int, int]],
) -> None:
    """Put what plants from one on to the right end come to, alone and with the best on the left.

    `aisle` and its first plant; `what` they are worth, hold, and cost by metres; `at` which plant
    they begin and on which sides they stand; `left`, driven back and ended in.
    """
    (k, first), (gains, held, deep), (i, sides) = aisle, what, at
    cut = (first, i, _NONE, sides)
    _put(room, k, FROM_RIGHT, (gains - 2.0 * deep, held), cut)
    _put(room, k, END_RIGHT, (gains - deep, held), cut)
    (worth, left_held, end, left_sides), (ended, ended_held, ended_end, ended_sides) = left
    if end > first:
        cut = (end, i, left_sides, sides)
        _put(room, k, FROM_BOTH, (worth + gains - 2.0 * deep, left_held + held), cut)
        _put(room, k, END_RIGHT_AND, (worth + gains - deep, left_held + held), cut)
        cut = (ended_end, i, ended_sides, sides)
        _put(room, k, END_LEFT_AND, (ended + gains - 2.0 * deep, ended_held + held), cut)


@inner_loop
def _value_in(
    ladder: Ladder, reward: Float, costs: Costs, state: tuple[int, float, bool], room: LadderRoom
) -> None:
    """Value an aisle that is entered and left by the same end, or in which the day ends.

    Of plants that do not pay, if they count at all, an end is entered for one at most.
    """
    k, price, every = state
    metre, stop, change = price * costs.metre_s, price * costs.stop_s, price * costs.change_s
    both_sides = min(price * costs.turn_s, change)
    first, end = ladder.start[k], ladder.start[k + 1]
    _sum_sides(ladder, reward, (first, end, stop), room)
    left = (IMPOSSIBLE, 0.0, first, 0), (IMPOSSIBLE, 0.0, first, 0)
    for i in range(first, end):
        side = 1 if ladder.upper[i] else 0
        from_left = metre * ladder.in_m[i]
        from_right = metre * (ladder.across_m[k] - ladder.in_m[i])
        if reward[i] > stop:
            for sides in range(1, 4):
                gains, held = _of_sides(room, sides, change, _FROM_HERE)
                if held != 0.0:
                    gains -= both_sides if sides == 3 else 0.0
                    what = gains, held, from_right
                    _put_from_right(room, (k, first), what, (i, sides), left)
            room.of_side[2, side] += reward[i] - stop
            room.of_side[3, side] += reward[i]
            turns = room.of_side[3, 1 - side] > 0.0
            for sides in range(1, 4):
                if sides & (side + 1):
                    gains, held = _of_sides(room, sides, change, _UP_TO_HERE)
                    gains -= both_sides if sides == 3 and turns else 0.0
                    left = _better_left(left, (gains, held, from_left), i + 1, sides)
        elif every and reward[i] > 0.0:
            gains, held = reward[i] - stop - change, reward[i]
            _put_from_right(room, (k, first), (gains, held, from_right), (i, side + 1), left)
            left = _better_left(left, (gains, held, from_left), i + 1, side + 1)
    into, ending = left
    if into[2] > first:
        _put(room, k, FROM_LEFT, into[:2], (into[2], end, into[3], _NONE))
        _put(room, k, END_LEFT, ending[:2], (ending[2], end, ending[3], _NONE))


@inner_loop
def _sum_sides(
    ladder: Ladder, reward: Float, state: tuple[int, int, float], room: LadderRoom
) -> None:
    """Sum what the plants that pay gain and hold on each side; none of them is passed yet.

    `state`: the first plant of the aisle, that after its last, and what a stop costs.
    """
    first, end, stop = state
    room.of_side[:] = 0.0
    for i in range(first, end):
        if reward[i] > stop:
            side = 1 if ladder.upper[i] else 0
            room.of_side[0, side] += reward[i] - stop
            room.of_side[1, side] += reward[i]


@inner_loop
def _of_sides(room: LadderRoom, sides: int, change: float, which: int) -> tuple[float, float]:
    """Return what plants on these sides gain and hold, less a change of aisle.

    `which`: those passed so far, or all others.
    """
    gains, held = -change, 0.0
    for of in range(2):
        if sides & (of + 1):
            if which == _UP_TO_HERE:
                gains += room.of_side[2, of]
                held += room.of_side[3, of]
            else:
                gains += room.of_side[0, of] - room.of_side[2, of]
                held += room.of_side[1, of] - room.of_side[3, of]
    return gains, held
