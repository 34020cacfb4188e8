"""A route on a map: driven in order, numbered where there is room."""

import numpy as np
import pytest

from app.show.maps import route_layers
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
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
