"""Answers lie on one map under their numbers; a tap on any part of one is that answer."""

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
