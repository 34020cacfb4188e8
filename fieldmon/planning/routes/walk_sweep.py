"""Compiled loops of the best walk: the sweep over the rows, and what leaves states out of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop, loop

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

#: how the part so far goes on: by the left headland, by the right, by both with one pass each,
#: by both with two passes each and joined already, or in two pieces that are yet to be joined
LEFT, RIGHT, ROUND, JOINED, APART = range(5)
STATES = 5
# what a row yields for so many half steps: in and out from the left, from the right, from both,
# from both with the right or the left one; through, its steps counted once the round is closed;
# and through that closes it, or for both ways at once
FROM_LEFT, FROM_RIGHT, FROM_BOTH, SOME_RIGHT, SOME_LEFT, ONCE, CLOSING = range(7)
TABLES = 7
#: in a row: state before, state after, and what is driven
IN_ROW = np.array(
    [
        (LEFT, LEFT, FROM_LEFT),
        (RIGHT, RIGHT, FROM_RIGHT),
        (ROUND, ROUND, FROM_BOTH),
        (JOINED, JOINED, FROM_BOTH),
        (LEFT, APART, SOME_RIGHT),
        (RIGHT, APART, SOME_LEFT),
        (APART, APART, FROM_BOTH),
        (LEFT, ROUND, ONCE),
        (RIGHT, ROUND, ONCE),
        (JOINED, ROUND, ONCE),
        (APART, ROUND, ONCE),
        (ROUND, JOINED, CLOSING),
        (LEFT, JOINED, CLOSING),
        (RIGHT, JOINED, CLOSING),
        (APART, JOINED, CLOSING),
    ]
)
#: in the headlands: state after a row, state before the next one
ON = np.array(
    [
        (LEFT, LEFT),
        (JOINED, LEFT),
        (RIGHT, RIGHT),
        (JOINED, RIGHT),
        (ROUND, ROUND),
        (JOINED, JOINED),
        (APART, APART),
    ]
)
#: passes of the left and the right headland
PASSES = np.array([(2, 0), (0, 2), (1, 1), (2, 2), (2, 2)])
ON_HALF = PASSES.sum(axis=1) // 2
NEVER = -1e300
# prices of a half step: the first is the best one known
BEST = 0
_MET = -1e299
_BLOCK = 512
_LANES = 4


class StateWorth(NamedTuple):
    """What the best way to each state, and on from it, comes to at each of p prices.

    ``(p, m, 5)`` each: on from before and from after a row, and up to there. ``half`` are the half
    steps of the best way on from before a row.
    """

    price: Float
    before: Float
    after: Float
    arrived: Float
    done: Float
    half: Int

    @classmethod
    def at(cls, price: Float, tables: Float) -> StateWorth:
        """Work them out at some prices of a half step."""
        shape = len(price), len(tables), STATES
        before, after, arrived, done = np.full((4, *shape), NEVER)
        worth = cls(price, before, after, arrived, done, np.zeros(shape, np.int64))
        _fill_worth(tables, worth, (np.empty(TABLES), np.zeros(TABLES, np.int64)))
        return worth


class KeptStates(NamedTuple):
    """The most reward by state and half steps, for those from `low` to `high` ``(m, 5)``.

    ``start`` ``(m, 5)`` is where they begin in `most`.
    """

    low: Int
    high: Int
    start: Int
    most: Float


class WalkEnd(NamedTuple):
    """A best walk's reward, and after which row, in which state and with which steps it ends."""

    reward: float
    row: int
    state: int
    half: int


class SweepRoom(NamedTuple):
    """Room for a sweep.

    The most reward after a row ``(5, h)``; that before it, moved ``(h + n + 2,)``; and half steps
    in a row that bring more than fewer, with what they bring ``(n + 2,)``.
    """

    done: Float
    source: Float
    deep: Int
    value: Float


@loop
def fill_tables(reward: Float, tables: Float) -> None:
    """Fill in what each row yields for so many half steps, ``(m, 7, n + 2)``."""
    m, n = reward.shape
    for row in range(m):
        of = tables[row]
        left, right = of[FROM_LEFT], of[FROM_RIGHT]
        left[0] = right[0] = 0.0
        for k in range(n):
            left[k + 1] = left[k] + reward[row, k]
            right[k + 1] = right[k] + reward[row, n - 1 - k]
        # the same to the last bit, so that a row that is done counts as done
        right[n] = left[n]
        of[ONCE, 0] = of[CLOSING, n + 1] = left[n]
        for k in range(n + 1):
            both, some_right, some_left = NEVER, NEVER, NEVER
            for deep in range(k + 1):
                value = left[k - deep] + right[deep] if k < n else left[n]
                both = max(both, value)
                if deep > 0:
                    some_right = max(some_right, value)
                if deep < k:
                    some_left = max(some_left, value)
            of[FROM_BOTH, k], of[SOME_RIGHT, k], of[SOME_LEFT, k] = both, some_right, some_left


