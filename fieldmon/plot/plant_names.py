"""What people call each plant, its row and its block, and the numbers that follow from it."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.plot.grid import block_number, plant_numbers, row_in_block

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    Int = NDArray[np.int64]

#: what people call the first and the second face of a plant
FACES = {"1": 1, "a": 1, "2": 2, "b": 2}
# names in a sentence
_NAMED = 12
# a whole number at the end of a name: 7, 07, 7.0, ROW07, ROW01VINE07; not 2.07
_NUMBER = re.compile(r"^(?!-?\d+[.,]\d*[1-9]\d*$)(?:.*\D)??0*(\d{1,6})(?:\.0+)?$")
# a name that is nothing else, and any number in a name
_PLAIN = re.compile(r"\s*\d+(?:\.0+)?\s*$")
_DIGITS = re.compile(r"(?<!\d)0*(\d{1,6})(?!\d)")


def faces_called(words: Iterable[str]) -> NDArray[np.int8]:
    """Return which face of its plant each word means ``(n,)``: 1 or 2, and 0 where it is none."""
    bare = (word.strip().casefold().removesuffix(".0") for word in words)
    return np.array([FACES.get(word, 0) for word in bare], np.int8)


class PlantNames(NamedTuple):
    """The names ``(n,)`` of row, block and plant of each measured plant, empty where it has none.

    None: no plant has one.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> fm.PlantNames(row=np.array(["R1", "R1", "R2"]))
    <PlantNames: 3 plants>
    """

    row: NDArray[np.str_] | None = None
    block: NDArray[np.str_] | None = None
    plant: NDArray[np.str_] | None = None

    def __repr__(self) -> str:
        return f"<PlantNames: {0 if self.row is None else len(self.row)} plants>"

    @classmethod
    def of(cls, field: Field) -> Self:
        """Return what a field's measured plants are called."""
        return cls(field.plant_rows, field.plant_blocks, field.plant_names)

    def on(self, field: Field) -> Field:
        """Return a field whose measured plants are called so."""
        return replace(field, plant_rows=self.row, plant_blocks=self.block, plant_names=self.plant)

    def take(self, which: NDArray[np.bool_]) -> Self:
        """Return the names of `which` plants, ``(n,)`` whether."""
        return type(self)(*(None if one is None else one[which] for one in self))


def numbered(grid: PlantGrid, lonlat: NDArray[np.float64], names: PlantNames) -> PlantGrid:
    """Return a grid of plants measured at ``(n, 2)`` with their names, and the numbers in these.

    A number is one at the end of a name. Where half of the rows have one, and no two the same,
    rows keep theirs; where no two of a block have the same, too, and count on from block to block.
    Rows without one then get one beyond all others. Plants keep theirs in rows where these tell
    all apart, if half of the rows are such. Else they count from 1. Names that are just their
    numbers are not kept.
    """
    if not grid.in_rows or all(one is None for one in names):
        return grid
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    of = cKDTree(grid.frame.xy_m(lonlat)).query(grid.xy_m)[1]
    if names.block is not None and grid.n_blocks > 1:
        blocks = block_number(grid)
        own = _lines_named(blocks - 1, names.block[of])
        numbers = np.arange(1, grid.n_blocks + 1)
        grid = replace(grid, block_named=_beyond_numbers(own, numbers))
    if names.row is not None:
        line, rows = grid.row_line[grid.row], names.row[of]
        own = _lines_named(line, rows)
        grid = replace(grid, line_called=_lines_called(grid, own))
        in_block = row_in_block(grid, np.unique(line, return_index=True)[1])
        grid = replace(grid, line_named=_beyond_numbers(own, in_block))
    if names.plant is not None:
        plants = numbers_in(names.plant)[of]
        grid = replace(grid, plant_called=_plants_called(grid, plants))
        number = plant_numbers(grid).number
        grid = replace(grid, plant_named=_beyond_numbers(names.plant[of], number))
    return grid


def _beyond_numbers(names: NDArray[np.str_], numbers: Int) -> NDArray[np.str_] | None:
    """Return names ``(k,)`` if one of them says more than its number; else None."""
    plain = np.char.isdecimal(names) & (numbers_in(names) == numbers)
    return None if plain.all() else names


def numbers_in(names: NDArray[np.str_]) -> Int:
    """Return the number at the end of each name ``(n,)``; -1 where there is none."""
    known, which = np.unique(names, return_inverse=True)
    found = (_NUMBER.match(name.strip()) for name in known.tolist())
    return np.array([int(one[1]) if one else -1 for one in found], np.int64)[which]


