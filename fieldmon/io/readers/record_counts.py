"""How many pests each record counts, and whether it found any."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.records import PRESENT, UNKNOWN
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, guessed, seen
from fieldmon.io.parse.columns import is_confidence, is_id, recognised
from fieldmon.io.parse.result_words import (
    ResultWords,
    about_fractions,
    about_minus,
    about_unsure,
    are_fractions,
    remedy_of_words,
)
from fieldmon.io.parse.values import codes_among, counted, is_missing, presence
from fieldmon.io.readers.inspection_file.columns import names_in
from fieldmon.io.readers.inspection_file.results import decimal_mark_in, results_in_names
from fieldmon.io.readers.other_counts import about_other_counts

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.io.parse.values import CellCount


from fieldmon.io.readers.record_columns import LOOKED_AT, RecordColumns

_FEW_WORDS = 12


class RecordCounts(NamedTuple):
    """How many each record counts ``(n,)``, NaN where nobody said, and whether any (`PRESENT`)."""

    number: NDArray[np.float64]
    present: NDArray[np.int8]
    messages: list[ImportMessage]


def counts_of(table: RecordColumns) -> RecordCounts:
    """Return how many, whether, and what was found."""
    count_name = table.named("count")
    present_name = table.named("present", frozenset({count_name} if count_name else ()))
    all_are_finds = table.options.column("present") == ""
    counts = RecordCounts(np.full(len(table), np.nan), np.full(len(table), UNKNOWN, np.int8), [])
    if count_name is not None:
        counts = _numbers_of(table, count_name)
    if present_name is not None and not all_are_finds:
        counts = _with_presence(table, present_name, counts)
    elif all_are_finds and count_name is None:
        counts.present[:] = PRESENT
        counts.messages.append(seen(worded("Every record was taken as a find, as told.")))
    elif count_name is None:
        counts = _by_names(table)
    others = about_other_counts(
        table.layer, table.options, count_name, table.used(), counts.present
    )
    return counts._replace(messages=[*counts.messages, *others.messages])


def _by_names(table: RecordColumns) -> RecordCounts:
    """Return what the names of waypoints say; ask what was found where fewer than half say it."""
    name = names_in(table.layer)
    said = [] if name is None else results_in_names(table.layer, name, table.options)
    if not said or 2 * sum(one.is_said for one in said) < len(said):
        raise _what_was_found(table)
    every = Remedy("columns", "present=", worded("Take every record as a find"))
    read = guessed(worded("What was found was read from the names."), name, every)
    number = np.array([one.how_many for one in said], dtype=np.float64)
    return RecordCounts(number, np.array([one.result for one in said], dtype=np.int8), [read])


def _what_was_found(table: RecordColumns) -> ChoiceNeeded:
    """Return the question which column says what was found, with those that could."""
    words = [*table.fitting(_are_results), *table.fitting(_hold_results)]
    numbers = [name for name in table.fitting(_are_numbers) if _could_count(table, name)]
    could = dict.fromkeys((*(f"present={n}" for n in words), *(f"count={n}" for n in numbers)))
    return ChoiceNeeded(
        worded(
            "{name} must have a column that says what was found (count, "
            "found, result), but none was recognised among: {value}. Say which one it is, or that "
            "every record is a find.",
            name=table.layer.name,
            value=", ".join(table.layer.columns) or "none",
        ),
        "columns",
        (*could, "present="),
    )


def _are_results(cells: list[str]) -> bool:
    read = [presence(cell) for cell in cells if not is_missing(cell)]
    return bool(read) and all(one != UNKNOWN for one in read) and not _are_numbers(cells)


def _hold_results(cells: list[str]) -> bool:
    """Return whether cells are a few words, one of which says what was found."""
    words = {cell for cell in cells if not is_missing(cell)}
    some = any(presence(word) != UNKNOWN for word in words)
    return len(words) <= _FEW_WORDS and some and not _are_numbers(cells)


def _could_count(table: RecordColumns, name: str) -> bool:
    """Return whether a column of numbers could count pests: no ids, no confidences."""
    cells = table.cells(name)
    if is_id(name, cells) or is_confidence(name):
        return False
    return not are_fractions(counted(cell).number for cell in cells[:LOOKED_AT])


def _are_numbers(cells: list[str]) -> bool:
    read = [counted(cell) for cell in cells if not is_missing(cell)]
    return bool(read) and all(np.isfinite(one.number) for one in read)


def _some(cells: Iterable[str]) -> str:
    """Return how a sentence shows cells: the first three that differ."""
    return ", ".join(repr(cell) for cell in list(dict.fromkeys(cells))[:3])


def _numbers_of(table: RecordColumns, name: str) -> RecordCounts:
    cells = table.cells(name)
    mark, messages = decimal_mark_in(table.layer, name, cells, table.options)
    known = {cell: counted(cell, mark) for cell in set(cells)}
    count = np.array([known[cell].number for cell in cells])
    present = np.array([known[cell].present for cell in cells], dtype=np.int8)
    messages.append(seen(worded("Counts are in column {name!r}.", name=name)))
    messages += about_fractions(name, count.tolist(), is_usual=bool(recognised([name])))
    if codes := codes_among(count.tolist()):
        of_codes = np.isin(count, [*codes])
        count[of_codes], present[of_codes] = np.nan, UNKNOWN
        messages.append(_about_codes(name, sorted(codes), int(of_codes.sum())))
    messages += _about_odd(name, [(cell, known[cell]) for cell in cells])
    return RecordCounts(count, present, messages)


def _about_odd(name: str, cells: list[tuple[str, CellCount]]) -> list[ImportMessage]:
    """Return what there is to say of cells of a column that are no plain numbers, as read."""
    messages: list[ImportMessage] = []
    unknown = [(cell, read) for cell, read in cells if read.present == UNKNOWN]
    none = [cell for cell, read in unknown if read.is_rough]
    rough = [cell for cell, read in cells if read.is_rough and read.present != UNKNOWN]
    if none:
        messages.append(
            doubtful(
                worded(
                    "{n} {n:count says|counts say} neither how many nor whether any ({shown}); "
                    "left open.",
                    n=len(none),
                    shown=_some(none),
                ),
                name,
            )
        )
    if rough:
        messages.append(
            doubtful(
                worded(
                    "{n} {n:count is|counts are} no plain number ({shown}); read roughly.",
                    n=len(rough),
                    shown=_some(rough),
                ),
                name,
            )
        )
    if n_missing := len(unknown) - len(none):
        messages.append(
            seen(
                worded(
                    "{n} {n:record has|records have} no count: not known, not zero.", n=n_missing
                ),
                name,
            )
        )
    return messages


def _about_codes(name: str, codes: list[float], n: int) -> ImportMessage:
    """Return a doubt about counts that may stand for no value."""
    said = worded(
        "{n} {n:count is|counts are} {codes}, which often stands for no value, and all others are "
        "far lower: left open. Empty such cells; where so many were counted, write found in a "
        "column of results.",
        n=n,
        codes=", ".join(f"{code:.0f}" for code in codes),
    )
    return doubtful(said, name)


def _with_presence(table: RecordColumns, name: str, counts: RecordCounts) -> RecordCounts:
    cells = table.cells(name)
    words = ResultWords(cells, table.options)
    known = {cell: _present(cell, words) for cell in set(cells)}
    stated = np.array([known[cell] for cell in cells], dtype=np.int8)
    at_odds = (stated != UNKNOWN) & (counts.present != UNKNOWN) & (stated != counts.present)
    messages = [*counts.messages, seen(worded("Presence is in column {name!r}.", name=name))]
    if at_odds.any():
        messages.append(
            doubtful(
                worded(
                    "{n} {n:record contradicts its|records contradict their} own count.",
                    n=int(at_odds.sum()),
                ),
                name,
            )
        )
    unread = sorted(cell for cell in known if known[cell] == UNKNOWN and not is_missing(cell))
    if unread:
        said = worded("These words say neither yes nor no: {shown}.", shown=_some(unread))
        messages.append(doubtful(said, name, remedy_of_words(unread, table.options)))
    messages += about_minus(cells, words)
    messages += about_unsure(name, {cell: counted(cell).number for cell in known})
    present = np.where(stated == UNKNOWN, counts.present, stated).astype(np.int8)
    return RecordCounts(counts.number, present, messages)


def _present(cell: str, words: ResultWords) -> int:
    said = words[cell]
    return presence(cell) if said is None else said
