"""Small tables that people write themselves: a header, and a line for each thing."""

from __future__ import annotations

import csv
from collections import Counter
from typing import NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.parse.quotes import refuse_open_quote
from fieldmon.io.sandbox import limits


class OwnTable(NamedTuple):
    """A table as it was written.

    Parameters
    ----------
    columns
        Their names, in order.
    lines
        Where each line stands, for sentences, and its cells by their columns; those that a short
        line lacks are empty. Lines without any are left out.
    """

    columns: tuple[str, ...]
    lines: tuple[tuple[str, dict[str, str]], ...]


def own_table(text: str, name: str, *, comments: bool = True) -> OwnTable:
    """Return the table of a text with commas, semicolons or tabs.

    Parameters
    ----------
    text, name
        What the file holds, and its name for sentences.
    comments
        Whether a line that begins with # is one.

    Raises
    ------
    FileProblem
        If a quote is not closed, a column is named twice, or a line has more cells than there are
        columns.
    """
    lines = [
        "\n" if comments and one.startswith("#") else one for one in text.splitlines(keepends=True)
    ]
    delimiter = max(",;\t", key=next((line for line in lines if line.strip()), "").count)
    csv.field_size_limit(limits.CELL_CHARACTERS)
    refuse_open_quote(lines, delimiter, name)
    reader = csv.reader(lines, delimiter=delimiter)
    try:
        rows = [(reader.line_num, [_in_one_line(cell) for cell in row]) for row in reader]
    except csv.Error as bad:
        raise FileProblem(
            worded("{name} must be a text table, but it cannot be read: {bad}.", name=name, bad=bad)
        ) from bad
    filled = [(number, row) for number, row in rows if any(row)]
    columns = tuple(filled[0][1]) if filled else ()
    twice = [one for one, n in Counter(map(str.casefold, columns)).items() if one and n > 1]
    if twice:
        raise FileProblem(
            worded(
                "{name}: two columns are called {called}. Leave one.", name=name, called=twice[0]
            )
        )
    made = []
    for number, row in filled[1:]:
        where = f"{name}, line {number}"
        if any(row[len(columns) :]):
            raise FileProblem(
                worded(
                    "{where} has {n} cells, but there are {columns} columns. Put what holds a "
                    "comma in quotes.",
                    where=where,
                    n=len(row),
                    columns=len(columns),
                )
            )
        cells = row + [""] * (len(columns) - len(row))
        made.append((where, dict(zip(columns, cells, strict=False))))
    return OwnTable(columns, tuple(made))


def _in_one_line(cell: str) -> str:
    return " ".join(part.strip() for part in cell.splitlines())
