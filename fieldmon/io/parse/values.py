"""Cells as people write them: numbers, counts, yes and no."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.ranges import MOST_COUNTED
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.formats.layer import text
from fieldmon.io.parse.result_words import meaning

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

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


# what programs write where a number is asked for and nothing was counted
_CODES = frozenset({999.0, 9999.0, 99999.0, 999999.0})
_FAR_BELOW = 10  # times lower are counts beside which nobody counts so many


def codes_among(counts: Iterable[float]) -> frozenset[float]:
    """Return which of some counts may stand for no value: 9999 where all others are far lower."""
    known = {count for count in counts if np.isfinite(count)}
    most = max(known - _CODES, default=np.inf)
    return frozenset(code for code in known & _CODES if _FAR_BELOW * most < code)


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
        if not low <= high:
            return CellCount(np.nan, UNKNOWN, is_rough=True)
        # of 0 to 5 there may be none
        present = PRESENT if low > 0 else UNKNOWN if high > 0 else ABSENT
        middle = np.nan if present == UNKNOWN else (low + high) / 2
        return _countable(high, CellCount(middle, present, is_rough=True))
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
