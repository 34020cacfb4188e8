"""The plan of a plot: rows and aisles where they are, a hatch on what is not driven through."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, box

from app.show.maps import plan_layers
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot, plot_around
from fieldmon.plot.projection import Frame
from tests.app.chosen import CORNER, a_plot

LON, LAT = CORNER
POND = MultiPolygon([box(LON + 0.0002, LAT + 0.0002, LON + 0.0004, LAT + 0.0004)])


@pytest.fixture(scope="module")
def plot():
    square = MultiPolygon([box(LON, LAT, LON + 0.0006, LAT + 0.0006)])
    return Plot.of(Field("with a pond", square, no_go=POND, gate=CORNER))


def test_every_plant_stands_on_its_row_and_every_lane_is_an_aisle(plot):
    grid = plot.grid
    rows = shapely.MultiLineString([*plan_layers.rows_m(grid)])
    assert len(rows.geoms) == grid.n_rows
    assert shapely.distance(rows, shapely.points(grid.xy_m)).max() < 0.01
    aisles = shapely.MultiLineString([*plan_layers.aisles_m(grid)])
    middles = np.column_stack([grid.lane_x_m.mean(axis=1), grid.lane_y_m])
    assert shapely.distance(aisles, shapely.points(middles)).max() < 0.02
    assert len(aisles.geoms) <= grid.n_rows


def test_a_hatch_covers_what_is_not_driven_through_and_nothing_else(plot):
    lines = plan_layers.hatch(plot.grid, plot.field)
    assert len(lines) > 8
    inside = shapely.buffer(plot.field.no_go, 1e-9)
    assert all(inside.covers(line) for line in lines)
    hull = shapely.MultiLineString(lines).convex_hull
    assert hull.area > 0.8 * plot.field.no_go.area


def test_layers_are_those_of_the_plan_with_the_outline_above(plot):
    assert [one.id for one in plan_layers.plan(plot.grid, plot.field)] == [
        *plan_layers.IDS, "boundary"
    ]  # fmt: skip
    bare = a_plot()
    ids = [one.id for one in plan_layers.plan(bare.grid, bare.field)]
    assert ids == ["headland", "rows-ground", "aisles", "boundary"]
    light, dark = (plan_layers.plan(bare.grid, bare.field, dark=d)[1] for d in (False, True))
    assert sum(light.get_color) > sum(dark.get_color)


def test_rows_that_bend_are_drawn_bent_and_aisles_as_far_as_their_lanes():
    k, j = np.divmod(np.arange(6 * 40), 40)
    at, turn = 60.0 + 2.5 * k, (j - 20) * 1.4 / 60
    xy_m = np.stack([at * np.sin(turn), at * np.cos(turn)], axis=1)
    # where plants are missing a row bends on
    there = (k != 2) | (j < 9) | (j > 30)
    bent = plot_around("bent", Frame(LON, LAT).lonlat(xy_m[there])).grid
    rows = [*plan_layers.rows_m(bent)]
    assert len(rows) == 6
    assert max(len(row) for row in rows) > 3
    assert len(np.concatenate(rows)) < len(bent)
    lines = shapely.MultiLineString(rows)
    everyone = bent.frame.xy_m(Frame(LON, LAT).lonlat(xy_m))
    assert shapely.distance(lines, shapely.points(everyone)).max() <= 0.15
    aisles = shapely.MultiLineString([*plan_layers.aisles_m(bent)])
    assert len(aisles.geoms) == 6
    assert shapely.distance(aisles, shapely.points(bent.stop_m)).max() < 0.01
    assert shapely.buffer(bent.drivable_m, 0.05).covers(aisles)
