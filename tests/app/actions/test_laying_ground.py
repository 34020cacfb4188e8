"""The ground from its page: a file under every map, and a map that is only shown once agreed to."""

import numpy as np
import pytest

from app.state import web_maps
from app.words import texts
from tests.app.driving import geotiff, go, layer, map_of, plants, tap, texts_of


def ids(app):
    return [one["id"] for one in map_of(app)["layers"]]


def test_a_picture_lies_under_the_plants_on_every_page_until_it_is_taken_out(app):
    go(app, "plot")
    app.file_uploader(key="ground_file").upload(
        "ground.tif", geotiff(np.full((400, 400), 90, np.uint8))
    ).run()
    assert not app.exception
    assert ids(app)[0] == "ground-picture", "below all else"
    assert "ground" in {one["key"] for one in map_of(app)["switches"]}
    corners = np.array(layer(app, "ground-picture")["bounds"])
    go(app, "today")
    assert ids(app)[0] == "ground-picture"
    lonlat = plants(app).lonlat
    assert (corners.min(axis=0) <= lonlat.min(axis=0)).all()
    assert (corners.max(axis=0) >= lonlat.max(axis=0)).all()
    go(app, "plot")
    tap(app, "ground_forget")
    assert ids(app)[0] == "headland"


def test_a_file_that_shows_nothing_is_said_and_the_map_goes_on_without(app):
    go(app, "plot")
    app.file_uploader(key="ground_file").upload("ground.tif", b"no picture").run()
    assert not app.exception
    assert app.error
    assert ids(app)[0] == "headland"


def test_heights_are_drawn_as_relief_unless_they_are_said_to_be_a_picture(app):
    go(app, "plot")
    rows = np.repeat(np.linspace(40, 0, 400, dtype=np.float32)[:, None], 400, axis=1)
    app.file_uploader(key="ground_file").upload("dem.tif", geotiff(rows)).run()
    assert "times as steep" in texts_of(app)
    assert not map_of(app)["ground"]["picture"]
    box = next(one for one in app.selectbox if one.key.startswith("ground_shows"))
    assert box.value == "heights"
    box.set_value("picture").run()
    assert map_of(app)["ground"]["picture"]


@pytest.fixture
def other(season_app):
    """Return a season's page on which another map's address was typed."""
    go(season_app, "plot")
    season_app.selectbox(key="web_map").set_value("other").run()
    season_app.text_input(key="web_map_address").set_value("https://a.example/{z}/{x}/{y}.png")
    return season_app.run()


def test_a_map_from_the_internet_is_asked_for_once_a_season_and_shown_only_when_agreed_to(other):
    assert "a.example" in other.info[-1].value
    assert "which area is looked at" in other.info[-1].value
    assert "ground-map" not in ids(other)
    tap(other, "web_map_agree")
    assert ids(other)[0] == "ground-map"
    assert layer(other, "ground-map")["data"] == "https://a.example/{z}/{x}/{y}.png"
    assert map_of(other)["ground"]["credit"] == "a.example"
    assert not [one for one in other.selectbox if one.key == "web_map"], "asked once"
    go(other, "today")
    assert ids(other)[0] == "ground-map"
    go(other, "plot")
    tap(other, "web_map_back")
    assert "ground-map" not in ids(other)
    (box,) = [one for one in other.expander if one.label == texts.GROUND]
    assert box.proto.expanded, "it is not folded under the hand"


def test_an_agreement_of_a_season_is_none_of_another_plot_s(other):
    tap(other, "web_map_agree")
    other.selectbox(key="season").set_value("Sample estate").run()
    assert "ground-map" not in ids(other)


def test_an_address_that_is_none_is_refused_and_cannot_be_agreed_to(app):
    go(app, "plot")
    app.selectbox(key="web_map").set_value("other").run()
    app.text_input(key="web_map_address").set_value("http://a.example/{z}").run()
    # addresses in sentences are no links: an invisible letter parts them
    assert "must begin with https://" in app.error[0].value.replace("\u2060", "")
    assert not [one for one in app.button if one.key == "web_map_agree"]
    app.selectbox(key="web_map").set_value("osm").run()
    assert web_maps.host(web_maps.OSM) in app.info[-1].value
    assert texts.WEB_MAP_SESSION in app.info[-1].value
    assert "ground-map" not in ids(app)
