"""Lanes of measured rows end within the boundary that somebody drew, or nobody turns there."""

from itertools import product

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.plot.field import Field
from fieldmon.plot.layout import grid_from_plants
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.travel import Aisles

FRAME = Frame(35.15, 30.36)
ROWS, PLANTS = 4, 15


def measured(bend_m, area):
    """Return four rows of fifteen plants 2 m apart, which may bend, within an area."""
    x, y = np.meshgrid(np.arange(0, 2 * PLANTS, 2.0), np.arange(0, 4 * ROWS, 4.0))
    y = y + bend_m * (x / x.max()) ** 2
    lonlat = FRAME.lonlat(np.stack([x.ravel(), y.ravel()], axis=1))
    boundary = MultiPolygon([FRAME.geometry_lonlat(area)])
    grid = grid_from_plants(lonlat, Planting(row_bearing_deg=90.0), Field("plot", boundary))
    return grid, grid.frame.geometry_m(boundary)


def farthest_m(grid, area_m, plants=range(0, ROWS * PLANTS, 7)):
    """Return how far ways from plant to plant leave an area."""
    aisles = Aisles.of(grid)
    pairs = [(i, j) for i, j in product(plants, plants) if i < j]
    corners = np.concatenate([aisles.path(i, j) for i, j in pairs])
    return shapely.distance(area_m, shapely.points(corners)).max()


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
@pytest.mark.parametrize("room_m", [-1.0, 0.4, 1.2, 1.9])
def test_rows_are_driven_from_their_other_end_where_the_boundary_is_near(bend_m, room_m):
    area = shapely.box(-6, -6, 28 + room_m, 26)
    grid, area_m = measured(bend_m, area)
    assert grid.n_lines == ROWS
    assert (grid.aisles_m is not None) == (bend_m > 0)
    on_plot = np.flatnonzero(shapely.intersects_xy(area_m, *grid.stop_m.T))
    assert len(on_plot) == ROWS * (PLANTS - (room_m < 0))
    assert farthest_m(grid, area_m, on_plot[::6]) < 0.02


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
def test_lanes_that_end_on_the_plot_are_as_they_were(bend_m):
    roomy, _ = measured(bend_m, shapely.box(-6, -6, 36, 26))
    open_, _ = measured(bend_m, shapely.box(-99, -99, 99, 99))
    apart_m = roomy.lane_x_m.mean(axis=1) - open_.lane_x_m.mean(axis=1)
    assert np.ptp(roomy.lane_x_m, axis=1) == pytest.approx(np.ptp(open_.lane_x_m, axis=1), abs=1e-3)
    assert np.ptp(apart_m) < 1e-3


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
def test_rows_without_an_end_on_the_plot_are_turned_outside_and_only_they(bend_m):
    # the first row only has no end within
    box = shapely.box(-6, -6, 36, 26)
    area = shapely.difference(
        box, shapely.union(shapely.box(-9, -9, 0.2, 2.6), shapely.box(27.7, -9, 40, 2.6 + bend_m))
    )
    grid, area_m = measured(bend_m, area)
    assert grid.beyond_m is not None
    assert not shapely.intersects(shapely.buffer(grid.drivable_m, -0.01), grid.beyond_m)
    assert farthest_m(grid, area_m, range(PLANTS, ROWS * PLANTS, 7)) < 0.02
    assert 0.5 < farthest_m(grid, area_m) < 4.0


def test_a_day_without_a_gate_begins_at_a_lane_end_on_the_plot():
    grid, area_m = measured(0.0, shapely.box(-0.4, -6, 36, 26))
    assert shapely.distance(area_m, shapely.points(Aisles.of(grid).gate_m)) < 0.01
