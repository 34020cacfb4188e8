"""Which lines of a table of weather were forecast, by a column's name or by what its cells say."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.infestation.records import PRESENT
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import doubtful
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.result_words import meaning

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.import_report import ImportMessage

# in plain names of columns, and in their cells
_FORECAST = re.compile(r"forecast|prognos|vorhersag|previs|pronostic|verwacht|תחזית|חזוי|توقع")
_FORECAST_IN_SHORT = frozenset({"f", "fc", "prev"})
_MEASURED = re.compile(
    r"measured|observ|actual|gemessen|messung|beobacht|mesure|medid|misurat|gemeten|waargenomen"
    r"|נמדד|מדוד|مقاس|مرصود|^(m|o|obs|real|past|reel)$"
)


def is_forecast(name: str) -> bool:
    """Return whether a column of this name says what was forecast."""
    return _FORECAST.search(plain(name)) is not None


def column_of_forecast(layer: Layer, taken: Collection[str]) -> str | None:
    """Return the column that says what was forecast, by its name or, as *type* does, by each cell.

    `taken` hold something else.
    """
    named = next((name for name in layer.columns if is_forecast(name)), None)
    free = (name for name in layer.columns if name not in taken)
    return named or next((name for name in free if _tells_forecast(layer.columns[name])), None)


def _tells_forecast(cells: NDArray[np.object_]) -> bool:
    """Return whether each cell says in words that it was forecast or measured, and some the one."""
    is_forecast = False
    for name in (plain(text(cell)) for cell in cells):
        if not _MEASURED.search(name):
            if not _FORECAST.search(name):
                return False
            is_forecast = True
    return is_forecast


def forecast_lines(
    layer: Layer, column: str | None
) -> tuple[NDArray[np.bool_], list[ImportMessage]]:
    """Return which rows a column calls forecast, and a doubt about those of which it is unclear."""
    if column is None:
        return np.zeros(len(layer), bool), []
    cells = [text(v) for v in layer.columns[column]]
    # F is forecast, but false beside T
    words = {cell.casefold() for cell in cells}
    found = {cell: _is_word_for_forecast(cell, truths="t" in words) for cell in set(cells)}
    unclear = [cell for cell in cells if cell and found[cell] is None]
    flags = np.array([found[cell] is True for cell in cells], bool)
    if not unclear:
        return flags, []
    said = worded(
        "{name} says of {n} {n:line|lines} neither that {n:it was|they were} forecast nor that "
        "{n:it was|they were} measured (the first says {cell!r}); taken as measured.",
        name=column,
        n=len(unclear),
        cell=unclear[0],
    )
    return flags, [doubtful(said)]


def _is_word_for_forecast(cell: str, *, truths: bool) -> bool | None:
    """Return whether a cell says that its line was forecast; None: it is no word for either."""
    name = plain(cell)
    if _MEASURED.search(name):
        return False
    if _FORECAST.search(name) or (name in _FORECAST_IN_SHORT and not (truths and name == "f")):
        return True
    result = meaning(cell)
    return None if result is None else result == PRESENT
