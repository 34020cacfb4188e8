"""A row bent by dragging: others follow it, are shown over the plot, and used or dropped."""

import numpy as np
import pytest
import streamlit as st

from app.actions import bending, editing_plot
from app.state import plot_files
from tests.app.chosen import a_plot, chosen
from tests.app.driving import go, layer, map_of, metric, plants, press


def bent(points, east=0.0, north=0.00008):
    """Return a row whose middle handle is dragged aside."""
    moved = [list(point) for point in points]
    middle = len(moved) // 2
    moved[middle] = [moved[middle][0] + east, moved[middle][1] + north]
    return tuple(tuple(point) for point in moved)


@pytest.fixture
def bending_on(session):
    """Return choices of a plot whose rows are being bent."""
    session["draw_kind"] = "row"
    return chosen(a_plot(0.001, row_bearing_deg=90.0))


def test_the_row_to_be_bent_is_on_the_map_with_handles_along_it(bending_on):
    made, _ = editing_plot.content(bending_on, bending_on.records)
    assert made.draw.kind == "bent"
    places = np.array(made.draw.points)
    assert len(places) == 5
    assert np.ptp(places[:, 1]) < 1e-6
    assert np.ptp(places[:, 0]) > 0.0007
    assert "row-lines" in [one.id for one in made.layers]


def test_rows_that_follow_a_bent_one_are_shown_before_they_are_used(bending_on):
    made, answers = editing_plot.content(bending_on, bending_on.records)
    answers.drawn(made.draw.name, bent(made.draw.points))
    assert plot_files.drawn(bending_on.plot_key) == ()
    again, _ = editing_plot.content(bending_on, bending_on.records)
    (tried,) = [one for one in again.layers if one.id == "rows-tried"]
    assert len(tried.data) > 10
    assert max(len(row["path"]) for row in tried.data) > 2
    assert again.draw.name == made.draw.name, "the handles stay where they were dragged to"


def test_bent_rows_are_laid_once_they_are_used_and_can_be_taken_back(app):
    go(app, "plot")
    before = plants(app, "plants").lonlat.tolist()
    app.selectbox(key="draw_kind").set_value("row").run()
    asked = map_of(app)["draw"]
    assert asked["kind"] == "bent"
    app.session_state["row tried"] = app.session_state["laying"], bent(asked["points"])
    app.run()
    assert not app.exception
    assert len(layer(app, "rows-tried")["data"]) > 10
    assert plants(app, "plants").lonlat.tolist() == before
    press(app, "Use these rows")
    assert not app.error
    assert plants(app, "plants").lonlat.tolist() != before
    assert int(metric(app, "Rows")) > 10
    press(app, "Undo the last one")
    assert plants(app, "plants").lonlat.tolist() == before


def test_what_was_tried_is_dropped_and_the_handles_begin_anew(bending_on):
    made, answers = editing_plot.content(bending_on, bending_on.records)
    answers.drawn(made.draw.name, bent(made.draw.points))
    bending.drop(bending_on)
    again, _ = editing_plot.content(bending_on, bending_on.records)
    assert "rows-tried" not in [one.id for one in again.layers]
    assert again.draw.name != made.draw.name


def test_rows_without_room_are_refused_in_a_sentence(bending_on):
    made, answers = editing_plot.content(bending_on, bending_on.records)
    start = made.draw.points[0]
    answers.drawn(made.draw.name, (start, start))
    editing_plot.content(bending_on, bending_on.records)
    assert st.session_state["notice"][0] == "error"