def depths(tables: Float, table: int, deep: int) -> tuple[int, int]:
    """Return how deep from the left and from the right a table's entry is."""
    n = tables.shape[1] - 2
    if table == FROM_LEFT:
        return deep, 0
    if table == FROM_RIGHT:
        return 0, deep
    for right in range(1 if table == SOME_RIGHT else 0, deep + (table != SOME_LEFT)):
        value = tables[FROM_LEFT, deep - right] + tables[FROM_RIGHT, right]
        if deep == n or value == tables[table, deep]:
            return deep - right, right
    raise AssertionError("a value must have come from somewhere")


@loop
def _fill_worth(tables: Float, worth: StateWorth, room: tuple[Float, Int]) -> None:
    """Work out the best way to every state and on from it at some prices."""
    for p in range(worth.price.size):
        _fill_onward(tables, worth, p, room)
        _fill_up_to(tables, worth, p, room)


@inner_loop
def _price_row(tables: Float, price: float, room: tuple[Float, Int]) -> None:
    """Find the best half steps of each way of driving a row at a price."""
    best, half = room
    for table in range(TABLES):
        best[table] = NEVER
        for k in range(tables.shape[1]):
            worth = tables[table, k] - price * k
            if worth > best[table]:
                best[table], half[table] = worth, k


@inner_loop
def _fill_onward(tables: Float, worth: StateWorth, p: int, room: tuple[Float, Int]) -> None:
    best, half = room
    price, m = worth.price[p], tables.shape[0]
    for row in range(m - 1, -1, -1):
        _price_row(tables[row], price, room)
        after, before = worth.after[p, row], worth.before[p, row]
        # a walk may be complete after any row; of its half steps: those of the rows beyond
        after[LEFT] = after[RIGHT] = after[JOINED] = 0.0
        onward = worth.half[p, (row + 1) % m]
        steps = worth.half[p, row]
        for move in range(IN_ROW.shape[0]):
            source, target, table = IN_ROW[move, 0], IN_ROW[move, 1], IN_ROW[move, 2]
            most, taken = after[target], 0
            if row + 1 < m:
                for way in range(ON.shape[0]):
                    to = ON[way, 1]
                    there = worth.before[p, row + 1, to] - price * ON_HALF[to]
                    if ON[way, 0] == target and there > most:
                        most, taken = there, onward[to] + ON_HALF[to]
            value = most + best[table]
            if value > before[source]:
                before[source], steps[source] = value, taken + half[table]
        if row + 1 < m:
            for way in range(ON.shape[0]):
                to = ON[way, 1]
                there = worth.before[p, row + 1, to] - price * ON_HALF[to]
                after[ON[way, 0]] = max(after[ON[way, 0]], there)


@inner_loop
def _fill_up_to(tables: Float, worth: StateWorth, p: int, room: tuple[Float, Int]) -> None:
    best, _ = room
    price, m = worth.price[p], tables.shape[0]
    worth.arrived[p, 0, LEFT] = 0.0
    for row in range(m):
        _price_row(tables[row], price, room)
        arrived, done = worth.arrived[p, row], worth.done[p, row]
        for move in range(IN_ROW.shape[0]):
            source, target, table = IN_ROW[move, 0], IN_ROW[move, 1], IN_ROW[move, 2]
            done[target] = max(done[target], arrived[source] + best[table])
        if row + 1 < m:
            onward = worth.arrived[p, row + 1]
            for way in range(ON.shape[0]):
                to = ON[way, 1]
                onward[to] = max(onward[to], done[ON[way, 0]] - price * ON_HALF[to])


@loop
def narrow(worth: StateWorth, limits: tuple[int, float], spans: Int) -> None:
    """Find the half steps ``(2, 2, m, 5)`` with which a walk may still hold as much as it must.

    Up to a state it holds no more than at any price, and on from it likewise: the sum of two
    straight lines in its half steps, for every pair of prices.
    """
    half, least = limits
    up_to, onward = (worth.arrived, worth.done), (worth.before, worth.after)
    for row in range(spans.shape[2]):
        for state in range(STATES):
            for which in range(2):
                low, high = 0.0, float(half)
                for p in range(worth.price.size):
                    to = up_to[which][p, row, state]
                    for q in range(worth.price.size):
                        on = onward[which][q, row, state]
                        if to < _MET or on < _MET:
                            high = -1.0
                            continue
                        spare = to + on + worth.price[q] * half - least
                        slope = worth.price[p] - worth.price[q]
                        if slope > 0.0:
                            low = max(low, -spare / slope)
                        elif slope < 0.0:
                            high = min(high, -spare / slope)
                        elif spare < 0.0:
                            high = -1.0
                spans[which, 0, row, state] = int(np.ceil(min(low, half + 1.0)))
                spans[which, 1, row, state] = int(np.floor(max(high, -1.0)))


