"""Inspections: which plant was looked at when, and what was seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import ObservationError

if TYPE_CHECKING:
    from numpy.typing import NDArray


CLEAN, FOUND, SKIPPED = 0, 1, 2


@dataclass(frozen=True, eq=False)
class Inspections:
    """Results of inspecting plants, in the order in which they were made, ``(k,)`` each.

    Parameters
    ----------
    plant
        int32.
    day
        int32 day of the season, from 0, never falling.
    result
        int8: `CLEAN`, `FOUND`, or `SKIPPED` (stood before it but could not inspect it).
    second
        Seconds since midnight; NaN where not noted.
    """

    plant: NDArray[np.int32]
    day: NDArray[np.int32]
    result: NDArray[np.int8]
    second: NDArray[np.float64]

    def __post_init__(self) -> None:
        if (np.diff(self.day) < 0).any():
            raise ObservationError("Inspections must be in the order of their days.")
        for values in vars(self).values():
            values.setflags(write=False)

    def __len__(self) -> int:
        """Return the number of inspections."""
        return len(self.plant)

    def of(self, which: NDArray[np.generic] | slice) -> Inspections:
        """Return some of them."""
        return Inspections(**{name: values[which].copy() for name, values in vars(self).items()})

    def on(self, day: int) -> Inspections:
        """Return those of one day."""
        return self.of(slice(*np.searchsorted(self.day, [day, day + 1])))

    def before(self, day: int) -> Inspections:
        """Return those of all days before `day`."""
        return self.of(slice(0, np.searchsorted(self.day, day)))

    @property
    def looked(self) -> Inspections:
        """Return those at which the plant was really inspected."""
        return self.of(self.result != SKIPPED)

    @classmethod
    def none(cls) -> Inspections:
        """Return no inspections."""
        return cls(np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0, np.int8), np.empty(0))
