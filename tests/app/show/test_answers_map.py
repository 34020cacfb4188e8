"""Answers lie on one map under their numbers; a tap on any part of one is that answer."""

import numpy as np
import pytest

from app.show import answers_map
from app.show.answers_map import PLACES, SHAPES
from app.state.tried_answers import TriedAnswer
from tests.app.chosen import a_plot

NEAR = a_plot().field
HERE = TriedAnswer("EPSG:2039", (NEAR, NEAR), "Asia/Jerusalem")
NOWHERE = TriedAnswer("EPSG:1")
ALSO = TriedAnswer("EPSG:28191", (NEAR,), "Asia/Jerusalem")


def test_nothing_to_look_at_is_no_map():
    assert answers_map.content((), dark=False) is None
    assert answers_map.content((NOWHERE,), dark=False) is None


def test_each_answer_that_leads_somewhere_is_named_by_its_number():
    made = answers_map.content((HERE, NOWHERE, ALSO), dark=False)
    assert [one["t"] for one in made.labels] == ["1", "3"]
    assert "2 places" in made.alt
    assert {layer.id for layer in made.layers} == {SHAPES, PLACES}, "near by: no time zones"
    west, south, east, north = made.bounds
    lon, lat = made.labels[0]["p"]
    assert west < lon < east
    assert south < lat < north


def test_a_tap_on_an_outline_or_its_dot_is_the_answer():
    tried = (HERE, NOWHERE, ALSO)
    assert [answers_map.tapped(tried, SHAPES, k) for k in range(3)] == [
        "EPSG:2039", "EPSG:2039", "EPSG:28191",
    ]  # fmt: skip
    assert answers_map.tapped(tried, PLACES, 1) == "EPSG:28191"
    assert answers_map.tapped(tried, PLACES, 2) is None
    assert answers_map.tapped(tried, "zones", 0) is None


def test_one_place_is_shown_from_so_far_that_its_country_is_seen():
    made = answers_map.content((HERE, NOWHERE), dark=False, on_earth=True)
    west, south, east, north = made.bounds
    assert east - west > 10
    assert north - south > 6
    zones = next(layer for layer in made.layers if layer.id == "zones")
    assert {"Asia/Jerusalem", "Asia/Amman"} <= {row["t"] for row in zones.data}
    # which of the plots of a file is meant is seen by their shapes
    near = answers_map.content((HERE, NOWHERE), dark=False)
    assert near.bounds[2] - near.bounds[0] < 0.01
    assert near.legend == [], "an empty legend"


@pytest.mark.parametrize("strip", [(5.0, 29.9, 35.0, 30.0), (34.9, 15.0, 35.0, 45.0)])
def test_answers_in_a_line_stand_on_a_map_and_no_strip(strip):
    (zones,) = answers_map.ground_of(np.array(strip), dark=False)
    corners = np.array([corner for row in zones.data for corner in row["p"]])
    wide, high = np.ptp(corners, axis=0)
    assert min(wide, high) >= 0.45 * max(wide, high)
