"""Rows as lines, and the stretches of ground beside them on which nothing can stand."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.plot.planting import Planting
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.row_lines import Blocked, RowLines, blocked_by, blocked_stretches, row_aisles

PLANTING = Planting(row_spacing_m=3.0, plant_spacing_m=2.0, headland_m=2.0)


def straight(n_rows=3, long_m=40.0):
    """Return rows that run along x, from right to left of their direction."""
    lines = [np.array([[0.0, 3.0 * k], [long_m, 3.0 * k]]) for k in range(n_rows)]
    return RowLines(Polylines.each(lines), np.zeros(n_rows, int))


@given(st.floats(5.0, 30.0), st.floats(0.5, 6.0))
def test_a_row_is_blocked_just_beside_what_stands_in_its_aisle(at_m, wide_m):
    rows = straight()
    post = shapely.box(at_m, 4.0, at_m + wide_m, 4.2)  # in the aisle above the middle row
    blocked = blocked_by(post, rows, row_aisles(rows, PLANTING), PLANTING)
    assert blocked.row.tolist() == [1]
    fine_m = 0.25 * PLANTING.plant_spacing_m
    assert blocked.from_m[0] == pytest.approx(at_m, abs=fine_m + 1e-6)
    assert blocked.to_m[0] == pytest.approx(at_m + wide_m, abs=fine_m + 1e-6)
    assert blocked.from_m[0] <= at_m
    assert blocked.to_m[0] >= at_m + wide_m


def test_where_nothing_stands_nothing_is_blocked():
    rows = straight()
    nowhere = blocked_by(shapely.MultiPolygon(), rows, row_aisles(rows, PLANTING), PLANTING)
    assert len(nowhere.row) == len(Blocked.nowhere().row) == 0


def test_a_strip_reaches_to_both_aisles_where_it_is_asked_whole():
    rows = straight()
    aisles = row_aisles(rows, PLANTING)
    below = shapely.box(10.0, 1.8, 11.0, 2.0)  # below the middle row, above the first

    def is_blocked(shapes):
        return shapely.intersects(shapes, below)

    assert blocked_stretches(rows, aisles, PLANTING, is_blocked).row.tolist() == []
    assert blocked_stretches(rows, aisles, PLANTING, is_blocked, whole=True).row.tolist() == [1]


def test_spacings_are_those_of_the_planting_where_blocks_say_none():
    rows = straight()
    assert rows.spacings(PLANTING).tolist() == [[3.0, 2.0]] * 3
    own = rows._replace(spacing_m=np.array([[4.0, 1.0]] * 3))
    assert own.spacings(PLANTING).tolist() == [[4.0, 1.0]] * 3
