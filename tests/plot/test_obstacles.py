"""What stands in the way: what can be driven past, and which corners ways go round."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, Polygon, box

from fieldmon.plot.obstacles import Obstacles, Where, filled
from tests.plot.test_road_network import in_grid, laid


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


def test_a_line_along_which_areas_touch_is_no_ground():
    both = shapely.union_all([box(0, 0, 4, 4), shapely.LineString([(4, 4), (9, 4)])])
    assert filled(both).equals(box(0, 0, 4, 4))
