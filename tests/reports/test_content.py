"""What a report says, whatever it is written as."""

from datetime import date

from fieldmon.reports.content import (
    Illustration,
    KeyFigure,
    KeyFigures,
    Listing,
    NoteLines,
    Paragraph,
    Report,
    Sheet,
    Table,
    TickList,
)
from fieldmon.reports.drawing import Drawing


def test_a_report_s_words_are_all_that_goes_on_paper():
    blocks = (
        Paragraph("a sentence"),
        KeyFigures((KeyFigure("label", "value", "note"),)),
        Listing("list", ("one", "two")),
        Table("table", ("column",), (("cell",),), (1.0,), rest="more"),
        TickList("not on paper", ("tick",), (("☐",),)),
        NoteLines("notes"),
        Illustration("drawn", "alt", lambda size: Drawing(*size, ()), (1.0, 1.0)),
    )
    report = Report("plot", "title", date(2026, 1, 1), (Sheet("heading", blocks),))
    assert list(report.words()) == [
        "plot", "title", "heading", "a sentence", "label", "value", "note", "list", "one", "two",
        "table", "column", "cell", "more", "notes", "drawn",
    ]  # fmt: skip
