"""Tables of text and of workbooks, in the dialects in which people save them."""

from __future__ import annotations

import csv
import io
from collections import Counter
from dataclasses import replace
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.formats.split_degrees import names_degrees, with_degrees
from fieldmon.io.formats.wkt import with_shapes
from fieldmon.io.formats.workbooks import sheet_rows
from fieldmon.io.import_report import ImportMessage, doubtful, dropped, seen
from fieldmon.io.parse.columns import plays_the_same, recognised
from fieldmon.io.parse.dates import dates
from fieldmon.io.parse.degrees import degrees
from fieldmon.io.parse.quotes import refuse_open_quote
from fieldmon.io.parse.text import decode
from fieldmon.io.parse.values import number
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.io.options import ReadOptions

_DELIMITERS = (",", ";", "\t", "|")
_LOOKED_AT = 50


def read_text_table(path: Path, name: str, options: ReadOptions) -> Layer:
    """Return a CSV or TSV file as a layer; its shapes where a column holds such (WKT)."""
    content, messages = decode(path.read_bytes(), options.encoding)
    if "\x00" in content:
        raise FileProblem(
            worded("{name} must be a text table, but it holds bytes that are no text.", name=name)
        )
    content, told = _told_delimiter(content)
    delimiter = options.delimiter or told or _delimiter(content)
    csv.field_size_limit(limits.CELL_CHARACTERS)
    if '"' in content:
        lines = io.StringIO(content, newline="")
        refuse_open_quote(lines, delimiter, name, above=int(told is not None))
    try:
        rows = list(csv.reader(io.StringIO(content, newline=""), delimiter=delimiter))
    except csv.Error as bad:
        raise FileProblem(
            worded("{name} must be a text table, but it cannot be read: {bad}.", name=name, bad=bad)
        ) from bad
    layer = _with_degrees(_table(rows, name, options.header), options)
    return with_shapes(replace(layer, messages=(*messages, *layer.messages)), _system_of_prj(path))


def _system_of_prj(path: Path) -> str | None:
    """Return the coordinate system in the .prj that some programs write beside a table."""
    beside = path.with_suffix(".prj")
    return beside.read_bytes()[:10_000].decode("utf-8", "ignore") if beside.exists() else None


def read_sheet(path: Path, name: str, sheet: str, options: ReadOptions) -> Layer:
    """Return one sheet of a workbook as a layer; its shapes where a column holds such."""
    layer = _table(sheet_rows(path, name, sheet), f"{name}, sheet {sheet}", options.header)
    return with_shapes(_with_degrees(layer, options), None)


def _with_degrees(layer: Layer, options: ReadOptions) -> Layer:
    """Return a table with degrees and minutes put together, unless their columns are named."""
    by_hand = {role for role, _ in options.columns}
    return layer if by_hand & {"lat", "lon", "position", "x", "y"} else with_degrees(layer)


def _told_delimiter(content: str) -> tuple[str, str | None]:
    """Return the text without Excel's ``sep=;`` line, and what that line says."""
    first, _, rest = content.partition("\n")
    first = first.strip()
    if first.casefold().startswith("sep=") and len(first) == 5:
        return rest, first[-1]
    return content, None


def _delimiter(content: str) -> str:
    """Return the delimiter that cuts the most lines into the same number of cells, above one."""
    lines = content[: 64 * 1024].splitlines(keepends=True)
    # what is remarked above a table is cut by other marks
    start = "".join(line for line in lines if not line.startswith("#")) or "".join(lines)
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


def _table(rows: list[list[Any]], name: str, header: str | None = None) -> Layer:
    """Return rows of cells as a layer, its columns named by the line above the records."""
    limits.check("records", len(rows), limits.RECORDS, name)
    rows, head = _headed(rows, name, header)
    limits.check("columns", len(rows[head]), limits.COLUMNS, name)
    names = _names(rows[head])
    lines = _body(rows, head)
    body = [row for row in lines if not _repeats_names(row, rows[head])]
    if not body:
        raise FileProblem(
            worded("{name} must hold records below its column names, but holds none.", name=name)
        )
    messages = (
        *_about_header(name, len(rows[0]), head, header),
        *_about_repeated_names(rows[head]),
        *_about_repeated_lines(len(lines) - len(body)),
        *_about_longer(body, len(names)),
    )
    above = "\n".join(", ".join(text(v) for v in row) for row in rows[:head])
    return Layer(name, _columns(names, body), messages=messages, above=above)


