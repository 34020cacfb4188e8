"""Lengths, areas and dates: the library's, with numbers and units in the session's language."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date

from fieldmon.compute import units as library
from fieldmon.compute.units import AREAS_M2, DATES, LENGTHS
from fieldmon.compute.wording import hours_figure

from . import texts
from .language import day_and_month, in_words, number, separators, weekday
from .signs import together

__all__ = ["AREAS_M2", "DATES", "LENGTHS", "UnitsInLanguage", "hours", "usual"]

_HALF_A_YEAR_DAYS, _TWO_MONTHS_DAYS = 182, 61


@dataclass(frozen=True)
class _InSentences(library.Units):
    """The library's units for sentences that the page shows among its own."""

    seen_from: date | None = None

    def day(self, on: date | str) -> str:
        """Return a date as the page says it."""
        own = UnitsInLanguage(self.length, self.area, self.date_like)
        return own.said_day(on, self.seen_from)


class UnitsInLanguage(library.Units):
    """How numbers are written, in the session's language."""

    @property
    def of_library(self) -> library.Units:
        """Return the same units as the library writes them, in English."""
        return library.Units(self.length, self.area, self.date_like)

    def in_sentences(self, seen_from: date) -> library.Units:
        """Return those of the library, with days as sentences of the page say them."""
        return _InSentences(self.length, self.area, self.date_like, seen_from)

    def metres(self, value_m: float, decimals: int = 0) -> str:
        """Return a length; long ones in kilometres or miles."""
        return in_words(super().metres(value_m, decimals))

    def square(self, value_m2: float) -> str:
        """Return an area."""
        return in_words(super().square(value_m2))

    def said_day(self, on: date | str, seen_from: date | None = None) -> str:
        """Return a date as people say it: weekday, day, month; its year where that is far off.

        >>> UnitsInLanguage().said_day("2026-11-16")
        'Mon 16 Nov'
        """
        day = date.fromisoformat(on) if isinstance(on, str) else on
        apart = 0 if seen_from is None else abs((day - seen_from).days)
        is_other_year = seen_from is not None and day.year != seen_from.year
        far = apart > (_TWO_MONTHS_DAYS if is_other_year else _HALF_A_YEAR_DAYS)
        said = f"{weekday(day, short=True)} {self.short_day(day)}"
        return f"{said} {day.year}" if far else said

    def said_days(self, first: date | str, last: date | str, seen_from: date | None = None) -> str:
        """Return the days from one to another in the same way: one of them, if they are the same.

        >>> UnitsInLanguage().said_days("2026-11-16", "2026-11-18")
        'Mon 16 Nov–Wed 18 Nov'
        """
        ends = dict.fromkeys((first, last))
        return "–".join(self.said_day(on, seen_from) for on in ends)

    def short_day(self, on: date) -> str:
        """Return a date without its weekday and year, for the axes of charts."""
        return day_and_month(on, month_first=DATES[self.date_like].startswith("%m"))

    def lengths_written(self) -> tuple[tuple[float, float, str, str], ...]:
        """Return how `metres` writes lengths, for the browser to do so too: short and long ones.

        Each from how many metres on, its unit in metres, what a browser writes its number by, text.

        >>> UnitsInLanguage().lengths_written()[0][:3]
        (0.0, 1.0, '0')
        """
        mark, long_m = separators()[0], 1609.344 if self.length == "ft" else 1000.0
        short, far = self.metres(0.0), self.metres(long_m)
        return (
            (0.0, LENGTHS[self.length], "0", short.replace("0", "{n}")),
            (long_m, long_m, f"0{mark}00", far.replace(number(1.0, ".2f"), "{n}")),
        )

    def lengths(self) -> list[tuple[float, str]]:
        """Return the round lengths for scale bars, shortest first: in metres and as text."""
        return [(metres, in_words(said)) for metres, said in super().lengths()]


def hours(value_h: float) -> str:
    """Return hours."""
    return together(texts.IN_HOURS.format(hours=in_words(hours_figure(value_h))))


def usual(language: str) -> UnitsInLanguage:
    """Return how numbers are usually written where a language is spoken."""
    return UnitsInLanguage(**_USUAL.get(language, {}))


_USUAL = {
    "he": {"area": "dunam", "date_like": "16.11.2026"},
    "ar": {"date_like": "16/11/2026"},
    "es": {"date_like": "16/11/2026"},
}