@loop
def sweep(
    tables: Float,
    limits: tuple[StateWorth, float],
    kept: KeptStates,
    spans: Int,
    room: SweepRoom,
    end: tuple[Float, Int],
) -> None:
    """Find the most reward for every state and number of half steps that are kept."""
    worth, least = limits
    m = tables.shape[0]
    kept.most[kept.start[0, LEFT]] = 0.0
    for row in range(m):
        room.done[:] = NEVER
        for move in range(IN_ROW.shape[0]):
            before, after, table = IN_ROW[move, 0], IN_ROW[move, 1], IN_ROW[move, 2]
            low, high = kept.low[row, before], kept.high[row, before]
            first, last = spans[0, row, after], spans[1, row, after]
            if low > high or first > last:
                continue
            # what is left of the row must be worth so much at the best price
            least_here = least - worth.arrived[BEST, row, before] - worth.after[BEST, row, after]
            n = _worth_it(tables[row, table], (worth.price[BEST], least_here), room)
            if n:
                start = kept.start[row, before]
                source = kept.most[start : start + high - low + 1]
                target = room.done[after, : last - first + 1]
                _spread(source, target, (low - first, n), room)
        for state in (LEFT, RIGHT, JOINED):
            first, last = spans[0, row, state], spans[1, row, state]
            for h in range(last - first + 1):
                if room.done[state, h] > end[0][0]:
                    end[0][0] = room.done[state, h]
                    end[1][0], end[1][1], end[1][2] = row, state, first + h
        if row + 1 < m:
            _go_on(kept, spans, row, room)


@inner_loop
def _worth_it(table: Float, limits: tuple[float, float], room: SweepRoom) -> int:
    """List the half steps of a row that bring more than fewer do, and enough; return how many."""
    price, least = limits
    most, n = NEVER, 0
    for k in range(table.size):
        if table[k] > most:
            most = table[k]
            if most - price * k >= least:
                room.deep[n], room.value[n] = k, most
                n += 1
    return n


@inner_loop
def _spread(source: Float, target: Float, at: tuple[int, int], room: SweepRoom) -> None:
    """Raise target[h] to the most of source[h - by - k] + value of k, for the n listed k.

    It is done in blocks that stay in the nearest cache, four k at a time.
    """
    by, n = at
    deep, value, moved = room.deep, room.value, room.source
    deepest = deep[n - 1]
    first_h, end_h = max(by + deep[0], 0), min(by + deepest + source.size, target.size)
    # moved[h + deepest - k] is the source k half steps before h
    for h in range(first_h, end_h + deepest):
        j = h - deepest - by
        moved[h] = source[j] if 0 <= j < source.size else NEVER
    for first in range(first_h, end_h, _BLOCK):
        stop = min(first + _BLOCK, end_h)
        to = target[first:stop]
        k = 0
        while k + _LANES <= n:
            a = moved[first + deepest - deep[k] : stop + deepest - deep[k]]
            b = moved[first + deepest - deep[k + 1] : stop + deepest - deep[k + 1]]
            c = moved[first + deepest - deep[k + 2] : stop + deepest - deep[k + 2]]
            d = moved[first + deepest - deep[k + 3] : stop + deepest - deep[k + 3]]
            for h in range(to.size):
                low = max(a[h] + value[k], b[h] + value[k + 1])
                high = max(c[h] + value[k + 2], d[h] + value[k + 3])
                to[h] = max(to[h], low, high)
            k += _LANES
        while k < n:
            a = moved[first + deepest - deep[k] : stop + deepest - deep[k]]
            for h in range(to.size):
                to[h] = max(to[h], a[h] + value[k])
            k += 1


@inner_loop
def _go_on(kept: KeptStates, spans: Int, row: int, room: SweepRoom) -> None:
    """Take what is known after a row to before the next one."""
    for way in range(ON.shape[0]):
        state, to = ON[way, 0], ON[way, 1]
        low, high = kept.low[row + 1, to], kept.high[row + 1, to]
        first, last = spans[0, row, state], spans[1, row, state]
        by = ON_HALF[to]
        start = kept.start[row + 1, to] - low
        for h in range(max(low, first + by), min(high, last + by) + 1):
            value = room.done[state, h - by - first]
            kept.most[start + h] = max(kept.most[start + h], value)
