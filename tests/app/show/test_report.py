"""The printed report of a day: figures, picture, finds, season, settings and every stop."""

import re
from dataclasses import replace
from datetime import date, datetime

import numpy as np
import pandas as pd
import pytest

from app.show import report
from app.state.chosen_day import DayRoute
from app.words.units import Units
from fieldmon.monitoring import DayFigures
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from tests.io.writers.handed import day
from tests.pages import HOSTILE, Page, held

DAYS = [
    DayFigures(date(2026, 11, 16), 40, 3, 21.34, 12, 30, 0.0),
    DayFigures(date(2026, 11, 17), 45, 5, 19.06, 11, 28, 0.01),
]


@pytest.fixture(scope="module")
def route():
    return day(rectangle(9, 14)).route


@pytest.fixture(scope="module")
def facts(route):
    n = len(route.aisles.grid)
    state = np.full(n, -1, np.int8)
    state[[3, 40]] = 1
    return report.Facts(
        name="Gate",
        day="2026-11-18",
        units=Units(),
        chance=np.linspace(0, 1, n),
        state=state,
        robot=Robot(hours=1.5),
        sampler="Adaptive",
        shown=DayRoute(route, datetime(2026, 11, 18, 6)),
        results={"Row 3": "17, 18"},
    )


def stops_of(n):
    """Return a table of stops like the pages have."""
    columns = {"arrive": [f"07:{k % 60:02d}:00" for k in range(n)], "row": range(1, n + 1),
               "chance %": (np.arange(n) / 3).round(1)}  # fmt: skip
    return pd.DataFrame(columns, pd.RangeIndex(1, n + 1, name="stop"))


def made(facts, n_stops=130, days=DAYS):
    return report.html(facts, stops_of(n_stops), days)


def test_figures_finds_season_and_settings_stand_in_their_tables(facts):
    page = Page(made(facts))
    figures, found, season, settings, *_ = page.tables
    route = facts.route
    assert [row[1] for row in figures] == [
        f"{len(route):,} / {len(facts.chance):,}",
        f"{route.end_s / 3600:.1f} h",
        facts.units.metres(route.drive_m),
        f"{route.expected_found:.1f}",
    ]
    assert found == [["Row 3", "17, 18"]]
    assert season[1:] == [
        ["2026-11-16", "40", "3", "21.3 (12-30)"],
        ["2026-11-17", "45", "5", "19.1 (11-28)"],
    ]
    assert [row[1] for row in settings] == ["Adaptive", "1.5", "40", "2.5 km/h", "84%"]


def test_every_stop_has_its_line_and_a_box_to_tick_sixty_a_table(facts):
    *_, one, two, three = Page(made(facts)).tables
    assert [len(table) - 1 for table in (one, two, three)] == [60, 60, 10]
    assert one[0] == two[0] == ["stop", "arrive", "row", "chance %", "found?"]
    lines = [row for table in (one, two, three) for row in table[1:]]
    table = stops_of(130)
    for line, (stop, arrive, row, chance) in zip(
        lines, table.reset_index().itertuples(index=False, name=None), strict=True
    ):
        assert line == [str(stop), arrive, str(row), f"{chance:.1f}", "☐"]


def test_after_the_work_the_report_says_what_was_done(facts):
    done = replace(facts, shown=replace(facts.shown, worked=True))
    page = Page(report.html(done, stops_of(5).assign(result="clean"), DAYS))
    route = facts.route
    assert list(page.tables[0]) == [
        ["Plants inspected", f"{len(route):,} / {len(facts.chance):,}"],
        ["Hours", f"{route.end_s / 3600:.1f} h"],
        ["Drive", facts.units.metres(route.drive_m)],
        ["Found that day", "2"],
    ]
    assert page.tables[-1][0] == ["stop", "arrive", "row", "chance %", "result"]
    assert "Route as it was worked" in page.headings


def test_what_is_assumed_stands_under_the_figures(facts):
    text = made(replace(facts, assumed="\\* assumed: rows 4 m apart."))
    assert "<p>* assumed: rows 4 m apart.</p>" in text


def test_what_is_not_there_has_no_heading(facts):
    page = Page(made(replace(facts, results={}), 0, []))
    assert page.headings[1:] == ["Settings"]
    assert len(page.tables) == 2


def test_the_picture_shows_every_plant_the_finds_and_the_gate(facts):
    page = Page(str(report.drawing(facts)))
    squares = sum(len(re.findall("M", path["d"])) for path in page.all("path") if "stroke" in path)
    assert squares == len(facts.chance)
    assert len(page.all("circle")) == 2 + 1
    (picture,) = page.all("svg", "map")
    assert "Gate" in picture["aria-label"]
    assert "2 plants found" in picture["aria-label"]


def test_the_page_is_whole_and_asks_for_nothing(facts):
    page = Page(made(facts))
    assert page.asks_for == page.runs == []


@pytest.mark.parametrize("text", HOSTILE)
def test_names_and_results_are_text_whatever_stands_in_them(facts, text):
    hostile = replace(facts, name=text, day=text, sampler=text, results={text: text})
    page = held(made(hostile), [text])
    assert [text, text] in page.tables[1]
    assert text in page.headings[0]
    assert text in page.all("svg", "map")[0]["aria-label"]


def test_on_a4_the_route_s_tables_stand_side_by_side(browser, facts, tmp_path):
    path = tmp_path / "report.html"
    path.write_text(made(facts), "utf-8")
    page = browser.new_page(color_scheme="dark")
    page.goto(path.as_uri())
    shade = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(shade) == "rgb(255, 255, 255)"  # paper is white in a dark room too
    printed = page.pdf(prefer_css_page_size=True)
    page.close()
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) <= 3
