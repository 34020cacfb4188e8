"""Rows by hand, gate and no-go areas: drawn, taken back, refused in a sentence."""

import numpy as np
import pytest
import streamlit as st

from app.actions import editing_plot
from app.state import plot_files
from tests.app.chosen import a_plot, chosen
from tests.app.driving import go, layer, map_of, metric, plants, press, row_box, upload


def test_rows_can_be_turned_and_set_apart(app):
    go(app, "plot")
    row_box(app, "row_bearing").set_value(158.0).run()
    row_box(app, "row_spacing").set_value(8.0).run()
    assert not app.exception
    assert metric(app, "Row direction") == "158.0°"
    laid = len(plants(app, "plants"))
    assert 1500 < laid < 2000
    go(app, "today")
    assert len(plants(app)) == laid


def test_a_gate_is_set_where_only_plants_were_brought(app):
    lonlat = "\n".join(f"{35 + x / 4e3:.6f},{30 + y / 4e3:.6f}" for x in range(6) for y in range(9))
    upload(app, plant=("plants.csv", f"lon,lat\n{lonlat}\n".encode(), "text/csv"))
    before = metric(app, "Plants")
    app.selectbox(key="draw_kind").set_value("gate").run()
    app.text_input(key="draw_typed").set_value("35.0001,29.9999").run()
    press(app, "Add")
    assert not app.error
    assert metric(app, "Plants") == before
    on_plot = layer(app, "gate")
    assert on_plot["data"][0]["p"] == pytest.approx([35.0001, 29.9999], abs=1e-6)
    go(app, "today")
    assert layer(app, "gate") == on_plot


def test_areas_are_drawn_refused_in_a_sentence_and_taken_back(app):
    go(app, "plot")
    before = plants(app, "plants")
    lon, lat = before.lonlat[len(before) // 2]
    assert map_of(app)["draw"] is None
    app.selectbox(key="draw_kind").set_value("no_go").run()
    asked = map_of(app)["draw"]
    assert (asked["id"], asked["kind"]) == ("no_go", "area")
    assert "Click the corners" in asked["hint"]
    # it snaps to the corners of the outline
    outline = [tuple(place) for row in layer(app, "boundary")["data"] for place in row["path"]]
    snaps = np.array(asked["snap"])
    assert len(snaps) > 3
    assert set(map(tuple, np.round(snaps, 7))) <= set(outline)
    corners = [(lon, lat), (lon + 3e-4, lat), (lon + 3e-4, lat + 3e-4), (lon, lat + 3e-4)]
    app.text_input(key="draw_typed").set_value(" ".join(f"{x},{y}" for x, y in corners)).run()
    press(app, "Add")
    assert len(layer(app, "corners")["data"]) == 4
    press(app, "Finish")
    assert not app.exception
    assert len(plants(app, "plants")) < len(before) - 20
    press(app, "Undo the last one")
    assert plants(app, "plants").lonlat.tolist() == before.lonlat.tolist()
    app.text_input(key="draw_typed").set_value("35,30 35.1,30.1 35.1,30 35,30.1").run()
    press(app, "Add")
    press(app, "Finish")
    assert "must not cross itself" in app.error[0].value


@pytest.fixture
def drawn_on(session):
    """Return choices of a plot on which something is drawn, and what keeps what was drawn."""
    choices = chosen(a_plot(0.001))

    def draw(kind, points):
        session["draw_kind"] = kind
        _, answers = editing_plot.content(choices, choices.records)
        answers.drawn(kind, points)
        return plot_files.drawn(choices.plot_key)

    return draw


AREA = ((35.1502, 30.3602), (35.1504, 30.3602), (35.1503, 30.3604))


@pytest.mark.usefixtures("session")
def test_each_layer_has_a_name_of_its_own():
    # of two of one name, the browser draws one and complains of the other
    choices = chosen(a_plot(0.001))
    made, _ = editing_plot.content(choices, choices.records)
    ids = [one.id for one in made.layers]
    assert sorted(ids) == sorted(set(ids))


def test_what_is_finished_on_the_map_is_kept_at_once(drawn_on):
    (area,) = drawn_on("no_go", AREA)
    assert (area.kind, area.lonlat) == ("no_go", AREA)
    _, gate = drawn_on("gate", AREA[:1])
    assert (gate.kind, gate.lonlat) == ("gate", AREA[:1])
    assert [edit.kind for edit in drawn_on("path", AREA[:2])] == ["no_go", "gate", "path"]


def test_an_area_over_the_whole_plot_is_refused_in_a_sentence_and_nothing_is_kept(drawn_on):
    whole = ((35.1, 30.3), (35.2, 30.3), (35.2, 30.4), (35.1, 30.4))
    assert drawn_on("no_go", whole) == ()
    kind, said = st.session_state["notice"]
    assert kind == "error"
    assert "must lie outside its no-go areas" in said


def test_what_another_tool_drew_is_not_taken_for_this_one(session):
    session["draw_kind"] = "gate"
    choices = chosen(a_plot(0.001))
    _, answers = editing_plot.content(choices, choices.records)
    answers.drawn("no_go", AREA)
    assert plot_files.drawn(choices.plot_key) == ()


def test_a_block_is_cut_by_a_line_and_planted_by_itself(app):
    go(app, "plot")
    lonlat = plants(app, "plants").lonlat
    (west, south), (east, north) = lonlat.min(axis=0), lonlat.max(axis=0)
    app.selectbox(key="draw_kind").set_value("cut").run()
    assert map_of(app)["draw"]["kind"] == "line"
    middle = (west + east) / 2
    line = f"{middle},{south - 0.001} {middle + 1e-4},{north + 0.001}"
    app.text_input(key="draw_typed").set_value(line).run()
    press(app, "Add")
    press(app, "Finish")
    assert not app.error
    assert len(layer(app, "blocks")["data"]) == 2
    boxes = [box for box in app.number_input if box.key.startswith("block_row_spacing")]
    assert len(boxes) == 2
    before = len(plants(app, "plants"))
    boxes[0].set_value(8.0).run()
    assert not app.exception
    assert len(plants(app, "plants")) < before - 20
    press(app, "Undo the last one")
    assert plants(app, "plants").lonlat.tolist() == lonlat.tolist()


def test_a_cut_that_parts_nothing_is_refused_in_a_sentence(drawn_on):
    assert drawn_on("cut", AREA[:2]) == ()
    kind, said = st.session_state["notice"]
    assert kind == "error"
    assert "this line parts nothing" in said
