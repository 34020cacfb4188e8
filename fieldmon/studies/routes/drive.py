"""Walks on a ladder of rows, step by step, and an independent check of what they cost and hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]


class Driven(NamedTuple):
    """What a walk took and passed."""

    steps: int
    reward: float


class Walker:
    """Walks from the left end of row 0, along rows and headlands only, noting every place."""

    def __init__(self, n_plants: int) -> None:
        self.far = n_plants + 1
        self.row, self.column = 0, 0
        self.places = [(0, 0)]

    def along(self, column: int) -> None:
        """Walk in the row to a column."""
        step = 1 if column > self.column else -1
        for each in range(self.column + step, column + step, step):
            self.places.append((self.row, each))
        self.column = column

    def to_row(self, row: int) -> None:
        """Walk in the headland to a row."""
        if self.column not in {0, self.far}:
            raise ValueError("rows can be changed in the headlands only")
        step = 1 if row > self.row else -1
        for each in range(self.row + step, row + step, step):
            self.places.append((each, self.column))
        self.row = row

    def excursion(self, row: int, deep: int) -> None:
        """Walk into a row so many plants deep from this headland, and back out."""
        self.to_row(row)
        if deep > 0:
            out = self.column
            self.along(deep if out == 0 else self.far - deep)
            self.along(out)

    def through(self, row: int) -> None:
        """Walk through a row to the other headland."""
        self.to_row(row)
        self.along(self.far - self.column)

    def home(self) -> Int:
        """Walk back to the start; return every place ``(k, 2)``."""
        if self.column != 0:
            self.along(0)
        self.to_row(0)
        return np.array(self.places, np.int64)


def driven(place: Int, reward: Float) -> Driven:
    """Check a walk step by step; raise `ValueError` if it is none, or does not come back."""
    m, n = reward.shape
    if not len(place) or tuple(place[0]) != (0, 0) or tuple(place[-1]) != (0, 0):
        raise ValueError("a walk must start and end at the left end of the first row")
    row, column = place.T
    if row.min() < 0 or row.max() >= m or column.min() < 0 or column.max() > n + 1:
        raise ValueError("a walk must stay on the plot")
    down, along = np.abs(np.diff(row)), np.abs(np.diff(column))
    if (down + along != 1).any():
        raise ValueError("a walk must go from place to place next to it")
    headland = (column[:-1] == 0) | (column[:-1] == n + 1)
    if (down[~headland] != 0).any():
        raise ValueError("a walk must not cross a row")
    plants = (column > 0) & (column <= n)
    passed = np.unique(row[plants] * n + column[plants] - 1)
    return Driven(len(place) - 1, float(reward.ravel()[passed].sum()))
