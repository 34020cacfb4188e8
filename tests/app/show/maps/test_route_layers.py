"""A route on a map: driven in order, arrows along the way, played as it is timed."""

from dataclasses import replace
from datetime import datetime

import numpy as np
import pytest

from app.show.maps import route_layers
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from tests.app.driving import SQUARE

SIX = datetime(2026, 11, 16, 6, 30)


@pytest.fixture(scope="module")
def plot():
    return Plot.of(Field("square", SQUARE, gate=(35.15, 30.36)))


@pytest.fixture(scope="module")
def route(plot):
    return plan_from(plot, np.random.default_rng(1).random(len(plot.grid)), PlanSettings()).route


def test_the_line_is_the_one_that_is_driven_and_arrows_point_along_it(route):
    layers = {layer.id: layer for layer in route_layers.route(route)}
    assert list(layers) == ["casing", "route", "arrows"]
    for name in ("casing", "route"):
        drawn = np.array(layers[name].data[0]["path"])
        assert drawn == pytest.approx(route.line_lonlat(), abs=1e-7)
    frame, arrows = route.aisles.grid.frame, layers["arrows"].data
    step = np.diff(route.line_m, axis=0)
    before = np.cumsum(np.hypot(*step.T))
    assert len(arrows) > 20
    for k, arrow in enumerate(arrows):
        tip, *wings = frame.xy_m(np.array(arrow["a"]))
        heading = tip - np.mean(wings, axis=0)
        leg = np.searchsorted(before, (k + 0.5) / len(arrows) * before[-1])
        along = heading @ step[leg] / np.hypot(*heading) / np.hypot(*step[leg])
        assert along == pytest.approx(1.0, abs=0.05)


def test_the_gate_is_where_the_plot_has_it_and_is_no_part_of_the_route(plot):
    gate = route_layers.gate(plot.aisles)
    assert gate.data[0]["p"] == pytest.approx((35.15, 30.36), abs=1e-6)
    # a gate 3 m wide would cover a plot of one plant
    assert gate.radius_max_pixels <= 16


def test_only_the_gate_says_what_it_is_so_that_no_arrow_hides_a_plant(route, plot):
    layers = [*route_layers.route(route), route_layers.gate(plot.aisles)]
    assert {layer.id for layer in layers if "t" in layer.data[0]} == {"gate"}


@pytest.mark.parametrize("dark", [False, True])
def test_the_line_stands_out_from_its_casing(route, dark):
    layers = route_layers.route(route, dark=dark)[:2]
    casing, line = (np.array(layer.get_color[:3]) for layer in layers)
    assert np.abs(casing - line).max() > 90


def test_no_stop_is_no_layer_and_nothing_to_play(plot):
    empty = plan_from(plot, np.full(len(plot.grid), 0.1), PlanSettings(Robot(hours=0.01))).route
    assert len(empty) == 0
    assert route_layers.route(empty) == []
    assert route_layers.playback(empty, SIX) is None


def test_a_stop_where_the_day_begins_has_no_arrow(route):
    still = replace(route, line_m=np.repeat(route.line_m[:1], len(route.line_m), axis=0))
    shown = {layer.id: layer for layer in route_layers.route(still)}
    assert shown["arrows"].data == []


def test_what_is_played_is_where_who_drives_is_at_which_second(route):
    play = route_layers.playback(route, SIX)
    line, at_s = np.array(play["line"]), np.array(play["at_s"])
    assert len(line) == len(at_s) == len(route.line_s) + len(route)
    assert (np.diff(at_s) >= 0).all()
    for second in np.linspace(0.0, route.end_s, 97):
        here = [np.interp(second, at_s, line[:, axis]) for axis in (0, 1)]
        stop = np.flatnonzero((route.arrive_s <= second) & (second <= route.leave_s))
        if stop.size:
            # who inspects stands still
            there = route.line_lonlat()[route.line_stop[stop[0]]]
            assert here == pytest.approx(there, abs=2e-7)
    assert np.array(play["stops"]) == pytest.approx(route.stops_lonlat(), abs=1e-7)
    assert np.array(play["leave_s"]) == pytest.approx(route.leave_s, abs=0.05)
    assert play["starts_s"] == 6.5 * 3600


def test_while_played_each_stop_is_reached_and_left_when_it_is(route):
    play = route_layers.playback(route, SIX)
    at_s, k = np.array(play["at_s"]), np.arange(len(route))
    reached = route.line_stop + k  # one place more for each stop before
    assert at_s[reached] == pytest.approx(route.arrive_s, abs=0.05)
    assert at_s[reached + 1] == pytest.approx(route.leave_s, abs=0.05)
