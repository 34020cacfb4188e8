"""Doses of a product in the units people write them in, compared with one another."""

from __future__ import annotations

import re
from dataclasses import dataclass

from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import AllowedRange
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

WATER_L_HA = AllowedRange(0.0, 1e6, above=True, below=True, unit=" litres per hectare")
# litres or kilograms
_AMOUNTS = {
    "l": ("l", 1.0), "ltr": ("l", 1.0), "litre": ("l", 1.0), "liter": ("l", 1.0),
    "ml": ("l", 1e-3), "cc": ("l", 1e-3), "cm3": ("l", 1e-3),
    "kg": ("kg", 1.0), "g": ("kg", 1e-3), "gr": ("kg", 1e-3), "mg": ("kg", 1e-6),
}  # fmt: skip
# hectares; litres of water
_OF = {
    "ha": ("area", 1.0), "hectare": ("area", 1.0), "dunam": ("area", 0.1), "du": ("area", 0.1),
    "acre": ("area", 0.404_685_642_24), "m2": ("area", 1e-4), "100m2": ("area", 1e-2),
    "l": ("water", 1.0), "100l": ("water", 100.0), "hl": ("water", 100.0),
}  # fmt: skip


@checked
@dataclass(frozen=True)
class Dose:
    """So much of a product on an area, or in water.

    Parameters
    ----------
    value
        Above 0.
    unit
        An amount by what it is for: ``"l/ha"``, ``"ml/dunam"``, ``"g/100 l"``; or ``"%"``, litres
        in 100 litres of water.

    Raises
    ------
    SettingError
        If the value is not above 0, or the unit is none of these.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Dose(50, "ml/dunam").share_of(fm.Dose(1, "l/ha"))
    0.5
    >>> fm.Dose(0.1, "%").share_of(fm.Dose(1, "l/ha"), water_l_ha=800)
    0.8
    """

    value: float
    unit: str

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A dose's")
        if not 0.0 < self.value < 1e6:
            raise SettingError(
                worded(
                    "A dose must be above 0, and below a million, but it is {value:g}.",
                    value=self.value,
                )
            )
        _parts(self.unit)

    def __str__(self) -> str:
        """Return it as people write it."""
        if self.unit == "%":  # whose place is each language's own
            return worded("{value:g} %", value=self.value)
        return worded("{value:g} {unit}", value=self.value, unit=self.unit)

    @classmethod
    def of(cls, text: str, called: str = "A dose") -> Dose:
        """Return a dose as people write it: a number, and its unit behind it.

        Raise `SettingError`, which names what was `called` so, if the `text` is none.

        Examples
        --------
        >>> import fieldmon as fm
        >>> fm.Dose.of("0,5 l/ha")
        Dose(value=0.5, unit='l/ha')
        """
        from fieldmon.io.parse.values import told_number  # noqa: PLC0415 - commands start without

        bare = text.strip()
        unit = re.sub(r"^[0-9.,]+", "", bare)
        digits = bare.removesuffix(unit)
        if not digits:
            raise SettingError(
                worded(
                    "{called} must be a number with its unit, such as '0.5 l/ha', but it is "
                    "{text!r}.",
                    called=called,
                    text=text,
                )
            )
        return cls(told_number(digits, called), unit.strip())

    def share_of(self, other: Dose, water_l_ha: float | None = None) -> float | None:
        """Return how many times the `other` dose this is; None where the two cannot be compared.

        Litres and kilograms cannot. A dose in water and one on an area can where it is known how
        much water goes on a hectare, `water_l_ha` litres.
        """
        amount, per, size = self._sized()
        their_amount, their_per, their_size = other._sized()
        if amount != their_amount:
            return None
        if per != their_per:
            if not water_l_ha:
                return None
            size, their_size = (
                one * (water_l_ha if kind == "water" else 1.0)
                for one, kind in ((size, per), (their_size, their_per))
            )
        return float(f"{size / their_size:.9g}")  # 0.1 + 0.2 is no more than 0.3

    def _sized(self) -> tuple[str, str, float]:
        """Return litres or kilograms, of area or water, and how many by hectare or litre."""
        (amount, of_one), (per, base) = _parts(self.unit)
        return amount, per, self.value * of_one / base


def _parts(unit: str) -> tuple[tuple[str, float], tuple[str, float]]:
    bare = re.sub(r"[\s.]", "", unit.casefold()).replace("litres", "l").replace("²", "2")
    if bare in {"%", "%v/v"}:
        return ("l", 1.0), ("water", 100.0)
    amount, slash, per = bare.partition("/")
    if not slash or amount not in _AMOUNTS or per not in _OF:
        raise SettingError(
            worded(
                "The unit of a dose must be an amount by what it is for, as l/ha, "
                "ml/dunam, kg/ha, g/100 l or %, but it is {unit!r}.",
                unit=unit,
            )
        )
    return _AMOUNTS[amount], _OF[per]
