"""Inspections as a file tells them. Who only takes them loads none of what reads files."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


# in front of digests in tables: of hexadecimal digits alone a spreadsheet may make a number
_IN_TABLE = "i"
_DIGEST = re.compile("[0-9a-f]{24}")
#: the row, and the number in it, of a plant that is not named by them: 0 is one where plots say so
UNSAID = -(2**31)


def mark_in_table(digest: str) -> str:
    """Return a digest of a season's file as a table has it that a spreadsheet may open."""
    return f"{_IN_TABLE}{digest}"


def is_mark(cell: str) -> bool:
    """Return whether a cell is a digest of a season's file, or one as such a table has it."""
    return bool(_DIGEST.fullmatch(cell.removeprefix(_IN_TABLE)))


def mark_of(cell: str) -> str:
    """Return the digest that such a table has in a cell; empty where it is none."""
    digest = cell.removeprefix(_IN_TABLE)
    return digest if digest != cell and _DIGEST.fullmatch(digest) else ""


@dataclass(frozen=True, eq=False)
class InspectionRows:
    """Inspections as a file tells them, one entry a record that says anything, ``(m,)`` each.

    Parameters
    ----------
    plant
        Number of the plant in the grid, as files given out have it; -1 where it is not named.
    line, number, face
        Row and number in it as people count, both `UNSAID` where one is not named; and which face,
        0 where not named.
    lonlat
        ``(m, 2)`` degrees; NaN without a position.
    accuracy_m
        Of the position; NaN where not stated.
    unread
        The position as the file has it, where nobody can read it; else empty.
    result
        int8 `PRESENT`, `ABSENT` or `UNKNOWN` (could not be inspected).
    count
        Pests counted; NaN where not counted.
    doubt
        Why a record is doubtful in itself; empty where it is not.
    when
        datetime64[s], local; NaT without a clock time.
    day
        datetime64[D]; NaT where none is stated.
    who, notes
        Text; empty where there is none.
    source_row
        Which record of the file, from 1.
    block
        What is named as the plant's block; empty where nothing is.
    face_word
        What is named as the face, where it is none that is known; else empty. None: all empty.
    leaf
        Which leaf it is of; empty where none is named. None: all empty.
    row_called, plant_called
        What is named as the row, and as the plant of it or of the plot, as the file has it; empty
        where nothing is. None: all empty.
    rest
        What all other columns say that tells it from another. None: nothing.
    detects
        Chance to see an infested plant that is inspected; NaN where none is said. None: all NaN.
    plot_called, plot_column
        What is named as the plot, empty where nothing is, and the column that does so. None: none
        does.
    mark
        The digest by which a season's file knows it, where it was exported from one; else empty.
        None: all empty.
    mark_called
        What stands where a season's file has its digest, as the file has it. None: all empty.
    lacks
        Which columns of a season's inspections the file does not have, between commas.
    n_silent
        How many records besides the file has, which say no result.
    """

    plant: NDArray[np.int64]
    line: NDArray[np.int64]
    number: NDArray[np.int64]
    face: NDArray[np.int8]
    lonlat: NDArray[np.float64]
    accuracy_m: NDArray[np.float64]
    unread: NDArray[np.str_]
    result: NDArray[np.int8]
    count: NDArray[np.float64]
    doubt: NDArray[np.str_]
    when: NDArray[np.datetime64]
    day: NDArray[np.datetime64]
    who: NDArray[np.str_]
    notes: NDArray[np.str_]
    source_row: NDArray[np.int64]
    block: NDArray[np.str_]
    face_word: NDArray[np.str_] | None = None
    leaf: NDArray[np.str_] | None = None
    row_called: NDArray[np.str_] | None = None
    plant_called: NDArray[np.str_] | None = None
    rest: NDArray[np.str_] | None = None
    detects: NDArray[np.float64] | None = None
    plot_called: NDArray[np.str_] | None = None
    plot_column: NDArray[np.str_] | None = None
    mark: NDArray[np.str_] | None = None
    mark_called: NDArray[np.str_] | None = None
    lacks: NDArray[np.str_] | None = None
    n_silent: int = 0

    @property
    def exported(self) -> NDArray[np.bool_]:
        """Which of them a season has exported, ``(m,)``: those that have a digest."""
        return np.zeros(len(self), np.bool_) if self.mark is None else self.mark != ""

    def __len__(self) -> int:
        """Return the number of records."""
        return len(self.result)

    def take(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> Self:
        """Return those records."""
        columns = vars(self).items()
        taken: dict[str, Any] = {k: c[which] for k, c in columns if isinstance(c, np.ndarray)}
        return replace(self, **taken)
