"""Reports in files, by their ending."""

from datetime import date
from pathlib import Path

import pytest

from fieldmon.errors import FileProblem, SettingError
from fieldmon.reports.content import Paragraph, Report, Sheet
from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import pdf_bytes
from fieldmon.reports.write import checked_ending, write_report


@pytest.fixture
def report():
    """Return a report of one sentence."""
    return Report("Gate", "Day", date(2026, 11, 18), (Sheet("Work", (Paragraph("Ann."),)),))


def test_the_ending_tells_the_format(report, tmp_path):
    assert write_report(report, tmp_path / "a.PDF").read_bytes() == pdf_bytes(report)
    page = write_report(report, str(tmp_path / "a.html"))
    assert page.read_text("utf-8") == html_text(report)


def test_the_paper_is_passed_on(report, tmp_path):
    file = write_report(report, tmp_path / "a.pdf", "letter")
    assert file.read_bytes() == pdf_bytes(report, "letter")


@pytest.mark.parametrize("name", ["report.docx", "report", ".pdf"])
def test_another_ending_is_refused_and_nothing_written(report, tmp_path, name):
    with pytest.raises(SettingError, match=r"must end in \.pdf or \.html"):
        write_report(report, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_a_sentence(report, tmp_path):
    with pytest.raises(FileProblem, match="must exist before"):
        write_report(report, tmp_path / "no" / "a.html")


def test_the_ending_is_told_before_anything_is_gathered():
    assert checked_ending(Path("x.Html")) == ".html"
