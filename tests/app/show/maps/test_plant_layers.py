"""Plants on a map: what is seen of them is what is known of them."""

import base64
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from app.show.maps import colours, plant_layers
from fieldmon.plot.grid import row_label
from fieldmon.plot.layout import rectangle


def test_each_pixel_of_a_picture_shows_the_most_important_plant_on_it(monkeypatch):
    monkeypatch.setattr(plant_layers, "_PICTURE_AT_MOST", 7)
    grid = rectangle(20, 30)
    shade = colours.by_state(np.random.default_rng(3).choice([-1, 0, 1], 600, p=[0.8, 0.1, 0.1]))
    layer = plant_layers._picture(grid, shade)
    packed = layer.image.value.split(",")[1]
    image = np.array(Image.open(BytesIO(base64.b64decode(packed))).convert("RGBA"))
    (west, south), _, (east, north), _ = layer.bounds
    across, down = ((grid.lonlat() - [west, north]) / [east - west, south - north]).T
    tall, wide = image.shape[:2]
    pixel = (down * tall).astype(int) * wide + (across * wide).astype(int)
    best = np.zeros(tall * wide, int)
    np.maximum.at(best, pixel, shade.rank + 1)
    table = np.vstack([[0, 0, 0, 0], shade.table])
    assert (image.reshape(-1, 4) == table[best]).all()
    assert len(np.unique(best)) > 2


GRID = rectangle(6, 8)


def layer_of(state, part=None):
    def said(which):
        return [f": {s}" for s in state[which].tolist()]

    return plant_layers.plants(GRID, colours.by_state(state), said, part)


def test_every_plant_is_a_point_that_says_where_it_stands():
    state = np.tile(np.array([-1, 0, 1], np.int8), 16)
    rows = layer_of(state).data
    label = row_label(GRID)
    assert [row["i"] for row in rows] == list(range(len(GRID)))
    assert np.array([row["p"] for row in rows]) == pytest.approx(GRID.lonlat(), abs=1e-7)
    wanted = zip(label.line, label.number, state.tolist(), strict=True)
    assert [row["t"] for row in rows] == [f"row {r}, plant {n}: {s}" for r, n, s in wanted]


def test_very_many_plants_are_one_picture_but_for_those_shown_close(monkeypatch):
    monkeypatch.setattr(plant_layers, "POINTS_AT_MOST", 10)
    state = np.zeros(len(GRID), np.int8)
    assert layer_of(state).type == "BitmapLayer"
    part = layer_of(state, np.array([3, 7]))
    assert (part.type, part.id) == ("ScatterplotLayer", "part")
    assert [row["i"] for row in part.data] == [3, 7]


def test_finds_have_two_rings_and_a_dot_where_they_are():
    state = np.zeros(len(GRID), np.int8)
    state[[5, 20]] = 1
    layers = plant_layers.finds(GRID, state)
    assert [layer.id for layer in layers] == ["finds0", "finds1", "found"]
    for layer in layers:
        here = np.array([row["p"] for row in layer.data])
        assert here == pytest.approx(GRID.lonlat()[[5, 20]], abs=1e-7)


def test_the_plant_whose_history_is_shown_has_a_ring_of_its_own():
    for layer in plant_layers.chosen(GRID, 11):
        assert layer.data[0]["p"] == pytest.approx(GRID.lonlat()[11], abs=1e-7)
