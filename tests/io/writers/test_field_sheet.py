"""The field sheet for paper: every plant in order with its boxes, a map true to scale."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest

from fieldmon.io.writers import write_handoff
from fieldmon.plot.layout import rectangle
from tests.io.writers.handed import DAYS, crooked, day, long, usual

_VOID = {"meta"}


class Sheet(HTMLParser):
    """What stands on a sheet."""

    def __init__(self, path):
        super().__init__()
        self.rows, self.circles, self.attributes, self.open = [], [], [], []
        self.text = ""
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag, attrs):
        named = dict(attrs)
        self.attributes += attrs
        if tag not in _VOID:
            self.open.append(tag)
        if tag == "tr" and "data-plant" in named:
            self.rows.append({"plant": int(named["data-plant"]), "cells": [], "boxes": 0})
        if tag == "td":
            self.rows[-1]["cells"].append("")
        if tag == "i" and "td" in self.open:
            self.rows[-1]["boxes"] += 1

    def handle_startendtag(self, tag, attrs):
        self.attributes += attrs
        if tag == "circle":
            named = dict(attrs)
            self.circles.append((float(named["cx"]), float(named["cy"])))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag  # every element is closed where it should be

    def handle_data(self, data):
        self.text += data
        if "td" in self.open:
            self.rows[-1]["cells"][-1] += data


@pytest.fixture(params=DAYS)
def plan(request):
    return DAYS[request.param]()


def sheet_of(plan, folder):
    (path,) = write_handoff(plan, folder / "sheet.html")
    return Sheet(path), path


def test_every_plant_stands_in_order_with_three_boxes(tmp_path, plan):
    sheet, _ = sheet_of(plan, tmp_path)
    assert sheet.open == []
    assert [row["plant"] for row in sheet.rows] == plan.route.plant.tolist()
    for row, stop in zip(sheet.rows, plan.stops, strict=True):
        face = "ab"[stop.face - 1] if stop.face else ""
        wanted = [
            str(stop.order),
            str(stop.row),
            f"{stop.number}{face}",
            stop.arrive[11:16],
            "",
            "",
        ]
        assert row["cells"] == wanted
        assert row["boxes"] == 3


def test_the_sheet_asks_for_nothing_from_outside(tmp_path, plan):
    sheet, path = sheet_of(plan, tmp_path)
    assert not {"src", "href", "data", "srcset"} & {name for name, _ in sheet.attributes}
    assert not re.search(r"<script|url\(|@import|https?:", path.read_text("utf-8"))


def test_names_are_text_whatever_stands_in_them(tmp_path):
    plan = day(rectangle(3, 4), plot='<img src="x">&amp;\x00')
    sheet, _ = sheet_of(plan, tmp_path)
    assert '<img src="x">&amp;' in sheet.text
    assert "src" not in {name for name, _ in sheet.attributes}


def test_the_map_is_true_to_scale_and_not_mirrored(tmp_path, plan):
    sheet, path = sheet_of(plan, tmp_path)
    on_paper = np.array(sheet.circles).reshape(-1, 2)
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
