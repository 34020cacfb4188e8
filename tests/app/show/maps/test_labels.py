"""Numbers on a map: legs from far, stops from near; rows before their first plants."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import MultiPolygon, Point, Polygon, box

from app.show.maps import labels
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from tests.app.chosen import CORNER, a_plot

PLOT = a_plot(0.001)


@pytest.fixture(scope="module")
def route():
    return plan_from(PLOT, np.random.default_rng(1).random(len(PLOT.grid)), PlanSettings()).route


def of_kind(made, kind):
    return [one for one in made if one["k"] == kind]


def test_stops_are_numbered_in_order_where_they_are(route):
    own = of_kind(labels.stops(route), "stop")
    assert [one["t"] for one in own] == [str(k + 1) for k in range(len(route))]
    assert np.array([one["p"] for one in own]) == pytest.approx(route.stops_lonlat(), abs=1e-7)


def test_a_leg_is_what_is_inspected_without_leaving_an_aisle(route):
    legs = of_kind(labels.stops(route), "leg")
    grid = PLOT.grid
    aisle = grid.corridor[grid.row[route.plant]]
    changes = 1 + (np.diff(aisle) != 0).sum()
    assert [one["t"] for one in legs] == [str(k + 1) for k in range(changes)]
    lonlat = np.round(route.stops_lonlat(), 7).tolist()
    its_aisle = [aisle[lonlat.index(one["p"])] for one in legs]
    assert its_aisle == [aisle[0], *aisle[1:][np.diff(aisle) != 0]]


def test_legs_give_way_to_stops_at_the_zoom_where_neighbours_are_16_pixels_apart(route):
    legs, stops = (of_kind(labels.stops(route), kind) for kind in ("leg", "stop"))
    (zoom,) = {one["to"] for one in legs} | {one["from"] for one in stops}
    lat = np.deg2rad(route.stops_lonlat()[0, 1])
    metres_of_pixel = 40_075_016.686 * np.cos(lat) / (512 * 2**zoom)
    assert PLOT.grid.plant_spacing_m / metres_of_pixel == pytest.approx(16.0)


def test_no_stop_has_no_number():
    empty = plan_from(PLOT, np.full(len(PLOT.grid), 0.1), PlanSettings(Robot(hours=0.01))).route
    assert labels.stops(empty) == []


def test_every_row_has_its_number_before_its_first_plant():
    grid = PLOT.grid
    made = labels.rows(grid)
    line = grid.row_line[grid.row]
    assert sorted(int(one["t"]) for one in made) == (np.unique(line) + 1).tolist()
    for one in made:
        own = grid.xy_m[line == int(one["t"]) - 1]
        x, y = grid.frame.xy_m(np.array([one["p"]]))[0]
        assert x < own[:, 0].min()
        assert np.hypot(*(own - [x, y]).T).min() < 2 * grid.plant_spacing_m
        # a number is pushed outwards from the outline, on which it would not be read
        assert grid.frame.xy_m(np.array([one["away"]]))[0][0] < x
        assert not PLOT.field.boundary.buffer(-1e-7).contains(Point(one["p"]))


def test_the_numbers_of_short_rows_are_beyond_an_outline_that_runs_askew():
    lon, lat = CORNER
    wide, high = 0.0012, 0.0006
    corner = Polygon([(lon, lat), (lon + wide, lat), (lon + wide, lat + high)])
    plot = Plot.of(Field("askew", MultiPolygon([corner])), Planting(row_bearing_deg=90.0))
    grid, half_m = plot.grid, plot.grid.row_spacing_m / 2
    made = labels.rows(grid)
    assert len(made) > 5
    for one in made:
        x, y = grid.frame.xy_m(np.array([one["p"]]))[0]
        own = grid.xy_m[grid.row_line[grid.row] == one["row"] - 1]
        assert x < own[:, 0].min()
        assert not grid.drivable_m.intersects(box(x - 3, y - half_m, x - 0.01, y + half_m))


def test_rows_have_the_numbers_of_the_file_of_their_plants_on_the_map():
    grid = PLOT.grid
    called = np.arange(len(grid.line_number))[::-1] + 30
    named = replace(grid, line_called=np.stack([called, called], axis=1))
    told = [(one["p"], int(one["t"])) for one in labels.rows(named)]
    assert told == [(one["p"], called[int(one["t"]) - 1]) for one in labels.rows(grid)]


def test_the_gate_and_what_is_not_driven_through_are_named_where_they_are():
    lon, lat = CORNER
    pond = MultiPolygon([box(lon + 0.0004, lat + 0.0004, lon + 0.0006, lat + 0.0006)])
    plot = Plot.of(replace(PLOT.field, no_go=pond))
    gate, no_go = labels.places(plot)
    assert (gate["t"], no_go["t"]) == ("gate", "no-go")
    assert pond.contains(Point(no_go["p"]))
    at, away = plot.grid.frame.xy_m(np.array([gate["p"], gate["away"]]))
    assert at == pytest.approx(plot.aisles.gate_m, abs=0.05)
    rows_y = plot.grid.xy_m[:, 1]
    assert away[1] < at[1] < rows_y.mean() or away[1] > at[1] > rows_y.mean(), "not into the rows"


def test_blocks_are_named_where_there_are_several():
    assert labels.blocks(PLOT.grid) == []
    halves = (PLOT.grid.row_line >= PLOT.grid.row_line.max() / 2).astype(np.int32)
    made = labels.blocks(replace(PLOT.grid, block=halves))
    assert [one["t"] for one in made] == ["block 1", "block 2"]
    below, above = PLOT.grid.frame.xy_m(np.array([one["p"] for one in made]))[:, 1]
    assert below < above
