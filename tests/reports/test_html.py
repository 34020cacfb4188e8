"""A report as a page of HTML."""

from dataclasses import replace

import pytest

from fieldmon.compute.units import Units
from fieldmon.reports.content import KeyFigures, Table
from fieldmon.reports.day import DayFacts, day_report
from fieldmon.reports.html import html_text
from tests.pages import HOSTILE, Page, held
from tests.reports.reading import opened, plain


def test_the_page_is_whole_and_asks_for_nothing(of_season, of_day):
    for report in (of_season, of_day):
        page = Page(html_text(report))
        assert page.asks_for == page.runs == []


def test_it_says_what_the_pdf_says_and_every_row_besides(of_season, of_day, of_worked_day):
    for report in (of_season, of_day, of_worked_day):
        page = Page(html_text(report))
        blocks = [block for sheet in report.sheets for block in sheet.blocks]
        tables = [block for block in blocks if isinstance(block, Table)]
        assert tables
        for block in tables:
            assert [[*row] for row in (block.columns, *block.rows)] in page.tables
        for block in blocks:
            if isinstance(block, KeyFigures):
                assert all(each.value in page.text for each in block.figures)


def test_every_stop_has_its_line_and_a_box_to_tick_sixty_a_table(of_day):
    page = Page(html_text(of_day))
    ticks = [table for table in page.tables if "found?" in table[0]]
    lines = [row for table in ticks for row in table[1:]]
    assert [int(row[0]) for row in lines] == list(range(1, len(lines) + 1))
    assert all(len(table) <= 61 for table in ticks)


@pytest.mark.parametrize("text", HOSTILE)
def test_names_and_results_are_text_whatever_stands_in_them(worked, last, text):
    facts = replace(DayFacts.of_season(worked, last), name=text)
    report = day_report(facts, Units())
    page = held(html_text(report), [text])
    assert text in page.headings[0]
    assert text in page.all("svg")[0]["aria-label"]


def test_pictures_say_what_they_show_and_the_legend_is_not_read_out(of_season):
    pictures = Page(html_text(of_season)).all("svg")
    assert all(("aria-label" in one) != ("aria-hidden" in one) for one in pictures)
    assert sum("aria-label" in one for one in pictures) == 2 + 4


def test_printed_by_a_browser_a_season_begins_each_part_on_a_page(browser, of_season, tmp_path):
    path = tmp_path / "report.html"
    path.write_text(html_text(of_season), "utf-8")
    page = browser.new_page(color_scheme="dark")
    page.goto(path.as_uri())
    shade = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(shade) == "rgb(255, 255, 255)"  # paper is white in a dark room too
    printed = page.pdf(prefer_css_page_size=True)
    page.close()
    pages = [plain(one.extract_text()) for one in opened(printed).pages]
    assert 4 <= len(pages) <= 7
    began = {
        k for sheet in of_season.sheets for k, text in enumerate(pages) if sheet.heading in text
    }
    assert len(began) >= 4


def test_on_a_phone_two_figures_stand_in_a_line(browser, of_season, tmp_path):
    path = tmp_path / "report.html"
    path.write_text(html_text(of_season), "utf-8")
    page = browser.new_page(viewport={"width": 360, "height": 800})
    page.goto(path.as_uri())
    widths = "[...document.querySelectorAll('.figures div')].map(one => one.clientWidth)"
    narrowest = min(page.evaluate(widths))
    page.close()
    assert narrowest > 120


def test_from_the_right_the_words_of_maps_and_charts_stand_where_they_stand_from_the_left(
    browser, of_season, tmp_path
):
    path = tmp_path / "report.html"
    path.write_text(html_text(of_season), "utf-8")
    page = browser.new_page()
    page.goto(path.as_uri())
    place = """(side) => { document.documentElement.dir = side;
      return [...document.querySelectorAll("svg text")].map((word) => {
        const at = word.getBoundingClientRect(), map = word.closest("svg").getBoundingClientRect();
        return at.left - map.left; }); }"""
    left, right = (page.evaluate(place, side) for side in ("ltr", "rtl"))
    page.close()
    assert len(left) > 20
    assert right == pytest.approx(left, abs=1.0)


def test_words_begin_where_reading_begins_and_figures_end_under_each_other(of_season):
    page = html_text(of_season)
    assert '<td class="words">day_5.csv</td>' in page
    assert '<th class="words">from</th>' in page
    assert "<th>how many</th>" in page
