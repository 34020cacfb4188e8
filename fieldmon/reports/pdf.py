"""A report as PDF: its pages laid out, one sheet of paper each, whatever they hold.

Nothing in it depends on the clock: the same report is the same file, byte for byte.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import SettingError
from fieldmon.reports import colours, words
from fieldmon.reports.content import (
    Block,
    Illustration,
    KeyFigures,
    Listing,
    NoteLines,
    Paragraph,
    Report,
    Sheet,
    Table,
    TickList,
)
from fieldmon.reports.drawing import Lettering
from fieldmon.reports.fonts import FontSet
from fieldmon.reports.language import ENGLISH
from fieldmon.reports.pdf_painter import PT_MM, letter, paint, wide_mm

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fpdf import FPDF

    from fieldmon.reports.drawing import Colour
    from fieldmon.reports.language import ReportLanguage

#: width and height, millimetres
PAPERS = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
_MARGIN, _HEAD, _FOOT, _GAP = 12.0, 17.0, 8.0, 3.2
_LINE = 1.32
_TITLE_MM, _ROW_MM, _NOTE_MM = 5.6, 4.1, 7.5
_FLOW_GAP = 5.0
_LEAST_NOTES, _MOST_NOTES = 2, 7
_LEAST_PICTURE_MM = 35.0
# smaller than this nobody reads it
_LEAST_PT = 5.5
_OTHER_END = {"start": "end", "middle": "middle", "end": "start"}


def load() -> None:
    """Load what writes a PDF, for who will print: most of what the first one takes."""
    import fpdf  # noqa: F401, PLC0415 - half a second

    FontSet.of(_own_words(ENGLISH))


def pdf_bytes(report: Report, paper: str = "a4") -> bytes:
    """Return a report as a PDF file.

    Parameters
    ----------
    report
        What it says.
    paper
        ``"a4"`` or ``"letter"``.

    Raises
    ------
    SettingError
        If there is no such paper.
    """
    if paper not in PAPERS:
        raise SettingError(
            worded(
                "Paper must be one of {names}, but it is {paper!r}.",
                names=", ".join(PAPERS),
                paper=paper,
            )
        )
    from fieldmon.reports.paper import Paper  # noqa: PLC0415 - a second to import

    fonts = FontSet.of([*report.words(), *_own_words(report.language)])
    pdf = Paper(PAPERS[paper], right_to_left=report.language.right_to_left)
    with working_folder() as folder:
        for font in fonts.fonts:
            file = Path(folder) / f"{font.family}{font.style}.ttf"
            file.write_bytes(font.data)
            pdf.add_font(font.family, font.style, file)
        families = {font.family for font in fonts.fonts}
        pdf.set_fallback_fonts(sorted(families - {"open"}))
        pdf.set_text_shaping(use_shaping_engine=True)
        pdf.set_auto_page_break(auto=False)
        pdf.set_title(f"{words.isolated(report.plot)}: {report.title}")
        pdf.set_lang(report.language.code)
        pdf.set_creation_date(datetime.combine(report.on, datetime.min.time(), UTC))
        page = _Page(pdf, fonts, PAPERS[paper], report)
        for number, sheet in enumerate(report.sheets, start=1):
            page.write(sheet, number)
        return bytes(pdf.output())


def _own_words(language: ReportLanguage) -> Iterator[str]:
    """Yield what drawings and pages write themselves, and all that numbers are made of."""
    yield language.letters
    yield "0123456789.,:;-–+%/()°'\" abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"


@dataclass(frozen=True, eq=False)
class _Page:
    """Writes sheets on paper of a size; from the right, where the report is read from there."""

    pdf: FPDF
    fonts: FontSet
    size: tuple[float, float]
    report: Report

    @property
    def mirrored(self) -> bool:
        """Whether all that has a side stands on the other one; maps and charts do not."""
        return self.report.language.right_to_left

    def _left(self, x: float, wide: float) -> float:
        """Return where a box of a width begins whose place is told from where reading begins."""
        return self.size[0] - x - wide if self.mirrored else x

    @property
    def wide(self) -> float:
        """Width between the margins."""
        return self.size[0] - 2 * _MARGIN

    def write(self, sheet: Sheet, number: int) -> None:
        """Write one sheet on a page of its own."""
        self.pdf.add_page()
        self._head(self.report, sheet)
        self._foot(self.report, number)
        blocks: list[Block] = [block for block in sheet.blocks if not isinstance(block, TickList)]
        y = _MARGIN + _HEAD
        heights = self._heights(blocks, self.size[1] - _MARGIN - _FOOT - y)
        for block, high in zip(blocks, heights, strict=True):
            self._block(block, y, high)
            y += high + _GAP

    # -- how high everything is

    def _heights(self, blocks: list[Block], room: float) -> list[float]:
        """Return the height of each block: what can grow or shrink shares what the others leave."""
        least = [self._least(block) for block in blocks]
        most = [max(low, self._most(block)) for low, block in zip(least, blocks, strict=True)]
        spare = room - sum(least) - _GAP * (len(blocks) - 1)
        # where even the least is too much, pictures give way
        for k, block in enumerate(blocks):
            if spare < 0 and isinstance(block, Illustration):
                less = min(-spare, max(least[k] - _LEAST_PICTURE_MM, 0.0))
                least[k] -= less
                spare += less
        # tables first, then pictures, then lines for notes
        for kind in (Table, Illustration, NoteLines):
            own = [k for k, block in enumerate(blocks) if isinstance(block, kind)]
            wish = sum(most[k] - least[k] for k in own)
            share = min(max(spare, 0.0) / wish, 1.0) if wish else 0.0
            for k in own:
                least[k] += share * (most[k] - least[k])
            spare -= share * wish
        return least

    def _least(self, block: Block) -> float:
        if isinstance(block, Table):
            return _titled(block.title) + _ROW_MM * (
                _lines(block) + 1 if block.whole else min(_lines(block) + 1, 5)
            )
        if isinstance(block, Illustration):
            return _titled(block.title) + block.heights[0]
        if isinstance(block, NoteLines):
            return _TITLE_MM + _LEAST_NOTES * _NOTE_MM
        return self._fixed(block)

    def _most(self, block: Block) -> float:
        if isinstance(block, Table):
            return _titled(block.title) + _ROW_MM * (_lines(block) + 1)
        if isinstance(block, Illustration):
            return _titled(block.title) + block.heights[1]
        if isinstance(block, NoteLines):
            return _TITLE_MM + _MOST_NOTES * _NOTE_MM
        return 0.0

    def _fixed(self, block: Block) -> float:
        if isinstance(block, KeyFigures):
            return 15.5
        if isinstance(block, Paragraph):
            return self._paragraph_high(block)
        if isinstance(block, Listing):
            self._font(8.0)
            high = (self._text_high(said, self.wide - 5.0, 8.0) + 0.8 for said in block.sentences)
            return _titled(block.title) + sum(high)
        return 0.0

    def _paragraph_high(self, block: Paragraph) -> float:
        self._font(*_paragraph_font(block))
        return self._text_high(block.text, self.wide, _paragraph_font(block)[0])

    def _text_high(self, text: str, wide: float, size: float) -> float:
        lines = self.pdf.multi_cell(
            wide, size * PT_MM * _LINE, self.fonts.printable(text), align=self._align, dry_run=True,
            output="LINES",
        )  # fmt: skip
        return len(lines) * size * PT_MM * _LINE  # type: ignore[arg-type]

    # -- writing

    def _font(self, size: float, style: str = "", colour: Colour = colours.INK) -> None:
        self.pdf.set_font("open", style, size)
        self.pdf.set_text_color(*colour)

    def _head(self, report: Report, sheet: Sheet) -> None:
        pdf, right = self.pdf, self.size[0] - _MARGIN
        self._line(_MARGIN, _MARGIN + 0.6, right, colours.ACCENT, 1.2)
        place = Lettering(right, _MARGIN + 5.8, report.title, 9.0, colours.SOFT, "end")
        self._put(place)
        aside = pdf.get_string_width(self.fonts.printable(report.title)) + 6.0
        self._font(17.0, "B")
        name = self._shortened(report.plot, self.wide - aside)
        self._put(Lettering(_MARGIN, _MARGIN + 5.6, name, 17.0, bold=True))
        place = Lettering(_MARGIN, _MARGIN + 12.4, sheet.heading, 10.5, colours.ACCENT, bold=True)
        self._put(place)

    def _foot(self, report: Report, number: int) -> None:
        y, right = self.size[1] - _MARGIN, self.size[0] - _MARGIN
        said = self._said(worded(words.PAGE, page=number, of=len(report.sheets)))
        for x, text, anchor in ((_MARGIN, self._unprinted(), "start"), (right, said, "end")):
            self._put(Lettering(x, y - 1.5, text, 7.0, colours.SOFT, anchor))

    def _unprinted(self) -> str:
        """Return the program's name, and which letters stand as a question mark, if any."""
        missing = sorted(self.fonts.missing)
        if not missing:
            return words.FOOTER
        codes = " ".join(f"U+{ord(one):04X}" for one in missing[:8])
        unprinted = self._said(worded(words.UNPRINTED, n=len(missing), codes=codes))
        return f"{words.FOOTER}. {unprinted}"

    def _put(self, part: Lettering) -> None:
        """Write words where they say, as told from where reading begins."""
        if self.mirrored:
            part = replace(part, x=self.size[0] - part.x, anchor=_OTHER_END[part.anchor])
        letter(self.pdf, self.fonts, part, (0.0, 0.0))

    def _said(self, sentence: str) -> str:
        return self.report.language.say(sentence)

    @property
    def _align(self) -> str:
        return "R" if self.mirrored else "L"

    def _line(self, x: float, y: float, end: float, colour: Colour, width: float) -> None:
        self.pdf.set_draw_color(*colour)
        self.pdf.set_line_width(width)
        begins = self._left(x, end - x)
        self.pdf.line(begins, y, begins + end - x, y)

    def _block(self, block: Block, y: float, high: float) -> None:
        if isinstance(block, Paragraph):
            self._font(*_paragraph_font(block))
            self._text(block.text, (_MARGIN, y), self.wide, _paragraph_font(block)[0])
        elif isinstance(block, KeyFigures):
            self._figures(block, y)
        elif isinstance(block, Listing):
            self._listing(block, y)
        elif isinstance(block, Table):
            self._table(block, y, high)
        elif isinstance(block, NoteLines):
            self._notes(block, y, high)
        elif isinstance(block, Illustration):
            y, high = self._title(block.title, y), high - _titled(block.title)
            drawn = block.draw((self.wide, high))
            if self.mirrored and block.is_read:
                drawn = drawn.turned()
            paint(self.pdf, self.fonts, drawn, (_MARGIN, y))

    def _title(self, text: str, y: float) -> float:
        """Write a block's title; return where what follows begins."""
        if text:
            place = Lettering(_MARGIN, y + 2.0, text, 8.5, colours.INK, bold=True)
            self._put(place)
        return y + _titled(text)

    def _text(self, text: str, place: tuple[float, float], wide: float, size: float) -> float:
        """Write sentences over as many lines as they need; return where they end."""
        self.pdf.set_xy(self._left(place[0], wide), place[1])
        self.pdf.c_margin, margin = 0.0, self.pdf.c_margin
        self.pdf.multi_cell(
            wide, size * PT_MM * _LINE, self.fonts.printable(text), align=self._align
        )
        self.pdf.c_margin = margin
        return float(self.pdf.get_y())

    def _shortened(self, text: str, wide: float) -> str:
        """Return as much of a text as has room, in the font that is set."""
        text = self.fonts.printable(text)
        if wide_mm(self.pdf, text) <= wide:
            return text
        while text and wide_mm(self.pdf, f"{text}...") > wide:
            text = text[:-1]
        return f"{text.rstrip()}..."

    def _fitted(self, text: str, wide: float, size: float, style: str = "") -> tuple[str, float]:
        """Return a text and the size in which it has room, smaller if need be; then shortened."""
        while size > _LEAST_PT and wide_mm(self.pdf, self.fonts.printable(text)) > wide:
            size -= 0.25
            self.pdf.set_font("open", style, size)
        return self._shortened(text, wide), size

    def _figures(self, block: KeyFigures, y: float) -> None:
        each = (self.wide + 2.0) / len(block.figures)
        for k, figure in enumerate(block.figures):
            x = _MARGIN + k * each
            self.pdf.set_fill_color(*colours.GROUND)
            self.pdf.rect(self._left(x, each - 2.0), y, each - 2.0, 15.0, style="F")
            lines = (
                (3.0, figure.label, 7.0, "", colours.SOFT),
                (7.9, figure.value, 14.0, "B", colours.INK),
                (12.6, figure.note, 7.0, "", colours.SOFT),
            )
            for down, text, size, style, colour in lines:
                self._font(size, style, colour)
                said, size = self._fitted(text, each - 5.0, size, style)  # noqa: PLW2901
                part = Lettering(x + 2.0, y + down, said, size, colour, bold=bool(style))
                self._put(part)

    def _listing(self, block: Listing, y: float) -> None:
        y = self._title(block.title, y)
        for number, said in enumerate(block.sentences, start=1):
            mark = f"{number}" if block.numbered else "–"
            self._put(Lettering(_MARGIN + 0.5, y + 1.9, mark, 8.0, bold=block.numbered))
            self._font(8.0)
            y = self._text(said, (_MARGIN + 5.0, y), self.wide - 5.0, 8.0) + 0.8

    def _table(self, block: Table, y: float, high: float) -> None:
        """Write as many rows as have room, and say how many have none."""
        y = self._title(block.title, y)
        fit = max(int((high - _titled(block.title)) / _ROW_MM + 1e-6) - 1, 1)
        rows = block.rows
        if _lines(block) > fit:
            shown = (fit - 1) * block.flow
            rows = rows[:shown]
            said = block.rest.format(n=len(block.rows) - shown)
            self._put(Lettering(_MARGIN, y + (fit + 0.5) * _ROW_MM, said, 7.0, colours.SOFT))
        deep = -(-len(rows) // block.flow)
        each = (self.wide - _FLOW_GAP * (block.flow - 1)) / block.flow
        block = replace(block, shares=self._shares(block, rows, each))
        for part in range(block.flow):
            own = rows[part * deep : (part + 1) * deep]
            if own:
                self._columns(block, own, (_MARGIN + part * (each + _FLOW_GAP), y), each)

    def _shares(
        self, block: Table, rows: tuple[tuple[str, ...], ...], wide: float
    ) -> tuple[float, ...]:
        """Return the columns' shares; one that needs more has it from those that need less."""
        self._font(7.5)
        need = [
            max(wide_mm(self.pdf, self.fonts.printable(text)) for text in column) + 2.6
            for column in zip(block.columns, *rows, strict=True)
        ]
        have = [share * wide for share in block.shares]
        more = sum(max(n - h, 0.0) for n, h in zip(need, have, strict=True))
        spare = sum(max(h - n, 0.0) for n, h in zip(need, have, strict=True))
        if not more:
            return block.shares
        given = min(more / spare, 1.0) if spare else 0.0
        taken = min(spare / more, 1.0)
        return tuple(
            (h + (n - h) * (taken if n > h else given)) / wide
            for n, h in zip(need, have, strict=True)
        )

    def _columns(
        self, block: Table, rows: tuple[tuple[str, ...], ...], corner: tuple[float, float],
        wide: float,
    ) -> None:  # fmt: skip
        x, y = corner
        self._cells(block, block.columns, corner, wide, colours.SOFT)
        for row in rows:
            self._line(x, y + _ROW_MM, x + wide, colours.FAINT, 0.15)
            y += _ROW_MM
            self._cells(block, row, (x, y), wide, colours.INK)

    def _cells(
        self, block: Table, row: tuple[str, ...], corner: tuple[float, float], wide: float,
        colour: Colour,
    ) -> None:  # fmt: skip
        x = corner[0]
        for k, (text, share) in enumerate(zip(row, block.shares, strict=True)):
            room = share * wide
            self._font(7.5, "", colour)
            said, size = self._fitted(text, room - 1.5, 7.5)
            left = k in block.left
            place = x + 1.0 if left else x + room - 1.5
            self._put(
                Lettering(
                    place, corner[1] + _ROW_MM / 2, said, size, colour, "start" if left else "end"
                )
            )
            x += room

    def _notes(self, block: NoteLines, y: float, high: float) -> None:
        y = self._title(block.title, y)
        for k in range(1, int((high - _TITLE_MM) / _NOTE_MM + 1e-6) + 1):
            self._line(_MARGIN, y + k * _NOTE_MM, self.size[0] - _MARGIN, colours.FAINT, 0.2)


def _titled(title: str) -> float:
    """Return the height of a title, if there is one."""
    return _TITLE_MM if title else 0.0


def _lines(block: Table) -> int:
    """Return how many lines all rows of a table need."""
    return -(-len(block.rows) // block.flow)


def _paragraph_font(block: Paragraph) -> tuple[float, str]:
    return (12.0, "B") if block.lead else (8.5, "")
