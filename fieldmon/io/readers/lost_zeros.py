"""Labels of row and plant that a spreadsheet read as decimal numbers: it makes 1.1 of 1.10.

Decisions
---------
- 1.1 is doubted only where the row has a plant 10, no position tells the two apart, and no label
  of the file ends in a zero.
- One of these besides must show that zeros were lost: some labels are padded (1.01); a label that
  may be two plants is there twice a day, as no other is; it stands next to 1.9 or 1.11; or
  `_EXPECTED` labels of the file would end in a zero if any plant were as likely as another.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.plot.grid import PlantGrid, PlantNumbers

_DECIMAL = re.compile(r"\d+[.,](\d+)")
_EXPECTED = 3.0  # by chance one file in twenty has none of so many


class _Decimals(NamedTuple):
    """Labels that look like decimal numbers, ``(k,)`` each; `open_yet` may have lost a zero."""

    record: list[int]
    written: list[str]
    line: NDArray[np.int64]
    number: NDArray[np.int64]
    open_yet: NDArray[np.bool_]


def lost_zeros(
    rows: InspectionRows, grid: PlantGrid, labelled: NDArray[np.int64]
) -> dict[int, str]:
    """Return a doubt for each plant ``(m,)``, known by its label, whose label lost a zero maybe."""
    called = [] if rows.plant_called is None else rows.plant_called.tolist()
    cells = {i: found for i in np.flatnonzero(labelled >= 0).tolist()
             if rows.plant[i] < 0 and (found := _DECIMAL.fullmatch(called[i]))}  # fmt: skip
    if not cells or any(found[1].endswith("0") for found in cells.values()):
        return {}
    which = np.array([*cells])
    line, number = plant_numbers(grid, labelled[which])
    every = plant_numbers(grid)
    ten = np.isin(line << 31 | number * 10, every.line << 31 | every.number)
    open_yet = ten & ~np.isfinite(rows.lonlat[which]).all(axis=1)
    told = _Decimals([*cells], [found[1] for found in cells.values()], line, number, open_yet)
    if not open_yet.any() or not _shows_it(told, rows, every):
        return {}
    return {
        told.record[k]: worded(
            "{label} may be plant {one} or plant {ten} of row {line}, as spreadsheets drop a last "
            "zero. Name row and plant in two columns, or write {clear}",
            label=called[told.record[k]],
            one=number[k],
            ten=number[k] * 10,
            line=line[k],
            clear=f"{line[k]}/{number[k]}",
        )
        for k in np.flatnonzero(open_yet).tolist()
    }


def _expected(every: PlantNumbers, line: NDArray[np.int64]) -> float:
    """Return how many labels of these lines ``(k,)`` would end in a zero, of plants at random."""
    lines, of = np.unique(every.line, return_inverse=True)
    share = np.bincount(of, every.number % 10 == 0) / np.bincount(of)
    return float(share[np.searchsorted(lines, line)].sum())


def _shows_it(told: _Decimals, rows: InspectionRows, every: PlantNumbers) -> bool:
    """Return whether anything shows that zeros were lost."""
    if any(written.startswith("0") for written in told.written):
        return True
    if _expected(every, told.line) >= _EXPECTED:
        return True
    return _next_to_ten(told) or _is_there_twice(told, rows)


def _next_to_ten(told: _Decimals) -> bool:
    """Return whether 1.1 stands between two records where 1.10 would: after 1.9 or before 1.11."""
    at, then = slice(None, -1), slice(1, None)
    same = told.line[at] == told.line[then]
    before = told.open_yet[then] & (told.number[at] == 10 * told.number[then] - 1)
    after = told.open_yet[at] & (told.number[then] == 10 * told.number[at] + 1)
    return bool((same & (before | after)).any())


def _is_there_twice(told: _Decimals, rows: InspectionRows) -> bool:
    """Return whether a label that may be two plants is twice of a day, and no other label is."""
    leaf = rows.leaf if rows.leaf is not None else np.full(len(rows), "")
    which = np.array(told.record)
    keys = list(
        zip(
            told.line.tolist(),
            told.number.tolist(),
            rows.face[which].tolist(),
            rows.day[which].astype(np.int64).tolist(),
            leaf[which].tolist(),
            strict=True,
        )
    )
    times = Counter(keys)
    twice = {open_yet for key, open_yet in zip(keys, told.open_yet.tolist(), strict=True)
             if times[key] > 1}  # fmt: skip
    return twice == {True}
