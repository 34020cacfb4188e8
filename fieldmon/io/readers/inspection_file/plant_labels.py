"""How a cell names a plant: by its number on the whole plot, or by its row and its number in it.

Decisions
---------
- A column is read in one way where figures could be either. Beside whole numbers, or typed as a
  number, 1.5 is no row 1, plant 5: a spreadsheet makes 1.1 of 1.10.
- Between two numbers a point or a comma is row and plant where none of the column is whole, and one
  of them cannot be a thousand; else it may be either, and is read as neither.
- In front of a row's number only words for rows count: Block 2-15 and Trap 4.7 are no plants.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.io.formats.layer import text
from fieldmon.plot.plant_columns import PLANT_WORDS, plain, without_numbering
from fieldmon.plot.plant_names import FACES

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_MOST = 2**31  # a plant's number, and more
_WHOLE = re.compile(r"[-+]?\d{1,10}|[1-9]\d{0,2}(?:['’]\d{3})+")
_NOUGHT = re.compile(r"([-+]?\d{1,10})[.,]0{1,2}")
_TWO = re.compile(r"(\d{1,6})[.,\s](\d{1,6})")
_THOUSANDS = re.compile(r"[1-9]\d{0,2}[.,\s]\d{3}")
_LABEL = re.compile(r"([^\d]*)(\d{1,6})\s*[/\-.,:;\s]\s*([^\d]*)(\d{1,6})([abAB]?)")
_SHORT = {"row": {"", "r", "ש"}, "plant": {"", "p", "pl", "t", "v", "nr", "no", "n", "ע"}}
_WORDS = {
    "row": {*map(plain, PLANT_WORDS["row"])} | _SHORT["row"],
    "plant": {*map(plain, (*PLANT_WORDS["plant"], *PLANT_WORDS["number"]))} | _SHORT["plant"],
}
# a minus in front is of a number that is none of a row
_MINUS = frozenset("-\u2212")


class LabelledPlants(NamedTuple):
    """What cells say, by their index: numbers, or row, number in it and face (0: not said).

    `either` are those that may be a number with thousands or row and plant, as they are written.
    """

    numbers: dict[int, int]
    labels: dict[int, tuple[int, int, int]]
    either: dict[int, str]


def plants_called(column: NDArray[np.object_], *, alone: bool = False) -> LabelledPlants:
    """Return which plants the cells ``(n,)`` of a column name; `alone`: by numbers, as was told."""
    cells = {i: text(value) for i, value in enumerate(column)}
    typed = {i for i, value in enumerate(column) if not isinstance(value, str)}
    numbers = {i: _whole(cell) for i, cell in cells.items() if _WHOLE.fullmatch(cell)}
    dotted = {i: cell for i, cell in cells.items() if i not in typed and _TWO.fullmatch(cell)}
    noughts = {i: int(found[1]) for i, cell in cells.items() if (found := _NOUGHT.fullmatch(cell))}
    either = {i: cell for i, cell in dotted.items() if _THOUSANDS.fullmatch(cell)}
    sure = dotted.keys() - either.keys() - noughts.keys()
    labels = {i: said for i, cell in cells.items()
              if i not in dotted and i not in typed and (said := _label(cell))}  # fmt: skip
    if alone:
        numbers |= {i: int(re.sub(r"\D", "", cell)) for i, cell in either.items()}
        either = {}
    elif sure and not numbers:
        labels |= {i: said for i, cell in dotted.items() if (said := _label(cell))}
        either, noughts = {}, {}
    numbers |= noughts
    return LabelledPlants({i: n for i, n in numbers.items() if abs(n) < _MOST}, labels, either)


def _whole(cell: str) -> int:
    return int(re.sub("['’]", "", cell))


def _label(cell: str) -> tuple[int, int, int] | None:
    """Return the row, the number in it and the face that a cell names; None: it names none."""
    found = _LABEL.fullmatch(cell)
    if not found or found[1].strip() in _MINUS:
        return None
    if not (_is_word("row", found[1]) and _is_word("plant", found[3])):
        return None
    return int(found[2]), int(found[4]), FACES.get(found[5].casefold(), 0)


def _is_word(role: str, written: str) -> bool:
    """Return whether what stands in front of a number is a word for rows or for plants."""
    word = plain(written)
    return word in _WORDS[role] or without_numbering(word) in _WORDS[role]
