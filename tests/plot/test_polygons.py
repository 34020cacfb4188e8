"""The polygons of an area."""

import numpy as np
import shapely
from shapely import GeometryCollection, LineString, MultiPolygon, Point, box

from fieldmon.plot.polygons import polygons_of

SQUARE, OTHER = box(0, 0, 1, 1), box(2, 0, 4, 1)


def test_what_a_cut_leaves_of_lines_and_points_is_no_area():
    left = GeometryCollection([SQUARE, LineString([(5, 0), (6, 0)]), Point(7, 0), OTHER])
    assert polygons_of(left) == MultiPolygon([SQUARE, OTHER])
    assert polygons_of(SQUARE) == MultiPolygon([SQUARE])
    assert polygons_of(shapely.intersection(SQUARE, box(1, 0, 2, 1))).is_empty


def test_of_several_areas_all_polygons_are_one():
    assert polygons_of(np.array([MultiPolygon([SQUARE]), OTHER])) == MultiPolygon([SQUARE, OTHER])
