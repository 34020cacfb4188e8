"""Charts put values where they belong, say what they are, and take no label for markup."""

import re

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from markupsafe import Markup

from fieldmon.studies.charts import Line, Range, line_chart, range_chart
from tests.pages import HOSTILE, Page, held

NAN = float("nan")
VALUES = st.floats(-1e4, 1e4).map(lambda value: round(value, 3))


def points_of(chart):
    """Return the points of every line of a chart, ``(k, 2)`` each."""
    return [
        np.array([[float(v) for v in point.split(",")] for point in line["points"].split()])
        for line in chart.all("polyline")
    ]


def ticks_of(chart, anchor):
    """Return what ticks say, and where they stand: ``middle`` across, ``end`` up."""
    found = re.findall(rf'x="([\d.-]+)" y="([\d.-]+)" text-anchor="{anchor}">(-?[\d.e+]+)<', chart)
    return [(float(said), float(x), float(y)) for x, y, said in found]


def test_a_line_runs_through_its_points():
    chart = line_chart("t", [Line("l", [0, 10], [0, 100])], ("x", "y"))
    (line,) = points_of(Page(chart))
    assert line.tolist() == [[50, 280], [510, 28]]


@given(st.lists(st.tuples(VALUES, VALUES), min_size=2, max_size=20, unique_by=lambda p: p[0]))
def test_a_line_is_true_to_the_ticks_on_both_axes(points):
    x, y = zip(*sorted((x, abs(y)) for x, y in points), strict=True)
    assume(max(x) - min(x) >= 1e-2 and max(y) >= 1e-2)
    chart = line_chart("t", [Line("l", x, y)], ("x", "y"))
    (drawn,) = points_of(Page(chart))
    across, up = ticks_of(chart, "middle"), ticks_of(chart, "end")
    for (said, place), values, own in (
        (zip(*[(said, at) for said, at, _ in across], strict=True), x, drawn[:, 0]),
        (zip(*[(said, at - 4) for said, _, at in up], strict=True), y, drawn[:, 1]),
    ):
        slope, start = np.polyfit(said, place, 1)
        span = abs(slope) * (max(said) - min(said))
        np.testing.assert_allclose(own, start + slope * np.array(values), atol=0.002 * span + 0.2)


def test_a_chart_of_ranges_has_a_bar_a_dot_and_a_cross_where_there_is_another_value():
    rows = [Range("a", 10, 20, 30, 40), Range("b", 20, 25, 40), Range("none", NAN, NAN, NAN)]
    chart = Page(range_chart("t", rows, "%"))
    bars, dots, crosses = chart.all("line", "range"), chart.all("circle"), chart.all("path")
    assert (len(bars), len(dots), len(crosses)) == (2, 2, 1)
    assert "thesis 40" in chart.text
    assert "none" not in chart.text
    ticks = ticks_of(chart.source, "middle")
    slope, start = np.polyfit(*zip(*[(said, x) for said, x, _ in ticks], strict=True), 1)
    for bar, dot, row in zip(bars, dots, rows, strict=False):
        places = [float(bar["x1"]), float(dot["cx"]), float(bar["x2"])]
        wanted = [start + slope * value for value in (row.low, row.mean, row.high)]
        assert places == pytest.approx(wanted, abs=0.2)
        assert bar["y1"] == bar["y2"] == dot["cy"]


def test_a_band_goes_forth_along_the_highs_and_back_along_the_lows():
    band = Line("l", [0, 10], [100, 50], [0, 20], [100, 80])
    (area,) = Page(line_chart("t", [band], ("x", "y"))).all("polygon", "band")
    corners = [tuple(map(float, corner.split(","))) for corner in area["points"].split()]
    x = [50, 510, 510, 50]
    y = [28, 28 + 0.2 * 252, 280 - 0.2 * 252, 280]
    assert corners == [pytest.approx(corner) for corner in zip(x, y, strict=True)]


def test_a_value_that_is_missing_leaves_no_point():
    (line,) = points_of(Page(line_chart("t", [Line("l", [0, 1, 2], [1, NAN, 3])], ("x", "y"))))
    assert len(line) == 2


def test_after_five_colours_lines_are_dashed():
    lines = [Line(str(k), [0, 1], [k, k]) for k in range(7)]
    styles = [line["class"] for line in Page(line_chart("t", lines, ("x", "y"))).all("polyline")]
    assert styles == [*(f"line c{k}" for k in range(5)), "line c0 dashed", "line c1 dashed"]


def test_nothing_to_show_makes_no_chart():
    assert range_chart("none", [Range("y", NAN, NAN, NAN)], "%") == ""
    assert line_chart("none", [Line("y", [0], [NAN])], ("x", "y")) == ""


def test_equal_values_still_make_a_chart():
    assert len(Page(range_chart("same", [Range("a", 5, 5, 5)], "%")).all("circle")) == 1


@pytest.mark.parametrize("text", HOSTILE)
def test_every_label_is_text_and_the_chart_is_safe_to_put_into_a_page(text):
    charts = (
        range_chart(text, [Range(text, 1, 2, 3)], text),
        line_chart(text, [Line(text, [0, 1], [1, 2])], (text, text)),
    )
    for chart in charts:
        assert isinstance(chart, Markup)
        page = held(chart, [text])
        assert set(page.tags) <= {
            *("figure", "figcaption", "div", "svg", "line", "circle", "text", "polyline", "title")
        }
        assert page.text.count(text) >= 3
        (drawing,) = page.all("svg")
        assert drawing["aria-label"] == text


def test_in_powers_every_step_up_is_ten_times_the_last():
    chart = line_chart("t", [Line("l", [0, 1, 2], [1, 10, 1000])], ("x", "y"), powers=True)
    (drawn,) = points_of(Page(chart))
    ups = np.diff(drawn[:, 1])
    assert ups[1] == pytest.approx(2 * ups[0])
    said = [value for value, _, _ in ticks_of(chart, "end")]
    assert said == [1, 10, 100, 1000]
    # of nothing there is no power: the point is left out
    (short,) = points_of(Page(line_chart("t", [Line("l", [0, 1, 2], [0, 10, 100])], ("x", "y"),
                                         powers=True)))  # fmt: skip
    assert len(short) == 2


def test_long_words_stay_within_the_drawing():
    """Labels, legends and titles of axes, however long."""
    label, axis = "B, spread 30% to one, clusters, prior records 5 %, records wrong", "ratio " * 9
    for chart in (
        range_chart("t", [Range(label, 1, 2, 3)], axis),
        line_chart("t", [Line(label, [0, 1], [0, 1])], ("x", "y")),
    ):
        (width,) = re.findall(r'viewBox="0 0 ([\d.]+) ', chart)
        for x, anchor, said in re.findall(
            r'x="([\d.-]+)" y="[^"]*" text-anchor="(\w+)">([^<]*)', chart
        ):
            share = {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor]
            begins = float(x) - share * 6.6 * len(said)
            assert begins >= 0.0
            assert begins + 6.6 * len(said) <= float(width) + 1e-6


def test_a_line_runs_where_neither_is_ahead():
    chart = Page(range_chart("t", [Range("a", 2, 3, 4)], "ratio", even=1.0))
    (even,) = chart.all("line", "even")
    ticks = {said: x for said, x, _ in ticks_of(chart.source, "middle")}
    assert float(even["x1"]) == float(even["x2"]) == ticks[1.0]
    assert not Page(range_chart("t", [Range("a", 2, 3, 4)], "ratio")).all("line", "even")
