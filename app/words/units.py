"""Lengths, areas and dates: the library's, with numbers and units in the session's language."""

from __future__ import annotations

from fieldmon.compute import units as library
from fieldmon.compute.units import AREAS_M2, DATES, LENGTHS

from . import texts
from .language import number

__all__ = ["AREAS_M2", "DATES", "LENGTHS", "UnitsInLanguage", "hours", "in_unit", "usual"]


class UnitsInLanguage(library.Units):
    """How numbers are written, in the session's language."""

    @property
    def of_library(self) -> library.Units:
        """Return the same units as the library writes them, in English."""
        return library.Units(self.length, self.area, self.date_like)

    def metres(self, value_m: float, decimals: int = 0) -> str:
        """Return a length; long ones in kilometres or miles."""
        if self.length == "ft" and value_m >= 1609.344:
            return in_unit(value_m / 1609.344, ".2f", "mi")
        if self.length == "m" and value_m >= 1000.0:
            return in_unit(value_m / 1000.0, ".2f", "km")
        return in_unit(value_m / LENGTHS[self.length], f".{decimals}f", self.length)

    def square(self, value_m2: float) -> str:
        """Return an area."""
        return in_unit(value_m2 / AREAS_M2[self.area], ",.2f", self.area)

    def lengths(self) -> list[tuple[float, str]]:
        """Return the round lengths for scale bars, shortest first: in metres and as text."""
        named = [(metres, text.split()) for metres, text in super().lengths()]
        return [(metres, in_unit(float(n), "g", unit)) for metres, (n, unit) in named]


def in_unit(value: float, form: str, unit: str) -> str:
    """Return a number with its unit, both as the session's language writes them."""
    return texts.IN_UNIT.format(value=number(value, form), unit=texts.UNITS[unit])


def hours(value_h: float) -> str:
    """Return hours."""
    return texts.IN_HOURS.format(hours=number(value_h, ".1f"))


def usual(language: str) -> UnitsInLanguage:
    """Return how numbers are usually written where a language is spoken."""
    return UnitsInLanguage(**_USUAL.get(language, {}))


_USUAL = {
    "he": {"area": "dunam", "date_like": "16.11.2026"},
    "ar": {"date_like": "16/11/2026"},
    "es": {"date_like": "16/11/2026"},
}
