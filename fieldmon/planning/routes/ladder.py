"""The best closed walk on a ladder of rows, exactly: unit steps, one reward a plant, a budget.

Rows are swept from the start to the far side. What was walked so far touches the two headlands in
one of five ways; for each of them and each number of steps the most reward is kept. The claim, its
proof and what it assumes are in ``docs/best_routes.md``.
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
_NEVER = -1e300
_MET = -1e299
# reward tables of a row: from the left, from the right, from both, both with the right or left one
_FROM_LEFT, _FROM_RIGHT, _FROM_BOTH, _SOME_RIGHT, _SOME_LEFT = range(5)
_BLOCK = 512
_LANES = 4


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


@dataclass(frozen=True, eq=False)
class Sweep:
    """All best walks up to a budget.

    Parameters
    ----------
    reward
        ``(m, n)`` reward of each plant; the walk starts and ends at the left end of row 0.
    best
        ``(h + 1,)`` most reward of a walk of exactly 2 k steps that ends its sweep; k = 0 ... h.
    last
        ``(h + 1, 2)`` row and state in which that walk ends.
    states
        ``(m, 5, n + 2 + h)`` most reward on arrival at each row, by state and steps.
    """

    reward: Float
    best: Float
    last: Int
    states: Float

    def most(self, budget: int) -> float:
        """Return the most reward of any closed walk of so many steps."""
        return float(self.best[: budget // 2 + 1].max())

    def walk(self, budget: int) -> Walk:
        """Return a best closed walk of so many steps."""
        half = int(np.argmax(self.best[: budget // 2 + 1]))
        drives = self._drives(half)
        return Walk(_euler(drives, self.reward.shape[1]), float(self.best[half]))

    def _drives(self, half: int) -> list[Drive]:
        """Trace back what is driven in each row."""
        row, state = (int(k) for k in self.last[half])
        value, left, right = float(self.best[half]), 0, 0
        drives: list[Drive] = []
        while True:
            before, half, drive = self._source(row, state, half, value)
            drives.append(Drive(row, *drive, left, right))
            if row == 0:
                return drives[::-1]
            value = float(self.states[row, before, self._at(half)])
            row, state, half, left, right = self._arrival(row - 1, before, half, value)

    def _at(self, half: int) -> int:
        return half + int(self.reward.shape[1]) + 1

    def _source(
        self, row: int, state: int, half: int, value: float
    ) -> tuple[int, int, tuple[int, int, int]]:
        """Return the state before a row, its half steps, and what is driven in the row."""
        tables = _tables(self.reward[row])
        n = self.reward.shape[1]
        arrived = self.states[row]
        for before, through, wide in _THROUGH.get(state, ()):
            start = half - (n + 1 if wide else 0)
            if start >= 0 and arrived[before, self._at(start)] + tables[_FROM_LEFT, n] == value:
                return before, start, (through, 0, 0)
        for before, table in _IN_AND_OUT[state]:
            back = arrived[before, self._at(half) - np.arange(n + 1)]
            hits = np.flatnonzero(back + tables[table] == value)
            if len(hits):
                deep = int(hits[0])
                return before, half - deep, (0, *_depths(tables, table, deep))
        raise AssertionError("a value must have come from somewhere")

    def _arrival(
        self, row: int, state: int, half: int, value: float
    ) -> tuple[int, int, int, int, int]:
        """Return row, state and half steps before the headland, and its passes left and right."""
        left, right = _PASSES[state]
        half -= (left + right) // 2
        for after in _COMES_FROM[state]:
            if self._after(row, after, half) == value:
                return row, after, half, left, right
        raise AssertionError("a value must have come from somewhere")

    def _after(self, row: int, state: int, half: int) -> float:
        """Return the most reward once a row is done, in one state at one number of half steps."""
        if half < 0:
            return _NEVER
        tables, arrived = _tables(self.reward[row]), self.states[row]
        n = self.reward.shape[1]
        found = [_NEVER]
        for before, _, wide in _THROUGH.get(state, ()):
            start = half - (n + 1 if wide else 0)
            if start >= 0:
                found.append(float(arrived[before, self._at(start)] + tables[_FROM_LEFT, n]))
        for before, table in _IN_AND_OUT[state]:
            back = arrived[before, self._at(half) - np.arange(n + 1)]
            found.append(float((back + tables[table]).max()))
        return max(found)


#: after a row: (state before, passes of the row, whether the half steps grow by a row's)
_THROUGH = {
    ROUND: ((LEFT, 1, False), (RIGHT, 1, False), (JOINED, 1, False), (APART, 1, False)),
    JOINED: ((ROUND, 1, True), (LEFT, 2, True), (RIGHT, 2, True), (APART, 2, True)),
}
#: after a row: (state before, reward table)
_IN_AND_OUT = {
    LEFT: ((LEFT, _FROM_LEFT),),
    RIGHT: ((RIGHT, _FROM_RIGHT),),
    ROUND: ((ROUND, _FROM_BOTH),),
    JOINED: ((JOINED, _FROM_BOTH),),
    APART: ((LEFT, _SOME_RIGHT), (RIGHT, _SOME_LEFT), (APART, _FROM_BOTH)),
}
#: passes of the left and the right headland to the next row, and the states they come from
_PASSES = {LEFT: (2, 0), RIGHT: (0, 2), ROUND: (1, 1), JOINED: (2, 2), APART: (2, 2)}
_COMES_FROM = {
    LEFT: (LEFT, JOINED),
    RIGHT: (RIGHT, JOINED),
    ROUND: (ROUND,),
    JOINED: (JOINED,),
    APART: (APART,),
}


def full_budget(n_rows: int, n_plants: int) -> int:
    """Return the steps that suffice to pass every plant and come back."""
    pairs = n_rows // 2 * 2
    # an odd row is walked in and out
    return pairs * (n_plants + 1) + (n_rows - pairs) * 2 * n_plants + 2 * (n_rows - 1)


def sweep(reward: ArrayLike, budget: int) -> Sweep:
    """Find the best walks of all budgets up to one, rewards ``(m, n)`` being 0 or more.

    It takes rows x budget x plants a row operations and 20 rows x budget bytes.
    """
    values = np.ascontiguousarray(reward, np.float64)
    if values.ndim != 2 or 0 in values.shape or not (values >= 0).all():
        raise SettingError(
            "Rewards must be a matrix of numbers of 0 or more, one line a row, but they are "
            f"{values.shape} with a least value of {values.min() if values.size else 'none'}."
        )
    if budget < 0:
        raise SettingError(f"A budget must be 0 steps or more, but it is {budget}.")
    m, n = values.shape
    # more steps than that bring nothing
    half = min(budget, full_budget(m, n)) // 2
    states = np.empty((m, _STATES, n + 2 + half))
    done = np.empty((_STATES, n + 2 + half))
    best, last = np.full(half + 1, _NEVER), np.zeros((half + 1, 2), np.int64)
    room = np.empty((_STATES, n + 1)), np.empty(n + 1, np.int64), np.empty(n + 1)
    _sweep(values, states, done, (best, last), room)
    return Sweep(values, best, last, states)


def best_walk(reward: ArrayLike, budget: int) -> Walk:
    """Return a closed walk of at most so many steps with the most reward that any can have."""
    return sweep(reward, budget).walk(budget)


def _tables(reward: Float) -> Float:
    tables = np.empty((_STATES, len(reward) + 1))
    _fill_tables(reward, tables)
    return tables


@loop
def _fill_tables(reward: Float, tables: Float) -> None:
    """Fill in what a row yields for so many plants in and out, ``(5, n + 1)``."""
    n = reward.size
    left, right = tables[_FROM_LEFT], tables[_FROM_RIGHT]
    left[0] = right[0] = 0.0
    for k in range(n):
        left[k + 1] = left[k] + reward[k]
        right[k + 1] = right[k] + reward[n - 1 - k]
    # the same to the last bit, so that a row that is done counts as done
    right[n] = left[n]
    for k in range(n + 1):
        both, some_right, some_left = _NEVER, _NEVER, _NEVER
        for deep in range(k + 1):
            value = left[k - deep] + right[deep] if k < n else left[n]
            both = max(both, value)
            if deep > 0:
                some_right = max(some_right, value)
            if deep < k:
                some_left = max(some_left, value)
        tables[_FROM_BOTH, k], tables[_SOME_RIGHT, k], tables[_SOME_LEFT, k] = (
            both,
            some_right,
            some_left,
        )


def _depths(tables: Float, table: int, deep: int) -> tuple[int, int]:
    """Return how deep from the left and from the right a table's entry is."""
    n = tables.shape[1] - 1
    if table == _FROM_LEFT:
        return deep, 0
    if table == _FROM_RIGHT:
        return 0, deep
    for right in range(1 if table == _SOME_RIGHT else 0, deep + (table != _SOME_LEFT)):
        value = tables[_FROM_LEFT, deep - right] + tables[_FROM_RIGHT, right]
        if deep == n or value == tables[table, deep]:
            return deep - right, right
    raise AssertionError("a value must have come from somewhere")


