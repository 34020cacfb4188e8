"""A route on a map: driven in order, numbered where there is room."""

import numpy as np
import pytest

from app.show.maps import route_layers
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from tests.app.driving import SQUARE


@pytest.fixture(scope="module")
def plot():
    return Plot.of(Field("square", SQUARE, gate=(35.15, 30.36)))


def test_numbers_of_stops_do_not_cover_each_other_where_the_whole_route_is_in_view(plot):
    chance = np.random.default_rng(1).random(len(plot.grid))
    route = plan_from(plot, chance, PlanSettings()).route
    numbers = next(layer for layer in route_layers.route(route) if layer.id == "numbers")
    shown = [int(row["n"]) for row in numbers.data]
    assert 1 in shown
    assert 5 < len(shown) < len(route)
    here = np.array([row["p"] for row in numbers.data])
    span = np.ptp(route.stops_lonlat(), axis=0) * [np.cos(np.radians(here[0, 1])), 1.0]
    px = (here[:, None] - here) * [np.cos(np.radians(here[0, 1])), 1.0] / span.max() * 300
    beside = (np.abs(px) >= [29.9, 16.9]).any(axis=2)
    assert beside[~np.eye(len(here), dtype=bool)].all()


@pytest.fixture(scope="module")
def route(plot):
    return plan_from(plot, np.random.default_rng(1).random(len(plot.grid)), PlanSettings()).route


def test_the_line_is_the_one_that_is_driven_and_arrows_point_along_it(route):
    line, arrows, gate, *_ = route_layers.route(route, numbers=False)
    assert np.array(line.data[0]["path"]) == pytest.approx(route.line_lonlat(), abs=1e-7)
    assert gate.data[0]["p"] == pytest.approx((35.15, 30.36), abs=1e-6)
    frame = route.aisles.grid.frame
    step, before = (
        np.diff(route.line_m, axis=0),
        np.cumsum(np.hypot(*np.diff(route.line_m, axis=0).T)),
    )
    for k, arrow in enumerate(arrows.data):
        tip, *wings = frame.xy_m(np.array(arrow["p"]))
        heading = tip - np.mean(wings, axis=0)
        leg = np.searchsorted(before, (k + 0.5) / len(arrows.data) * before[-1])
        along = heading @ step[leg] / np.hypot(*heading) / np.hypot(*step[leg])
        assert along == pytest.approx(1.0, abs=0.05)


def test_no_stop_is_no_layer(plot):
    empty = plan_from(plot, np.full(len(plot.grid), 0.1), PlanSettings(Robot(hours=0.01))).route
    assert len(empty) == 0
    assert route_layers.route(empty) == route_layers.playback(empty, 10.0) == []


def test_the_trail_ends_where_the_robot_is_and_stops_made_are_marked(route):
    for second in (0.0, float(route.leave_s[3]), route.end_s):
        trail, stops, robot = route_layers.playback(route, second)
        assert trail.data[0]["path"][-1] == pytest.approx(robot.data[0]["p"])
        assert len(stops.data) == (route.leave_s <= second).sum()
    assert robot.data[0]["p"] == pytest.approx(route.line_lonlat()[-1].tolist(), abs=1e-6)
