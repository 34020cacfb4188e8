"""Plants and hot spots: what is known of plants, and of very many of them."""

import json
import re

import numpy as np

from app.show.maps import colours
from tests.app.driving import go, layer, map_of, plants, square, texts_of, upload, zipped


def test_the_map_tells_three_states_apart_by_shape_and_the_history_of_a_plant(app):
    go(app, "field")
    shown = plants(app, "plants-state")
    found = shown.of_colour(colours.FOUND)
    assert set(shown.colour[:, 3].tolist()) == {30, 255}
    assert len(found) > 20
    rings = np.array([row["p"] for row in layer(app, "finds0")["data"]])
    assert np.abs(rings - shown.lonlat[found]).max() < 2e-7
    app.number_input(key="history row").set_value(20).run()
    assert "Chance of infestation now" in texts_of(app)
    app.number_input(key="history row").set_value(99_999).run()
    assert not app.exception
    assert "must be one of 1–" in app.error[0].value


def test_hot_spots_are_told_in_words_under_their_numbers_on_the_map(app):
    go(app, "field")
    numbers = [row["number"]["t"] for row in layer(app, "hot")["data"]]
    said = re.findall(r"^(\d+)\. ", texts_of(app), re.MULTILINE)
    assert numbers == said
    records = r"Chances and hot spots begin with [\d,]+ records of \w+ \d+ \w+.* to \w+ \d+ \w+"
    assert re.search(records, texts_of(app))
    assert said


def test_a_plot_of_many_plants_is_sent_as_a_few_bytes_a_plant(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(size=0.006))))
    go(app, "field")
    assert not app.exception
    n = len(plants(app))
    assert n > 20_000
    sent = {name: len(layer(app, "plants-chance")[name]) for name in ("places", "ranks", "values")}
    assert all(length < 80 for length in sent.values()), "addresses, not content"
    assert len(json.dumps({**map_of(app), "labels": []})) < 300_000
