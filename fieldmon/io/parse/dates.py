"""Days as people write them in cells."""

from __future__ import annotations

import re
from datetime import date, timedelta
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.io.formats.layer import text
from fieldmon.io.parse.values import MISSING

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.io.options import DateOrder

    Float = NDArray[np.float64]

_ISO = re.compile(r"^(\d{4})[-/.](\d{1,2})[-/.](\d{1,2})(?:[T\s].*)?$")
_COMPACT = re.compile(r"^(\d{4})(\d{2})(\d{2})$")
_NUMERIC = re.compile(r"^(\d{1,2})[-/. ](\d{1,2})[-/. ](\d{2}|\d{4})(?:[,T\s].*)?$")
# 5 May 26, 5. Mai 2026, 1er mai 2026, 1.º de mayo de 2026, 6 de jun. de 2026, 10 בינואר 2026
_NAMED = re.compile(
    r"^(\d{1,2})(?:st|nd|rd|th|er|\.?[ºª°])?[-/. ]*(?:(?:de|of) |d['’]|ב[- ]?)?"
    r"([^\W\d_]{3,})\.?[-/., ]*(?:(?:del?|of) )?(\d{2}|\d{4})(?:[,T\s].*)?$",
    re.IGNORECASE,
)
_NAMED_US = re.compile(
    r"^([^\W\d_]{3,})\.?[-/ ]*(\d{1,2})(?:st|nd|rd|th)?[-/., ]+(?:del? )?(\d{4})(?:\s.*)?$"
)
_WEEKDAY = (
    "monday|tuesday|wednesday|thursday|friday|saturday|sunday|"
    "mon|tue|tues|wed|thu|thur|thurs|fri|sat|sun|"
    "montag|dienstag|mittwoch|donnerstag|freitag|samstag|sonnabend|sonntag|mo|di|mi|do|fr|sa|so|"
    "lunes|martes|miércoles|miercoles|jueves|viernes|sábado|sabado|domingo|"
    "lun|mar|mié|mie|jue|vie|sáb|sab|dom|"
    "lundi|mardi|mercredi|jeudi|vendredi|samedi|dimanche|mer|jeu|ven|sam|dim|"
    "lunedì|martedì|mercoledì|giovedì|venerdì|domenica|gio|"
    "segunda-feira|terça-feira|quarta-feira|quinta-feira|sexta-feira|"
    "segunda|terça|quarta|quinta|sexta|seg|ter|qua|qui|sex|"
    "ראשון|שני|שלישי|רביעי|חמישי|שישי|שבת"
)
# what may stand before a date: Di, | Tuesday, | martes | יום ג' | Dienstag, den | le
_BEFORE = re.compile(
    rf"^(?:(?:(?:ב?יום )?(?:{_WEEKDAY}|[א-וש]['’׳])"
    r"\.?,? )(?:(?:den|the|le|el|il) |ה-?)?|(?:den|the|le|el|il) |ה-?)(?=[^\W_])",
    re.IGNORECASE,
)
_MONTHS = {
    word: month
    for month, words in enumerate(
        (
            "jan january januar ene enero janv janvier gennaio gen janeiro ינואר",
            "feb february februar feb febrero fevr février fév febbraio fevereiro fev פברואר",
            "mar march märz mär maerz mrz marzo mars março מרץ",
            "apr april abr abril avr avril aprile אפריל",
            "may mai mayo maggio mag maio מאי",
            "jun june juni junio juin giugno giu junho יוני",
            "jul july juli julio juil juillet luglio lug julho יולי",
            "aug august ago agosto aout août אוגוסט",
            "sep sept september septiembre setiembre septembre set settembre setembro ספטמבר",
            "oct october okt oktober octubre octobre ottobre ott outubro out אוקטובר",
            "nov november noviembre novembre novembro נובמבר",
            "dec december dez dezember dic diciembre déc décembre dicembre dezembro דצמבר",
        ),
        start=1,
    )
    for word in words.split()
}
_EXCEL_ZERO = date(1899, 12, 30)
_EXCEL_RANGE = (20_000, 80_000)  # 1954 to 2119: what a serial number of a day can be here


class DatedColumn(NamedTuple):
    """A column of dates: the days, and what is unclear about them."""

    day: NDArray[np.datetime64]
    order: DateOrder | None
    is_ambiguous: bool
    #: cells that are no date and not missing, by their index
    unread: dict[int, str]
    n_serial: int
    #: cells that could be day or month first, in a column that has certain ones of both kinds
    n_mixed: int = 0
    #: in such a column, how many are certain to be day first, and one of them; and month first
    sure: tuple[tuple[int, str], ...] = ()

    @property
    def broken(self) -> tuple[str, ...]:
        """Return the first few different cells that are no date."""
        return tuple(dict.fromkeys(self.unread.values()))[:5]


