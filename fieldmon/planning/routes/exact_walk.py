"""The best closed walk on a ladder of rows, exactly: unit steps, one reward a plant, a budget.

Rows are swept from the start to the far side. What was walked so far touches the two headlands in
one of five ways; for each of them and each number of steps the most reward is kept. A price of
steps bounds what any walk can hold that comes by a state with so many steps; what cannot come near
enough to that bound is left out. The claim, its proof and what it assumes are in
``docs/best_routes.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import loop, part
from fieldmon.errors import SettingError
from fieldmon.planning.routes.passes import Passes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

#: how the part so far goes on: by the left headland, by the right, by both with one pass each,
#: by both with two passes each and joined already, or in two pieces that are yet to be joined
LEFT, RIGHT, ROUND, JOINED, APART = range(5)
_STATES = 5
# what a row yields for so many half steps: in and out from the left, from the right, from both,
# from both with the right or the left one; through, its steps counted once the round is closed;
# and through that closes it, or for both ways at once
_FROM_LEFT, _FROM_RIGHT, _FROM_BOTH, _SOME_RIGHT, _SOME_LEFT, _ONCE, _CLOSING = range(7)
_TABLES = 7
#: in a row: state before, state after, and what is driven
_IN_ROW = np.array(
    [
        (LEFT, LEFT, _FROM_LEFT),
        (RIGHT, RIGHT, _FROM_RIGHT),
        (ROUND, ROUND, _FROM_BOTH),
        (JOINED, JOINED, _FROM_BOTH),
        (LEFT, APART, _SOME_RIGHT),
        (RIGHT, APART, _SOME_LEFT),
        (APART, APART, _FROM_BOTH),
        (LEFT, ROUND, _ONCE),
        (RIGHT, ROUND, _ONCE),
        (JOINED, ROUND, _ONCE),
        (APART, ROUND, _ONCE),
        (ROUND, JOINED, _CLOSING),
        (LEFT, JOINED, _CLOSING),
        (RIGHT, JOINED, _CLOSING),
        (APART, JOINED, _CLOSING),
    ]
)
#: in the headlands: state after a row, state before the next one
_ON = np.array(
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
_PASSES = np.array([(2, 0), (0, 2), (1, 1), (2, 2), (2, 2)])
_ON_HALF = _PASSES.sum(axis=1) // 2
_NEVER = -1e300
_MET = -1e299
_BLOCK = 512
_LANES = 4
# bounds are taken at the best price, at some so far from it, and at some of what all plants hold
_BEST = 0
_AROUND = (1.0, 0.0, 0.2, 0.5, 0.7, 0.85, 0.95, 0.98, 1.02, 1.05, 1.15, 1.3, 1.6, 2.5, 5.0)
_OF_ALL = (1e-7, 1e-6, 1e-5, 1e-4, 1.0)
_LEAST_PRICE, _MOST_PRICES = 1e-13, 200
# the share of the bound that walks may lack at first, and how much more if none is found
_LACKING, _MORE = 1e-4, 8.0
_ROUNDED = 1e-9


class Drive(NamedTuple):
    """What is driven in one row, and the passes of the headlands from there to the next row.

    `through` is how often the row is driven from end to end; otherwise it is entered `from_left`
    plants deep from the left, and `from_right` from the right.
    """

    row: int
    through: int
    from_left: int
    from_right: int
    left_passes: int
    right_passes: int


@dataclass(frozen=True, eq=False)
class Walk:
    """A closed walk on a ladder.

    Parameters
    ----------
    place
        ``(k, 2)`` row and column of each step's place, from the start back to it. Columns 0 and
        n + 1 are the headlands, 1 to n the plants.
    reward
        What the plants passed hold together.
    """

    place: Int
    reward: float

    @property
    def steps(self) -> int:
        """Return the number of steps."""
        return max(len(self.place) - 1, 0)


def full_budget(n_rows: int, n_plants: int) -> int:
    """Return the steps that suffice to pass every plant and come back."""
    pairs = n_rows // 2 * 2
    # an odd row is walked in and out
    return pairs * (n_plants + 1) + (n_rows - pairs) * 2 * n_plants + 2 * (n_rows - 1)


def best_walk(reward: ArrayLike, budget: int) -> Walk:
    """Return a closed walk of at most so many steps with the most reward that any can have.

    Parameters
    ----------
    reward
        ``(m, n)`` reward of each plant, 0 or more; the walk starts and ends at the left end of
        row 0.
    budget
        Steps.

    Raises
    ------
    SettingError
        If rewards are no matrix of numbers of 0 or more, or the budget is below 0.
    """
    values = np.ascontiguousarray(reward, np.float64)
    if values.ndim != 2 or 0 in values.shape or not (values >= 0).all():
        raise SettingError(
            "Rewards must be a matrix of numbers of 0 or more, one line a row, but they are "
            f"{values.shape} with a least value of {values.min() if values.size else 'none'}."
        )
    if budget < 0:
        raise SettingError(f"A budget must be 0 steps or more, but it is {budget}.")
    # more steps than that bring nothing
    return _Search(values).best(min(budget, full_budget(*values.shape)) // 2)


class _Worth(NamedTuple):
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
    def at(cls, price: Float, tables: Float) -> _Worth:
        """Work them out at some prices of a half step."""
        shape = len(price), len(tables), _STATES
        before, after, arrived, done = np.full((4, *shape), _NEVER)
        worth = cls(price, before, after, arrived, done, np.zeros(shape, np.int64))
        _fill_worth(tables, worth, (np.empty(_TABLES), np.zeros(_TABLES, np.int64)))
        return worth


class _Kept(NamedTuple):
    """The most reward by state and half steps, for those from `low` to `high` ``(m, 5)``.

    ``start`` ``(m, 5)`` is where they begin in `most`.
    """

    low: Int
    high: Int
    start: Int
    most: Float


class _End(NamedTuple):
    """A best walk's reward, and after which row, in which state and with which steps it ends."""

    reward: float
    row: int
    state: int
    half: int


