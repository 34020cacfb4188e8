"""Rows and plants by what a person calls them: numbers, or names of the plot's file."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted, first_few, runs, worded
from fieldmon.errors import SettingError
from fieldmon.plot.grid import block_number, plant_at, plant_numbers, rows_listed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.plot.grid import PlantGrid


def plants_in_rows(grid: PlantGrid, rows: str) -> NDArray[np.bool_]:
    """Return which plants ``(n,)`` stand in rows as people count or name them.

    Raises
    ------
    SettingError
        If they are not so written, or the plot has no such row.
    """
    called, wanted = CalledRows(grid), set[int]()
    for part in rows.split(","):
        low, high = _ends(called, part.strip(), rows)
        wanted.update(row for row in called.numbers if low <= row <= high)
    plants: NDArray[np.bool_] = np.isin(plant_numbers(grid).line, sorted(wanted))
    return plants


def _ends(called: CalledRows, part: str, rows: str) -> list[int]:
    """Return the numbers of the first and the last row of a part such as 3-5 or 8."""
    if (row := called.number(part)) is not None:
        return [row, row]
    # a name may have a dash in it
    cuts = [(part[: m.start()], part[m.end() :]) for m in re.finditer(r"\s*-\s*", part)]
    for cut in cuts:
        first, last = map(called.number, cut)
        if first is not None and last is not None:
            _refuse_beyond(called, cut, (first, last))
            return sorted((first, last))
    for named in (*cuts, (part,)):
        if all(one.isdecimal() for one in named):
            raise SettingError(
                worded(
                    "Rows of this plot are {some}, but row {row} is named.",
                    some=runs(called.numbers),
                    row=next(int(one) for one in named if called.number(one) is None),
                )
            )
    raise SettingError(
        worded(
            "Rows must be such as 3-5,8, but they are {rows}. Rows of this plot are {some}.",
            rows=rows,
            some=called.listed(),
        )
    )


def place_in_words(grid: PlantGrid, plants: NDArray[np.bool_]) -> Worded:
    """Return where plants ``(n,)`` stand: the rows that they fill, or how many of which rows."""
    if plants.all():
        return worded("the whole plot")
    line = grid.row_line_number[grid.row]
    if not grid.in_rows or np.isin(line[~plants], line[plants]).any():
        return plants_in_words(grid, plants)
    rows = rows_listed(grid, line[plants])
    one = len(np.unique(line[plants])) == 1
    return worded("row {row}", row=rows) if one else worded("rows {rows}", rows=rows)


def plants_in_words(grid: PlantGrid, plants: NDArray[np.bool_]) -> Worded:
    """Return how many plants ``(n,)`` these are, both faces of one as one, and of which rows."""
    which = counted(int(np.count_nonzero(grid.vines_of(plants))), "plant")
    if not grid.in_rows:
        return which
    line = grid.row_line_number[grid.row[plants]]
    rows = rows_listed(grid, line)
    if len(np.unique(line)) == 1:
        return worded("{plants} in row {row}", plants=which, row=rows)
    return worded("{plants} in rows {rows}", plants=which, rows=rows)


def plant_meant(grid: PlantGrid, row: str, plant: int) -> int:
    """Return the plant that somebody typed by its row, a number or a name, and its number.

    Raise `FieldmonError` where there is none, or where several may be meant.
    """
    line = row_meant(grid, row)
    meant = CalledPlants(grid).meant(line, f"{plant}")
    if len(meant) > 1:
        raise SettingError(
            worded(
                "A plant must be one, but {name} may be any of plants {some} of row {row} here, by "
                "their numbers or by their names in the file of plants. Tap the plant on the map.",
                name=plant,
                some=runs(meant),
                row=grid.line_signs[line],
            )
        )
    return plant_at(grid, line, next(iter(meant), plant))


def rows_meant(grid: PlantGrid, first: str | None, last: str | None) -> tuple[int, int]:
    """Return the numbers of the first and the last row that somebody typed; None is the plot's.

    Raise `SettingError` where there is no such row, or several may be meant.
    """
    called = CalledRows(grid)
    low = min(called.numbers) if first is None else row_meant(grid, first)
    high = max(called.numbers) if last is None else row_meant(grid, last)
    _refuse_beyond(called, (first, last), (low, high))
    return low, high


def _refuse_beyond(
    called: CalledRows, ends: tuple[str | None, str | None], numbers: tuple[int, int]
) -> None:
    """Refuse rows from or to one that has no number of its own: where it lies is not told."""
    said = [end for end, number in zip(ends, numbers, strict=True) if number in called.beyond]
    name = next((end for end in said if end is not None), None)
    if name is not None and numbers[0] != numbers[1]:
        raise SettingError(
            worded(
                "Rows from one to another must have numbers of their own, but {name} has none in "
                "the file of plants. Write that row by itself.",
                name=name.strip(),
            )
        )


def row_meant(grid: PlantGrid, said: str) -> int:
    """Return the number of the row that somebody typed, by its number or its name.

    Raise `SettingError` where there is none, or where several may be meant.
    """
    called = CalledRows(grid)
    meant = called.number(said)
    if meant is None:
        raise SettingError(
            worded(
                "A row must be one of {some} on this plot, but it is {line}.",
                some=called.listed(),
                line=said,
            )
        )
    return meant


class CalledRows:
    """The rows of a plot by what a person calls them."""

    def __init__(self, grid: PlantGrid) -> None:
        self.numbers = grid.line_number.tolist()
        self._known, self._names = set(self.numbers), list[str]()
        self._counts_on = grid.n_blocks > 1 and grid.counts_on
        self.beyond = grid.rows_beyond
        self._named: dict[str, list[tuple[int, int]]] = defaultdict(list)
        if grid.line_named is not None:
            first = grid.row_start[np.unique(grid.row_line, return_index=True)[1]]
            block = block_number(grid, first).tolist()
            columns = grid.line_named.tolist(), self.numbers, block
            for names, number, of in zip(*columns, strict=True):
                for name in names.splitlines():
                    self._named[key(name)].append((number, of))
                    self._names += [] if key(name) == f"{number}" else [name]

    def listed(self) -> str:
        """Return the numbers of all rows, and some of the names that are others than these."""
        numbers, names = runs(self.numbers), dict.fromkeys(self._names)
        if all(name.isdecimal() and int(name) in self._known for name in names):
            return numbers
        return worded(
            "{numbers} (in the file of plants: {names})",
            numbers=numbers,
            names=first_few(list(names)),
        )

    def meant(self, said: str, block: int | None = None) -> set[int]:
        """Return the numbers of the rows that may be meant, perhaps those of a block.

        Not where blocks count by themselves and a number may be the block's own.
        """
        meant = {n for n, of in self._named.get(key(said), ()) if block in {None, of}}
        is_own = block is not None and self._counts_on
        if not is_own and said.strip().isdecimal() and int(said) in self._known:
            meant.add(int(said))
        return meant

    def number(self, said: str) -> int | None:
        """Return the number of the row that is meant; None: there is none.

        Raise `SettingError` where several may be meant.
        """
        meant = self.meant(said)
        if len(meant) > 1:
            raise SettingError(
                worded(
                    "A row must be one, but {name} may be any of rows {some} here, by their "
                    "numbers or by their names in the file of plants.",
                    name=said,
                    some=runs(meant),
                )
            )
        return next(iter(meant), None)


class CalledPlants:
    """The plants of a plot by what a person calls them."""

    def __init__(self, grid: PlantGrid) -> None:
        vines = np.unique(grid.vine)
        numbered, names = plant_numbers(grid, vines), grid.plant_named
        self._known = set(zip(numbered.line.tolist(), numbered.number.tolist(), strict=True))
        self._in_row: dict[tuple[int, str], set[int]] = defaultdict(set)
        self._alone: dict[str, set[int]] = defaultdict(set)
        if names is None and grid.plant_called is None:
            return
        called = numbered.number.astype(np.str_) if names is None else names[vines]
        columns = (
            called.tolist(),
            numbered.line.tolist(),
            numbered.number.tolist(),
            vines.tolist(),
        )
        for name, line, number, plant in zip(*columns, strict=True):
            self._in_row[line, key(name)].add(number)
            self._alone[key(name)].add(plant)

    def meant(self, line: int, said: str) -> set[int]:
        """Return the numbers in their row of the plants that may be meant."""
        meant = self._in_row.get((line, key(said)), set())
        if said.strip().isdecimal() and (line, int(said)) in self._known:
            meant = meant | {int(said)}
        return meant

    def plant(self, said: str) -> int | None:
        """Return the plant whose name nobody else on the plot has; None: there is none."""
        meant = self._alone.get(key(said), set())
        return next(iter(meant)) if len(meant) == 1 else None


def called_blocks(grid: PlantGrid) -> dict[str, int]:
    """Return the number of each block by the `key` of what a person calls it.

    Not by the number of one that is the name of another.
    """
    called = {f"{k}": {k} for k in range(1, grid.n_blocks + 1)}
    for k, names in enumerate([] if grid.block_named is None else grid.block_named.tolist(), 1):
        for name in names.splitlines():
            called.setdefault(key(name), set()).add(k)
    return {name: next(iter(meant)) for name, meant in called.items() if len(meant) == 1}


def key(name: str) -> str:
    """Return a name without capitals, without zeros before and a point behind whole numbers."""
    bare = re.sub(r"(?<![\d.])(\d+)\.0+$", r"\1", name.strip().casefold())
    return re.sub(r"0*(\d+)", r"\1", bare)
