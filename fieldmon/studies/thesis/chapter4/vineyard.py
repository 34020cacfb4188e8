"""The thesis's chapter 4 field: a rectangle of vine rows whose two faces are inspected apart."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.jit import routine
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

VIEWPOINTS_S = {1: 4.34, 2: 16.14, 3: 23.74}
"""Seconds at a stop for one, two and three viewpoints (thesis, chapter 4)."""

MOST_SKIPPED = 5


@dataclass(frozen=True)
class Vineyard:
    """A rectangle of vine rows; a side is one face of one row, as its aisle sees it.

    Sides run 0, 1, 2, ... over the field: aisle ``a`` lies between sides ``2a`` and ``2a + 1``; the
    outermost rows have one side each, every other row has two (odd, then even) with the same vines.

    Parameters
    ----------
    plants
        Vines in a row (P).
    vine_rows
        Rows (R); there are 2R - 2 sides.
    between_plants_m
        Distance from vine to vine along a row.
    """

    plants: int
    vine_rows: int
    between_plants_m: float

    def __post_init__(self) -> None:
        if self.plants <= MOST_SKIPPED:
            raise SettingError(
                f"A row must hold more than {MOST_SKIPPED} vines, the longest random step, "
                f"but it holds {self.plants}."
            )
        if self.vine_rows < 2:
            raise SettingError(
                f"A vineyard must have at least 2 rows around an aisle, but it has "
                f"{self.vine_rows}."
            )
        if not 0 < self.between_plants_m < math.inf:
            raise SettingError(
                f"Vines must stand more than 0 m apart, but they stand {self.between_plants_m} m "
                "apart."
            )

    @classmethod
    def from_size(
        cls, row_m: float, dunam: float, between_rows_m: float, between_plants_m: float
    ) -> Vineyard:
        """Return the field that the thesis makes of row length, area and distances.

        Halves are rounded away from zero; a dunam is 1000 square metres.
        """
        for name, value in (
            ("row length", row_m),
            ("area", dunam),
            ("distance between rows", between_rows_m),
            ("distance between plants", between_plants_m),
        ):
            if not 0 < value < math.inf:
                raise SettingError(f"The {name} must be above 0, but it is {value}.")
        return cls(
            plants=math.floor(row_m / between_plants_m + 0.5),
            vine_rows=math.floor(1000 * dunam / (row_m * between_rows_m) + 0.5),
            between_plants_m=between_plants_m,
        )

    @property
    def sides(self) -> int:
        """How many row sides face an aisle."""
        return 2 * self.vine_rows - 2

    @property
    def faces(self) -> int:
        """How many vine faces there are to inspect (T)."""
        return self.plants * self.sides

    @property
    def vines(self) -> int:
        """How many vines there are."""
        return self.plants * self.vine_rows


SCENARIOS = {
    "A": Vineyard(50, 6, 2.0),
    "B": Vineyard(67, 6, 3.0),
    "C": Vineyard(100, 6, 4.0),
}
"""The fields of tables 2, 3 and 4: 500, 670 and 1000 faces."""


@dataclass(frozen=True)
class Hours:
    """What the robot's day is spent on: the constants of chapter 4.

    Parameters
    ----------
    speed_m_s
        Driving speed along a row.
    turn_180_s
        Turning from one side of an aisle to the other.
    row_change_s
        Leaving one row and entering the next.
    day_s
        Working time a day.
    days
        Days in a run.
    """

    speed_m_s: float = 2.5 / 3.6
    turn_180_s: float = 23.0
    row_change_s: float = 25.0
    day_s: float = 7200.0
    days: int = 3

    def __post_init__(self) -> None:
        if not 0 < self.speed_m_s < math.inf:
            raise SettingError(f"Speed must be above 0 m/s, but it is {self.speed_m_s}.")
        for name in ("turn_180_s", "row_change_s"):
            if not 0 <= getattr(self, name) < math.inf:
                raise SettingError(f"{name} must be 0 s or more, but it is {getattr(self, name)}.")
        if not 0 < self.day_s <= 86_400:
            raise SettingError(f"A day must last 0 to 86400 s, but day_s is {self.day_s}.")
        if self.days < 1:
            raise SettingError(f"A run must last at least 1 day, but days is {self.days}.")


CHAPTER_4 = Hours()


@routine
def infest(plants: int, sides: int, coins: NDArray[np.float64], start: float) -> NDArray[np.bool_]:
    """Return which faces are infested at the start, ``(T,)``, side by side.

    One coin per vine, rows in order, vines in order (`coins` ``(P R,)``): a vine is infested where
    its coin is above ``1 - start``, and then on every face it has.
    """
    infested = np.zeros(sides * plants, np.bool_)
    for side in range(sides):
        row = (side + 1) // 2
        for j in range(plants):
            infested[side * plants + j] = coins[row * plants + j] > 1.0 - start
    return infested
