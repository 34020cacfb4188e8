"""What was found, as cells say it: words in many languages, signs, counts, names of waypoints."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, guessed, seen
from fieldmon.io.parse.columns import is_average, recognised
from fieldmon.io.parse.result_words import (
    MAYBE_GONE,
    MINUS,
    NOT_INSPECTED,
    ResultWords,
    about_confidences,
    about_fractions,
    about_mark,
    about_minus,
    about_unsure,
    is_gone,
    plain_word,
    remedy_of_words,
)
from fieldmon.io.parse.values import (
    codes_among,
    counted,
    is_missing,
    mark_of_counts,
    number,
    presence,
)
from fieldmon.io.readers.inspection_file.columns import names_in
from fieldmon.io.readers.inspection_file.plants import PLANT_IN_NAME
from fieldmon.io.readers.other_counts import about_other_counts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import RecordOptions
    from fieldmon.io.readers.inspection_file.columns import InspectionColumns
    from fieldmon.io.readers.inspection_options import InspectionOptions

# cells of each other column that may tell the decimal mark
_LOOKED_AT = 200
# what stands for no value where a number is asked for, and for a result says something
_SAYS_SOMETHING = MAYBE_GONE | {"?"}
_PLUS = re.compile(r"^\+\s*(\d*)$")
_COUNT_BEHIND = re.compile(r"\s+\+\d+\s*$")


class SeenResults(NamedTuple):
    """What was seen, ``(n,)`` each; `said` where anything at all was written down.

    `gone` are the rows whose result says that the plant does not stand there any more, `unread`
    those in which something is written that says nothing.
    """

    result: NDArray[np.int8]
    how_many: NDArray[np.float64]
    doubt: NDArray[np.str_]
    said: NDArray[np.bool_]
    messages: list[ImportMessage]
    gone: NDArray[np.bool_]
    unread: NDArray[np.bool_]


class CellResult(NamedTuple):
    """What one cell says."""

    result: int
    how_many: float
    is_said: bool
    is_read: bool = True


_SILENT = CellResult(UNKNOWN, np.nan, is_said=False)
_NOT_INSPECTED = CellResult(UNKNOWN, np.nan, is_said=True)


def results_in(layer: Layer, columns: InspectionColumns, options: InspectionOptions) -> SeenResults:
    """Return what was seen at each plant of a layer."""
    if columns.marks is not None:
        said = results_in_names(layer, columns.marks, options)
        seen_so = _put_together(said, [_SILENT] * len(said), [])
        return seen_so._replace(doubt=_doubt_of_names(layer, columns.marks, options, seen_so))
    by_result, of_results = _by_result(layer, columns.result, options)
    by_count, of_counts = _by_count(layer, columns.number_found, options)
    taken = (columns.result, columns.number_found, *options.named_columns)
    messages = [*of_results, *of_counts, *about_confidences(layer.columns, taken)]
    seen_so = _put_together(by_result, by_count, messages)
    others = about_other_counts(layer, options, columns.number_found, columns, seen_so.result)
    doubt = np.where(seen_so.doubt == "", others.doubt, seen_so.doubt)
    doubt = np.where(doubt == "", _doubt_of_codes(seen_so.how_many), doubt)
    seen_so = seen_so._replace(doubt=doubt, messages=[*seen_so.messages, *others.messages])
    if columns.result is None:
        against = _doubt_of_names(layer, names_in(layer), options, seen_so)
        return seen_so._replace(doubt=np.where(seen_so.doubt == "", against, seen_so.doubt))
    column = layer.column(columns.result)
    gone = np.array([is_gone(text(v), options.gone) for v in column], np.bool_)
    return seen_so._replace(gone=gone & (seen_so.result == UNKNOWN))


def _doubt_of_codes(counts: NDArray[np.float64]) -> NDArray[np.str_]:
    """Return why counts ``(n,)`` are doubted that may stand for no value; empty: they are not."""
    codes = codes_among(counts.tolist())
    return np.array(
        [
            worded(
                "its count is {count:.0f}, which often stands for no value, and all others are far "
                "lower",
                count=count,
            )
            if count in codes
            else ""
            for count in counts.tolist()
        ],
        np.str_,
    )


def _doubt_of_names(
    layer: Layer, name: str | None, options: InspectionOptions, seen_so: SeenResults
) -> NDArray[np.str_]:
    """Return why rows are doubted ``(n,)`` whose names say in a word what their counts do not."""
    if name is None:
        return np.full(len(layer), "", np.str_)
    words = ResultWords(["+"], options)
    said = [_of_mark(_COUNT_BEHIND.sub("", text(v)), words) for v in layer.column(name)]
    in_words = np.array([one.result for one in said], np.int8)
    spoken = seen_so.said & np.array([one.is_said for one in said], np.bool_)
    return np.where(_against(spoken, in_words, seen_so.result), _contradicts(), "")


def _against(
    spoken: NDArray[np.bool_], result: NDArray[np.int8], by_count: NDArray[np.int8]
) -> NDArray[np.bool_]:
    """Return in which rows ``(n,)`` a result that is said and a count contradict each other."""
    against: NDArray[np.bool_] = spoken & (by_count != UNKNOWN) & (result != by_count)
    against &= (result != UNKNOWN) | (by_count == PRESENT)
    return against


def _contradicts() -> str:
    return worded("its result and its count contradict each other")


def _by_result(
    layer: Layer, column: str | None, options: InspectionOptions
) -> tuple[list[CellResult], list[ImportMessage]]:
    """Return what the cells of a column for results say, and what to say of them."""
    if column is None:
        return [_SILENT] * len(layer), []
    cells = [text(v) for v in layer.column(column)]
    words = ResultWords(cells, options)
    mark, guess = decimal_mark_in(layer, column, cells, options)
    known = {cell: result_of(cell, mark, words) for cell in set(cells)}
    known |= {cell: _NOT_INSPECTED for cell in known if is_gone(cell, options.gone)}
    return [known[cell] for cell in cells], [
        (seen if _is_named(column, options) else guessed)(
            worded("Results are in column {result!r}.", result=column)
        ),
        *guess,
        *_unread(cells, known, options),
        *about_minus(cells, words),
        *about_unsure(column, {cell: counted(cell, mark).number for cell in known}),
    ]


def _by_count(
    layer: Layer, column: str | None, options: InspectionOptions
) -> tuple[list[CellResult], list[ImportMessage]]:
    """Return what the cells of a column for counts say, and what to say of them."""
    if column is None:
        return [_SILENT] * len(layer), []
    cells = [text(v) for v in layer.column(column)]
    mark, guess = decimal_mark_in(layer, column, cells, options)
    known = {cell: _of_count(cell, mark) for cell in set(cells)}
    by_count = [known[cell] for cell in cells]
    numbers = [one.how_many for one in by_count]
    return by_count, [
        seen(worded("Counts are in column {number_found!r}.", number_found=column)),
        *guess,
        *about_fractions(column, numbers, is_usual=bool(recognised([column]))),
        *_unread(cells, known, options),
    ]


def results_in_names(layer: Layer, name: str, options: RecordOptions) -> list[CellResult]:
    """Return what the names of waypoints in a column say."""
    words = ResultWords(["+"], options)
    return [_of_mark(text(v), words) for v in layer.column(name)]


def _is_named(column: str, options: InspectionOptions) -> bool:
    """Return whether a column is that of results by its name, or was told to be."""
    return options.column("present") == column or bool(recognised([column]))


def decimal_mark_in(
    layer: Layer, name: str, cells: list[str], options: RecordOptions
) -> tuple[str, list[ImportMessage]]:
    """Return the decimal mark of a column's counts, and what was guessed of it.

    1,234 alone is told by the rest of the table.
    """
    if options.decimal is not None:
        return options.decimal, []
    if not any(isinstance(value, str) for value in layer.column(name)):
        return ".", []  # typed as numbers: these have no thousands marks
    others = (values for column, values in layer.columns.items() if column != name)
    looked_at = (text(v) for values in others for v in values[:_LOOKED_AT])
    mark, unsure = mark_of_counts(cells, looked_at, averages=is_average(name))
    return mark, about_mark(unsure, name, mark)


def _put_together(
    by_result: list[CellResult], by_count: list[CellResult], messages: list[ImportMessage]
) -> SeenResults:
    """Return what result and count say together.

    Forms fill in zeros by themselves: in a file with results, a zero beside an empty result is
    doubtful, one beside "not inspected" says nothing, and one beside a find that nobody counted.
    """
    first = np.array([s.result for s in by_result], dtype=np.int8)
    second = np.array([s.result for s in by_count], dtype=np.int8)
    spoken = np.array([s.is_said for s in by_result], dtype=bool)
    counted_too = np.array([s.is_said for s in by_count], dtype=bool)
    own = np.array([s.how_many for s in by_result], dtype=np.float64)
    zero_found = (first == PRESENT) & (second == ABSENT) & np.isnan(own)
    against = _against(spoken, first, second) & ~zero_found
    zero_alone = ~spoken & (second == ABSENT) & spoken.any()
    doubt = np.where(against, _contradicts(), "")
    doubt = np.where(zero_alone, worded("its count is 0, but its result is empty"), doubt)
    result = np.where(against, PRESENT, np.where(spoken, first, second)).astype(np.int8)
    count = np.array([s.how_many for s in by_count], dtype=np.float64)
    how_many = np.where(np.isnan(count), own, count)
    if zero_found.any():
        said = worded(
            "{n} {n:record is|records are} found, but {n:its count is|their counts are} 0: taken "
            "as found, not counted.",
            n=int(zero_found.sum()),
        )
        messages = [*messages, guessed(said)]
    said_any, gone = spoken | counted_too, np.zeros(len(result), np.bool_)
    read = [of.is_read and n.is_read for of, n in zip(by_result, by_count, strict=True)]
    unread = ~np.array(read, np.bool_)
    return SeenResults(result, how_many, doubt.astype(np.str_), said_any, messages, gone, unread)


def _unread(
    cells: list[str], known: dict[str, CellResult], options: RecordOptions
) -> list[ImportMessage]:
    odd = [cell for cell in cells if not known[cell].is_read]
    of_plant = [cell for cell in odd if plain_word(cell) in MAYBE_GONE]
    others = [cell for cell in odd if cell not in {*of_plant}]
    return [*_neither(others, options), *_maybe_gone(of_plant)]


def _neither(odd: list[str], options: RecordOptions) -> list[ImportMessage]:
    if not odd:
        return []
    said = worded(
        "{n} {n:record says|records say} neither clean nor found ({shown}); left unknown.",
        n=len(odd),
        shown=_some(odd),
    )
    return [doubtful(said, None, remedy_of_words(odd, options))]


def _maybe_gone(odd: list[str]) -> list[ImportMessage]:
    """Return a doubt about words that may be of the plant, of the pest or of the value."""
    if not odd:
        return []
    said = worded(
        "{n} {n:record says|records say} {shown}, which may be of the plant; left unknown. Write "
        "gone where it does not stand there any more.",
        n=len(odd),
        shown=_some(odd),
    )
    label = worded("Take {shown} as plants that are gone", shown=_some(odd))
    return [doubtful(said, None, Remedy("gone", ",".join(dict.fromkeys(odd)), label))]


def _some(cells: list[str]) -> str:
    return ", ".join(repr(cell) for cell in list(dict.fromkeys(cells))[:5])


def result_of(cell: str, mark: str, words: ResultWords) -> CellResult:
    """Return what a cell for a result says: a word in many languages, a sign, or a count.

    `words` are what those of its column mean: a lone minus is "clean" only in a column that has a
    plus somewhere, else it is nothing. A number above 1 is a find with that count; 1 is "yes",
    which counts nothing.
    """
    word = " ".join(cell.casefold().replace("_", " ").split())
    plus = _PLUS.match(word)
    if plus:
        return CellResult(PRESENT, counted(plus.group(1) or "").number, is_said=True)
    if word in NOT_INSPECTED:
        return _NOT_INSPECTED
    meant = words[cell]
    if meant is not None and not np.isfinite(number(word)):
        return CellResult(meant, np.nan, is_said=True)
    result = presence(word, mark)
    if result == UNKNOWN:
        is_empty = is_missing(word) and plain_word(cell) not in _SAYS_SOMETHING
        return CellResult(UNKNOWN, np.nan, is_said=False, is_read=is_empty)
    read = counted(word, mark)
    how_many = read.number if read.number > 1 and not read.is_rough else np.nan
    return CellResult(result, how_many, is_said=True)


def _of_count(cell: str, mark: str) -> CellResult:
    """Return what a cell for a count says; ``<5`` is a find that was not counted."""
    if cell.strip().casefold() in NOT_INSPECTED:
        return _NOT_INSPECTED
    read = counted(cell.removeprefix("+"), mark)
    if read.present == UNKNOWN:
        return CellResult(UNKNOWN, np.nan, is_said=False, is_read=not read.is_rough)
    # "no" and "0" count nothing; a range or a bound is a find, not a number
    number = read.number if read.present == PRESENT and not read.is_rough else np.nan
    return CellResult(read.present, 0.0 if read.present == ABSENT else number, is_said=True)


def _of_mark(name: str, words: ResultWords) -> CellResult:
    """Return what a waypoint's name says: ``+3``, ``+``, ``-``, ``0``, ``clean``, ``R3/17 +2``.

    A number alone is none: handhelds number their waypoints 001, 002.
    """
    parts = name.split()
    last = parts[-1] if parts else ""
    for sign in (name.strip(), last):
        plus = _PLUS.match(sign)
        if plus:
            return CellResult(PRESENT, counted(plus.group(1) or "").number, is_said=True)
        if sign in MINUS:
            return CellResult(ABSENT, np.nan, is_said=True)
    bare = PLANT_IN_NAME.sub(" ", name).strip()
    if bare == "0":
        return CellResult(ABSENT, np.nan, is_said=True)
    if not bare or re.fullmatch(r"[\d\s]+", bare):
        return _SILENT
    said = result_of(bare, ".", words)
    return said if said.is_said else _SILENT
