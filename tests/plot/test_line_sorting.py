"""Lines drawn anyhow come out as rows, in order."""

import numpy as np
import pytest

from fieldmon.plot.line_sorting import sorted_rows
from fieldmon.plot.polylines import Polylines


def test_lines_drawn_in_any_order_and_either_way_are_put_in_order():
    x = np.linspace(0, 50, 20)
    drawn = [np.stack([x, 3.0 * k + 2 * np.sin(x / 15)], axis=1) for k in range(6)]
    mixed = [drawn[k][:: -1 if k % 2 else 1] for k in (3, 0, 5, 1, 4, 2)]
    rows = sorted_rows(Polylines.each(mixed), 8.0)
    assert rows.block.tolist() == [0] * 6
    assert rows.spacing_m == pytest.approx(3.0, rel=0.05)
    for k in range(6):
        assert rows.lines.line(k) == pytest.approx(drawn[k])


def test_pieces_of_one_drawn_row_are_one_row():
    whole = [np.array([[0.0, 3.0 * k], [60.0, 3.0 * k]]) for k in (0, 2)]
    pieces = [np.array([[0.0, 3.0], [20.0, 3.0]]), np.array([[60.0, 3.0], [40.0, 3.0]])]
    rows = sorted_rows(Polylines.each([whole[0], *pieces, whole[1]]), 8.0)
    assert len(rows.block) == 3
    assert rows.lines.line(1)[:, 0].tolist() == [0.0, 20.0, 40.0, 60.0]
