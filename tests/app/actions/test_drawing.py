"""Rows by hand, gate and no-go areas: drawn, taken back, refused in a sentence."""

import json

import pytest

from tests.app.driving import go, layer, metric, press, row_box, upload


def test_rows_can_be_turned_and_set_apart(app):
    go(app, "plot")
    row_box(app, "row_bearing").set_value(158.0).run()
    row_box(app, "row_spacing").set_value(8.0).run()
    assert not app.exception
    assert metric(app, "Row bearing") == "158.0°"
    assert 1500 < len(layer(app, "plants")["data"]) < 2000
    go(app, "today")
    assert 1500 < len(layer(app, "plants")["data"]) < 2000


def test_a_gate_is_set_where_only_plants_were_brought(app):
    lonlat = "\n".join(f"{35 + x / 4e3:.6f},{30 + y / 4e3:.6f}" for x in range(6) for y in range(9))
    upload(app, plant=("plants.csv", f"lon,lat\n{lonlat}\n".encode(), "text/csv"))
    plants = metric(app, "Plants")
    app.selectbox(key="draw_kind").set_value("gate").run()
    app.text_input(key="draw_typed").set_value("35.0001,29.9999").run()
    press(app, "Add")
    assert not app.error
    assert metric(app, "Plants") == plants
    assert layer(app, "gate")["data"][0]["p"] == [35.0001, 29.9999]
    go(app, "today")
    assert layer(app, "gate")["data"][0]["p"] == pytest.approx([35.0001, 29.9999], abs=1e-6)


def hears_clicks(app):
    return json.loads(app.get("bidi_component")[0].proto.json)["draws"]


def test_the_gate_and_areas_are_drawn_and_taken_back(app):
    go(app, "plot")
    plants = len(layer(app, "plants")["data"])
    lon, lat = layer(app, "plants")["data"][plants // 2]["p"]
    assert not hears_clicks(app)
    app.selectbox(key="draw_kind").set_value("no_go").run()
    assert hears_clicks(app)
    corners = [(lon, lat), (lon + 3e-4, lat), (lon + 3e-4, lat + 3e-4), (lon, lat + 3e-4)]
    app.text_input(key="draw_typed").set_value(" ".join(f"{x},{y}" for x, y in corners)).run()
    press(app, "Add")
    assert len(layer(app, "corners")["data"]) == 4
    press(app, "Finish")
    assert not app.exception
    left = len(layer(app, "plants")["data"])
    assert left < plants - 20
    press(app, "Undo the last one")
    assert len(layer(app, "plants")["data"]) == plants


def test_an_area_that_crosses_itself_is_refused_in_a_sentence(app):
    go(app, "plot")
    app.selectbox(key="draw_kind").set_value("no_go").run()
    app.text_input(key="draw_typed").set_value("35,30 35.1,30.1 35.1,30 35,30.1").run()
    press(app, "Add")
    press(app, "Finish")
    assert "must not cross itself" in app.error[0].value
