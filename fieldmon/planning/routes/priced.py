"""The best drive on a ladder at a price of time, and with it a bound on every drive in the hours.

At a price a plant is worth its reward less its stop. What each way of driving an aisle is worth
then follows from its plants alone, and the best drive from a sweep up the ladder.
"""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from fieldmon.compute.jit import loop, part
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
    N_WAYS,
    NOTHING,
    ONCE,
    RIGHT_BACK,
    TWICE,
    Tables,
    tables,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from fieldmon.planning.routes.relaxation import Ladder
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_NEVER = -1e300
# no literals: see `frontier`
_SIDES: Any = np.arange(4)
_NONE, _BOTH = _SIDES[0], _SIDES[3]
_SAME_PLACE_M = 1e-6
# drives are told apart by which of so many stretches they begin in, and end in, up the ladder
_STRETCHES = 16
#: prices of a kind of drives are looked for so far from that of all at most
REACH = 30.0
# so many prices are tried for a bound of each kind of drive; those of one so near each other end it
_PRICES, _CLOSE = 40, 1.01


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


class Offered(NamedTuple):
    """What each way of driving each element comes to, ``(e, 12)``, see `Drawn`."""

    worth: Float
    reward: Float
    cut: Int


class Drawn(NamedTuple):
    """A drive on a ladder.

    Parameters
    ----------
    worth
        Reward less the priced time; a first change of aisle is charged, too, that none pays.
    reward
        What its plants hold.
    way
        ``(e,)`` how each element is driven, see `frontier`; of the gate, which stubs.
    cut
        ``(e, 4)`` plants of the element up to the first, and from the second on, are visited;
        on which sides of the aisle those are (1 the lower, 2 the upper, 3 both).
    passes
        ``(e, 2)`` passes of the left and right headland on to the next element.
    """

    worth: float
    reward: float
    way: Int
    cut: Int
    passes: Int


class HangingPart(Protocol):
    """A part of the plot that hangs on a ladder as one of its elements; see `PendantPart`."""

    def stops(self, price: float, *, ends: bool) -> Int:
        """Return the plants of the best drive in it at a price, in order."""
        ...


class _Room(NamedTuple):
    """Room for a sweep: worth ``(e, 12)``, cuts, rewards; the best to every state, its reward."""

    worth: Float
    reward: Float
    cut: Int
    best: Float
    held: Float
    choice: Int
    of_side: Float


