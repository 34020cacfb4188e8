"""Text tables and workbooks, in the dialects in which people save them."""

from __future__ import annotations

import csv
import io
from collections import Counter
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import ImportMessage, dropped, seen
from fieldmon.io.parse.columns import recognised
from fieldmon.io.parse.text import decode
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.io.options import ReadOptions

_DELIMITERS = (",", ";", "\t", "|")
_LOOKED_AT = 50


def read_text_table(path: Path, name: str, options: ReadOptions) -> Layer:
    """Return a CSV or TSV file as a layer without geometry."""
    content, messages = decode(path.read_bytes(), options.encoding)
    if "\x00" in content:
        raise FileProblem(f"{name} must be a text table, but it holds bytes that are no text.")
    content, told = _told_delimiter(content)
    delimiter = options.delimiter or told or _delimiter(content)
    csv.field_size_limit(limits.CELL_CHARACTERS)
    try:
        rows = list(csv.reader(io.StringIO(content, newline=""), delimiter=delimiter))
    except csv.Error as bad:
        raise FileProblem(f"{name} must be a text table, but it cannot be read: {bad}.") from bad
    layer = _table(rows, name)
    return Layer(name, layer.columns, messages=(*messages, *layer.messages))


def sheet_names(path: Path, name: str) -> tuple[str, ...]:
    """Return the sheets of a workbook that can hold a table."""
    with _Workbook(path, name) as book:
        return tuple(str(sheet) for sheet in book.sheetnames)


def read_sheet(path: Path, name: str, sheet: str) -> Layer:
    """Return one sheet of an Excel workbook as a layer without geometry."""
    with _Workbook(path, name) as book:
        if sheet not in book.sheetnames:
            raise ChoiceNeeded(
                f"{name} has no sheet {sheet!r}. Choose one of: {', '.join(book.sheetnames)}.",
                "layer",
                tuple(book.sheetnames),
            )
        rows: list[list[Any]] = []
        for row in book[sheet].iter_rows(values_only=True, max_col=limits.COLUMNS + 1):
            cells = list(row)
            while cells and cells[-1] is None:
                cells.pop()
            rows.append(cells)
            if len(rows) > limits.RECORDS:
                break
    while rows and not any(text(v) for v in rows[-1]):
        rows.pop()
    return _table(rows, f"{name}, sheet {sheet}")


class _Workbook:
    """A workbook opened to read values; whatever openpyxl raises becomes a `FileProblem`."""

    def __init__(self, path: Path, name: str) -> None:
        self.path, self.name = path, name
        self.book: Any = None

    def __enter__(self) -> Any:  # noqa: ANN401 - an untyped library
        import openpyxl  # noqa: PLC0415 - a tenth of a second to import

        try:
            self.book = openpyxl.load_workbook(self.path, read_only=True, data_only=True)
        except Exception as bad:
            raise self._problem(bad) from bad
        return self.book

    def __exit__(self, kind: object, bad: BaseException | None, trace: object) -> None:
        if self.book is not None:
            self.book.close()
        # openpyxl reads as it goes, and lets through whatever its parsers of zip and XML raise
        if isinstance(bad, Exception) and not isinstance(bad, FieldmonError | MemoryError):
            raise self._problem(bad) from bad

    def _problem(self, bad: BaseException) -> FileProblem:
        return FileProblem(
            f"{self.name} must be an Excel workbook, but it cannot be read ({bad}). "
            "Save it again as .xlsx or CSV."
        )


def _told_delimiter(content: str) -> tuple[str, str | None]:
    """Return the text without Excel's ``sep=;`` line, and what that line says."""
    first, _, rest = content.partition("\n")
    first = first.strip()
    if first.casefold().startswith("sep=") and len(first) == 5:
        return rest, first[-1]
    return content, None


def _delimiter(content: str) -> str:
    """Return the delimiter that cuts the most lines into the same number of cells, above one."""
    start = content[: 64 * 1024]
    best, best_score = ",", (0, 0)
    for delimiter in _DELIMITERS:
        try:
            rows = list(csv.reader(io.StringIO(start, newline=""), delimiter=delimiter))
        except csv.Error:
            continue
        widths = Counter(len(row) for row in rows[:_LOOKED_AT] if row)
        widths.pop(1, None)
        if widths:
            width, n_rows = max(widths.items(), key=lambda item: (item[1], item[0]))
            best, best_score = max(
                (best, best_score), (delimiter, (n_rows, width)), key=lambda pair: pair[1]
            )
    return best


def _table(rows: list[list[Any]], name: str) -> Layer:
    limits.check("records", len(rows), limits.RECORDS, name)
    head = _head_row(rows)
    if head is None:
        raise FileProblem(f"{name} must hold a table with a line of column names, but holds none.")
    messages: list[ImportMessage] = []
    if head:
        messages.append(seen(f"{head} line(s) above the column names were passed over."))
    limits.check("columns", len(rows[head]), limits.COLUMNS, name)
    names = _names(rows[head])
    body = [row for row in rows[head + 1 :] if any(map(_is_filled, row))]
    if not body:
        raise FileProblem(f"{name} must hold records below its column names, but holds none.")
    longer = sum(len(row) > len(names) and any(text(v) for v in row[len(names) :]) for row in body)
    if longer:
        messages.append(
            dropped(
                f"{longer} line(s) have more cells than there are columns; those were left out."
            )
        )
    return Layer(name, _columns(names, body), messages=tuple(messages))


def _columns(names: list[str], body: list[list[Any]]) -> dict[str, NDArray[np.object_]]:
    columns = {}
    for name, cells in zip(names, zip_longest(*body), strict=False):
        values = np.empty(len(body), dtype=object)
        values[:] = [_cell(value) for value in cells]
        columns[name] = values
    for name in names[len(columns) :]:
        columns[name] = np.full(len(body), None, dtype=object)
    return columns


def _is_filled(value: object) -> bool:
    return not value.isspace() and value != "" if isinstance(value, str) else value is not None


def _cell(value: object) -> object:
    if isinstance(value, str):
        return value.strip() or None
    if value is None or isinstance(value, bool | int | float):
        return value
    return str(value)


def _head_row(rows: list[list[Any]]) -> int | None:
    """Return which row names the columns: known words, or the first full one."""
    looked_at = rows[:_LOOKED_AT]
    filled = [sum(bool(text(v)) for v in row) for row in looked_at]
    if not any(filled):
        return None
    known = [len(recognised(text(v) for v in row)) for row in looked_at]
    if max(known) >= 2:
        return known.index(max(known))
    widest = max(filled)
    return next(i for i, n in enumerate(filled) if n >= max(2, widest - 1) or n == widest)


def _names(row: Iterable[Any]) -> list[str]:
    """Return column names: empty ones numbered, those that repeat told apart."""
    names: list[str] = []
    for i, value in enumerate(row):
        name = text(value) or f"column {i + 1}"
        while name in names:
            name += "_2"
        names.append(name)
    return names