class _Search:
    """Looks for the best walk on a matrix of rewards."""

    def __init__(self, reward: Float) -> None:
        self.reward, self.total = reward, float(reward.sum())
        self.tables = np.full((len(reward), _TABLES, reward.shape[1] + 2), _NEVER)
        _fill_tables(reward, self.tables)

    def best(self, half: int) -> Walk:
        """Return the best walk of so many half steps.

        Only walks are followed that may hold as much as the bound, but for what they may lack. If
        one is found that does, it is the best. If not, as much is allowed as the best one lacks
        that was found.
        """
        if not self.total:
            return Walk(np.zeros((1, 2), np.int64), 0.0)
        price, bound, known, half = self._price(half)
        prices = np.concatenate([price * np.array(_AROUND), self.total * np.array(_OF_ALL)])
        worth = _Worth.at(prices, self.tables)
        lacking = min(_LACKING * bound, bound - known)
        while True:
            least = bound - lacking - _ROUNDED * self.total
            kept, end = self._swept(worth, half, least)
            if end.reward >= least:
                return Walk(_euler(self._drives(kept, end), self.reward.shape[1]), end.reward)
            lacking = min(_MORE * lacking, bound - max(end.reward, known))

    def _price(self, half: int) -> tuple[float, float, float, int]:
        """Return the price of a half step with the least bound, that bound, and what is held.

        The bound is the most of two lines, each of a walk, where they cross; at that price another
        walk may be better, and take the place of the one on its side. The last number is how many
        half steps are of use.
        """
        price = _LEAST_PRICE * self.total / (self.reward.size + len(self.reward))
        short, long = (0.0, 0), self._walk_at(price)
        if long[1] <= half:
            return price, long[0], long[0], long[1]
        least = price, long[0]
        for _ in range(_MOST_PRICES):
            price = (long[0] - short[0]) / (long[1] - short[1])
            found = self._walk_at(price)
            bound = found[0] + price * (half - found[1])
            if bound < least[1]:
                least = price, bound
            if bound <= short[0] + price * (half - short[1]) + _ROUNDED * self.total:
                break
            short, long = (short, found) if found[1] > half else (found, long)
        return *least, short[0], half

    def _walk_at(self, price: float) -> tuple[float, int]:
        """Return reward and half steps of the best walk at a price."""
        worth = _Worth.at(np.array([price]), self.tables)
        half = int(worth.half[0, 0, LEFT])
        return float(worth.before[0, 0, LEFT]) + price * half, half

    def _swept(self, worth: _Worth, half: int, least: float) -> tuple[_Kept, _End]:
        """Return what is kept of all walks that may hold so much, and the best one's end."""
        m, width = len(self.reward), self.tables.shape[2]
        spans = np.zeros((2, 2, m, _STATES), np.int64)
        _narrow(worth, (half, least), spans)
        size = np.maximum(spans[:, 1] - spans[:, 0] + 1, 0)
        start = np.cumsum(size[0]).reshape(m, _STATES) - size[0]
        most = np.full(int(size[0].sum()), _NEVER)
        kept = _Kept(spans[0, 0], spans[0, 1], start, most)
        widest = int(size.max())
        room = _Room(
            np.empty((_STATES, widest)), np.empty(widest + width), np.zeros(width, np.int64),
            np.empty(width),
        )  # fmt: skip
        end = np.full(1, _NEVER), np.zeros(3, np.int64)
        least_there = least - float(worth.price[_BEST]) * half
        _sweep(self.tables, (worth, least_there), kept, spans[1], room, end)
        return kept, _End(float(end[0][0]), *(int(k) for k in end[1]))

    def _drives(self, kept: _Kept, end: _End) -> list[Drive]:
        """Trace back what is driven in each row."""
        value, row, half = end.reward, end.row, end.half
        ends: tuple[int, ...] = (end.state,)
        passes, drives = (0, 0), list[Drive]()
        while True:
            before, table, k = self._source(kept, (row, half), ends, value)
            drives.append(Drive(row, *self._driven(row, before, table, k), *passes))
            if row == 0:
                return drives[::-1]
            half -= k
            value = float(kept.most[kept.start[row, before] + half - kept.low[row, before]])
            passes = int(_PASSES[before, 0]), int(_PASSES[before, 1])
            row, half = row - 1, half - int(_ON_HALF[before])
            ends = tuple(int(state) for state, on in _ON if on == before)

    def _source(
        self, kept: _Kept, at: tuple[int, int], ends: tuple[int, ...], value: float
    ) -> tuple[int, int, int]:
        """Return state before a row, table and half steps in it that lead to a value after it."""
        row, half = at
        for before, after, table in _IN_ROW.tolist():
            low, high = int(kept.low[row, before]), int(kept.high[row, before])
            first, last = max(low, half - self.tables.shape[2] + 1), min(high, half)
            if after not in ends or first > last:
                continue
            start = int(kept.start[row, before]) - low
            back = kept.most[start + first : start + last + 1]
            ways = self.tables[row, table, half - last : half - first + 1][::-1]
            hits = np.flatnonzero(back + ways == value)
            if len(hits):
                return before, table, half - first - int(hits[-1])
        raise AssertionError("a value must have come from somewhere")

    def _driven(self, row: int, before: int, table: int, k: int) -> tuple[int, int, int]:
        """Return how often a row is driven through, or how deep from the left and the right."""
        if table == _ONCE or (table == _CLOSING and before == ROUND):
            return 1, 0, 0
        if table == _CLOSING:
            return 2, 0, 0
        return 0, *_depths(self.tables[row], table, k)


