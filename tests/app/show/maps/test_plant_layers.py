"""Plants on a map: what is seen of them is what is known of them."""

import base64
from io import BytesIO

import numpy as np
from PIL import Image

from app.show.maps import colours, plant_layers
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
