"""The best drive on a ladder at a price of time, and with it a bound on every drive in the hours.

At a price a plant is worth its reward less its stop. What each way of driving an aisle is worth
then follows from its plants alone, and the best drive from a sweep up the ladder.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from fieldmon.compute.jit import inner_loop, loop
from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.planning.routes.aisle_ways import IMPOSSIBLE, Costs, LadderRoom, value_ways
from fieldmon.planning.routes.frontier import GATE_CLOSED, GATE_OPEN, N_WAYS, Tables, tables

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from fieldmon.planning.routes.ladders import Ladder
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# drives are told apart by which of so many stretches they begin in, and end in, up the ladder
_STRETCHES = 16
#: a price of a kind of drives is so much more, or less, as long as none to the other side is known
REACH = 30.0
# of a kind of drives without any, the best is worth less than this
_NONE = 0.5 * IMPOSSIBLE
# so many prices are tried for a bound of each kind of drive, until the one with the most cannot
# come lower by more than this share; every so many, prices between those tried are halved
_PRICES, _CLOSE, _HALVED = 40, 1e-7, 5


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


class ADrive(Protocol):
    """A drive, on one ladder (`Drawn`) or on several, with its worth and its reward."""

    @property
    def worth(self) -> float:
        """Reward less the priced time."""
        ...

    @property
    def reward(self) -> float:
        """What its plants hold."""
        ...


class AtPrices:
    """What a drive at a price of time says of seconds: its own, and those of all others."""

    costs: Costs

    def bound(self, drawn: ADrive, price: float, seconds: float) -> float:
        """Return what no drive in so many seconds can reach, by the best drive at a price."""
        return max(drawn.worth + price * (seconds + self.costs.change_s), 0.0)

    def seconds(self, drawn: ADrive, price: float) -> float:
        """Return the seconds that a drive takes, at least."""
        return (drawn.reward - drawn.worth) / price - self.costs.change_s


class Priced(AtPrices):
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
        self._room = LadderRoom(
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
        value_ways(ladder, self.reward, self.costs, (price, False, False), room)
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
        value_ways(self.ladder, self.reward, self.costs, (price, True, False), self._room)
        self._value_rest(price)
        room = self._room
        return Offered(room.worth.copy(), room.reward.copy(), room.cut.copy())

    def _value_rest(self, price: float) -> None:
        """Value what is no aisle: the gate."""
        gate, metre = self.ladder.gate, price * self.costs.metre_s
        self._room.worth[gate] = IMPOSSIBLE
        self._room.reward[gate] = 0.0
        self._room.worth[gate, :4] = -metre * (self._gate_passes * self.ladder.stub_m).sum(axis=1)

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
        value_ways(self.ladder, self.reward, self.costs, (price, False, True), self._room)
        self._value_rest(price)
        metre = price * self.costs.metre_s
        _sweep_kinds(self.ladder, self.tables, metre, self._room, (low, high, worth, reward))
        return worth, reward


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
        Up to which moment of `FIRST_USE.work_clock` prices are tried.
    """
    worth, reward = kinds(price)
    shape = worth.shape
    low, high = np.zeros(shape), np.full(shape, np.inf)
    # what the last drives too long, and in time, hold, and the seconds that they leave
    held, left_s = np.zeros((2, *shape)), np.zeros((2, *shape))
    least = np.full(shape, np.inf)
    for k in range(_PRICES):
        if k:
            worth, reward = kinds(price)
        here = worth + price * seconds
        least = np.minimum(least, here)
        over = reward > here
        nearer = np.where(over, price >= low, price <= high) & (worth > _NONE)
        for side in range(2):
            met = nearer & (over == (side == 0))
            held[side, met], left_s[side, met] = reward[met], (here - reward)[met] / price
        low = np.where(over, np.maximum(low, price), low)
        high = np.where(over, high, np.minimum(high, price))
        at = np.unravel_index(np.argmax(least), shape)
        of, by = (low[at], high[at]), -left_s[0][at]
        # nothing is less than where the lines of its two drives cross, or what one in time holds
        cross, floor = np.inf, held[1][at]
        if of[0] > 0.0 and of[1] < np.inf:
            cross = (held[0][at] - held[1][at]) / (left_s[1][at] + by)
            floor = held[0][at] - cross * by
        is_least = least[at] <= floor * (1.0 + _CLOSE) or of[1] < (1.0 + _CLOSE) * of[0]
        if is_least or FIRST_USE.work_clock() > until_s:
            break
        if of[0] > 0.0 and of[1] < np.inf:
            crosses = of[0] < cross < of[1] and k % _HALVED < _HALVED - 1
            price = float(cross if crosses else np.sqrt(of[0] * of[1]))
        else:
            price = float(of[0] * REACH if of[0] > 0.0 else of[1] / REACH)
    return least


@inner_loop
def _take_element(ladder: Ladder, tables: Tables, metre: float, room: LadderRoom, k: int) -> None:
    """Find the best way to every state after an element, its reward and its choice."""
    ways = tables.gate if k == ladder.gate else tables.aisle
    for t in range(ways.shape[0]):
        before, way, after = ways[t, 0], ways[t, 1], ways[t, 2]
        # a drive is not complete before it came by the gate
        if room.best[k, before] <= IMPOSSIBLE or (after == 1 and k < ladder.gate):
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
    ladder: Ladder, tables: Tables, metre: float, room: LadderRoom, drawn: tuple[Int, Int]
) -> None:
    """Find the best way to every state after every element; follow back that to the last state.

    `drawn`: how each element is driven then, and its passes, as `Drawn` has them.
    """
    room.best[:] = IMPOSSIBLE
    room.best[0, 0] = 0.0
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
    room: LadderRoom,
    kinds: tuple[Int, Int, Float, Float],
) -> None:
    """Find worth and reward of the best drive that begins and ends in each pair of stretches."""
    low, high, worth, reward = kinds
    worth[:] = IMPOSSIBLE
    reward[:] = 0.0
    for begin in range(low.size - 1):
        end = 0
        room.best[:] = IMPOSSIBLE
        room.best[low[begin], 0] = room.held[low[begin], 0] = 0.0
        for k in range(low[begin], ladder.across_m.size):
            while end + 1 < high.size - 1 and k >= high[end + 1]:
                end += 1
            _take_element(ladder, tables, metre, room, k)
            if k + 1 == low[begin + 1]:
                # it has begun by now
                room.best[k + 1, 0] = IMPOSSIBLE
            if room.best[k + 1, 1] > worth[begin, end]:
                worth[begin, end], reward[begin, end] = room.best[k + 1, 1], room.held[k + 1, 1]
            # those that end here do not end further up
            room.best[k + 1, 1] = IMPOSSIBLE
