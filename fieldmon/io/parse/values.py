"""Cells as people write them: numbers, positions, dates, counts, yes and no."""

from __future__ import annotations

import re
from datetime import date, timedelta
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.ranges import MOST_COUNTED
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.observations import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.formats.layer import text
from fieldmon.io.parse.result_words import meaning

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from fieldmon.io.options import DateOrder

    Float = NDArray[np.float64]

MISSING = frozenset(
    {"", "na", "n/a", "n.a.", "nan", "null", "none given", "-", "--", "?", ".", "nd", "n.d."}
    | {"unknown", "missing", "#n/a", "<na>", "-9999", "-999", "nat", "unbekannt", "לא ידוע"}
)


def is_missing(value: object) -> bool:
    """Return whether a cell holds nothing, or a word for nothing known."""
    return text(value).casefold() in MISSING


#: no thousands begin with a zero: 0,500 is a half
_GROUPED = re.compile(r"[-+]?[1-9]\d{0,2}([.,]\d{3})+")
_COMMA = re.compile(r"[-+]?([1-9]\d{0,2}(\.\d{3})+|\d+),\d+")
_POINT = re.compile(r"[-+]?([1-9]\d{0,2}(,\d{3})+|\d+)\.\d+")


def could_be_thousands(cell: str) -> bool:
    """Return whether 1,234 may mean more than a thousand, or little more than one."""
    return bool(_GROUPED.fullmatch(cell))


def decimal_mark(cells: Iterable[str]) -> str | None:
    """Return the decimal mark that cells speak for; None where they speak for none."""
    commas = points = 0
    for cell in cells:
        commas += bool(_COMMA.fullmatch(cell))
        points += bool(_POINT.fullmatch(cell))
    return None if commas == points == 0 else "," if commas > points else "."


def mark_of_counts(
    cells: Iterable[str], others: Iterable[str], *, averages: bool = False
) -> tuple[str, str | None]:
    """Return the decimal mark of counts, and a cell for which it was guessed; None: for none.

    1,234 and 1.234 are thousands where no other count of theirs has decimals: nobody counts to a
    thousandth, unless they are `averages`. That is a guess, and so is what the `others` of the
    table tell where a column has both.
    """
    each = list(cells)
    either = [cell for cell in each if could_be_thousands(cell)]
    own = decimal_mark(cell for cell in each if not could_be_thousands(cell))
    used = {mark for cell in either for mark in ",." if mark in cell}
    if own is None and len(used) == 1:
        return ("." if ("," in used) != averages else ","), either[0]
    told = own or decimal_mark(others)
    mark = told or "."
    thousands = [cell for cell in either if mark not in cell]
    if told is None:
        return mark, next(iter(either), None)
    sure = own is not None and len(thousands) in {0, len(either)}
    return mark, None if sure else next(iter(thousands), None)


def number(cell: str, decimal: str = ".") -> float:
    """Return a number from a cell, NaN where it is none; thousands may be set apart."""
    bare = re.sub(r"[\s\u00a0\u202f'’_]", "", cell).replace("\u2212", "-")
    other = "," if decimal == "." else "."
    if other in bare:
        whole = bare.split(decimal, maxsplit=1)[0]
        if not re.fullmatch(rf"[-+]?[1-9]\d{{0,2}}(\{other}\d{{3}})+", whole):
            return np.nan
        bare = bare.replace(other, "")
    try:
        return float(bare.replace(decimal, "."))
    except ValueError:
        return np.nan


def told_number(cell: str, role: str, most: float = np.inf) -> float:
    """Return a number that a person wrote alone, with either decimal mark.

    Parameters
    ----------
    cell
        What was written.
    role
        What it is, for sentences.
    most
        The most that it can be: what is more as thousands is none.

    Raises
    ------
    SettingError
        If it is no number, or may be thousands: 1,500 is 1500 to some and 1.5 to others.
    """
    cell = cell.strip()
    bare = cell.replace(",", ".")
    if could_be_thousands(cell) and abs(thousands := float(bare.replace(".", ""))) <= most:
        whole, _, rest = bare.partition(".")
        raise SettingError(
            worded(
                "{role} is {cell}: is that {bare:g} or {other:g}? Write it without the mark, "
                "or with other decimals.",
                role=role,
                cell=cell,
                bare=thousands,
                other=float(f"{whole}.{rest.replace('.', '')}"),
            )
        )
    value = number(cell, decimal_mark([cell]) or ".")
    if not np.isfinite(value):
        raise SettingError(
            worded("{role} must be a number, but it is {cell!r}.", role=role, cell=cell)
        )
    return value


def plain_numbers(column: NDArray[np.object_]) -> Float | None:
    """Return a column as numbers ``(n,)`` if all it holds are plain ones or nothing, else None."""
    try:
        return np.array([np.nan if v is None else v for v in column.tolist()], dtype=np.float64)
    except (ValueError, TypeError):
        return None


def numbers(column: NDArray[np.object_], decimal: str | None = None) -> Float:
    """Return a column as numbers ``(n,)``; NaN where missing or not a number."""
    read = plain_numbers(column)
    if read is not None:
        return read
    cells = [text(v) for v in column]
    mark = decimal or decimal_mark(cells) or "."
    return np.array([np.nan if c.casefold() in MISSING else number(c, mark) for c in cells])


