"""The network of ways between row ends: complete, clear of rows, and on the plot."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely import MultiPolygon, Polygon, box

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.road_network import Obstacles, Where, find_roads, row_lines
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
    net = find_roads(grid)
    if len(shapely.get_parts(grid.drivable_m)) == 1:
        assert outside_m(grid, lines(net)).max() < 0.02


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
@settings(max_examples=30)
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


def test_a_gate_on_the_plot_is_where_it_is_said_to_be():
    grid = laid(box(-50, -50, 50, 50))
    gate = gate_at(grid, -49.0, 3.0)
    net = find_roads(grid, gate)
    assert net.xy_m[net.gate] == pytest.approx(gate)
    assert outside_m(grid, lines(net)).max() < 0.02


@pytest.mark.parametrize(("x", "y"), [(-80.0, 0.0), (0.0, 0.0)], ids=["beyond", "in a hole"])
def test_a_gate_off_the_plot_is_linked_by_the_shortest_line(x, y):
    ring = box(-50, -50, 50, 50).difference(box(-9, -20, 15, 20))
    grid = laid(ring)
    gate = gate_at(grid, x, y)
    net = find_roads(grid, gate)
    assert net.xy_m[net.gate] == pytest.approx(gate)
    away_m = shapely.distance(shapely.points(gate), grid.drivable_m)
    assert away_m == pytest.approx(30.0 if x else 9.0, abs=0.01)
    links = slice(net.start[net.gate], net.start[net.gate + 1])
    assert net.length_m[links] == pytest.approx([away_m])
    assert outside_m(grid, lines(net)).sum() / 2 == pytest.approx(away_m, abs=0.02)


def test_a_gate_among_the_plants_of_a_row_is_moved_to_their_lane():
    grid = laid(box(-50, -50, 50, 50))
    x, y = grid.xy_m[len(grid) // 2]
    net = find_roads(grid, (x + 0.4, y + 0.1))
    lane_y = grid.lane_y_m[grid.row[len(grid) // 2]]
    assert net.xy_m[net.gate] == pytest.approx([x + 0.4, lane_y])


def test_a_gate_between_two_rows_is_linked_to_both_ends_of_the_aisle():
    grid = laid(box(-50, -50, 50, 50))
    y = float(grid.lane_y_m[10]) + 0.2
    net = find_roads(grid, (3.0, y))
    reached = net.xy_m[net.to[net.start[net.gate] : net.start[net.gate + 1]], 0]
    assert reached.min() < grid.lane_x_m[:, 0].max() + 0.1
    assert reached.max() > grid.lane_x_m[:, 1].min() - 0.1


def test_parts_beside_each_other_are_joined_at_every_row():
    left, right = box(-60, -40, -4, 40), box(4, -40, 60, 40)
    grid = laid(left, right)
    steps = lines(find_roads(grid))
    over = steps[outside_m(grid, steps) > 0.02]
    assert outside_m(grid, over) == pytest.approx(7.98, abs=2.0)
    y = shapely.get_coordinates(shapely.centroid(over))[:, 1]
    assert np.ptp(y) > 70.0


def test_parts_are_not_joined_over_a_no_go_area():
    grid = laid(box(-60, -40, -4, 40), box(4, -40, 60, 40))
    ditch = in_grid(grid, MultiPolygon([box(-1, -300, 1, 50)]))
    steps = lines(find_roads(grid, no_go_m=ditch))
    assert not shapely.intersects(shapely.buffer(ditch, -0.02), steps).any()
    assert shapely.intersects(ditch, lines(find_roads(grid))).any()


def test_parts_behind_a_no_go_area_are_joined_round_its_end():
    grid = laid(box(-60, -40, -4, 40), box(4, -40, 60, 40))
    ditch = in_grid(grid, MultiPolygon([box(-1, -900, 1, 300)]))
    net = find_roads(grid, no_go_m=ditch)
    steps = lines(net)
    assert not shapely.intersects(shapely.buffer(ditch, -0.02), steps).any()
    (left,), (right,) = (
        np.flatnonzero((net.xy_m[:, 1] > 299) & (np.abs(net.xy_m[:, 0] - x) < 0.1)) for x in (-1, 1)
    )
    round_it = net.to[net.start[left] : net.start[left + 1]]
    assert len(round_it) == 2
    assert right in round_it


def test_a_part_within_the_hole_of_another_is_reached_through_the_hole():
    ring = box(-60, -60, 60, 60).difference(box(-35, -35, 35, 35))
    grid = laid(ring, box(-25, -25, 25, 25))
    assert find_roads(grid).end.min() >= 0


def test_rows_shut_in_by_a_no_go_area_cannot_be_reached():
    ring = box(-60, -60, 60, 60).difference(box(-35, -35, 35, 35))
    grid = laid(ring, box(-25, -25, 25, 25))
    moat = in_grid(grid, MultiPolygon([box(-32, -32, 32, 32).difference(box(-28, -28, 28, 28))]))
    island = np.abs(grid.xy_m[grid.row_start[:-1]]).max(axis=1) < 27
    sentence = f"{np.count_nonzero(island)} of {grid.n_rows} rows are not"
    with pytest.raises(PlotError, match=sentence):
        find_roads(grid, no_go_m=moat)


def test_ways_go_round_a_crowded_boundary():
    round_hole = shapely.Point(0, 0).buffer(30, quad_segs=500)
    bean = box(-60, -60, 60, 60).difference(round_hole).difference(box(-1, 0, 1, 70))
    grid = laid(bean)
    net = find_roads(grid)
    assert outside_m(grid, lines(net)).max() < 0.02


def test_obstacles_tell_what_can_be_driven_and_how_far_one_may_go():
    hole = box(-10, -10, 10, 10)
    grid = laid(box(-50, -50, 50, 50).difference(hole))
    obstacles = Obstacles.of(grid, MultiPolygon())
    low_x, high_x = grid.lane_x_m[:, 0].min(), grid.lane_x_m[:, 1].max()
    low_y, high_y = grid.lane_y_m.min(), grid.lane_y_m.max()
    along_headland = ([low_x, low_y], [low_x, high_y])
    across_rows = ([-20.0, low_y], [-20.0, high_y])
    over_the_hole = ([-9.0, -9.0], [9.0, 9.0])
    beyond = ([high_x + 3, low_y], [high_x + 3, high_y])
    from_m, to_m = (
        np.array(ends)
        for ends in zip(along_headland, across_rows, over_the_hole, beyond, strict=True)
    )
    assert obstacles.clear(from_m, to_m).tolist() == [True, False, False, False]
    assert obstacles.clear(from_m, to_m, Where.OUTSIDE).tolist() == [True, False, False, True]
    assert obstacles.clear(from_m, to_m, Where.ANYWHERE).tolist() == [True, False, True, True]


def test_corners_to_drive_round_are_those_that_stand_in_the_way():
    grid = laid(Polygon([(-50, -50), (50, -50), (50, 50), (0, 0), (-50, 50)]))
    obstacles = Obstacles.of(grid, MultiPolygon())
    (notch,) = obstacles.corners(Where.INSIDE)
    expected = in_grid(grid, shapely.Point(0, 0))
    assert notch == pytest.approx([expected.x, expected.y], abs=0.03)
    assert len(obstacles.corners(Where.OUTSIDE)) == 0
