"""A report as a page of HTML that asks for nothing from outside."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.io.html import page
from fieldmon.reports import words
from fieldmon.reports.svg import svg

if TYPE_CHECKING:
    from markupsafe import Markup

    from fieldmon.reports.content import Block, Illustration, Report

# so high that a warning still fits on the page of a map
_WIDE_MM, _HIGH_MM = 186.0, 112.0
_STOPS_A_TABLE = 60


def html_text(report: Report) -> str:
    """Return a report as a page of HTML: all of it, where paper has room for a part."""
    return page(
        "fieldmon/reports/report.html.j2",
        title=f"{words.isolated(report.plot)}: {report.title}",
        report=report,
        language=report.language.code,
        direction="rtl" if report.language.right_to_left else "ltr",
        kind=_kind,
        drawn=_drawn,
        parts=_parts,
        footer=words.FOOTER,
    )


def _kind(block: Block) -> str:
    return type(block).__name__


def _drawn(block: Illustration) -> Markup:
    return svg(block.draw((_WIDE_MM, min(block.heights[1], _HIGH_MM))), block.alt)


def _parts(rows: tuple[tuple[str, ...], ...]) -> list[tuple[tuple[str, ...], ...]]:
    """Return rows in tables to stand side by side: a route is many pages long otherwise."""
    return [rows[k : k + _STOPS_A_TABLE] for k in range(0, len(rows), _STOPS_A_TABLE)]
