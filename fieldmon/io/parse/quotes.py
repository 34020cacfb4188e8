"""Quotes that are not closed: what comes after one would stand in its cell, unseen."""

from __future__ import annotations

import csv
from itertools import chain
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


def refuse_open_quote(lines: Iterable[str], delimiter: str, name: str, *, above: int = 0) -> None:
    """Raise `FileProblem` where a quote is not closed before the next cell.

    A cell of several lines in quotes is none such, nor one in which words follow the quote.
    `above` is how many lines of the file stand above these.
    """
    of_row: list[str] = []

    def fed() -> Iterator[str]:
        for line in chain(lines, [""]):  # a quote that is open in the last line takes in one more
            of_row.append(line)
            yield line

    reader = csv.reader(fed(), delimiter=delimiter, strict=True)
    while True:
        try:
            next(reader)
        except StopIteration:
            return
        except csv.Error:
            if len(of_row) > 1 or of_row[0].count('"') % 2:
                line = above + reader.line_num - len(of_row) + 1
                raise FileProblem(
                    worded(
                        "{name}, line {line}: a quote that opens here must be closed before the "
                        "next cell, but it is not. Close it, or take it away.",
                        name=name,
                        line=line,
                    )
                ) from None
        of_row.clear()
