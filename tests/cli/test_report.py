"""`fieldmon report`: a day or a season on paper."""

from datetime import date, timedelta

import pytest

from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, begin_next_year
from tests.reports.reading import sizes_mm, texts


def test_a_season_is_written_on_four_pages(run, season):
    code, out, err, made = run("report", season, "-o", "season.pdf")
    assert code == 0, err
    assert out == "Report written to season.pdf\n"
    (file,) = made
    pages = texts(file.read_bytes())
    assert len(pages) == 4
    assert all("Nursery" in page for page in pages)
    assert sizes_mm(file.read_bytes())[0] == (210.0, 297.0)


def test_a_day_is_written_on_one_page_of_the_paper_asked_for(run, season):
    code, _, err, made = run(
        *("report", season, "-o", "day.pdf", "--date", BEGINS, "--paper", "letter")
    )
    assert code == 0, err
    (file,) = made
    (page,) = texts(file.read_bytes())
    assert f"Day of {BEGINS}" in page
    assert sizes_mm(file.read_bytes()) == [(215.9, 279.4)]


def test_it_is_written_as_html_too_and_the_season_is_as_it_was(run, season):
    before = season.read_bytes()
    code, _, err, made = run("report", season, "-o", "season.html")
    assert code == 0, err
    (file,) = made
    assert "Where it stands" in file.read_text("utf-8")
    assert season.read_bytes() == before


def test_the_season_can_end_on_an_earlier_day(run, season):
    later = date.fromisoformat(BEGINS) + timedelta(days=2)
    kept = Season(season)
    kept.plan(later)
    pages = {}
    for name, words in (("a.html", ()), ("b.html", ("--until", BEGINS))):
        run("report", season, "-o", name, *words)
        pages[name] = (season.parent / name).read_text("utf-8")
    assert f"to {later}" in pages["a.html"]
    assert f"to {BEGINS}" in pages["b.html"]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("-o", "report.docx"), "must end in .pdf or .html, but it is 'report.docx'"),
        (("--date", "yesterday"), "--date must be a day as YYYY-MM-DD"),
        (("--until", "2026-13-01"), "--until must be a day as YYYY-MM-DD"),
        (("--date", BEGINS, "--until", BEGINS), "both --date and --until were given"),
        (("--date", "2020-01-01"), f"which began on {BEGINS}"),
        (("-o", "nowhere/report.pdf"), "The folder nowhere must exist"),
    ],
)
def test_what_cannot_be_is_a_sentence_and_leaves_no_file(run, season, words, says):
    code, _, err, made = run("report", season, *words)
    assert code == 2
    assert says in " ".join(err.split())
    assert made == set()


def test_the_record_for_a_certifier_is_of_several_seasons_and_a_report_of_one(
    run, season, tmp_path
):
    other = begin_next_year(run, tmp_path)
    code, _, err, made = run("report", season, other, "--certification", "-o", "record.html")
    assert code == 0, err
    assert made == {tmp_path / "record.html"}
    page = (tmp_path / "record.html").read_text("utf-8")
    assert page.count("the chain holds") == 2
    code, _, err, _ = run("report", season, other, "-o", "report.html")
    assert code == 2
    assert "A report is of one season, but 2 are given" in " ".join(err.split())
    code, _, err, _ = run("report", season, "--certification", "--date", "2026-11-02")
    assert code == 2
    assert "is of seasons, not of --date" in " ".join(err.split())


@pytest.mark.parametrize(
    ("code", "says", "direction"),
    [("he", "המצב", "rtl"), ("ar", "الحال الآن", "rtl"), ("es", "Cómo está", "ltr")],
)
def test_it_is_written_in_the_language_asked_for_with_its_dates(run, season, code, says, direction):
    outcome, _, err, made = run("report", season, "-o", "s.html", "--language", code)
    assert outcome == 0, err
    page = next(iter(made)).read_text("utf-8")
    assert f'dir="{direction}"' in page
    assert says in page
    assert "Where it stands" not in page
    day = date.fromisoformat(BEGINS)
    assert f"{day:%d.%m.%Y}" in page or f"{day:%d/%m/%Y}" in page
    assert BEGINS not in page


def test_a_season_keeps_the_language_of_its_reports(run, season):
    for code in ("es", "he"):
        assert run("change", season, "--language", code)[0] == 0
    pages = {}
    for name, words in (("kept.pdf", ()), ("asked.pdf", ("--language", "he"))):
        assert run("report", season, "-o", name, *words)[0] == 0
        pages[name] = texts((season.parent / name).read_bytes())
    assert pages["kept.pdf"] == pages["asked.pdf"]
    code, _, err, made = run("report", season, "--language", "tlh")
    assert (code, made) == (2, set())
    assert "A language must be one of en, he, ar, es, but it is 'tlh'." in err
