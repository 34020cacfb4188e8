"""Reports into files, their format told by the ending."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.atomic_write import write_whole
from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import pdf_bytes

if TYPE_CHECKING:
    from fieldmon.reports.content import Report


def write_report(report: Report, path: str | Path, paper: str = "a4") -> Path:
    """Write a report as ``.pdf`` or ``.html``; return the file.

    Raises
    ------
    SettingError
        If the ending tells no format, or there is no such paper.
    FileProblem
        If the file cannot be written; it appears whole or not at all.
    """
    file = Path(path)
    ending = checked_ending(file)
    data = pdf_bytes(report, paper) if ending == ".pdf" else html_text(report).encode()
    write_whole(file, data)
    return file


def checked_ending(path: Path) -> str:
    """Return a report's ending; raise `SettingError` where it tells no format."""
    ending = path.suffix.lower()
    if ending not in {".pdf", ".html"}:
        raise SettingError(
            worded(
                "A report's file must end in .pdf or .html, but it is {name!r}. Name it "
                "report.pdf, for example.",
                name=path.name,
            )
        )
    return ending
