"""Tables with a column for each day, or each plant, become records: one a cell filled in."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.infestation.records import UNKNOWN
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, guessed, seen
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.dates import dates
from fieldmon.io.parse.result_words import meaning
from fieldmon.io.parse.values import counted, is_missing, number
from fieldmon.io.readers.inspection_file.columns import own_column
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import RecordOptions
    from fieldmon.io.parse.dates import DatedColumn

_FEWEST = 2
# columns called by numbers that are plants of a row
_FEWEST_PLANTS = 3
# what says of which plant a line is, or what was found
_TELLING = ("plant", "count", "present", "position", "lon", "lat", "x", "y")


def by_day(layer: Layer, options: RecordOptions) -> Layer:
    """Return a table that has columns called by dates with one record a filled cell of those.

    What the cells hold becomes column ``count`` where all of them are numbers, else ``result``.
    Any other table is returned as it is.
    """
    names = list(layer.columns)
    read = dates(np.array(names, dtype=object), options.date_order)
    dated = [name for name, day in zip(names, read.day, strict=True) if not np.isnat(day)]
    if len(dated) < _FEWEST or options.column("date") is not None:
        return layer
    others = [name for name in names if name not in dated]
    stated = find("date", others)
    if stated is not None:
        said = worded(
            "{n} columns are called by dates, but the dates were taken from this one.", n=len(dated)
        )
        return layer.saying(doubtful(said, stated))
    limits.check("records", len(layer) * len(dated), limits.RECORDS, layer.name)
    days = {name: str(day) for name, day in zip(names, read.day, strict=True)}
    return _unfolded(layer, {name: days[name] for name in dated}, _about(read, dated), "date")


def by_plant(layer: Layer, options: RecordOptions) -> Layer:
    """Return a grid, a line for each row of plants and columns 1, 2, 3, ..., with a record a cell.

    Only where nothing else says which plant or what was found; any other table stays as it is.
    """
    row = options.column("row")
    row = find("row", layer.columns) if row is None else row or None
    numbered = [name for name in layer.columns if name.strip().isdecimal()]
    counts_on = [int(name) for name in numbered] == list(range(1, len(numbered) + 1))
    others = [name for name in layer.columns if name not in {row, *numbered}]
    said = any(options.column(role) or find(role, others) for role in _TELLING)
    said |= layer.geometry is not None
    said |= any(own_column(role, layer, numbered) for role in ("number", "ordinal", "id"))
    if row is None or row in numbered or not counts_on or len(numbered) < _FEWEST_PLANTS or said:
        return layer
    limits.check("records", len(layer) * len(numbered), limits.RECORDS, layer.name)
    about = worded(
        "{n} columns are called by numbers from 1: each cell is one plant of its row.",
        n=len(numbered),
    )
    plants = {name: name.strip() for name in numbered}
    return _unfolded(layer, plants, [guessed(about)], "plant")


def _unfolded(
    layer: Layer, named: dict[str, str], messages: list[ImportMessage], what_they_are: str
) -> Layer:
    """Return one record a cell of the columns that are ``named`` by days or plants."""
    cells = np.stack([layer.columns[name] for name in named], axis=1)
    filled = np.array([[bool(text(cell)) for cell in row] for row in cells], dtype=bool)
    row, column = np.nonzero(filled)
    values = cells[row, column]
    long = layer.take(row)
    columns = {name: cell for name, cell in long.columns.items() if name not in named}
    passed = [name for role in ("count", "present") if (name := find(role, columns)) is not None]
    for name in passed:
        del columns[name]
    if passed:
        messages.append(
            seen(worded("Beside them, these were passed over: {names}.", names=", ".join(passed)))
        )
    of = np.array(list(named.values()), dtype=object)[column]
    what = "count" if _are_counts(values) else "result"
    blank = filled.size - len(row)
    if blank:
        messages.append(
            seen(
                worded(
                    "{blank} {blank:cell is|cells are} not filled in: nothing is known of them.",
                    blank=blank,
                )
            )
        )
    return replace(
        long,
        columns=columns | {what_they_are: of, what: values},
        messages=(*layer.messages, *messages),
    )


def _are_counts(values: NDArray[np.object_]) -> bool:
    cells = {cell for v in values if not is_missing(cell := text(v))}
    words = {cell for cell in cells if meaning(cell) is not None and np.isnan(number(cell))}
    return not words and all(counted(cell).present != UNKNOWN for cell in cells)


def _about(read: DatedColumn, dated: list[str]) -> list[ImportMessage]:
    first, last = np.nanmin(read.day), np.nanmax(read.day)
    said = worded(
        "{n} columns are called by dates, {first} to {last}: each cell is one record.",
        n=len(dated),
        first=first,
        last=last,
    )
    messages = [seen(said)]
    if read.is_ambiguous:
        messages.append(
            guessed(
                worded(
                    "The dates above the columns could be day first or month "
                    "first; they were read day first."
                ),
                remedy=Remedy("date_order", "mdy", worded("Read month first")),
            )
        )
    return messages
