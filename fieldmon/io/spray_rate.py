"""How much is sprayed: litres, and litres a hectare in files for a sprayer."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING

from fieldmon.compute.arguments import must_be
from fieldmon.compute.ranges import AllowedRange
from fieldmon.compute.wording import figure, worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.compute.wording import Worded

RATE_L_HA = AllowedRange(0.0, 100_000.0, above=True, below=True, unit=" litres per hectare")
USUAL_RATE_L_HA = 300.0


def must_be_rate(rate_l_ha: float) -> None:
    """Raise `SettingError` unless so many litres can be sprayed on a hectare."""
    must_be("The rate in the zones must be a number", rate_l_ha, Real, "Give litres a hectare.")
    if RATE_L_HA.broken(rate_l_ha):
        raise SettingError(
            worded(
                "The rate in the zones must lie between 0 and 100 000 litres a hectare, but it "
                "is {rate_l_ha:g}.",
                rate_l_ha=max(min(rate_l_ha, 1e300), -1e300),  # a whole number may be no float
            )
        )


def litres_figure(litres: float) -> Worded:
    """Return litres as whole ones; few in as many digits as say anything.

    Examples
    --------
    >>> litres_figure(1234.5), litres_figure(1.44), litres_figure(0.0312)
    ('1,234', '1.4', '0.031')
    """
    return figure(litres, ",.0f" if litres >= 10 or litres <= 0 else ".2g")
