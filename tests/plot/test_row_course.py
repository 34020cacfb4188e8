"""Rows that bend go through their plants, and on along their aisle between them."""

import numpy as np
import pytest
import shapely
from hypothesis import given

from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.planting import Planting
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_course import row_courses
from fieldmon.plot.row_lines import Ground, RowLines
from tests.bent import FRAME, bent_grids


@given(bent_grids())
def test_a_course_leads_through_all_plants_of_its_row_in_order(grid):
    for k, course in enumerate(row_courses(grid)):
        corners = [tuple(corner) for corner in shapely.get_coordinates(course)]
        plants = grid.xy_m[grid.row_start[k] : grid.row_start[k + 1]]
        at = [corners.index(tuple(plant)) for plant in plants]
        assert at == sorted(at)
        if len(plants) > 1:
            assert (corners[0], corners[-1]) == (tuple(plants[0]), tuple(plants[-1]))
        else:
            assert corners == [tuple(plants[0])] * 2


@pytest.mark.parametrize("faces", [1, 2])
def test_where_plants_are_missing_a_row_keeps_to_its_circle(faces):
    turn = np.arange(-12, 13) * 0.05
    rows_m = [r * np.stack([np.sin(turn), np.cos(turn)], axis=1) for r in (20.0, 22.5, 25.0)]
    rows = RowLines(Polylines.each(rows_m), np.zeros(3, int))
    left = np.r_[0:2, 18:25]
    plants = np.concatenate([rows_m[0], rows_m[1][left], rows_m[2]])
    row = np.repeat([0, 1, 2], [25, 9, 25])
    planting = Planting(row_spacing_m=2.5, plant_spacing_m=1.1, faces=faces)
    grid = bent_grid(FRAME, rows, (plants, row), Ground(None, shapely.MultiPolygon()), planting)
    for course, line in zip(row_courses(grid), grid.row_line, strict=True):
        off_m = np.hypot(*shapely.get_coordinates(course).T) - (20.0 + 2.5 * line)
        assert np.abs(off_m).max() < 0.05
        assert shapely.length(course) == pytest.approx(1.2 * (20.0 + 2.5 * line), rel=0.01)