class CellCount(NamedTuple):
    """What a cell for a count says: how many, and whether there is anything."""

    number: float
    present: int
    is_rough: bool


_BOUND = re.compile(r"^(<=|>=|<|>|~|≈|≤|≥|ca\.?|about|approx\.?)?\s*([\d.,]+)\s*(\+)?$")
_PART = re.compile(r"^(\d+(?:[.,]\d+)?)\s*[%\u066a]$")
_RANGE = re.compile(r"^([\d.,]+)\s*(?:-|–|to|bis|a)\s*([\d.,]+)$")


def counted(cell: str, decimal: str = ".") -> CellCount:
    """Return what a cell for a count says; zero is absence, a missing cell is nothing known.

    Numbers that cannot have been counted say nothing.
    """
    word = cell.strip().casefold()
    if word in MISSING:
        return CellCount(np.nan, UNKNOWN, is_rough=False)
    value = number(cell, decimal)
    if np.isfinite(value):
        return _countable(value, CellCount(value, PRESENT if value > 0 else ABSENT, is_rough=False))
    said = meaning(word)
    if said is not None:
        return CellCount(np.nan if said == PRESENT else 0.0, said, is_rough=False)
    if part := _PART.match(word):
        # of a leaf: nothing is none, and how many are on 30 % of it nobody can say
        some = number(part.group(1).replace(",", ".")) > 0
        return CellCount(np.nan if some else 0.0, PRESENT if some else ABSENT, is_rough=some)
    return _roughly(word, decimal)


def _countable(highest: float, said: CellCount) -> CellCount:
    """Return what a cell says, unless the highest number in it cannot have been counted."""
    return said if 0 <= highest <= MOST_COUNTED else CellCount(np.nan, UNKNOWN, is_rough=True)


def _roughly(word: str, decimal: str) -> CellCount:
    between = _RANGE.match(word)
    if between:
        low, high = (number(part, decimal) for part in between.groups())
        present = PRESENT if high > 0 else ABSENT
        return _countable(high, CellCount((low + high) / 2, present, is_rough=True))
    bound = _BOUND.match(word)
    if not bound:
        return CellCount(np.nan, UNKNOWN, is_rough=True)
    sign, digits, _ = bound.groups()
    value = number(digits, decimal)
    if sign in {"<", "<=", "≤"}:
        # fewer than 5 were seen, so some were; fewer than 1 may be none
        some = value > 1 or (sign != "<" and value >= 1)
        return _countable(value, CellCount(np.nan, PRESENT if some else UNKNOWN, is_rough=True))
    return _countable(value, CellCount(value, PRESENT if value > 0 else UNKNOWN, is_rough=True))


def presence(cell: str, decimal: str = ".") -> int:
    """Return `PRESENT`, `ABSENT` or `UNKNOWN` for a cell that says whether."""
    word = cell.strip().casefold()
    if word in MISSING:
        return UNKNOWN
    said = meaning(word)
    return counted(cell, decimal).present if said is None else said


# --- positions ---------------------------------------------------------------------------------

_HEMISPHERE = re.compile(r"^([NSEW])\s*(.*)$|^(.*?)\s*([NSEW])$", re.IGNORECASE)
_DMS = re.compile(
    r"^([-+]?\d{1,3})\s*(?:°|º|d|deg|:|\s)\s*"
    r"(\d{1,2}(?:[.,]\d+)?)\s*(?:'|′|’|m|min|:|\s|$)\s*"
    r"(?:(\d{1,2}(?:[.,]\d+)?)\s*(?:\"|″|”|''|s|sec)?)?$",
    re.IGNORECASE,
)


#: 35.26.33: nobody can tell by looking whether its end are seconds or decimals of minutes
_DOTTED = re.compile(r"^([-+]?\d{1,3})\.(\d{1,2})\.(\d{1,6})$")


def is_dotted(cell: str) -> bool:
    """Return whether a cell holds degrees written as 35.26.33."""
    return bool(_DOTTED.match(_signed(cell.strip())[1]))


def dotted(cell: str, how: str) -> float:
    """Return degrees from ``35.26.33``, NaN for none: seconds ("dms") or decimal minutes ("dm").

    Of more than two digits for seconds, the others are their decimals.
    """
    sign, bare = _signed(cell.strip())
    parts = _DOTTED.match(bare)
    if not parts:
        return np.nan
    whole, first, rest = parts.groups()
    minutes = float(f"{first}.{rest}") if how == "dm" else float(first)
    seconds = 0.0 if how == "dm" else float(f"{rest[:2]}.{rest[2:] or 0}")
    if minutes >= 60 or seconds >= 60:
        return np.nan
    sign = -sign if whole.startswith("-") else sign
    return sign * (abs(int(whole)) + minutes / 60 + seconds / 3600)


