"""A treatment of some plants on some day, as what is believed knows it."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.arguments import must_be
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Treatment:
    """A spraying, or whatever else kills insects, on some plants on some day.

    Parameters
    ----------
    day
        Day of the season.
    plants
        ``(n,)`` whether each plant was treated.
    efficacy
        Chance that an infested plant is clean afterwards.
    second
        Seconds since that day's midnight at which it was over: what was inspected later on that day
        counts after it. Infinite where nobody said: it works after all of the day's inspections.
    """

    day: int
    plants: NDArray[np.bool_]
    efficacy: float
    second: float = np.inf

    def __post_init__(self) -> None:
        must_be("The efficacy of a treatment must be a chance in 0..1", self.efficacy, Real,
                "Give 0.8, for instance.")  # fmt: skip
        if not 0.0 <= self.efficacy <= 1.0:
            raise SettingError(
                worded(
                    "The efficacy of a treatment must be a chance in 0..1, but it is {efficacy}.",
                    efficacy=self.efficacy,
                )
            )
