"""A gate wherever it is, and parts that lie apart, are joined to the ways between rows."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, box

from fieldmon.errors import PlotError
from fieldmon.plot.grid import rows_listed
from fieldmon.plot.road_network import find_roads
from tests.plot.test_road_network import gate_at, in_grid, laid, lines, outside_m


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
    shut = rows_listed(grid, grid.row_line_number[island])
    sentence = f"{np.count_nonzero(island)} of {grid.n_rows} rows are not: {shut}. Move"
    with pytest.raises(PlotError, match=sentence):
        find_roads(grid, no_go_m=moat)
