"""Layers of the ground: their content beside their JSON, addresses as they were given."""

import json

import numpy as np

from app.show.maps import deck, ground_layers
from app.state.map_store import STORE
from fieldmon.io.rasters.read import Backdrop
from fieldmon.io.rasters.tiles import read_tiles
from tests.io.rasters.tile_maps import about, mbtiles

CORNERS = np.array([[35.0, 30.0], [35.0, 30.1], [35.1, 30.1], [35.1, 30.0]])


def sent(layer):
    where = deck.published(layer)
    return where, json.loads(STORE.get(where["url"])[1])


def test_a_picture_is_fetched_from_this_server_and_lies_at_its_corners():
    where, made = sent(ground_layers.picture(Backdrop(b"jpeg", "image/jpeg", CORNERS)))
    assert STORE.get(where["image"])[1] == b"jpeg"
    assert made["bounds"] == CORNERS.tolist()
    assert "jpeg" not in json.dumps(made)


def test_a_relief_is_darker_by_night_and_a_picture_is_not():
    def tint(**how):
        return sent(
            ground_layers.picture(Backdrop(b"j", "image/jpeg", CORNERS), **how)
        )[1]["tintColor"]  # fmt: skip

    assert tint(is_relief=True, dark=True) < tint(is_relief=True) == tint(dark=True)


def test_a_map_in_tiles_says_its_zooms_and_where_it_ends(tmp_path):
    own = read_tiles(mbtiles(tmp_path / "a.mbtiles", about(35.15, 30.36, [14, 15])))
    _, made = sent(ground_layers.tiles("/map_tiles/x/{z}/{x}/{y}", own))
    assert made["data"] == "/map_tiles/x/{z}/{x}/{y}"
    assert (made["minZoom"], made["maxZoom"], made["tileSize"]) == (14, 15, 256)
    assert made["extent"] == list(own.bounds)
    _, web = sent(ground_layers.web_map("https://a.example/{z}/{x}/{y}", 19))
    assert (web["id"], web["maxZoom"]) == ("ground-map", 19)
    assert {web["id"], made["id"]} < set(ground_layers.IDS)