@part
def _spread(
    source: Float,
    table: Float,
    target: Float,
    room: tuple[NDArray[np.int64], Float],
    end: int,
) -> None:
    """Raise target[h] to the most of source[h - k] + table[k], for all h below `end`.

    Entries of the table that bring no more than a smaller k are left out. Steps are taken in
    blocks that stay in the nearest cache, four k at a time.
    """
    deep, value = room
    pad = table.size
    most, n = _NEVER, 0
    for k in range(table.size):
        if table[k] > most:
            most = table[k]
            deep[n], value[n] = k, most
            n += 1
    for first in range(pad, pad + end, _BLOCK):
        stop = min(first + _BLOCK, pad + end)
        to = target[first:stop]
        k = 0
        while k + _LANES <= n:
            a = source[first - deep[k] : stop - deep[k]]
            b = source[first - deep[k + 1] : stop - deep[k + 1]]
            c = source[first - deep[k + 2] : stop - deep[k + 2]]
            d = source[first - deep[k + 3] : stop - deep[k + 3]]
            for h in range(to.size):
                low = max(a[h] + value[k], b[h] + value[k + 1])
                high = max(c[h] + value[k + 2], d[h] + value[k + 3])
                to[h] = max(to[h], low, high)
            k += _LANES
        while k < n:
            a = source[first - deep[k] : stop - deep[k]]
            for h in range(to.size):
                to[h] = max(to[h], a[h] + value[k])
            k += 1


