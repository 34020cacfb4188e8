"""The report: one page that needs nothing else."""

import re
from html.parser import HTMLParser

import pytest

from fieldmon.studies.charts import Line, Range, line_chart, range_chart
from fieldmon.studies.thesis.chapter4.report import report_html

VOID = {"meta", "br", "img"}


class Balance(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.met = [], []

    def handle_starttag(self, tag, attrs):  # noqa: ARG002 - the parser's form
        self.met.append(tag)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):  # noqa: ARG002 - the parser's form
        self.met.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def page(everything):
    return report_html(everything)


def test_the_page_is_whole_and_has_plots_and_tables(page):
    parser = Balance()
    parser.feed(page)
    assert parser.open == []
    assert parser.met.count("table") == 10
    assert parser.met.count("svg") >= 3 * 4 + 6
    assert parser.met.count("h2") == 10


def test_the_page_asks_for_nothing_from_outside(page):
    assert not re.search(r"https?://|<script|<link|src=|@import|url\(", page)


def test_no_number_is_missing_its_value(page):
    assert "nan" not in re.sub(r"<style>.*?</style>", "", page, flags=re.DOTALL).lower().split()
    assert ">nan" not in page


def test_verdicts_and_misprints_can_be_read_without_colour(page):
    for words in ("thesis 53 =", "thesis 82 !", "reference 53.0 ✓", "Known misprints"):
        assert words in page
    assert "its first digit is lost: 266 + 193 = 459" in page


def test_charts_escape_labels_and_leave_out_what_has_no_value():
    chart = range_chart("a < b", [Range("<x>", 1, 2, 3), Range("y", *[float("nan")] * 3)], "%")
    assert "a &lt; b" in chart
    assert "&lt;x&gt;" in chart
    assert chart.count("<circle") == 1
    assert range_chart("none", [Range("y", *[float("nan")] * 3)], "%") == ""
    assert line_chart("none", [Line("y", [0], [float("nan")])], ("x", "y")) == ""


def test_charts_put_points_where_they_belong():
    chart = line_chart("t", [Line("l", [0, 10], [0, 100])], ("x", "y"))
    (points,) = re.findall(r'points="([^"]*)"', chart)
    (x0, y0), (x1, y1) = (map(float, point.split(",")) for point in points.split())
    assert (x0, y0) == (50, 280)
    assert (x1, y1) == (510, 28)


def test_equal_values_still_make_a_chart():
    assert "<circle" in range_chart("same", [Range("a", 5, 5, 5)], "%")
