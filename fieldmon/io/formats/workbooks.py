"""Workbooks: sheets of Excel and LibreOffice, row by row."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, Protocol

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_CELLS = 20_000_000
# of an .ods: what holds the cells, and what else its reader wants
_CONTENT, _BESIDE = "content.xml", ("mimetype", "META-INF/manifest.xml", "styles.xml")
_CONTENT_BYTES = 200_000_000
# around rows, cells and their text, but not within it
_BLANKS = re.compile(rb"(?<=>)\s+(?=</?table:|</?office:|<text:p[\s/>])")


class _Book(Protocol):
    """A workbook that is open."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its sheets."""

    def rows(self, sheet: str) -> Iterator[tuple[Any, ...]]:
        """Yield the rows of a sheet."""


class _NewBook:
    """An Excel workbook (.xlsx), read row by row as it is unpacked."""

    def __init__(self, path: Path) -> None:
        import openpyxl  # noqa: PLC0415 - a tenth of a second to import

        self.book: Any = openpyxl.load_workbook(path, read_only=True, data_only=True)

    @property
    def names(self) -> tuple[str, ...]:
        # sheets that are a chart have no cells
        return tuple(str(s.title) for s in self.book.worksheets)

    def rows(self, sheet: str) -> Iterator[tuple[Any, ...]]:
        one = self.book[sheet]
        one.reset_dimensions()  # what a sheet says of its own size is often wrong
        rows: Iterator[tuple[Any, ...]] = one.iter_rows(
            values_only=True, max_col=limits.COLUMNS + 1
        )
        return rows


class _OldBook:
    """A workbook of old Excel (.xls, .xlsb) or LibreOffice (.ods), or an unusual new one."""

    def __init__(self, path: Path) -> None:
        import python_calamine  # noqa: PLC0415 - only where there is one

        # from its bytes: by its name it would be taken for what it is called
        data = path.read_bytes()
        if path.suffix == ".ods":
            data = _unspaced(data, path.name)
        self.with_cells = python_calamine.SheetTypeEnum.WorkSheet
        self.book: Any = python_calamine.CalamineWorkbook.from_filelike(io.BytesIO(data))

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(s.name for s in self.book.sheets_metadata if s.typ == self.with_cells)

    def rows(self, sheet: str) -> Iterator[tuple[Any, ...]]:
        one = self.book.get_sheet_by_name(sheet)
        limits.check("cells", one.total_height * one.total_width, _CELLS, sheet)
        for row in one.to_python(skip_empty_area=False):
            yield tuple(None if cell == "" else cell for cell in row)


def _unspaced(data: bytes, name: str) -> bytes:
    """Return an .ods without blanks between its cells: GDAL writes them, calamine cannot."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as book:
            content = book.getinfo(_CONTENT)
            limits.check("bytes of cells", content.file_size, _CONTENT_BYTES, name)
            bare = _BLANKS.sub(b"", spaced := book.read(content))
            if len(bare) == len(spaced):
                return data
            others = {one: book.read(one) for one in _BESIDE if one in book.namelist()}
    except (zipfile.BadZipFile, KeyError, ValueError, NotImplementedError, zlib.error, OSError):
        return data  # calamine says what is wrong with it
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as book:
        for one, content_of in {**others, _CONTENT: bare}.items():
            book.writestr(one, content_of)
    return made.getvalue()


def sheet_names(path: Path, name: str) -> tuple[str, ...]:
    """Return the sheets of a workbook that can hold a table."""
    with _opened(path, name) as book:
        return book.names


def sheet_rows(path: Path, name: str, sheet: str) -> list[list[Any]]:
    """Return the cells of a sheet, without the empty ones at the ends of rows and below all."""
    with _opened(path, name) as book:
        if sheet not in book.names:
            raise ChoiceNeeded(
                worded(
                    "{name} has no sheet {sheet!r}. Choose one of: {names}.",
                    name=name,
                    sheet=sheet,
                    names=", ".join(book.names),
                ),
                "layer",
                book.names,
            )
        rows: list[list[Any]] = []
        n_filled = 0
        for row in book.rows(sheet):
            cells = list(row)
            while cells and cells[-1] is None:
                cells.pop()
            rows.append(cells)
            if cells:
                n_filled = len(rows)
            if n_filled > limits.RECORDS:
                break
        return rows[:n_filled]


def _book(path: Path) -> _Book:
    """Open a workbook by the reader that can: not all new ones are as openpyxl expects."""
    if path.suffix == ".xlsx":
        with suppress(Exception):
            return _NewBook(path)
    return _OldBook(path)


@contextmanager
def _opened(path: Path, name: str) -> Iterator[_Book]:
    """Open a workbook; whatever its reader raises becomes a `FileProblem`."""
    try:
        yield _book(path)
    except (FieldmonError, MemoryError):
        raise
    except BaseException as bad:
        # what panics in a reader written in Rust is no ordinary exception
        if not isinstance(bad, Exception) and type(bad).__name__ != "PanicException":
            raise
        raise FileProblem(
            worded(
                "{name} must be a workbook of Excel or LibreOffice, but it "
                "cannot be read ({value}). Save it again as .xlsx or CSV.",
                name=name,
                value=str(bad)[:300],
            )
        ) from bad