@part
def _shift(source: Float, by: int, more: float, target: Float) -> None:
    """Raise target[h] to source[h - by] + more."""
    for h in range(by, target.size):
        target[h] = max(target[h], source[h - by] + more)


@part
def _cut(values: Float) -> int:
    """Take out values that more steps do not raise any more; return where the rest ends."""
    top = 0
    for h in range(values.size):
        if values[h] < _MET:
            values[h] = _NEVER
        elif values[h] > values[top]:
            top = h
    values[top + 1 :] = _NEVER
    return top + 1


@loop
def _sweep(
    reward: Float,
    states: Float,
    done: Float,
    ends: tuple[Float, NDArray[np.int64]],
    room: tuple[Float, NDArray[np.int64], Float],
) -> None:
    m, n = reward.shape
    pad = n + 1
    width = states.shape[2]
    best, last = ends
    tables, deep, value = room
    states[0] = _NEVER
    states[0, LEFT, pad] = 0.0
    for row in range(m):
        here = states[row]
        _fill_tables(reward[row], tables)
        done[:] = _NEVER
        end = 0
        for state in range(_STATES):
            end = max(end, _cut(here[state]))
        end = min(end - pad + n + 1, width - pad)
        whole = tables[_FROM_LEFT, n]
        spare = (deep, value)
        _spread(here[LEFT], tables[_FROM_LEFT], done[LEFT], spare, end)
        _spread(here[RIGHT], tables[_FROM_RIGHT], done[RIGHT], spare, end)
        _spread(here[ROUND], tables[_FROM_BOTH], done[ROUND], spare, end)
        _spread(here[JOINED], tables[_FROM_BOTH], done[JOINED], spare, end)
        _spread(here[LEFT], tables[_SOME_RIGHT], done[APART], spare, end)
        _spread(here[RIGHT], tables[_SOME_LEFT], done[APART], spare, end)
        _spread(here[APART], tables[_FROM_BOTH], done[APART], spare, end)
        for state in range(_STATES):
            if state == ROUND:
                _shift(here[ROUND], pad, whole, done[JOINED])
                continue
            _shift(here[state], 0, whole, done[ROUND])
            if state != JOINED:
                _shift(here[state], pad, whole, done[JOINED])
        for state in (LEFT, RIGHT, JOINED):
            for h in range(best.size):
                if done[state, pad + h] > best[h]:
                    best[h] = done[state, pad + h]
                    last[h, 0], last[h, 1] = row, state
        if row + 1 < m:
            there = states[row + 1]
            there[:] = _NEVER
            _shift(done[LEFT], 1, 0.0, there[LEFT])
            _shift(done[JOINED], 1, 0.0, there[LEFT])
            _shift(done[RIGHT], 1, 0.0, there[RIGHT])
            _shift(done[JOINED], 1, 0.0, there[RIGHT])
            _shift(done[ROUND], 1, 0.0, there[ROUND])
            _shift(done[JOINED], 2, 0.0, there[JOINED])
            _shift(done[APART], 2, 0.0, there[APART])


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
