"""The polygons of an area."""

import numpy as np
import shapely
from shapely import GeometryCollection, LineString, MultiPolygon, Point, box

from fieldmon.plot.polygons import is_slim, polygons_of, without_slits

SQUARE, OTHER = box(0, 0, 1, 1), box(2, 0, 4, 1)


def test_what_a_cut_leaves_of_lines_and_points_is_no_area():
    left = GeometryCollection([SQUARE, LineString([(5, 0), (6, 0)]), Point(7, 0), OTHER])
    assert polygons_of(left) == MultiPolygon([SQUARE, OTHER])
    assert polygons_of(SQUARE) == MultiPolygon([SQUARE])
    assert polygons_of(shapely.intersection(SQUARE, box(1, 0, 2, 1))).is_empty


def test_of_several_areas_all_polygons_are_one():
    assert polygons_of(np.array([MultiPolygon([SQUARE]), OTHER])) == MultiPolygon([SQUARE, OTHER])


def test_slits_between_and_in_areas_are_theirs_and_nothing_is_in_two():
    first = MultiPolygon([box(0, 0, 1, 1), box(1.1, 0, 2, 1)])
    other = MultiPolygon([box(2.15, 0, 3, 1)])
    far = MultiPolygon([box(3.5, 0, 5, 1) - box(4, 0.4, 4.1, 0.6)])
    made = without_slits([first, other, far])
    assert [len(one.geoms) for one in made] == [1, 1, 1]
    assert [round(one.area, 9) for one in made] == [2.15, 0.85, 1.5]
    assert shapely.intersection(*made[:2]).area == 0.0
    assert without_slits([]) == []
    assert without_slits([MultiPolygon()]) == [MultiPolygon()]


def test_what_is_a_few_centimetres_wide_is_slim():
    assert is_slim(box(0, 0, 9, 0.15))
    assert not is_slim(box(0, 0, 9, 0.25))