class _Room(NamedTuple):
    """Room for a sweep.

    The most reward after a row ``(5, h)``; that before it, moved ``(h + n + 2,)``; and half steps
    in a row that bring more than fewer, with what they bring ``(n + 2,)``.
    """

    done: Float
    source: Float
    deep: Int
    value: Float


@loop
def _fill_tables(reward: Float, tables: Float) -> None:
    """Fill in what each row yields for so many half steps, ``(m, 7, n + 2)``."""
    m, n = reward.shape
    for row in range(m):
        of = tables[row]
        left, right = of[_FROM_LEFT], of[_FROM_RIGHT]
        left[0] = right[0] = 0.0
        for k in range(n):
            left[k + 1] = left[k] + reward[row, k]
            right[k + 1] = right[k] + reward[row, n - 1 - k]
        # the same to the last bit, so that a row that is done counts as done
        right[n] = left[n]
        of[_ONCE, 0] = of[_CLOSING, n + 1] = left[n]
        for k in range(n + 1):
            both, some_right, some_left = _NEVER, _NEVER, _NEVER
            for deep in range(k + 1):
                value = left[k - deep] + right[deep] if k < n else left[n]
                both = max(both, value)
                if deep > 0:
                    some_right = max(some_right, value)
                if deep < k:
                    some_left = max(some_left, value)
            of[_FROM_BOTH, k], of[_SOME_RIGHT, k], of[_SOME_LEFT, k] = both, some_right, some_left