def dates(column: NDArray[np.object_], order: DateOrder | None = None) -> DatedColumn:
    """Return a column as days; NaT where missing or no date.

    The order of day and month is the one told; else the only one that fits all of the column. Where
    both fit, `is_ambiguous` is true and the days are read day first; where neither does, `n_mixed`
    says how many cells could be either, read day first too, and `sure` which are of one kind.
    """
    cells = [text(v) for v in column]
    distinct = sorted(set(cells))
    numeric = [found for c in distinct if (found := _NUMERIC.match(_date_alone(c)))]
    day_first = all(int(m.group(2)) <= 12 for m in numeric)
    month_first = all(int(m.group(1)) <= 12 for m in numeric)
    same = all(m.group(1).zfill(2) == m.group(2).zfill(2) for m in numeric)
    ambiguous = bool(numeric) and order is None and day_first and month_first and not same
    used: DateOrder = order or ("mdy" if month_first and not day_first else "dmy")
    known = {c: _day(c, used) for c in distinct}
    days = np.array([known[c] or "NaT" for c in cells], dtype="datetime64[D]")
    none = {c for c in distinct if known[c] is None and c.casefold() not in MISSING}
    unread = {i: c for i, c in enumerate(cells) if c in none}
    serial = sum(known[c] is not None and _is_serial(c) for c in cells)
    either = set() if day_first or month_first or order else {c for c in distinct if _either(c)}
    mixed = sum(c in either for c in cells)
    kinds: tuple[tuple[int, str], ...] = ()
    if not (day_first or month_first or order):
        which = {c: _beyond_12(c) for c in distinct}
        sure = [[c for c in cells if which[c] == k] for k in (0, 1)]
        kinds = tuple((len(one), one[0]) for one in sure if one)
    return DatedColumn(days, used if numeric else None, ambiguous, unread, serial, mixed, kinds)


def is_written_as_day(cell: str) -> bool:
    """Return whether a cell is written as days are, be it one or none (2026-02-30)."""
    return _has_form(_date_alone(cell)) or _is_serial(cell)


def _date_alone(cell: str) -> str:
    """Return a date without the weekday and the article before it; another cell as it is."""
    rest = _BEFORE.sub("", cell)
    return rest if _has_form(rest) else cell


def _has_form(cell: str) -> bool:
    return any(pattern.match(cell) for pattern, _ in _DATE_FORMS)


def _either(cell: str) -> bool:
    """Return whether a cell is one day read day first and another read month first."""
    found = _NUMERIC.match(_date_alone(cell))
    if not found:
        return False
    first, second = int(found.group(1)), int(found.group(2))
    return first <= 12 and second <= 12 and first != second


def _beyond_12(cell: str) -> int | None:
    """Return which number of a date alone can be no month: its first (0) or second; None: none."""
    found = _NUMERIC.match(_date_alone(cell))
    beyond = [] if not found else [k for k in (0, 1) if int(found.group(k + 1)) > 12]
    return beyond[0] if len(beyond) == 1 else None


def dates_of_parts(year: Float, month: Float, day: Float) -> DatedColumn:
    """Return days from three columns of numbers; NaT where they name none."""
    days, unread = [], {}
    for i, parts in enumerate(np.stack([year, month, day], axis=1).tolist()):
        whole = all(np.isfinite(parts))
        found = _valid(*(int(part) for part in parts)) if whole else None
        if whole and found is None:
            unread[i] = "-".join(f"{part:g}" for part in parts)
        days.append(found or "NaT")
    named = np.array(days, dtype="datetime64[D]")
    return DatedColumn(named, None, False, unread, 0)


def _is_serial(cell: str) -> bool:
    if not re.fullmatch(r"\d{5}(\.\d+)?", cell):
        return False
    return _EXCEL_RANGE[0] <= float(cell) <= _EXCEL_RANGE[1]


def _day(cell: str, order: DateOrder) -> date | None:
    alone = _date_alone(cell)
    for pattern, parse in _DATE_FORMS:
        found = pattern.match(alone)
        if found:
            return parse(found, order)
    if _is_serial(cell):
        return _EXCEL_ZERO + timedelta(days=int(float(cell)))
    return None


def _numeric(found: re.Match[str], order: DateOrder) -> date | None:
    first, second, third = found.groups()
    if order == "ymd":
        return _valid(_century(first), int(second), int(third)) if len(third) == 2 else None
    day, month = (first, second) if order == "dmy" else (second, first)
    return _valid(_century(third), int(month), int(day))


def _named(found: re.Match[str], _: DateOrder) -> date | None:
    day, word, year = found.groups()
    month = _MONTHS.get(word.casefold()) or _MONTHS.get(word.casefold()[:3])
    return _valid(_century(year), month, int(day)) if month else None


def _named_us(found: re.Match[str], _: DateOrder) -> date | None:
    word, day, year = found.groups()
    month = _MONTHS.get(word.casefold()) or _MONTHS.get(word.casefold()[:3])
    return _valid(int(year), month, int(day)) if month else None


def _plain_day(found: re.Match[str], _: DateOrder) -> date | None:
    return _valid(*(int(part) for part in found.groups()))


_DATE_FORMS: tuple[
    tuple[re.Pattern[str], Callable[[re.Match[str], DateOrder], date | None]], ...
] = (
    (_ISO, _plain_day),
    (_COMPACT, _plain_day),
    (_NUMERIC, _numeric),
    (_NAMED, _named),
    (_NAMED_US, _named_us),
)


def _century(year: str) -> int:
    if len(year) == 4:
        return int(year)
    return 2000 + int(year) if int(year) < 70 else 1900 + int(year)


def _valid(year: int, month: int, day: int) -> date | None:
    try:
        return date(year, month, day) if 1900 <= year <= 2200 else None
    except ValueError:
        return None