def _body(rows: list[list[Any]], head: int) -> list[list[Any]]:
    """Return the records below the column names: neither empty lines nor bare ``#``."""
    body = [row for row in rows[head + 1 :] if any(map(_is_filled, row))]
    if _is_remark(rows[head]):
        body = [row for row in body if text(row[0]) != "#" or any(map(_is_filled, row[1:]))]
    return body


def _about_header(
    name: str, n_columns: int, head: int, header: str | None
) -> tuple[ImportMessage, ...]:
    """Return what to say of which line names the columns."""
    if header == "no":
        said = worded(
            "{name} has no line of names: its columns are called column 1 to {n}.",
            name=name,
            n=n_columns,
        )
        return (seen(said),)
    if not head:
        return ()
    said = worded(
        "{head} {head:line|lines} above the column names {head:was|were} passed over.", head=head
    )
    return (seen(said),)


def _about_repeated_names(cells: list[Any]) -> tuple[ImportMessage, ...]:
    """Return a doubt about columns of one name."""
    twice = [name for name, n in Counter(map(text, cells)).items() if name and n > 1]
    if not twice:
        return ()
    said = worded(
        "Several columns are called {names}: the first keeps its name, the next is {other}.",
        names=", ".join(twice),
        other=f"{twice[0]}_2",
    )
    return (doubtful(said),)


def _in_one_line(rows: list[list[Any]], head: int) -> tuple[list[list[Any]], int]:
    """Return rows, and which names the columns: two lines in one where both name some of them.

    So people write who merge cells: a position, and below it lat and lon.
    """
    for upper in (head, head - 1):
        above, below = (rows[k] if 0 <= k < len(rows) else [] for k in (upper, upper + 1))
        pairs = [(text(a), text(b)) for a, b in zip_longest(above, below)]
        lacks = any(any(pair) and not pair[head - upper] for pair in pairs)
        if lacks and _names_some(above) and _names_some(below):
            return [*rows[:upper], [b or a for a, b in pairs], *rows[upper + 2 :]], upper
    return rows, head


def _names_some(row: list[Any]) -> bool:
    """Return whether a row holds known names of columns, and no data."""
    if len(recognised(map(text, row))) < 2 or _is_remark(row):
        return False
    return not any(_kind(value) in _DATA for value in row)


def _repeats_names(row: list[Any], names: list[Any]) -> bool:
    """Return whether a line below the column names says them once more, or others for the same."""
    same = others = 0
    for value, name in zip_longest(row, names[: len(row)]):
        if not _is_filled(value):
            continue
        if text(value).casefold() == text(name).casefold():
            same += 1
        elif isinstance(value, str) and plays_the_same(value, text(name)):
            others += 1
        else:
            return False
    return same > 1 or (same + others > 1 and (same > 0 or others > 2))


def _about_repeated_lines(n: int) -> tuple[ImportMessage, ...]:
    """Return what was left out of lines that say the column names once more."""
    if not n:
        return ()
    said = worded(
        "{n} {n:line that repeats|lines that repeat} the column names {n:was|were} left out.", n=n
    )
    return (dropped(said),)


def _about_longer(body: list[list[Any]], n_columns: int) -> tuple[ImportMessage, ...]:
    """Return what was left out of lines with more cells than there are columns."""
    longer = sum(len(row) > n_columns and any(map(text, row[n_columns:])) for row in body)
    if not longer:
        return ()
    said = worded(
        "{longer} {longer:line has|lines have} more cells than there are columns; "
        "those were left out.",
        longer=longer,
    )
    return (dropped(said),)


