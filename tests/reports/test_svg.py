"""Drawings as SVG: each part as an element where it says."""

import base64

import numpy as np
import pytest

from fieldmon.reports.drawing import (
    Areas,
    Bitmap,
    Discs,
    Drawing,
    Lettering,
    Segments,
    Strokes,
)
from fieldmon.reports.svg import svg
from tests.pages import Page

LINE = np.array([[1.0, 2.0], [3.0, 4.5]])


def drawn(*parts, label=""):
    return Page(svg(Drawing(50, 20, parts), label))


def test_a_drawing_is_as_large_as_it_says_and_says_what_it_shows():
    (picture,) = drawn(label="A <map>").all("svg")
    assert (picture["viewbox"], picture["aria-label"]) == ("0 0 50.0 20.0", "A <map>")
    assert drawn().all("svg")[0]["aria-hidden"] == "true"


@pytest.mark.parametrize(
    ("part", "data"),
    [
        (Strokes((LINE, LINE + 1), (1, 2, 3), 0.5), "M1 2L3 4.5M2 3L4 5.5"),
        (Segments(np.array([[1, 2, 3, 4.5]]), (1, 2, 3), 0.5), "M1 2L3 4.5"),
        (Areas((LINE,), fill=(1, 2, 3)), "M1 2L3 4.5Z"),
    ],
)
def test_lines_and_areas_run_through_their_places(part, data):
    (path,) = drawn(part).all("path")
    assert path["d"] == data
    assert "#010203" in {path["fill"], path["stroke"]}


def test_a_disc_is_a_circle_of_its_radius():
    circles = drawn(Discs(LINE, 1.5, edge=(255, 0, 16))).all("circle")
    assert [(one["cx"], one["cy"], one["r"]) for one in circles] == [
        ("1", "2", "1.5"), ("3", "4.5", "1.5"),
    ]  # fmt: skip
    assert {(one["fill"], one["stroke"]) for one in circles} == {("none", "#ff0010")}


def test_words_are_text_whatever_stands_in_them():
    page = drawn(Lettering(1, 2, "<b>12 m</b>", anchor="end", bold=True))
    assert page.text.strip() == "<b>12 m</b>"
    (said,) = page.all("text")
    assert (said["text-anchor"], said["font-weight"]) == ("end", "bold")


def test_a_picture_travels_inside_the_page():
    (image,) = drawn(Bitmap(1, 2, 3, 4, b"png")).all("image")
    assert image["href"] == "data:image/png;base64," + base64.b64encode(b"png").decode()


def test_dashes_and_opacity_are_kept():
    dashed, pale = drawn(Strokes((LINE,), (0, 0, 0), 1, dashed=True),
                         Areas((LINE,), fill=(0, 0, 0), opacity=0.5)).all("path")  # fmt: skip
    assert dashed["stroke-dasharray"] == "1.2"
    assert pale["fill-opacity"] == "0.5"
