"""The best closed walk on a ladder of rows, exactly: unit steps, one reward a plant, a budget.

Rows are swept from the start to the far side. What was walked so far touches the two headlands in
one of five ways; for each of them and each number of steps the most reward is kept. A price of
steps bounds what any walk can hold that comes by a state with so many steps; what cannot come near
enough to that bound is left out. The claim, its proof and what it assumes are in
``docs/exact_walk.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.errors import SettingError
from fieldmon.planning.routes.passes import Passes
from fieldmon.planning.routes.walk_sweep import (
    BEST,
    CLOSING,
    IN_ROW,
    LEFT,
    NEVER,
    ON,
    ON_HALF,
    ONCE,
    PASSES,
    ROUND,
    STATES,
    TABLES,
    KeptStates,
    StateWorth,
    SweepRoom,
    WalkEnd,
    depths,
    fill_tables,
    narrow,
    sweep,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# bounds are taken at the best price, at some so far from it, and at some of what all plants hold
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
    return _WalkSearch(values).best(min(budget, full_budget(*values.shape)) // 2)


class _WalkSearch:
    """Looks for the best walk on a matrix of rewards."""

    def __init__(self, reward: Float) -> None:
        self.reward, self.total = reward, float(reward.sum())
        self.tables = np.full((len(reward), TABLES, reward.shape[1] + 2), NEVER)
        fill_tables(reward, self.tables)

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
        worth = StateWorth.at(prices, self.tables)
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
        worth = StateWorth.at(np.array([price]), self.tables)
        half = int(worth.half[0, 0, LEFT])
        return float(worth.before[0, 0, LEFT]) + price * half, half

    def _swept(self, worth: StateWorth, half: int, least: float) -> tuple[KeptStates, WalkEnd]:
        """Return what is kept of all walks that may hold so much, and the best one's end."""
        m, width = len(self.reward), self.tables.shape[2]
        spans = np.zeros((2, 2, m, STATES), np.int64)
        narrow(worth, (half, least), spans)
        size = np.maximum(spans[:, 1] - spans[:, 0] + 1, 0)
        start = np.cumsum(size[0]).reshape(m, STATES) - size[0]
        most = np.full(int(size[0].sum()), NEVER)
        kept = KeptStates(spans[0, 0], spans[0, 1], start, most)
        widest = int(size.max())
        room = SweepRoom(
            np.empty((STATES, widest)), np.empty(widest + width), np.zeros(width, np.int64),
            np.empty(width),
        )  # fmt: skip
        end = np.full(1, NEVER), np.zeros(3, np.int64)
        least_there = least - float(worth.price[BEST]) * half
        sweep(self.tables, (worth, least_there), kept, spans[1], room, end)
        return kept, WalkEnd(float(end[0][0]), *(int(k) for k in end[1]))

    def _drives(self, kept: KeptStates, end: WalkEnd) -> list[Drive]:
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
            passes = int(PASSES[before, 0]), int(PASSES[before, 1])
            row, half = row - 1, half - int(ON_HALF[before])
            ends = tuple(int(state) for state, on in ON if on == before)

    def _source(
        self, kept: KeptStates, at: tuple[int, int], ends: tuple[int, ...], value: float
    ) -> tuple[int, int, int]:
        """Return state before a row, table and half steps in it that lead to a value after it."""
        row, half = at
        for before, after, table in IN_ROW.tolist():
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
        if table == ONCE or (table == CLOSING and before == ROUND):
            return 1, 0, 0
        if table == CLOSING:
            return 2, 0, 0
        return 0, *depths(self.tables[row], table, k)


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
