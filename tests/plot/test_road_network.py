"""The network of ways between row ends: complete, clear of rows, and on the plot."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely import MultiPolygon, box

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.obstacles import row_lines
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.road_network import find_roads
from tests.crooked import crooked_fields, crooked_grids, plantings

FRAME = Frame(35.15, 30.36)
EASTWARD = Planting(row_bearing_deg=90.0, row_spacing_m=4.0, plant_spacing_m=2.0)


def laid(*areas):
    """Return plants in rows running east; metres about a fixed place."""
    field = Field("test", FRAME.geometry_lonlat(MultiPolygon(areas)))
    return lay(field, EASTWARD)


def in_grid(grid, geometry):
    """Return a geometry given in the metres of `laid` in those of the grid."""
    return grid.frame.geometry_m(FRAME.geometry_lonlat(geometry))


def gate_at(grid, x, y):
    return tuple(grid.frame.xy_m(FRAME.lonlat([[x, y]]))[0].tolist())


def lines(net):
    """Return all ways as lines."""
    start = np.repeat(np.arange(len(net.xy_m)), np.diff(net.start))
    return shapely.linestrings(np.stack([net.xy_m[start], net.xy_m[net.to]], axis=1))


def crossed(grid, steps):
    """Tell which straight lines touch a row."""
    return shapely.STRtree(row_lines(grid)).query(steps, predicate="intersects")[0]


def outside_m(grid, steps, edge_m=0.01):
    """Return the metres of each line farther than an edge outside the drivable area."""
    return shapely.length(shapely.difference(steps, shapely.buffer(grid.drivable_m, edge_m)))


@given(crooked_grids())
def test_ways_lead_to_every_row_and_across_none(grid):
    net = find_roads(grid)
    assert net.end.min() >= 0
    assert len(crossed(grid, lines(net))) == 0
    here = net.xy_m[net.end]
    assert here[:, :, 0] == pytest.approx(grid.lane_x_m, abs=1e-6)
    assert here[:, :, 1] == pytest.approx(np.stack([grid.lane_y_m] * 2, axis=1), abs=1e-6)


@given(crooked_grids())
def test_ways_stay_on_the_plot_unless_parts_must_be_joined(grid):
    assume(len(shapely.get_parts(grid.drivable_m)) == 1)
    assert outside_m(grid, lines(find_roads(grid))).max() < 0.02


@given(field=crooked_fields(max_radius_m=50), planting=plantings())
def test_the_plot_is_left_only_for_what_cannot_be_reached_on_it(field, planting):
    try:
        plot = Plot.of(field, planting)
    except PlotError:
        assume(False)
    net = plot.aisles.roads
    start = np.repeat(np.arange(len(net.xy_m)), np.diff(net.start))
    # where parts are joined, a sharp corner is gone round on its brink: a centimetre from both
    # sides of it, and so at most five from its tip
    leaves = outside_m(plot.grid, lines(net), 0.05) > 0.02
    stays = np.stack([start, net.to])[:, ~leaves]
    on_it = coo_array((np.ones(stays.shape[1]), stays), shape=(len(net.xy_m),) * 2)
    part = connected_components(on_it, directed=False)[1]
    assert (part[start[leaves]] != part[net.to[leaves]]).all()
    # a corner off the plot is on one way only, which does not lead back to where it came from
    stops = np.isin(part, part[np.append(net.end.ravel(), net.gate)])
    for corner in np.setdiff1d(part, part[stops]):
        there = part[net.to[part[start] == corner]]
        there = there[there != corner]
        assert len(there) == len(set(there.tolist())) <= 2


@given(crooked_grids(max_radius_m=50))
def test_every_way_can_be_driven_both_ways_and_has_the_length_of_its_line(grid):
    net = find_roads(grid)
    start = np.repeat(np.arange(len(net.xy_m)), np.diff(net.start))
    there = dict(zip(zip(start, net.to, strict=True), net.length_m, strict=True))
    assert len(there) == len(net.to)
    assert all(there[b, a] == metres for (a, b), metres in there.items())
    assert shapely.length(lines(net)) == pytest.approx(net.length_m)


def test_nodes_are_sorted_by_y_then_x():
    xy_m = find_roads(rectangle(7, 5)).xy_m
    assert (np.lexsort(xy_m.T) == np.arange(len(xy_m))).all()


def test_without_a_gate_work_starts_at_the_low_end_of_the_first_lane():
    grid = rectangle(7, 5)
    net = find_roads(grid)
    assert net.xy_m[net.gate] == pytest.approx([grid.lane_x_m[0, 0], grid.lane_y_m[0]])


def test_ways_go_round_a_crowded_boundary():
    round_hole = shapely.Point(0, 0).buffer(30, quad_segs=500)
    bean = box(-60, -60, 60, 60).difference(round_hole).difference(box(-1, 0, 1, 70))
    grid = laid(bean)
    net = find_roads(grid)
    assert outside_m(grid, lines(net)).max() < 0.02