def _headed(rows: list[list[Any]], name: str, header: str | None) -> tuple[list[list[Any]], int]:
    """Return rows, and which of them names the columns; ask where the first looks like data."""
    if header == "no":
        widest = max((len(row) for row in rows), default=0)
        rows, head = [[f"column {i + 1}" for i in range(widest)], *rows], 0
    else:
        found = _head_row(rows)
        if found is None:
            raise FileProblem(
                worded(
                    "{name} must hold a table with a line of column names, but holds none.",
                    name=name,
                )
            )
        head = found
        rows, head = _in_one_line(rows, head)
        if header is None and looks_like_data(rows[head], rows[head + 1 :]):
            shown = ", ".join(text(v) for v in rows[head][:5] if text(v))
            raise ChoiceNeeded(
                worded(
                    "{name} must have a line of column names, but its first "
                    "line looks like data ({shown}). Say header=no if it has "
                    "no names; its columns are called column 1, column 2 and "
                    "so on then. Or write names above it.",
                    name=name,
                    shown=shown,
                ),
                "header",
                ("no", "yes"),
            )
    return rows, head


def looks_like_data(first: list[Any], below: list[list[Any]]) -> bool:
    """Return whether a row that should name the columns holds what the rows below it hold."""
    if recognised(text(v) for v in first):
        return False
    alike = filled = 0
    for i, value in enumerate(first):
        kind = _kind(value)
        filled += kind != "nothing"
        others = [_kind(row[i]) for row in below[:_COMPARED] if i < len(row)]
        others = [other for other in others if other != "nothing"]
        alike += kind in _DATA and (not others or others.count(kind) * 2 > len(others))
    return alike > 0 and alike * 3 >= filled


_COMPARED = 20
_DATA = frozenset({"number", "date", "position"})


def _kind(value: object) -> str:
    cell = text(value)
    if not cell:
        return "nothing"
    if np.isfinite(number(cell)) or np.isfinite(number(cell, ",")):
        return "number"
    if not np.isnat(dates(np.array([cell], dtype=object)).day[0]):
        return "date"
    return "position" if np.isfinite(degrees(cell)) else "word"


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
    remarked = _named_in_remarks(rows)
    if remarked is not None:
        return remarked
    start = _after_facts(rows)
    looked_at = rows[start : start + _LOOKED_AT]
    filled = [sum(bool(text(v)) for v in row) for row in looked_at]
    if not any(filled):
        return None
    known = [
        len({*recognised(map(text, row)), *filter(names_degrees, map(text, row))})
        for row in looked_at
    ]
    if max(known) >= 2:
        return start + known.index(max(known))
    widest = max(filled)
    return start + next(i for i, n in enumerate(filled) if n >= max(2, widest - 1) or n == widest)


def _is_remark(row: list[Any]) -> bool:
    return bool(row) and text(row[0]).startswith("#")


def _named_in_remarks(rows: list[list[Any]]) -> int | None:
    """Return which of the lines with # above a table names its columns: the last as wide as it."""
    first = next((i for i, row in enumerate(rows) if any(map(_is_filled, row))), None)
    if first is None or not _is_remark(rows[first]):
        return None
    body = next((i for i, row in enumerate(rows) if any(map(_is_filled, row))
                 and not _is_remark(row)), None)  # fmt: skip
    if body is None or len(rows[body]) < 2:
        return None
    named = [
        i for i in range(body)
        if len(rows[i]) == len(rows[body]) and not any(_kind(value) in _DATA for value in rows[i])
    ]  # fmt: skip
    return named[-1] if named else None


def _after_facts(rows: list[list[Any]]) -> int:
    """Return where a table begins: after two lines of facts about its place and an empty one."""
    empty = [not any(map(_is_filled, row)) for row in rows[:5]]
    if empty != [False, False, True, False, False]:
        return 0
    return 3 if all(_kind(value) in {"word", "nothing"} for value in rows[3]) else 0


def _names(row: Iterable[Any]) -> list[str]:
    """Return column names: empty ones numbered, those that repeat told apart."""
    names: list[str] = []
    for i, value in enumerate(row):
        name = text(value) or f"column {i + 1}"
        while name in names:
            name += "_2"
        names.append(name)
    return names
