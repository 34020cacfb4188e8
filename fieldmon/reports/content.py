"""What a report says, whatever it is written as: pages of blocks."""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any

from fieldmon.reports.drawing import Drawing, Lettering
from fieldmon.reports.language import ENGLISH, ReportLanguage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from datetime import date

    from fieldmon.reports.drawing import Part

    Size = tuple[float, float]


@dataclass(frozen=True)
class Paragraph:
    """A sentence or several; a `lead` is what to read if nothing else is."""

    text: str
    lead: bool = False


@dataclass(frozen=True)
class KeyFigure:
    """A figure with its name, and what stands under it: an interval, a unit, what it is of."""

    label: str
    value: str
    note: str = ""


@dataclass(frozen=True)
class KeyFigures:
    """Figures side by side."""

    figures: tuple[KeyFigure, ...]


@dataclass(frozen=True)
class Listing:
    """Sentences below each other; `numbered` as on the map."""

    title: str
    sentences: tuple[str, ...]
    numbered: bool = False


@dataclass(frozen=True)
class Table:
    """Rows of texts.

    Parameters
    ----------
    shares
        Width of each column, as a share of the whole.
    flow
        How many times the table stands side by side; its rows go on from one to the next.
    rest
        What is said of rows that a page of paper has no room for, with ``{n}``.
    left
        Columns, from 0, whose texts begin at the left; figures end at the right.
    whole
        Whether every row must find room, whatever is left to others.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    shares: tuple[float, ...]
    flow: int = 1
    rest: str = ""
    left: tuple[int, ...] = ()
    whole: bool = False


@dataclass(frozen=True)
class TickList:
    """Every stop with a box to tick. Only a page without an end has room for it."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class NoteLines:
    """Room for what somebody writes by hand."""

    title: str


@dataclass(frozen=True, eq=False)
class Illustration:
    """A map or a chart.

    Parameters
    ----------
    alt
        What it shows, in words.
    draw
        Draws it on so many millimetres.
    heights
        The least that it needs and the most that it is worth, millimetres.
    is_read
        Whether it is read as a line of words: from the right where the report is.
    """

    title: str
    alt: str
    draw: Callable[[Size], Drawing]
    heights: tuple[float, float]
    is_read: bool = False


Block = Paragraph | KeyFigures | Listing | Table | TickList | NoteLines | Illustration


@dataclass(frozen=True)
class Sheet:
    """One page of paper."""

    heading: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Report:
    """A report: its plot, what it is about, and its pages."""

    plot: str
    title: str
    on: date
    sheets: tuple[Sheet, ...]
    language: ReportLanguage = ENGLISH

    def said_in(self, language: ReportLanguage) -> Report:
        """Return the report in a language; the plot's name stays as it is."""
        sheets = _said(self.sheets, language.say)
        return Report(self.plot, language.say(self.title), self.on, sheets, language)

    def words(self) -> Iterator[str]:
        """Yield every text that goes on paper, but not those in drawings."""
        yield from (self.plot, self.title)
        for sheet in self.sheets:
            yield sheet.heading
            for block in sheet.blocks:
                yield from _words(block)


def _said(thing: Any, say: Callable[[str], str]) -> Any:  # noqa: ANN401 - whatever a report holds
    """Return a part of a report with all of its texts said, those in its drawings too."""
    if isinstance(thing, str):
        return say(thing)
    if isinstance(thing, tuple):
        return tuple(_said(one, say) for one in thing)
    if isinstance(thing, Illustration):
        made = replace(thing, title=say(thing.title), alt=say(thing.alt))
        return replace(made, draw=lambda size: _said(thing.draw(size), say))
    if isinstance(thing, Drawing):
        return replace(thing, parts=tuple(_said_part(part, say) for part in thing.parts))
    if is_dataclass(thing) and not isinstance(thing, type):
        return replace(thing, **{f.name: _said(getattr(thing, f.name), say) for f in fields(thing)})
    return thing


def _said_part(part: Part, say: Callable[[str], str]) -> Part:
    return replace(part, text=say(part.text)) if isinstance(part, Lettering) else part


def _words(block: Block) -> Iterator[str]:
    if isinstance(block, TickList):
        return
    if isinstance(block, Paragraph):
        yield block.text
    elif isinstance(block, KeyFigures):
        for figure in block.figures:
            yield from (figure.label, figure.value, figure.note)
    else:
        yield block.title
    if isinstance(block, Listing):
        yield from block.sentences
    if isinstance(block, Table):
        yield from block.columns
        for row in block.rows:
            yield from row
        yield block.rest
