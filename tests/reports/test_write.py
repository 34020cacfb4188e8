"""Reports in files, by their ending."""

from pathlib import Path

import pytest

from fieldmon.errors import FileProblem, SettingError
from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import pdf_bytes
from fieldmon.reports.write import checked_ending, write_report


def test_the_ending_tells_the_format(of_day, tmp_path):
    assert write_report(of_day, tmp_path / "a.PDF").read_bytes() == pdf_bytes(of_day)
    page = write_report(of_day, str(tmp_path / "a.html"))
    assert page.read_text("utf-8") == html_text(of_day)


def test_the_paper_is_passed_on(of_day, tmp_path):
    file = write_report(of_day, tmp_path / "a.pdf", "letter")
    assert file.read_bytes() == pdf_bytes(of_day, "letter")


@pytest.mark.parametrize("name", ["report.docx", "report", ".pdf"])
def test_another_ending_is_refused_and_nothing_written(of_day, tmp_path, name):
    with pytest.raises(SettingError, match=r"must end in \.pdf or \.html"):
        write_report(of_day, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_a_sentence(of_day, tmp_path):
    with pytest.raises(FileProblem, match="must exist before"):
        write_report(of_day, tmp_path / "no" / "a.html")


def test_the_ending_is_told_before_anything_is_gathered():
    assert checked_ending(Path("x.Html")) == ".html"
