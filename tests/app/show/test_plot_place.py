"""Where a plot lies is said in the words of the question about coordinate systems."""

import json

import pytest

from app.show import plot_place
from app.words import texts
from tests.app.chosen import a_plot
from tests.app.driving import go, press, texts_of, upload


@pytest.mark.parametrize(
    ("zone", "says"),
    [
        ("Africa/Juba", "South Sudan"),
        ("Etc/GMT+1", texts.AT_SEA),
        ("Moon/Sea_of_Rain",) * 2,
        ("", ""),
    ],
)
def test_an_answer_is_named_by_its_country(zone, says):
    assert plot_place.of_zone(zone) == says.replace("_", " ")


def test_countries_are_named_in_the_page_s_language(speaking):
    speaking("he")
    assert plot_place.of_zone("Asia/Jerusalem") == "ישראל"


def test_a_plot_lies_where_its_plants_are():
    said = plot_place.sentence(a_plot())
    assert "30.36" in said
    assert said.endswith("Israel.")


def test_corners_that_changed_places_are_seen_where_a_plot_is_opened_first(app):
    lon, lat = 41.62, 0.62
    ring = [[lon, lat], [lon + 0.001, lat], [lon + 0.001, lat + 0.001], [lon, lat + 0.001]]
    plot = {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}
    upload(app, plot=("plot.geojson", json.dumps(plot).encode()))
    for page in ("plot", "today"):
        assert texts_of(go(app, page)).count("Somalia") == 1
    press(app, texts.BEGIN)
    asked = texts_of(app)
    assert "Is this right" in asked
    assert asked.count("Somalia") == 1