def degrees(cell: str, decimal: str = ".", how: str | None = None) -> float:
    """Return degrees from decimal degrees, degrees-minutes-seconds or ``N 31.2``; NaN for neither.

    Minutes and seconds must be below 60: ``07.16.5046`` is not a coordinate to guess, and neither
    is the letter O, which is east in German and west in Spanish. `how` says what 35.26.33 means.
    """
    if how is not None and is_dotted(cell):
        return dotted(cell, how)
    sign, bare = _signed(cell.strip())
    bare = re.sub(r"\s+", " ", bare).replace(" °", "°").replace(" º", "º")
    # a blank here stands between degrees and minutes, never between thousands
    value = np.nan if " " in bare else number(bare.rstrip("°º"), decimal)
    if np.isfinite(value):
        return sign * value
    parts = _DMS.match(bare)
    if not parts:
        return np.nan
    whole, minutes, seconds = (float((p or "0").replace(",", ".")) for p in parts.groups())
    if minutes >= 60 or seconds >= 60 or (seconds and not minutes.is_integer()):
        return np.nan
    if bare.startswith("-"):
        sign, whole = -sign, -whole
    return sign * (whole + minutes / 60 + seconds / 3600)


def _signed(cell: str) -> tuple[float, str]:
    found = _HEMISPHERE.match(cell)
    if not found:
        return 1.0, cell
    letter = (found.group(1) or found.group(4)).upper()
    rest = found.group(2) if found.group(1) else found.group(3)
    return (-1.0 if letter in "SW" else 1.0), rest.strip()


def all_degrees(
    column: NDArray[np.object_], decimal: str | None = None, how: str | None = None
) -> Float:
    """Return a column of coordinates as degrees ``(n,)``; NaN where a cell holds none."""
    read = plain_numbers(column)
    if read is not None:
        return read
    cells = [text(v) for v in column]
    mark = decimal or decimal_mark(cells) or "."
    return np.array([degrees(c, mark, how) for c in cells])


def hemispheres(cells: Iterable[str]) -> set[str]:
    """Return the letters N, S, E, W with which cells say where they lie."""
    found = (_HEMISPHERE.match(cell.strip()) for cell in set(cells))
    return {(m.group(1) or m.group(4)).upper() for m in found if m}


class CellPositions(NamedTuple):
    """Positions that stand in one cell: ``(n, 2)`` lon, lat; NaN for none; is their order sure."""

    values: NDArray[np.float64]
    is_certain: bool


_WKT_POINT = re.compile(r"^POINT\s*Z?M?\s*\(\s*(\S+)\s+([^\s)]+).*\)$", re.IGNORECASE)


def positions_in_cells(cells: list[str], how: str | None = None) -> CellPositions:
    """Return positions from cells that hold both coordinates.

    WKT is longitude, latitude; letters say which is which; else latitude comes first, as people
    write it, unless a first number is beyond 90.
    """
    values = np.full((len(cells), 2), np.nan)
    sure = np.zeros(len(cells), dtype=bool)
    for i, cell in enumerate(cells):
        values[i], sure[i] = _pair(cell.strip(), how)
    read = np.isfinite(values).all(axis=1)
    if (np.abs(values[read & ~sure, 1]) > 90).any():
        values[~sure] = values[~sure][:, ::-1]
        sure[:] = True
    return CellPositions(values, bool(sure[read].all()))


def _pair(cell: str, how: str | None) -> tuple[tuple[float, float], bool]:
    nothing = (np.nan, np.nan)
    wkt = _WKT_POINT.match(cell)
    if wkt:
        return (number(wkt.group(1)), number(wkt.group(2))), True
    parts = halves(cell)
    if parts is None:
        return nothing, False
    first, second = (degrees(part, "," if ";" in cell else ".", how) for part in parts)
    letters = [hemispheres([part]) for part in parts]
    if letters[0] <= set("EW") and letters[1] <= set("NS") and all(letters):
        return (first, second), True
    if letters[0] <= set("NS") and letters[1] <= set("EW"):
        return (second, first), all(letters)
    return nothing, False


def halves(cell: str) -> list[str] | None:
    """Return both coordinates of a cell that holds two, or None."""
    for mark in (";", ",", "/"):
        parts = [part.strip() for part in cell.split(mark)]
        if len(parts) == 2 and all(parts):
            return parts
    lettered = re.match(r"^(.*?[NS])\s*(.*[EW])$|^([NS].*?)\s*([EW].*)$", cell, re.IGNORECASE)
    if lettered:
        return [part for part in lettered.groups() if part]
    parts = cell.split()
    return parts if len(parts) == 2 else None


# --- dates -------------------------------------------------------------------------------------

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

    @property
    def broken(self) -> tuple[str, ...]:
        """Return the first few different cells that are no date."""
        return tuple(dict.fromkeys(self.unread.values()))[:5]


def dates(column: NDArray[np.object_], order: DateOrder | None = None) -> DatedColumn:
    """Return a column as days; NaT where missing or no date.

    The order of day and month is the one told; else the only one that fits all of the column. Where
    both fit, `is_ambiguous` is true and the days are read day first; where neither does, `n_mixed`
    says how many cells could be either, read day first too.
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
    return DatedColumn(days, used if numeric else None, ambiguous, unread, serial, mixed)


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
