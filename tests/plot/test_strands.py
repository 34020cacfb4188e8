"""The line through plants follows a bend, and not what single plants are off it."""

import numpy as np
import pytest

from fieldmon.plot.strands import Strands, lines_of, ordered, row_deviations
from tests.plot.test_row_tracing import arcs


def test_how_far_plants_stand_beside_a_bent_row_is_what_they_were_moved_by():
    rng = np.random.default_rng(4)
    xy_m, row = arcs(6, 60, (2.5, 1.4), 80.0)
    moved = xy_m + rng.normal(0, 0.2, xy_m.shape)
    left_m, alone_m, free = row_deviations(moved, row)
    assert np.sqrt((left_m**2).sum() / free) == pytest.approx(0.2, rel=0.1)
    assert np.abs(row_deviations(xy_m, row).left_m).max() < 0.01
    # to the line of the others, which is itself not sure, it is a little more
    assert np.sqrt((alone_m**2).mean()) == pytest.approx(0.23, rel=0.12)


def test_plants_of_a_strand_come_in_order_and_its_line_leads_through_them():
    xy_m, row = arcs(3, 20, (2.5, 1.4), 70.0)
    mixed = np.random.default_rng(2).permutation(len(row))
    strands = ordered(xy_m[mixed], row[mixed], xy_m[mixed, 0])
    assert mixed[strands.plant].tolist() == list(range(60))
    assert strands.owner.tolist() == row.tolist()
    assert np.abs(strands.line_m - xy_m).max() < 0.02


def test_the_line_of_a_single_plant_is_short_and_has_a_direction():
    alone = Strands(np.array([0]), np.array([0, 1]), np.zeros((1, 2)), np.array([[0.0, 1.0]]))
    assert lines_of(alone).line(0).tolist() == [[0.0, 0.0], [0.0, 0.01]]