def _lines_called(grid: PlantGrid, names: NDArray[np.str_]) -> Int | None:
    """Return the number of each line, and that in its block, from its names ``(lines,)``.

    Lines without a number of their own get one beyond all in the names, which nobody means.
    """
    own = [name.splitlines() for name in names.tolist()]
    numbers = [set(numbers_in(np.array(one or [""])).tolist()) for one in own]
    called = np.array([one.pop() if len(one) == 1 else -1 for one in numbers], np.int64)
    on, kept = called.copy(), called[called >= 0]
    if len(np.unique(kept)) < len(kept):
        if grid.n_blocks > 1 and not kept.all():  # counted on, 0 would be a number of before
            return None
        plain = np.array([all(map(_PLAIN.match, one)) for one in own])
        first = np.unique(grid.row_line[grid.row], return_index=True)[1]
        block = block_number(grid, first)
        for k in range(1, grid.n_blocks + 1):
            mine = block == k
            called[mine] = _plainest(called[mine], plain[mine])
            kept = called[mine & (called >= 0)]
            if len(np.unique(kept)) < len(kept):
                return None
            before = on[block < k].max(initial=0)
            on[mine] = np.where(called[mine] < 0, -1, called[mine] + before)
    odd = called < 0
    if 2 * np.count_nonzero(odd) > len(odd):
        return None
    seen = [*map(int, _DIGITS.findall("\n".join(names.tolist()))), int(on.max())]
    beyond = 10 ** max(len(f"{max(seen)}"), 2) + 1
    on[odd] = called[odd] = beyond + np.arange(np.count_nonzero(odd))
    return np.stack([on, called], axis=1)


def _plainest(called: Int, plain: NDArray[np.bool_]) -> Int:
    """Return numbers ``(k,)``, -1 where one of the same is the only one that is all of its name."""
    same = called[:, None] == called
    given_up = ~plain & ((same & plain).sum(axis=1) == 1)
    return np.where(given_up, -1, called)


def _lines_named(line: NDArray[np.integer], rows: NDArray[np.str_]) -> NDArray[np.str_]:
    """Return the name of each line, or its names as lines of text, from those of its plants.

    Plants without a name say nothing.
    """
    names, which = np.unique(rows, return_inverse=True)
    own: list[list[str]] = [[] for _ in range(int(line.max()) + 1)]
    for at, name in np.unique(np.stack([line, which], axis=1), axis=0).tolist():
        own[at] += [str(names[name])] if names[name] else []
    return np.array(["\n".join(one) for one in own], np.str_)


def _plants_called(grid: PlantGrid, plants: Int) -> Int | None:
    """Return the number of each plant from those in their names ``(n,)``; None: all from 1."""
    line = grid.row_line[grid.row]
    mixed = np.unique(line[_not_told_apart(grid, plants)])
    if 2 * len(mixed) > len(np.unique(line)):
        return None
    from_one = plant_numbers(replace(grid, plant_called=None)).number
    return np.where(np.isin(line, mixed), from_one, plants)


def _not_told_apart(grid: PlantGrid, plants: Int) -> Int:
    """Return which plants have no number ``(n,)``, or that of another one of their line."""
    vines = np.unique(grid.vine)
    keys = np.stack([grid.row_line[grid.row[vines]], plants[vines]], axis=1)
    _, which, many = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    wrong: Int = vines[(plants[vines] < 0) | (many[which.ravel()] > 1)]
    return wrong


def said_of_numbers(grid: PlantGrid) -> list[str]:
    """Return which numbers rows and plants have whose names are no numbers; of many the first."""
    each = (_of_blocks(grid), _of_rows(grid), _of_rows_beyond(grid), _of_plants(grid))
    return [said for said in each if said]


def _of_blocks(grid: PlantGrid) -> str:
    if grid.block_named is None:
        return ""
    some = [
        worded("{name} is block {number}", name=first_few(name.splitlines(), 3), number=k)
        for k, name in enumerate(grid.block_named.tolist(), start=1)
    ]
    return worded("Blocks count from 1: {some}.", some=first_few(some, _NAMED))


def _of_rows(grid: PlantGrid) -> str:
    if grid.line_called is not None and grid.counts_on:
        return _of_rows_counted_on(grid, grid.line_called)
    if grid.line_named is None:
        return ""
    own = [
        (name, n)
        for name, n in zip(grid.line_named.tolist(), grid.line_number.tolist(), strict=True)
        if n not in grid.rows_beyond
    ]
    some = [
        worded("{name} is row {number}", name=first_few(name.splitlines(), 3), number=n)
        for name, n in own
        if name
    ]
    if grid.line_called is None:
        return worded(
            "Rows count from 1, since no numbers in their names tell them apart: {some}.",
            some=first_few(some, _NAMED),
        )
    if any(f"{n}" != name for name, n in own):
        return worded("Rows have the numbers in their names: {some}.", some=first_few(some, 2))
    return ""


