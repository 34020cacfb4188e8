"""The field sheet for paper: every plant in order with its boxes, a map true to scale."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.compute.wording import PaperLanguage
from fieldmon.io.writers import HandoffPlan, write_handoff
from fieldmon.io.writers.field_sheet import WORDS, _map_of, _marks, _row_numbers, _scale_bar
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from tests.io.writers.handed import DAYS, START, crooked, day, long, usual
from tests.pages import HOSTILE, Page, held

#: to tick for each plant: clean, found, could not be inspected
BOXES = 3


@pytest.fixture(params=DAYS)
def plan(request):
    return DAYS[request.param]()


def sheet_of(plan, folder):
    (path,) = write_handoff(plan, folder / "sheet.html")
    return Page(path.read_text("utf-8")), path


def test_every_plant_stands_in_order_with_three_boxes(tmp_path, plan):
    sheet, _ = sheet_of(plan, tmp_path)
    ((heads, *rows),) = sheet.tables
    assert heads == ["", "row", "plant", "time", "", "how many"]
    for cells, stop in zip(rows, plan.stops, strict=True):
        face = "ab"[stop.face - 1] if stop.face else ""
        number = f"{stop.number}{face}"
        assert cells == [str(stop.order), str(stop.row), number, stop.arrive[11:16], "", ""]
    plants = [int(row["data-plant"]) for row in sheet.all("tr") if "data-plant" in row]
    assert plants == plan.route.plant.tolist()
    # those of the legend, and those of each plant
    assert len(sheet.all("i")) == BOXES * (1 + len(plants))
    assert "Write gone if dead or missing." in sheet.text


def test_a_thick_line_stands_over_each_new_row_of_plants(tmp_path, plan):
    sheet, _ = sheet_of(plan, tmp_path)
    lines = [row.get("class") == "row" for row in sheet.all("tr") if "data-plant" in row]
    rows = np.array([stop.row for stop in plan.stops])
    assert lines == [True, *(np.diff(rows) != 0).tolist()][: len(rows)]


def test_the_head_says_plot_day_plants_and_hours(tmp_path):
    plan = usual()
    sheet, _ = sheet_of(plan, tmp_path)
    assert sheet.headings == [f"{plan.notes.plot} {START:%Y-%m-%d}"]
    ends = plan.clock(plan.route.end_s)[11:16]
    assert f"{len(plan.route)} plants, {plan.route.drive_m / 1000:.2f} km" in sheet.text
    assert f"(07:30 to {ends})" in sheet.text


def test_a_sheet_is_written_in_its_language_and_from_its_side(tmp_path):
    plan = usual()
    spoken = PaperLanguage("he", lambda said: f"<{said}>", right_to_left=True)
    notes = replace(plan.notes, language=spoken)
    sheet, _ = sheet_of(HandoffPlan(plan.route, notes), tmp_path)
    (head,) = sheet.all("html")
    assert (head["lang"], head["dir"]) == ("he", "rtl")
    for said in WORDS.values():
        assert f"<{said}>" in sheet.text or said == WORDS["map"]
    assert [one["aria-label"] for one in sheet.all("svg")] == ["<map>"]
    (english,) = sheet_of(plan, tmp_path)[0].all("html")
    assert (english["lang"], english["dir"]) == ("en", "ltr")


def test_the_sheet_asks_for_nothing_from_outside(tmp_path, plan):
    sheet, path = sheet_of(plan, tmp_path)
    assert sheet.asks_for == sheet.runs == []
    assert not re.search(r"<script|url\(|@import|https?:", path.read_text("utf-8"))


@pytest.mark.parametrize("name", [*HOSTILE, '<img src="x">&amp;\x00'])
def test_names_are_text_whatever_stands_in_them(tmp_path, name):
    plan = day(rectangle(3, 4), plot=name)
    (path,) = write_handoff(plan, tmp_path / "sheet.html")
    sheet = held(path.read_text("utf-8"), [name.strip("\x00")])
    assert set(sheet.tags) <= {
        *("html", "head", "meta", "title", "style", "body", "h1", "bdi", "p", "span", "i", "div"),
        *(
            "svg",
            "g",
            "path",
            "circle",
            "rect",
            "text",
            "table",
            "thead",
            "tbody",
            "tr",
            "th",
            "td",
        ),
    }


def test_a_bar_of_any_scale_is_the_longest_round_number_of_a_fifth_of_the_drawing():
    size = np.array([186.0, 240.0])
    for scale in np.geomspace(0.05, 50.0, 60):
        bar = str(_scale_bar(scale, size))
        metres = float(re.search(r">([\d.e+-]+) m<", bar).group(1))
        there_could_be = [k * 10.0**n for n in range(-3, 5) for k in (1, 2, 5)]
        fitting = [round_m for round_m in there_could_be if round_m * scale <= 186.0 / 5]
        assert metres == pytest.approx(max(fitting))
        assert float(re.search(r"h([\d.]+)", bar).group(1)) == pytest.approx(
            metres * scale, abs=0.01
        )


def test_the_map_is_true_to_scale_and_not_mirrored(tmp_path, plan):
    sheet, path = sheet_of(plan, tmp_path)
    circles = [(float(c["cx"]), float(c["cy"])) for c in sheet.all("circle")]
    on_paper = np.array(circles).reshape(-1, 2)
    assert len(on_paper) == len(plan.route)
    if not len(on_paper):
        return
    xy = plan.grid.xy_m[plan.route.plant]
    here = (xy - xy.mean(axis=0)) @ (1, 1j)
    there = (on_paper - on_paper.mean(axis=0)) @ (1, -1j)  # paper's y runs down
    turn = np.vdot(here, there) / np.vdot(here, here)
    assert np.abs(turn * here - there).max() < 0.02  # millimetres; a mirrored map fits nowhere
    text = path.read_text("utf-8")
    metres = float(re.search(r'class="scale">([\d.]+) m<', text).group(1))
    bar_mm = float(re.search(r"h([\d.]+)\" stroke", text).group(1))
    # a round number, and about a fifth of the drawing
    assert f"{metres:e}"[0] in "125"
    assert 186.0 / 5 / 2.6 < bar_mm <= 186.0 / 5 + 0.01
    assert bar_mm / metres == pytest.approx(abs(turn), rel=0.01)
    north = float(re.search(r"rotate\((-?[\d.]+)\)", text).group(1))
    # up on paper, turned back, is this angle from the rows, whose bearing is the frame's
    up = np.degrees(np.angle(1j / turn))
    assert np.cos(np.radians(plan.grid.frame.bearing_deg - up + north)) > np.cos(np.radians(0.2))


def test_on_paper_a_day_of_a_hundred_plants_has_one_page_and_no_line_is_cut(browser, tmp_path):
    page = browser.new_page()
    pages = {}
    for make in (usual, crooked, long):
        (path,) = write_handoff(make(), tmp_path / f"{make.__name__}.html")
        page.goto(path.as_uri())
        printed = page.pdf(prefer_css_page_size=True)
        pages[make] = len(re.findall(rb"/Type\s*/Page\b", printed))
        box = re.search(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)", printed)
        assert [float(side) for side in box.groups()] == pytest.approx([595, 842], abs=1)
    page.close()
    assert len(crooked().route) > 95
    assert pages[usual] == pages[crooked] == 1
    assert pages[long] <= 1 + len(long().route) // 120


def test_a_sheet_is_white_in_a_dark_room_too(browser, tmp_path):
    (path,) = write_handoff(usual(), tmp_path / "sheet.html")
    page = browser.new_page(color_scheme="dark")
    page.goto(path.as_uri())
    colours = "getComputedStyle(document.body).{}"
    assert page.evaluate(colours.format("backgroundColor")) == "rgb(255, 255, 255)"
    assert page.evaluate(colours.format("color")) == "rgb(0, 0, 0)"
    page.close()


def test_a_plot_that_is_taller_than_wide_lies_on_its_side_and_is_true_to_scale(tmp_path):
    test_the_map_is_true_to_scale_and_not_mirrored(tmp_path, day(rectangle(30, 4)))


def on_paper(sheet, plan):
    """Return how a place on the plot comes on paper, from where the plants of the route stand."""
    circles = np.array([(float(c["cx"]), float(c["cy"])) for c in sheet.all("circle")])
    here, there = plan.grid.xy_m[plan.route.plant] @ (1, 1j), circles @ (1, -1j)
    turn, off = np.polyfit(here, there, 1)

    def placed(xy_m):
        at = turn * (xy_m @ (1, 1j)) + off
        return np.stack([at.real, -at.imag], axis=1)

    return placed


@pytest.mark.parametrize("shape", [(9, 14), (30, 4), (60, 5), (130, 6)])
def test_numbers_on_the_map_stand_by_what_they_number(tmp_path, shape):
    plan = day(rectangle(*shape))
    sheet, path = sheet_of(plan, tmp_path)
    placed, grid = on_paper(sheet, plan), plan.grid
    word = r'<text x="(-?[\d.]+)" y="(-?[\d.]+)"( text-anchor="middle")?>(\d+)</text>'
    said = re.findall(word, path.read_text("utf-8"))
    at = np.array([(float(x), float(y)) for x, y, _, _ in said])
    number = np.array([int(one[-1]) for one in said])
    of_row = np.array([bool(one[2]) for one in said])
    firsts = placed(grid.xy_m[grid.row_start[:-1]])
    near = [np.hypot(*(firsts - one).T).argmin() for one in at[of_row]]
    assert (grid.row_line[near] + 1).tolist() == number[of_row].tolist()
    assert number[of_row][0] == 1
    assert len(set(np.diff(number[of_row])[1:])) <= 1  # each, or each so many-th
    # so many that they have room
    crowded = max(shape) > 100
    assert (number[of_row][2] - number[of_row][1] > 1) == crowded
    assert len(set(np.diff(number[~of_row])[1:])) <= 1
    assert len(plan.stops) / 5 < sum(~of_row) <= 61
    stops = placed(grid.xy_m[plan.route.plant])[number[~of_row] - 1]
    assert number[~of_row][0] == 1
    assert np.hypot(*(at[~of_row] - stops).T).max() < 2  # millimetres
    (begins,) = [one for one in sheet.all("rect") if one.get("width") == "2"]
    middle = np.array([float(begins["x"]) + 1, float(begins["y"]) + 1])
    assert middle == pytest.approx(placed(plan.route.line_m[:1])[0], abs=0.02)


def test_each_stop_is_drawn_on_the_page(tmp_path, plan):
    sheet, path = sheet_of(plan, tmp_path)
    wide, high = map(
        float, re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', path.read_text()).groups()
    )
    circles = [(float(c["cx"]), float(c["cy"])) for c in sheet.all("circle")]
    assert len(circles) == len(plan.stops)
    assert all(0.0 <= x <= wide and 0.0 <= y <= high for x, y in circles)


@pytest.mark.parametrize("rows", [1, 12, 40, 70, 100, 170, 400, 900])
@pytest.mark.parametrize("faces", [1, 2])
def test_row_numbers_are_round_and_as_many_as_have_room(rows, faces):
    plan = SimpleNamespace(grid=rectangle(rows, 3, Planting(faces=faces)))
    plan.route = SimpleNamespace(line_m=plan.grid.xy_m[:1])
    placed, size = _map_of(plan)
    words = re.findall(r'x="([\d.]+)" y="([\d.]+)"[^>]*>(\d+)<', str(_row_numbers(plan, placed)))
    at = {int(number): np.array([float(x), float(y)]) for x, y, number in words}
    lines, first = np.unique(plan.grid.row_line, return_index=True)
    starts = placed(plan.grid.xy_m[plan.grid.row_start[first]])
    gap_mm = np.hypot(*(starts[1] - starts[0])) if rows > 1 else np.inf
    # the least round step at which two numbers stand two and a half millimetres apart
    step = next(k for k in (1, 2, 5, 10, 20, 50, 100) if k * gap_mm >= 2.5)
    assert sorted(at) == [k for k in lines + 1 if k == 1 or k % step == 0]
    for number, place in at.items():
        beside = np.hypot(*(starts - place).T).argmin()
        assert lines[beside] + 1 == number
        assert (place >= 0.0).all()
        assert (place <= size).all()


@pytest.mark.parametrize("hours", [0.6, 1.2, 3.0, 9.0])
def test_numbers_of_stops_are_round_and_sixty_at_most(hours):
    plan = day(rectangle(16, 30), hours=hours, by="naive")
    placed, _ = _map_of(plan)
    n = len(plan.stops)
    said = [int(k) for k in re.findall(r">(\d+)</text>", str(_marks(plan, placed)))]
    step = next(k for k in (1, 5, 10, 20, 50, 100) if n / k <= 60)
    assert said == [k for k in range(1, n + 1) if k == 1 or k % step == 0]
