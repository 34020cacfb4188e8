"""Degrees as people write them in cells: alone, and both of a position together."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.io.formats.layer import text
from fieldmon.io.parse.values import decimal_mark, is_missing, number, plain_numbers

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    Float = NDArray[np.float64]

_HEMISPHERE = re.compile(r"^([NSEW])\s*(.*)$|^(.*?)\s*([NSEW])$", re.IGNORECASE)
_BEGINS_A_NUMBER = re.compile(r"\s*[-+]?[.,]?\d")
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
    """Return the letters N, S, E, W with which cells of numbers say where they lie."""
    found = (_HEMISPHERE.match(cell.strip()) for cell in set(cells))
    # "lon" and "north" are words
    return {
        (m.group(1) or m.group(4)).upper()
        for m in found
        if m and _BEGINS_A_NUMBER.match(m.group(2) or m.group(3) or "")
    }


def is_lettered(cells: Iterable[str], letters: str) -> bool:
    """Return whether most cells that hold something have one of these letters N, S, E, W."""
    held = Counter(cell for cell in cells if not is_missing(cell))
    lettered = sum(n for cell, n in held.items() if hemispheres([cell]) & set(letters))
    return 2 * lettered > held.total()


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