def _of_rows_counted_on(grid: PlantGrid, called: Int) -> str:
    first = np.unique(grid.row_line, return_index=True)[1]
    block = block_number(grid, grid.row_start[first])
    some = [
        worded("row {row} of block {block} is row {number}", row=row, block=k, number=n)
        for n, row, k in zip(*called.T.tolist(), block.tolist(), strict=True)
        if n != row
    ]
    return worded(
        "Rows of several blocks have the same names and are counted on: {some}.",
        some=first_few(some, _NAMED),
    )


def _of_rows_beyond(grid: PlantGrid) -> str:
    if not grid.rows_beyond or grid.line_named is None:
        return ""
    some = [
        worded("{name} is row {number}", name=first_few(name.splitlines(), 3), number=n)
        if name
        else worded("a row without a name is row {number}", number=n)
        for name, n in zip(grid.line_named.tolist(), grid.line_number.tolist(), strict=True)
        if n in grid.rows_beyond
    ]
    return worded(
        "Rows whose names have no number of their own get one beyond all others: {some}.",
        some=first_few(some, _NAMED),
    )


def _of_plants(grid: PlantGrid) -> str:
    if grid.plant_named is None:
        return ""
    numbered = plant_numbers(grid)
    shown = np.arange(min(len(grid), 2))
    if grid.plant_called is not None:
        shown = np.flatnonzero(numbers_in(grid.plant_named) == numbered.number)[:2]
    some = [
        worded("{name} is plant {number} of row {row}", name=name, number=n, row=row)
        for name, n, row in zip(
            grid.plant_named[shown].tolist(),
            numbered.number[shown],
            numbered.line[shown],
            strict=True,
        )
    ]
    if grid.plant_called is None:
        return worded("Plants count from 1 in each row: {some}.", some=", ".join(some))
    return worded("Plants have the numbers in their names: {some}.", some=", ".join(some))


def doubts_of_numbers(grid: PlantGrid) -> list[str]:
    """Return what is to be said of names that are numbers of other rows, or of other plants."""
    return [said for said in (_doubt_of_rows(grid), _doubt_of_plants(grid)) if said]


def _doubt_of_plants(grid: PlantGrid) -> str:
    """Return which plants take the numbers in their names from all of their row."""
    if grid.plant_named is None:
        return ""
    plants = numbers_in(grid.plant_named)
    if grid.plant_called is not None and (plants == grid.plant_called).all():
        return ""
    wrong = _not_told_apart(grid, plants)
    # where most have none, or share theirs, they are meant otherwise if they are not just numbers
    not_empty = grid.plant_named[grid.plant_named != ""].tolist()
    are_numbers = 2 * sum(_PLAIN.match(name) is not None for name in not_empty) > len(not_empty)
    if not len(wrong) or (2 * len(wrong) > len(np.unique(grid.vine)) and not are_numbers):
        return ""
    line = plant_numbers(grid).line[wrong].tolist()
    names = grid.plant_named[wrong].tolist()
    some = [
        worded("{name} in row {row}", name=name or "?", row=grid.line_signs.get(row, row))
        for name, row in islice(dict.fromkeys(zip(names, line, strict=True)), _NAMED + 1)
    ]
    where = (
        worded("in all rows")
        if grid.plant_called is None
        else worded("in {n} {n:row|rows}", n=len(set(line)))
    )
    return worded(
        "Plants count from 1 {where}, not by the numbers in their names, as these do not tell them "
        "apart: {some}. Give each plant of a row a number of its own in the file.",
        where=where,
        some=first_few(some, _NAMED),
    )


def _doubt_of_rows(grid: PlantGrid) -> str:
    """Return what is to be said of rows whose names are numbers of other rows."""
    if grid.line_named is None or (grid.line_called is not None and grid.counts_on):
        return ""
    own = zip(grid.line_named.tolist(), grid.line_number.tolist(), strict=True)
    here = set(grid.line_number.tolist())
    both = [
        name
        for names, n in own
        for name in names.splitlines()
        if name.isdecimal() and int(name) != n and int(name) in here
    ]
    if not both:
        return ""
    return worded(
        "Rows are called {some} in the file, which are numbers of other rows here: such a row "
        "is refused wherever rows are written. Give each row a number of its own in the file.",
        some=first_few(list(dict.fromkeys(both)), _NAMED),
    )
