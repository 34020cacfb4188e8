"""Lengths, areas and dates as the person is used to reading them."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import TYPE_CHECKING

from fieldmon.compute.wording import figure, worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.compute.wording import Worded

LENGTHS = {"m": 1.0, "ft": 0.3048}
AREAS_M2 = {"ha": 10_000.0, "dunam": 1_000.0, "acre": 4_046.8564224}
DATES = {"2026-11-16": "%Y-%m-%d", "16.11.2026": "%d.%m.%Y", "16/11/2026": "%d/%m/%Y",
         "11/16/2026": "%m/%d/%Y"}  # fmt: skip
# of a hectare or a dunam: what is smaller is said in square metres
_SMALL = 0.1
#: a number with its unit
IN_UNIT = {"m": "{value} m", "km": "{value} km", "ft": "{value} ft", "mi": "{value} mi",
           "m2": "{value} m²",
           "ha": "{value} ha", "dunam": "{value} dunam", "acre": "{value} acre"}  # fmt: skip


def in_unit(value: float, form: str, unit: str) -> Worded:
    """Return a number with its unit."""
    return worded(IN_UNIT[unit], value=figure(value, form))


def distance_figure(metres: float) -> Worded:
    """Return a distance in metres, or in kilometres.

    Examples
    --------
    >>> distance_figure(2.53), distance_figure(111.32), distance_figure(11132.0)
    ('2.5 m', '111 m', '11.13 km')
    >>> distance_figure(2668.4), distance_figure(123456.0)
    ('2.67 km', '123 km')
    """
    if metres < 1000:
        return in_unit(metres, ".2g" if metres < 10 else ".0f", "m")
    return in_unit(metres / 1000, ".2f" if metres < 1e5 else ".0f", "km")


@dataclass(frozen=True)
class Units:
    """How numbers are written.

    Parameters
    ----------
    length
        ``"m"`` or ``"ft"``.
    area
        ``"ha"``, ``"dunam"`` or ``"acre"``.
    date_like
        An example of a date, a key of `DATES`.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Units(length="ft").metres(3.0)
    '10 ft'
    """

    length: str = "m"
    area: str = "ha"
    date_like: str = "2026-11-16"

    def __post_init__(self) -> None:
        known = {"length": [*LENGTHS], "area": [*AREAS_M2], "date_like": [*DATES]}
        for name, those in known.items():
            if not isinstance(said := getattr(self, name), str) or said not in those:
                raise SettingError(
                    f"The {name} of units must be one of {', '.join(those)}, but it is {said!r}."
                )

    def metres(self, value_m: float, decimals: int = 0) -> str:
        """Return `value_m` as text with `decimals`; long ones in kilometres or miles."""
        if self.length == "ft" and value_m >= 1609.344:
            return in_unit(value_m / 1609.344, ".2f", "mi")
        if self.length == "m" and value_m >= 1000.0:
            return in_unit(value_m / 1000.0, ".2f", "km")
        return in_unit(value_m / LENGTHS[self.length], f".{decimals}f", self.length)

    def shown(self, value_m: float) -> float:
        """Return `value_m` as a number in the chosen unit, precise to less than a millimetre."""
        return round(value_m / LENGTHS[self.length], 4)

    def in_metres(self, shown: float) -> float:
        """Return what `shown` showed, to the millimetre."""
        return round(shown * LENGTHS[self.length], 3)

    def limits(self, *values_m: float) -> tuple[float, ...]:
        """Return lengths `values_m` as limits of a box in the chosen unit."""
        return tuple(round(value_m / LENGTHS[self.length], 1) for value_m in values_m)

    def square(self, value_m2: float) -> str:
        """Return `value_m2` in three digits at least, so that parts add up.

        Below a tenth of a hectare or of a dunam it is in square metres.

        >>> import fieldmon as fm
        >>> [fm.Units().square(value_m2) for value_m2 in (150.0, 2884.0, 123456.0)]
        ['150 m²', '0.288 ha', '12.35 ha']
        """
        value = value_m2 / AREAS_M2[self.area]
        if 0 < value < _SMALL and self.length == "m" and self.area != "acre":
            return in_unit(value_m2, ".0f" if value_m2 >= 99.95 else ".3g", "m2")
        return in_unit(value, ",.2f" if value >= 0.9995 or value <= 0 else ".3g", self.area)

    @property
    def one_area(self) -> Worded:
        """Return one of the chosen unit of area, of which a cost or a rate is."""
        return in_unit(1.0, "g", self.area)

    def by_area(self, per_ha: float) -> float:
        """Return a cost or a rate `per_ha` as that of the chosen unit of area.

        >>> import fieldmon as fm
        >>> fm.Units(area="dunam").by_area(300.0)
        30.0
        """
        return float(f"{per_ha * AREAS_M2[self.area] / AREAS_M2['ha']:.8g}")

    def by_hectare(self, shown: float) -> float:
        """Return what `by_area` returned, as it is `shown`, as that of a hectare.

        >>> import fieldmon as fm
        >>> acres = fm.Units(area="acre")
        >>> acres.by_hectare(acres.by_area(300.0))
        300.0
        """
        return float(f"{shown * AREAS_M2['ha'] / AREAS_M2[self.area]:.7g}")

    @property
    def date_format(self) -> str:
        """Return how dates are typed in, in Streamlit's letters."""
        form = DATES[self.date_like]
        return form.replace("%Y", "YYYY").replace("%m", "MM").replace("%d", "DD")

    def day(self, on: date | str) -> str:
        """Return the day `on` as a date is written."""
        day = date.fromisoformat(on) if isinstance(on, str) else on
        return day.strftime(DATES[self.date_like])

    def bar_m(self, at_most_m: float) -> tuple[float, str]:
        """Return the longest round length up to `at_most_m`, in metres and as text."""
        lengths = self.lengths()
        return max([one for one in lengths if one[0] <= at_most_m], default=lengths[0])

    def lengths(self) -> list[tuple[float, str]]:
        """Return the round lengths for scale bars, shortest first: in metres and as text."""
        long_m, long = (1000.0, "km") if self.length == "m" else (1609.344, "mi")
        short = [(n * 10.0**power, self.length) for power in range(-1, 4) for n in (1, 2, 5)]
        far = [(n * 10.0**power, long) for power in range(3) for n in (1, 2, 5)]
        short_m: list[tuple[float, str]] = [
            (n * LENGTHS[self.length], in_unit(n, "g", unit)) for n, unit in short
        ]
        far_m: list[tuple[float, str]] = [(n * long_m, in_unit(n, "g", unit)) for n, unit in far]
        return [one for one in short_m if one[0] < long_m] + far_m