def _depths(tables: Float, table: int, deep: int) -> tuple[int, int]:
    """Return how deep from the left and from the right a table's entry is."""
    n = tables.shape[1] - 2
    if table == _FROM_LEFT:
        return deep, 0
    if table == _FROM_RIGHT:
        return 0, deep
    for right in range(1 if table == _SOME_RIGHT else 0, deep + (table != _SOME_LEFT)):
        value = tables[_FROM_LEFT, deep - right] + tables[_FROM_RIGHT, right]
        if deep == n or value == tables[table, deep]:
            return deep - right, right
    raise AssertionError("a value must have come from somewhere")


@loop
def _fill_worth(tables: Float, worth: _Worth, room: tuple[Float, Int]) -> None:
    """Work out the best way to every state and on from it at some prices."""
    for p in range(worth.price.size):
        _fill_onward(tables, worth, p, room)
        _fill_up_to(tables, worth, p, room)


@part
def _price_row(tables: Float, price: float, room: tuple[Float, Int]) -> None:
    """Find the best half steps of each way of driving a row at a price."""
    best, half = room
    for table in range(_TABLES):
        best[table] = _NEVER
        for k in range(tables.shape[1]):
            worth = tables[table, k] - price * k
            if worth > best[table]:
                best[table], half[table] = worth, k


@part
def _fill_onward(tables: Float, worth: _Worth, p: int, room: tuple[Float, Int]) -> None:
    best, half = room
    price, m = worth.price[p], tables.shape[0]
    for row in range(m - 1, -1, -1):
        _price_row(tables[row], price, room)
        after, before = worth.after[p, row], worth.before[p, row]
        # a walk may be complete after any row; of its half steps: those of the rows beyond
        after[LEFT] = after[RIGHT] = after[JOINED] = 0.0
        onward = worth.half[p, (row + 1) % m]
        steps = worth.half[p, row]
        for move in range(_IN_ROW.shape[0]):
            source, target, table = _IN_ROW[move, 0], _IN_ROW[move, 1], _IN_ROW[move, 2]
            most, taken = after[target], 0
            if row + 1 < m:
                for way in range(_ON.shape[0]):
                    to = _ON[way, 1]
                    there = worth.before[p, row + 1, to] - price * _ON_HALF[to]
                    if _ON[way, 0] == target and there > most:
                        most, taken = there, onward[to] + _ON_HALF[to]
            value = most + best[table]
            if value > before[source]:
                before[source], steps[source] = value, taken + half[table]
        if row + 1 < m:
            for way in range(_ON.shape[0]):
                to = _ON[way, 1]
                there = worth.before[p, row + 1, to] - price * _ON_HALF[to]
                after[_ON[way, 0]] = max(after[_ON[way, 0]], there)


@part
def _fill_up_to(tables: Float, worth: _Worth, p: int, room: tuple[Float, Int]) -> None:
    best, _ = room
    price, m = worth.price[p], tables.shape[0]
    worth.arrived[p, 0, LEFT] = 0.0
    for row in range(m):
        _price_row(tables[row], price, room)
        arrived, done = worth.arrived[p, row], worth.done[p, row]
        for move in range(_IN_ROW.shape[0]):
            source, target, table = _IN_ROW[move, 0], _IN_ROW[move, 1], _IN_ROW[move, 2]
            done[target] = max(done[target], arrived[source] + best[table])
        if row + 1 < m:
            onward = worth.arrived[p, row + 1]
            for way in range(_ON.shape[0]):
                to = _ON[way, 1]
                onward[to] = max(onward[to], done[_ON[way, 0]] - price * _ON_HALF[to])