class Priced:
    """Best drives on a ladder at any price."""

    def __init__(self, ladder: Ladder, reward: Float, robot: Robot) -> None:
        self.ladder = ladder
        self.costs = Costs.of(robot)
        self.tables: Tables = tables(returns=robot.returns)
        self.reward = np.ascontiguousarray(reward[ladder.plant])
        self.of_all = reward
        self.parts: Mapping[int, HangingPart] = {}
        self._gate_passes = np.array(GATE_CLOSED if robot.returns else GATE_OPEN)
        e, s = len(ladder.across_m), len(self.tables.passes)
        ways = e, N_WAYS
        self._room = _Room(
            np.empty(ways),
            np.empty(ways),
            np.zeros((*ways, 4), np.int64),
            np.empty((e + 1, s)),
            np.empty((e + 1, s)),
            np.empty((e, s), np.int64),
            np.empty((4, 2)),
        )

    @property
    def how(self) -> str:
        """Say what it is."""
        if self.ladder.cross_links == 0 and not self.ladder.hangs.any():
            return "price of time on a ladder of aisles"
        return (
            f"price of time on a ladder with {self.ladder.cross_links} cross links and "
            f"{int((self.ladder.hangs > 0).sum())} hanging aisles, as the plot is no ladder itself"
        )

    def best(self, price: float) -> Drawn:
        """Return the best drive at a price of reward a second."""
        room, ladder, tables = self._room, self.ladder, self.tables
        _value(ladder, self.reward, self.costs, (price, False), room)
        self._value_rest(price)
        way, passes = (
            np.zeros(len(ladder.across_m), np.int64),
            np.zeros((len(ladder.across_m), 2), np.int64),
        )
        _sweep(ladder, tables, price * self.costs.metre_s, room, (way, passes))
        at = np.arange(len(way)), way
        return Drawn(
            float(room.best[-1, 1]), float(room.reward[at].sum()), way, room.cut[at], passes
        )

    def ways(self, price: float) -> Offered:
        """Return what each way of driving each element comes to, if driven just so."""
        _value(self.ladder, self.reward, self.costs, (price, True), self._room)
        self._value_rest(price)
        room = self._room
        return Offered(room.worth.copy(), room.reward.copy(), room.cut.copy())

    def _value_rest(self, price: float) -> None:
        """Value what is no aisle: the gate."""
        gate, metre = self.ladder.gate, price * self.costs.metre_s
        self._room.worth[gate] = _NEVER
        self._room.reward[gate] = 0.0
        self._room.worth[gate, :4] = -metre * (self._gate_passes * self.ladder.stub_m).sum(axis=1)

    def bound(self, drawn: Drawn, price: float, seconds: float) -> float:
        """Return what no drive in so many seconds can reach, by the best drive at a price."""
        return max(drawn.worth + price * (seconds + self.costs.change_s), 0.0)

    def bound_by_kind(self, seconds: float, price: float, until_s: float) -> float:
        """Return what no drive in so many seconds can reach: the most of all kinds of drives."""
        least = least_by_kind(self.kinds, seconds + self.costs.change_s, price, until_s)
        return max(float(least.max()), 0.0)

    def kinds(self, price: float) -> tuple[Float, Float]:
        """Return worth and reward of the best drive of each kind at a price, ``(g, h)``.

        A kind is the stretch of the ladder in which a drive begins, the lowest, and that in which
        it ends, the highest.
        """
        gate, end = self.ladder.gate, len(self.ladder.across_m)
        low, high = _stretches(0, gate + 1), _stretches(gate, end)
        worth, reward = np.empty((2, len(low) - 1, len(high) - 1))
        _value(self.ladder, self.reward, self.costs, (price, False), self._room)
        self._value_rest(price)
        metre = price * self.costs.metre_s
        _sweep_kinds(self.ladder, self.tables, metre, self._room, (low, high, worth, reward))
        return worth, reward

    def seconds(self, drawn: Drawn, price: float) -> float:
        """Return the seconds that a drive takes on the ladder."""
        return (drawn.reward - drawn.worth) / price - self.costs.change_s


def _stretches(first: int, end: int) -> Int:
    """Return where stretches of elements begin, and the end."""
    return np.unique(np.linspace(first, end, min(_STRETCHES, end - first) + 1).astype(np.int64))


def least_by_kind(
    kinds: Callable[[float], tuple[Float, Float]], seconds: float, price: float, until_s: float
) -> Float:
    """Return what no drive of each kind can reach in so many seconds, by a price of its own.

    At one price for all, a kind that is far too long and one that is too short may seem worth a
    drive between them, which does not exist. Here each has the price that is least for it: the
    kind with the most is given a better one, until no other helps.

    Parameters
    ----------
    kinds
        Worth and reward of the best drive of each kind at a price.
    seconds
        The hours, and what is granted.
    price
        Where to begin.
    until_s
        Up to which moment of the clock prices are tried.
    """
    worth, reward = kinds(price)
    shape = worth.shape
    low, high = np.full(shape, price / REACH), np.full(shape, price * REACH)
    least = np.full(shape, np.inf)
    for k in range(_PRICES):
        if k:
            worth, reward = kinds(price)
        least = np.minimum(least, worth + price * seconds)
        too_long = reward - worth > price * seconds
        low = np.where(too_long, np.maximum(low, price), low)
        high = np.where(too_long, high, np.minimum(high, price))
        at = np.unravel_index(np.argmax(least), shape)
        if high[at] < _CLOSE * low[at] or monotonic() > until_s:
            break
        price = float(np.sqrt(low[at] * high[at]))
    return least


