"""The map of the field: what is known of plants, and of very many of them."""

import json

from tests.app.driving import go, layer, map_of, square, texts_of, upload, zipped


def test_the_map_tells_three_states_apart_by_shape_and_the_history_of_a_plant(app):
    go(app, "map")
    app.radio(key="shade").set_value("state").run()
    colours = {tuple(p["c"]) for p in layer(app, "plants")["data"]}
    assert {c[3] for c in colours} == {30, 255}
    finds = len(layer(app, "finds0")["data"])
    assert finds == sum(p["c"][:3] == [213, 30, 30] for p in layer(app, "plants")["data"])
    assert finds > 20
    app.number_input(key="history row").set_value(20).run()
    assert "Chance of infestation now" in texts_of(app)
    app.number_input(key="history row").set_value(99_999).run()
    assert not app.exception
    assert "must be one of 1 to" in app.error[0].value


def test_a_plot_of_many_plants_travels_as_one_picture(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(size=0.006))))
    go(app, "today")
    assert not app.exception
    assert layer(app, "plants-picture")["@@type"] == "BitmapLayer"
    assert layer(app, "plants") is None, "another plot's points must not be taken for this picture"
    assert len(json.dumps(map_of(app))) < 1_000_000
    go(app, "map")
    first, last = app.slider(key="rows_close").value
    assert 0 < len(layer(app, "part")["data"]) < 20_000
    assert all(
        first <= int(p["t"].split(",")[0][4:]) <= last for p in layer(app, "part")["data"][::50]
    )
