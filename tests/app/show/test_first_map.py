"""A plot's outline before there is a map: where things are, and named."""

import re
from urllib.parse import unquote

import numpy as np
import pytest
import shapely

from app.show import first_map
from fieldmon.plot.field import Field
from tests.app.chosen import CORNER
from tests.pages import Page


def drawn(outline):
    """Return the rings of the drawing, in its own units, y downwards."""
    (path,) = re.findall(r' d="([^"]+)"', unquote(outline))
    return [np.array([pair.split(" ") for pair in ring[1:].split("L")], float)
            for ring in path.removesuffix("Z").split("Z")]  # fmt: skip


def test_the_outline_has_the_plot_s_shape_north_up():
    lon, lat = CORNER
    corners = [(lon, lat), (lon + 0.004, lat), (lon + 0.004, lat + 0.001), (lon, lat + 0.002)]
    field = Field("wedge", shapely.MultiPolygon([shapely.Polygon(corners)]))
    (ring,) = drawn(first_map.outline(field))
    flat = np.cos(np.deg2rad(lat + 0.001))
    x, y = (np.array([*corners, corners[0]]) - corners[0]).T
    assert ring[:, 0] == pytest.approx(x / 0.004 * 1000, abs=0.1)
    assert ring[:, 1] == pytest.approx((0.002 - y) / (0.004 * flat) * 1000, abs=0.1)


def test_holes_and_parts_are_drawn_and_nothing_lies_outside_the_picture():
    lon, lat = CORNER
    hole = shapely.box(lon + 0.0002, lat + 0.0002, lon + 0.0004, lat + 0.0004)
    parts = [shapely.box(lon, lat, lon + 0.001, lat + 0.001) - hole,
             shapely.box(lon + 0.002, lat, lon + 0.003, lat + 0.001)]  # fmt: skip
    made = first_map.outline(Field("two", shapely.MultiPolygon(parts)))
    rings = np.concatenate(drawn(made))
    assert len(drawn(made)) == 3
    wide, tall = map(float, re.search(r'viewBox="0 0 (\d+) (\d+)"', unquote(made)).groups())
    assert (rings >= 0).all()
    assert (rings <= [wide, tall + 1]).all()


def test_a_name_of_any_kind_is_only_words():
    square = shapely.MultiPolygon([shapely.box(*CORNER, CORNER[0] + 0.001, CORNER[1] + 0.001)])
    page = Page(first_map.outline(Field('"><script>alert("1")</script> & שדה', square)))
    assert [tag for tag in page.tags if tag != "img"] == []
    assert "<script>" not in first_map.outline(Field("<script>", square))