@part
def _put(
    room: _Room, k: int, way: int, what: tuple[float, float], cut: tuple[int, int, int, int]
) -> None:
    """Note a way of driving an aisle if it is worth more than the one known."""
    if what[0] > room.worth[k, way]:
        room.worth[k, way], room.reward[k, way] = what
        for c in range(4):
            room.cut[k, way, c] = cut[c]


@loop
def _value(
    ladder: Ladder, reward: Float, costs: Costs, state: tuple[float, bool], room: _Room
) -> None:
    """Work out what each way of driving each aisle is worth at a price.

    `state`: the price, and whether each way must be one that can be driven just so; if not, it
    may be worth more than that.
    """
    price, feasible = state
    room.worth[:] = _NEVER
    room.reward[:] = 0.0
    for k in range(ladder.across_m.size):
        if k != ladder.gate:
            _value_through(ladder, reward, costs, (k, price, feasible), room)
            _value_in(ladder, reward, costs, (k, price), room)
            if ladder.hangs[k] > 0:
                _hang(room, k, ladder.hangs[k] - 1)


@part
def _hang(room: _Room, k: int, side: int) -> None:
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
                room.worth[k, way] = _NEVER
        room.worth[k, to], room.reward[k, to] = worth, held


@part
def _value_through(
    ladder: Ladder, reward: Float, costs: Costs, state: tuple[int, float, bool], room: _Room
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


@part
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
    lower, upper, free, thrice = _NEVER, _NEVER, 0.0, _NEVER
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


@part
def _value_in(  # noqa: C901, PLR0912, PLR0915 - one pass; parts would cost its speed
    ladder: Ladder, reward: Float, costs: Costs, state: tuple[int, float], room: _Room
) -> None:
    """Value an aisle that is entered and left by the same end, or in which the day ends."""
    k, price = state
    metre, stop, change = price * costs.metre_s, price * costs.stop_s, price * costs.change_s
    both_sides = min(price * costs.turn_s, change)
    first, end = ladder.start[k], ladder.start[k + 1]
    gains_of, held_of = room.of_side[0], room.of_side[1]
    left_of, left_held_of = room.of_side[2], room.of_side[3]
    room.of_side[:] = 0.0
    for i in range(first, end):
        if reward[i] > stop:
            side = 1 if ladder.upper[i] else 0
            gains_of[side] += reward[i] - stop
            held_of[side] += reward[i]
    in_left, in_left_held, in_sides, in_cut = _NEVER, 0.0, 0, first
    end_left, end_left_held, end_sides, end_cut = _NEVER, 0.0, 0, first
    for i in range(first, end):
        if reward[i] <= stop:
            continue
        deep = metre * (ladder.across_m[k] - ladder.in_m[i])
        for sides in range(1, 4):
            gains, held = -change, 0.0
            for side in range(2):
                if sides & (side + 1):
                    gains += gains_of[side] - left_of[side]
                    held += held_of[side] - left_held_of[side]
            if held == 0.0:
                continue
            if sides == 3:
                gains -= both_sides
            cut = (first, i, _NONE, sides)
            _put(room, k, FROM_RIGHT, (gains - 2.0 * deep, held), cut)
            _put(room, k, END_RIGHT, (gains - deep, held), cut)
            if in_cut > first:
                cut = (in_cut, i, in_sides, sides)
                what = in_left + gains - 2.0 * deep, in_left_held + held
                _put(room, k, FROM_BOTH, what, cut)
                what = in_left + gains - deep, in_left_held + held
                _put(room, k, END_RIGHT_AND, what, cut)
                cut = (end_cut, i, end_sides, sides)
                what = end_left + gains - 2.0 * deep, end_left_held + held
                _put(room, k, END_LEFT_AND, what, cut)
        side = 1 if ladder.upper[i] else 0
        left_of[side] += reward[i] - stop
        left_held_of[side] += reward[i]
        deep = metre * ladder.in_m[i]
        for sides in range(1, 4):
            if not sides & (side + 1):
                continue
            gains, held = -change, 0.0
            for of in range(2):
                if sides & (of + 1):
                    gains += left_of[of]
                    held += left_held_of[of]
            if sides == 3 and left_held_of[1 - side] > 0.0:
                gains -= both_sides
            if gains - 2.0 * deep > in_left:
                in_left, in_left_held = gains - 2.0 * deep, held
                in_cut, in_sides = i + 1, sides
            if gains - deep > end_left:
                end_left, end_left_held = gains - deep, held
                end_cut, end_sides = i + 1, sides
    if in_cut > first:
        _put(room, k, FROM_LEFT, (in_left, in_left_held), (in_cut, end, in_sides, _NONE))
        _put(room, k, END_LEFT, (end_left, end_left_held), (end_cut, end, end_sides, _NONE))


@part
def _take_element(ladder: Ladder, tables: Tables, metre: float, room: _Room, k: int) -> None:
    """Find the best way to every state after an element, its reward and its choice."""
    ways = tables.gate if k == ladder.gate else tables.aisle
    for t in range(ways.shape[0]):
        before, way, after = ways[t, 0], ways[t, 1], ways[t, 2]
        # a drive is not complete before it came by the gate
        if room.best[k, before] <= _NEVER or (after == 1 and k < ladder.gate):
            continue
        worth = room.best[k, before] + room.worth[k, way]
        if after > 1 and k + 1 == ladder.across_m.size:
            continue
        if after > 1:
            left, right = tables.passes[after, 0], tables.passes[after, 1]
            worth -= metre * (left * ladder.up_m[k, 0] + right * ladder.up_m[k, 1])
        if worth > room.best[k + 1, after]:
            room.best[k + 1, after] = worth
            room.held[k + 1, after] = room.held[k, before] + room.reward[k, way]
            room.choice[k, after] = t


@loop
def _sweep(
    ladder: Ladder, tables: Tables, metre: float, room: _Room, drawn: tuple[Int, Int]
) -> None:
    """Find the best way to every state after every element; follow back that to the last state.

    `drawn`: how each element is driven then, and its passes, as `Drawn` has them.
    """
    room.best[:] = _NEVER
    room.best[0, 0] = 0.0
    room.held[0, 0] = 0.0
    for k in range(ladder.across_m.size):
        _take_element(ladder, tables, metre, room, k)
    way, passes = drawn
    state = 1
    for k in range(way.size - 1, -1, -1):
        ways = tables.gate if k == ladder.gate else tables.aisle
        t = room.choice[k, state]
        way[k], after = ways[t, 1], ways[t, 2]
        passes[k, 0], passes[k, 1] = tables.passes[after, 0], tables.passes[after, 1]
        state = ways[t, 0]


@loop
def _sweep_kinds(
    ladder: Ladder,
    tables: Tables,
    metre: float,
    room: _Room,
    kinds: tuple[Int, Int, Float, Float],
) -> None:
    """Find worth and reward of the best drive that begins and ends in each pair of stretches."""
    low, high, worth, reward = kinds
    worth[:] = _NEVER
    reward[:] = 0.0
    for begin in range(low.size - 1):
        end = 0
        room.best[:] = _NEVER
        room.best[0, 0] = 0.0
        room.held[0, 0] = 0.0
        for k in range(low[begin], ladder.across_m.size):
            if k == low[begin]:
                room.best[k, 0] = room.held[k, 0] = 0.0
            while end + 1 < high.size - 1 and k >= high[end + 1]:
                end += 1
            _take_element(ladder, tables, metre, room, k)
            if k + 1 == low[begin + 1]:
                # it has begun by now
                room.best[k + 1, 0] = _NEVER
            if room.best[k + 1, 1] > worth[begin, end]:
                worth[begin, end], reward[begin, end] = room.best[k + 1, 1], room.held[k + 1, 1]
            # those that end here do not end further up
            room.best[k + 1, 1] = _NEVER
