"""Plants selected on the map are inspected too, or not, and it is said what cannot be."""

from datetime import timedelta
from types import SimpleNamespace

import numpy as np
import pytest
import streamlit as st

import fieldmon as fm
from app.actions import picking
from app.state import wishes
from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.planning.wishes import Wishes
from tests.app.chosen import a_plot, chosen, in_season
from tests.app.driving import go, map_of, opened, press, row_box, texts_of, word_of
from tests.monitoring.seasons import BEGINS, a_season
from tests.paths import ROOT


def select(app, plants, plot=None):
    """Select plants as the map's lasso does, which has no browser here; of the sample plot."""
    sample = ROOT / "sample_data" / "paran_estate.zip"
    plot = fm.read_plot(sample, feature="Gate") if plot is None else plot
    app.session_state["plants picked"] = (chosen(plot).laid, tuple(plants))
    return app.run()


def stops(app):
    return app.dataframe[0].value


def test_selected_plants_are_ringed_and_inspected_too_then_dropped(app):
    before = stops(app)
    rows = {(row, plant) for row, plant in zip(before["row"], before["plant"], strict=True)}
    assert (40, 1) not in rows
    grid_row_40 = 39 * 85
    select(app, [grid_row_40, grid_row_40 + 1])
    assert "2 plants selected" in texts_of(app)
    assert any(layer["id"] == "picked" for layer in map_of(app)["layers"])
    press(app, "Inspect these too")
    assert not app.exception
    after = stops(app)
    assert {(40, 1), (40, 2)} <= set(zip(after["row"], after["plant"], strict=True))
    assert "2 plants to be inspected besides" in texts_of(app)
    again = opened(files=word_of(app)).run()
    assert stops(again).equals(after), "a reload finds what is wanted"
    row_box(go(app, "plot"), "row_spacing").set_value(7.0).run()
    assert "inspected besides" not in texts_of(go(app, "today")), "other plants have their numbers"
    row_box(go(app, "plot"), "row_spacing").set_value(4.0).run()
    go(app, "today")
    press(app, "As planned before")
    assert stops(app).equals(before)


def test_plants_left_out_are_not_on_the_route(app):
    first = stops(app).iloc[0]
    plant = (int(first["row"]) - 1) * 85 + int(first["plant"]) - 1
    select(app, [plant])
    press(app, "Not these")
    left = set(zip(stops(app)["row"], stops(app)["plant"], strict=True))
    assert (first["row"], first["plant"]) not in left
    assert "1 plant left out" in texts_of(app)


@pytest.mark.usefixtures("session")
def test_a_plant_that_is_not_there_is_not_selected():
    choices = chosen(a_plot(0.001))
    picking.take(choices, (0, len(choices.plot.grid)))
    assert wishes.picked(choices.laid) == (0,)
    (ring,) = picking.layers(choices)
    assert ring.data == [{"p": np.round(choices.plot.grid.lonlat(np.array([0])), 7)[0].tolist()}]
    picking.take(choices, ())
    assert picking.layers(choices) == []
    assert st.session_state["plants picked"] == (choices.laid, ())


@pytest.mark.usefixtures("session")
def test_a_plant_wanted_that_is_gone_is_said_to_be_gone(tmp_path, monkeypatch):
    season = a_season(tmp_path / "s.gpkg")
    gone = Inspections.of([3], [SKIPPED], np.datetime64(BEGINS), notes=["gone"])
    season.record(gone, "test")
    choices, said = in_season(season, BEGINS + timedelta(days=1)), []
    monkeypatch.setattr(wishes, "were_told", lambda *_: True)
    monkeypatch.setattr(wishes, "of", lambda *_: Wishes((3, 5)))
    monkeypatch.setattr(picking.st, "warning", said.append)
    picking.show(choices, SimpleNamespace(route=SimpleNamespace(plant=np.array([7]))))
    assert said == [
        "1 of those is not on the route: that plant is gone.",
        "1 of those is not on the route: the hours, or the strategy, do not allow it.",
    ]
