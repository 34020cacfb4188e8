"""What every format tells of a day: stops in words and numbers, texts, and pieces of a line."""

import re
from datetime import datetime, timedelta
from itertools import pairwise
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fieldmon.io.writers import write_handoff
from fieldmon.io.writers.day_file import DECIMALS, faces, pieces, plain_text
from fieldmon.plot.grid import plant_at
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from tests.io.writers.handed import CM, START, apart_m, crooked, day, usual


def test_a_stop_names_the_plant_that_it_is_at(plan):
    for order, (stop, plant) in enumerate(zip(plan.stops, plan.route.plant, strict=True), 1):
        first_face = plan.grid.vine[plant]
        assert plan.grid.vine[plant_at(plan.grid, stop.row, stop.number)] == first_face
        assert (stop.order, stop.plant) == (order, plant)
        assert stop.chance == pytest.approx(plan.route.chance[order - 1], abs=1e-6)


def test_a_stop_is_at_its_plant_and_its_vertex_on_the_line_beside_it(plan):
    lonlat = [(stop.lon, stop.lat) for stop in plan.stops]
    assert apart_m(lonlat, plan.grid.lonlat(plan.route.plant)) < CM
    vertex = [stop.vertex for stop in plan.stops]
    beside_m = plan.route.aisles.stop_m[plan.route.plant]
    assert apart_m(plan.line_lonlat[vertex], plan.grid.frame.lonlat(beside_m)) < CM


def test_stops_are_in_the_order_of_the_clock_and_pauses_fit_between(plan):
    for stop, after in pairwise(plan.stops):
        assert stop.arrive_s + stop.inspect_s <= after.arrive_s + 2e-3
        assert stop.arrive <= after.arrive
    for stop, arrive_s in zip(plan.stops, plan.route.arrive_s.tolist(), strict=True):
        assert stop.arrive == (START + timedelta(seconds=round(arrive_s))).isoformat()


def test_without_a_start_there_are_seconds_only():
    plan = day(rectangle(3, 4), start=None)
    assert {stop.arrive for stop in plan.stops} == {""}
    assert plan.clock(60.0) == ""
    assert plan.title == plan.notes.plot


def test_labels_differ_and_read_back():
    for plan in (usual(), crooked()):
        labels = [stop.label for stop in plan.stops]
        assert len(set(labels)) == len(labels)
        for stop, label in zip(plan.stops, labels, strict=True):
            order, row, number, face = re.fullmatch(
                r"(\d{3,}) R(\d+)/(\d+)([ab]?)", label
            ).groups()  # fmt: skip
            assert (int(order), int(row), int(number)) == (stop.order, stop.row, stop.number)
            assert face == ("", "a", "b")[stop.face]


def test_faces_are_two_where_both_are_inspected_and_else_none():
    plan = crooked()
    assert plan.has_faces
    assert not usual().has_faces
    grid = rectangle(2, 3, Planting(faces=2))
    of = faces(grid, np.arange(len(grid)))
    assert set(of.tolist()) == {1, 2}
    assert (of + of[grid.twin] == 3).all()
    assert (faces(rectangle(2, 3), np.arange(6)) == 0).all()


def test_a_day_is_called_by_its_plot_and_date():
    assert (
        day(rectangle(3, 4), plot="Gate", start=datetime(2026, 1, 2, 7)).title == "Gate 2026-01-02"
    )


@given(text=st.text(alphabet=st.characters(codec=None), max_size=60))
def test_any_name_can_stand_in_xml_and_stays_as_long(text):
    """XML 1.0 holds neither control characters nor halves of surrogate pairs, not even escaped."""
    plain = plain_text(text)
    assert len(plain) == len(text)
    element = ET.Element("name")
    element.text = plain
    back = ET.fromstring(ET.tostring(element, encoding="utf-8")).text or ""  # noqa: S314 - our own
    assert back == plain.replace("\r\n", "\n").replace("\r", "\n") or back == plain
    kept = [c for c in text if c.isprintable() and c.isascii()]
    assert [c for c in plain if c.isprintable() and c.isascii() and c != " "] == [
        c for c in kept if c != " "
    ]


@example(n=1, most=2)
@given(n=st.integers(0, 1200), most=st.integers(2, 260))
def test_pieces_of_a_line_are_short_and_each_begins_where_the_last_one_ended(n, most):
    cut = pieces(n, most)
    lengths = [run.stop - run.start for run in cut]
    assert all(length <= most for length in lengths)
    assert n < 2 or min(lengths) >= 2
    assert all(before.stop - 1 == after.start for before, after in pairwise(cut))
    assert (cut[0].start, cut[-1].stop) == (0, n) if n else cut == []


def test_degrees_have_as_many_decimals_as_mean_anything():
    stop = usual().stops[3]
    assert round(stop.lon, DECIMALS) == stop.lon
    assert 0.001 < 111_320 * 10.0**-DECIMALS < 0.002  # a millimetre, and nothing below it


def test_a_block_is_written_where_there_are_several(plan, tmp_path):
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    heads = path.read_text("utf-8-sig").splitlines()[0]
    several = plan.grid.block is not None and len(set(plan.grid.block.tolist())) > 1
    assert ("block" in heads.split(",")) == several