@loop
def _narrow(worth: _Worth, limits: tuple[int, float], spans: Int) -> None:
    """Find the half steps ``(2, 2, m, 5)`` with which a walk may still hold as much as it must.

    Up to a state it holds no more than at any price, and on from it likewise: the sum of two
    straight lines in its half steps, for every pair of prices.
    """
    half, least = limits
    up_to, onward = (worth.arrived, worth.done), (worth.before, worth.after)
    for row in range(spans.shape[2]):
        for state in range(_STATES):
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
def _sweep(
    tables: Float,
    limits: tuple[_Worth, float],
    kept: _Kept,
    spans: Int,
    room: _Room,
    end: tuple[Float, Int],
) -> None:
    """Find the most reward for every state and number of half steps that are kept."""
    worth, least = limits
    m = tables.shape[0]
    kept.most[kept.start[0, LEFT]] = 0.0
    for row in range(m):
        room.done[:] = _NEVER
        for move in range(_IN_ROW.shape[0]):
            before, after, table = _IN_ROW[move, 0], _IN_ROW[move, 1], _IN_ROW[move, 2]
            low, high = kept.low[row, before], kept.high[row, before]
            first, last = spans[0, row, after], spans[1, row, after]
            if low > high or first > last:
                continue
            # what is left of the row must be worth so much at the best price
            least_here = least - worth.arrived[_BEST, row, before] - worth.after[_BEST, row, after]
            n = _worth_it(tables[row, table], (worth.price[_BEST], least_here), room)
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


@part
def _worth_it(table: Float, limits: tuple[float, float], room: _Room) -> int:
    """List the half steps of a row that bring more than fewer do, and enough; return how many."""
    price, least = limits
    most, n = _NEVER, 0
    for k in range(table.size):
        if table[k] > most:
            most = table[k]
            if most - price * k >= least:
                room.deep[n], room.value[n] = k, most
                n += 1
    return n


@part
def _spread(source: Float, target: Float, at: tuple[int, int], room: _Room) -> None:
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
        moved[h] = source[j] if 0 <= j < source.size else _NEVER
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


@part
def _go_on(kept: _Kept, spans: Int, row: int, room: _Room) -> None:
    """Take what is known after a row to before the next one."""
    for way in range(_ON.shape[0]):
        state, to = _ON[way, 0], _ON[way, 1]
        low, high = kept.low[row + 1, to], kept.high[row + 1, to]
        first, last = spans[0, row, state], spans[1, row, state]
        by = _ON_HALF[to]
        start = kept.start[row + 1, to] - low
        for h in range(max(low, first + by), min(high, last + by) + 1):
            value = room.done[state, h - by - first]
            kept.most[start + h] = max(kept.most[start + h], value)


def _euler(drives: list[Drive], n: int) -> Int:
    """Return the places of a closed walk that drives what is to be driven, each pass once."""
    passes, deep = Passes(), {}
    for drive in drives:
        row = drive.row
        passes.link((row, 0), (row, 1), drive.through)
        passes.link((row, 0), (row + 1, 0), drive.left_passes)
        passes.link((row, 1), (row + 1, 1), drive.right_passes)
        deep[row, 0], deep[row, 1] = drive.from_left, drive.from_right
    return _spell_out(passes.walk((0, 0))[::-1], deep, n)


def _spell_out(ends: list[tuple[int, int]], deep: dict[tuple[int, int], int], n: int) -> Int:
    """Return every place of a walk given by the row ends it comes by."""
    row: list[int] = []
    column: list[int] = []
    for before, end in zip([None, *ends], ends, strict=False):
        far = (n + 1) * end[1]
        if before is not None and before[0] == end[0]:
            way = range(1, n + 2) if end[1] else range(n, -1, -1)
            column += way
            row += [end[0]] * (n + 1)
        else:
            column.append(far)
            row.append(end[0])
        inward = deep.pop(end, 0)
        out = range(1, inward + 1) if not end[1] else range(n, n - inward, -1)
        column += [*out, *list(out)[-2::-1], *([far] if inward else [])]
        row += [end[0]] * (2 * inward)
    return np.stack([np.array(row, np.int64), np.array(column, np.int64)], axis=1)
