"""What a sprayer can switch, and what treating costs and saves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import MONEY, AllowedRange, broken_setting
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.plot.planting import PLANTED

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: what settings of `Sprayer` may be: no plot has more rows or is longer
SWITCHED = dict.fromkeys(("rows", "least_on_m", "least_off_m", "ring"), AllowedRange(0.0, 10_000.0))
#: what settings of `TreatmentCosts` may be
COSTS = {
    "per_ha": MONEY,
    "per_zone": MONEY,
    "infested_plant_day": MONEY,
    "days": AllowedRange(0.0, 3650.0),
    "works": AllowedRange(0.0, 1.0, above=True),
    "reserve": AllowedRange(0.0, 1.0, below=True),
}


@checked
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

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.AdviceSettings(sprayer=fm.Sprayer(rows=0)).sprayer.rows
    0
    """

    rows: int = 2
    least_on_m: float = 6.0
    least_off_m: float = 6.0
    ring: int = 0

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A sprayer's")
        if broken := broken_setting(self, SWITCHED):
            raise SettingError(
                worded("A sprayer's {name} must be {rule}, but it is {value:g}.", **broken)
            )

    @classmethod
    def of_boom(
        cls, boom_m: float, sections: int, row_spacing_m: float, least_on_m: float = 6.0
    ) -> Sprayer:
        """Return the sprayer of a boom: as many rows a section as stand under one, at least one.

        Parameters
        ----------
        boom_m, sections
            The boom's width, and how many sections it has.
        row_spacing_m
            From row to row.
        least_on_m
            Least length of a stretch, and of a gap.

        Raises
        ------
        SettingError
            If the boom has no width or no section, or rows do not stand apart.

        Examples
        --------
        >>> import fieldmon as fm
        >>> fm.Sprayer.of_boom(12.0, 4, row_spacing_m=1.5).rows
        2
        """
        if not (0.0 < boom_m < math.inf and sections >= 1):
            raise SettingError(
                worded(
                    "A boom must have a width above 0 and a section or more, but it has {boom_m:g} "
                    "m and {sections}.",
                    boom_m=boom_m,
                    sections=sections,
                )
            )
        if rule := PLANTED["row_spacing_m"].broken(row_spacing_m):
            raise SettingError(
                worded(
                    "The rows under a boom must be {rule} apart, but it is {spacing_m:g}.",
                    rule=rule,
                    spacing_m=row_spacing_m,
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

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.AdviceSettings(costs=fm.TreatmentCosts(per_ha=120)).costs.per_ha
    120
    """

    per_ha: float = 100.0
    per_zone: float = 0.5
    infested_plant_day: float = 0.1
    days: float = 14.0
    works: float = 0.9
    reserve: float = 0.0

    def __post_init__(self) -> None:
        must_hold_kinds(self, "The treatment's")
        if broken := broken_setting(self, COSTS):
            raise SettingError(
                worded("The treatment's {name} must be {rule}, but it is {value:g}.", **broken)
            )

    @property
    def per_infested_plant(self) -> float:
        """Return what treating an infested plant saves."""
        return self.lost_per_infested_plant * self.works

    @property
    def lost_per_infested_plant(self) -> float:
        """Return what an infested plant loses that is not treated."""
        return self.infested_plant_day * self.days
