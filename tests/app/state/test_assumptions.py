"""What is assumed unless a person says otherwise."""

from dataclasses import replace

import pytest

from app.state import assumptions, widget_memory
from fieldmon.infestation.prior.prior_settings import PriorSettings
from tests.app.chosen import a_plot, chosen


@pytest.mark.usefixtures("session")
def test_an_empty_box_is_our_guess_and_a_number_is_what_was_said():
    assert assumptions.prior() == PriorSettings()
    widget_memory.first(assumptions.BACKGROUND, 3.0)
    assert assumptions.prior().background_chance == pytest.approx(0.03)


def test_without_a_season_nothing_is_said_of_nights():
    settings = {one.setting for one in assumptions.of(chosen(a_plot()))}
    assert "background_chance" in settings
    assert "rate_per_day" not in settings
    # what is not said in a box is assumed too
    assert "edge_chance" in settings


def test_a_gate_is_assumed_where_nobody_said_it():
    here = chosen(a_plot())
    plot = here.plot
    for gate in (None, tuple(plot.field.boundary.centroid.coords[0])):
        there = replace(plot, field=replace(plot.field, gate=gate))
        settings = {one.setting for one in assumptions.of(replace(here, plot=there))}
        assert ("gate" in settings) == (gate is None)
