"""Lengths, areas and dates: the library's, with numbers and units in the session's language."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fieldmon.compute import units as library
from fieldmon.compute.units import AREAS_M2, DATES, LENGTHS

from . import texts
from .language import in_words, number

if TYPE_CHECKING:
    from datetime import date

__all__ = ["AREAS_M2", "DATES", "LENGTHS", "UnitsInLanguage", "hours", "usual"]


class UnitsInLanguage(library.Units):
    """How numbers are written, in the session's language."""

    @property
    def of_library(self) -> library.Units:
        """Return the same units as the library writes them, in English."""
        return library.Units(self.length, self.area, self.date_like)

    def metres(self, value_m: float, decimals: int = 0) -> str:
        """Return a length; long ones in kilometres or miles."""
        return in_words(super().metres(value_m, decimals))

    def square(self, value_m2: float) -> str:
        """Return an area."""
        return in_words(super().square(value_m2))

    def short_day(self, on: date) -> str:
        """Return a date without its year, for the axes of charts."""
        return on.strftime(re.sub(r"\W?%Y\W?", "", DATES[self.date_like]))

    def lengths(self) -> list[tuple[float, str]]:
        """Return the round lengths for scale bars, shortest first: in metres and as text."""
        return [(metres, in_words(said)) for metres, said in super().lengths()]


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
