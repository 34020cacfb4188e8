"""What a sprayer can switch, and what treating costs and saves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

# no plot has more rows or is longer
_MOST = {"rows": 10_000, "least_on_m": 10_000.0, "least_off_m": 10_000.0, "ring": 10_000}


@dataclass(frozen=True)
class Sprayer:
    """What can be switched.

    Parameters
    ----------
    rows
        Rows that one section covers; 0: plants are sprayed one by one, with a knapsack.
    least_on_m, least_off_m
        Least length along the rows of a stretch that is sprayed, and of a gap between two.
    ring
        With a knapsack: how many plants around each chosen one are sprayed with it.

    Raises
    ------
    SettingError
        If a number is below 0, or beyond any plot.
    """

    rows: int = 2
    least_on_m: float = 6.0
    least_off_m: float = 6.0
    ring: int = 0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0 <= value < np.inf:
                raise SettingError(
                    worded(
                        "A sprayer's {name} must be 0 or more, but it is {value:g}.",
                        name=name.replace("_", " "),
                        value=value,
                    )
                )
            if value > _MOST[name]:
                raise SettingError(
                    worded(
                        "A sprayer's {name} must be {most:g} at most, but it is {value:g}.",
                        name=name.replace("_", " "),
                        most=_MOST[name],
                        value=value,
                    )
                )

    @classmethod
    def of_boom(
        cls, boom_m: float, sections: int, row_spacing_m: float, least_on_m: float = 6.0
    ) -> Sprayer:
        """Return the sprayer of a boom: as many rows a section as stand under one, at least one.

        Raises
        ------
        SettingError
            If the boom has no width or no section.

        Examples
        --------
        >>> Sprayer.of_boom(12.0, 4, row_spacing_m=1.5).rows
        2
        """
        if not (boom_m > 0.0 and sections >= 1):
            raise SettingError(
                worded(
                    "A boom must have a width above 0 and a section or more, but it has {boom_m:g} "
                    "m and {sections}.",
                    boom_m=boom_m,
                    sections=sections,
                )
            )
        rows = max(1, int(boom_m / sections / row_spacing_m + 1e-9))
        return cls(rows, least_on_m, least_on_m)


@dataclass(frozen=True)
class TreatmentCosts:
    """What treating costs, and what not treating does; in one currency.

    Parameters
    ----------
    per_ha
        Product, water and work for a hectare sprayed.
    per_zone
        Each zone: switching on and off, slowing down, overlap.
    infested_plant_day
        Loss by a plant that is infested for a day.
    days
        How long an infested plant stays so if it is not treated.
    works
        Chance that an infested plant is clean after the treatment.
    reserve
        Share of the plot that is never sprayed, from which predators and mites that no product
        was tried on come back (resistance).

    Raises
    ------
    SettingError
        If a number cannot be.
    """

    per_ha: float = 100.0
    per_zone: float = 0.5
    infested_plant_day: float = 0.1
    days: float = 14.0
    works: float = 0.9
    reserve: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.reserve < 1.0:
            raise SettingError(
                worded(
                    "The share that is never sprayed must be 0 or more and below 1, but it is "
                    "{reserve:g}.",
                    reserve=self.reserve,
                )
            )
        for name, value in vars(self).items():
            if not 0.0 <= value < np.inf:
                raise SettingError(
                    worded(
                        "The cost {name!r} must be 0 or more, but it is {value:g}.",
                        name=name.replace("_", " "),
                        value=value,
                    )
                )
        if not 0.0 < self.works <= 1.0:
            raise SettingError(
                worded(
                    "The chance that a treatment works must be above 0 and at most 1, but it is "
                    "{works:g}.",
                    works=self.works,
                )
            )

    @property
    def per_infested_plant(self) -> float:
        """Return what treating an infested plant saves."""
        return self.infested_plant_day * self.days * self.works
