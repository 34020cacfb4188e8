"""Lines beside each other are rows of one block, level by level from right to left."""

import numpy as np
import pytest

from fieldmon.plot.row_order import StrandRows, in_line, neighbouring_strands
from fieldmon.plot.strands import ordered
from tests.bent import turned


def strands_of(*lines_m):
    """Return strands along lines given as corners, a plant a metre, the first line first."""
    drawn = []
    for one, other in lines_m:
        start, way = np.array(one, float), np.subtract(other, one)
        steps = np.arange(int(np.hypot(*way)) + 1)
        drawn.append(start + steps[:, None] * way / np.hypot(*way))
    owner = np.repeat(np.arange(len(drawn)), [len(line) for line in drawn])
    xy_m = np.concatenate(drawn)
    return ordered(xy_m, owner, np.arange(len(xy_m), dtype=float))


def rows_of(strands):
    return StrandRows.of(strands, neighbouring_strands(strands, 1.0))


def test_rows_rise_to_the_left_of_their_direction_whichever_way_they_were_drawn():
    strands = strands_of(((0, 6), (30, 6)), ((30, 0), (0, 0)), ((0, 3), (30, 3)))
    rows = rows_of(strands)
    assert rows.row.tolist() == [2, 0, 1]
    assert rows.turned.tolist() == [False, True, False]
    assert rows.block.tolist() == [0, 0, 0]
    assert rows.spacing_m == pytest.approx(3.0)


def test_pieces_level_with_each_other_are_one_row_in_their_order_along_it():
    strands = strands_of(((0, 0), (40, 0)), ((22, 3), (40, 3)), ((0, 3), (18, 3)))
    rows = rows_of(strands)
    assert rows.row.tolist() == [0, 1, 1]
    assert in_line(strands, rows, [1, 2]) == [2, 1]


def test_what_runs_another_way_is_another_block_and_the_larger_comes_first():
    west = [((0.0, y), (10.0, y)) for y in (0.0, 3.0)]
    lines = [np.array([(0.0, y), (25.0, y)]) for y in (0.0, 3.0, 6.0)]
    east = [tuple(turned(line, 40.0) + np.array([40.0, 0.0])) for line in lines]
    rows = rows_of(strands_of(*west, *east))
    assert rows.block.tolist() == [0, 0, 0, 1, 1]
    assert rows.block[rows.row].tolist() == [1, 1, 0, 0, 0]
