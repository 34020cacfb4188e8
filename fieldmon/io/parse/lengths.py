"""Distances as tables write them: plain metres, or with a unit, ``25 m`` or ``11'``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.units import LENGTHS
from fieldmon.compute.wording import joined, worded
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, doubtful
from fieldmon.io.parse.values import is_missing, number, numbers, plain_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]

_SHOWN = 3
#: only what has a unit, or a mark before it, is more than a number
_WITH_UNIT = re.compile(r"(?=[±~≈]|.*\D$)[±~≈]?\s*([-+]?[\d.,]*\d)\s*([^\s\d.,].*)?")
_BRACKETS = re.compile(r"[(\[]([^)\]]*)[)\]]")
#: metres of each unit, by what it is called
UNITS_M = {
    **dict.fromkeys(("m", "mt", "mts", "metre", "metres", "meter", "meters", "metern"), 1.0),
    **dict.fromkeys(("metro", "metros", "metri", "mètre", "mètres", "м", "米"), 1.0),
    **dict.fromkeys(("מ", "מ'", "מ׳", "מטר", "מטרים", "م", "متر", "أمتار", "امتار"), 1.0),
    **dict.fromkeys(("cm", "centimetres", "centimeters"), 0.01),
    "mm": 0.001,
    "km": 1000.0,
    **dict.fromkeys(("'", "’", "′", "ft", "foot", "feet"), LENGTHS["ft"]),
    **dict.fromkeys(('"', "”", "″", "in", "inch", "inches"), LENGTHS["ft"] / 12),
}


def metres(cells: NDArray[np.object_], unit_m: float = 1.0) -> Float:
    """Return distances in metres ``(n,)``, each in the unit it is written in; NaN in any other.

    Those without one are in one of `unit_m` metres, as their column may say.
    """
    return _measured(cells, None, unit_m)


def units_said(name: str, *, at_end: bool = False) -> list[str]:
    """Return what a column's name has in brackets, in their order, as `UNITS_M` writes units.

    Only what is in brackets `at_end` of it, if that is asked for.
    """
    found = _BRACKETS.finditer(name)
    return [_unit(one[1]) for one in found if not (at_end and name[one.end() :].strip())]


def unit_m(said: str) -> float | None:
    """Return how many metres a unit is; None: it is no length."""
    return UNITS_M.get(_unit(said))


def accuracies(
    cells: NDArray[np.object_], column: str, decimal: str | None = None
) -> tuple[Float, list[ImportMessage]]:
    """Return accuracies in metres ``(n,)``, NaN where none is known, and a doubt of what is none.

    Of cells without a unit the column may say it in brackets: ``accuracy (ft)``.
    """
    usual_m = UNITS_M.get(next(iter(units_said(column)), ""), 1.0)
    stated = _measured(cells, decimal, usual_m)
    wrong = [k for k in np.flatnonzero(~np.isfinite(stated)).tolist() if not is_missing(cells[k])]
    known = np.where(stated > 0, stated, np.nan)
    if not wrong:
        return known, []
    some = [f"{one!r}" for one in dict.fromkeys(text(cells[k]) for k in wrong)]
    said = worded(
        "Accuracies must be distances such as 3, 3 m or 10 ft, but {n} {n:is|are} not: {some}. "
        "Their records count as if no accuracy was stated.",
        n=len(wrong),
        some=joined(", ", [*some[:_SHOWN], *["..."] * (len(some) > _SHOWN)]),
    )
    return known, [doubtful(said, column)]


def _measured(cells: NDArray[np.object_], decimal: str | None, usual_m: float) -> Float:
    """Return distances in metres ``(n,)``; those without a unit are in one of so many metres."""
    stated = numbers(cells, decimal) * usual_m
    if plain_numbers(cells) is not None:
        return stated
    for k, cell in enumerate(map(text, cells)):
        if found := _WITH_UNIT.fullmatch(_plain(cell)):
            value = number(found[1], decimal or ("," if "," in found[1] else "."))
            own_m = unit_m(found[2]) if found[2] else usual_m
            stated[k] = np.nan if own_m is None else value * own_m
    return stated


def _plain(cell: str) -> str:
    return cell.strip().casefold()


def _unit(said: str) -> str:
    return _plain(said).rstrip(".").rstrip()
