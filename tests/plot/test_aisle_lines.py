"""Aisles lie midway between rows, and beside the outermost."""

import numpy as np
import pytest
import shapely

from fieldmon.plot.aisle_lines import aisles_of
from fieldmon.plot.polylines import Polylines


def arc(radius_m, low=-0.4, high=0.4):
    turn = np.linspace(low, high, 60)
    return radius_m * np.stack([np.sin(turn), np.cos(turn)], axis=1)


def test_aisles_of_concentric_rows_are_concentric_and_midway():
    radii = 60.0 + 2.5 * np.arange(6)
    rows = Polylines.each([arc(r) for r in radii])
    aisles = aisles_of(rows, np.zeros(6, int), np.full(6, 2.5), 3.0)
    assert len(aisles.lines) == 7
    assert (aisles.right.tolist(), aisles.left.tolist()) == (list(range(6)), list(range(1, 7)))
    for k in range(7):
        inner = aisles.lines.line(k)[1:-1]
        wanted = 60.0 + 2.5 * k - 1.25
        assert np.hypot(*inner.T) == pytest.approx(np.full(len(inner), wanted), abs=0.03)


def test_between_rows_of_unequal_length_the_aisle_is_as_long_as_the_longer():
    rows = Polylines.each([arc(60.0, -0.1, 0.1), arc(62.5), arc(65.0, -0.4, 0.0)])
    aisles = aisles_of(rows, np.zeros(3, int), np.full(3, 2.5), 0.0)
    for k, radius_m in ((1, 61.25), (2, 63.75)):
        line = aisles.lines.line(k)
        assert np.hypot(*line.T) == pytest.approx(np.full(len(line), radius_m), abs=0.05)
        ends = np.arctan2(line[[0, -1], 0], line[[0, -1], 1])
        assert ends == pytest.approx([-0.4, 0.4], abs=0.02)


def test_each_block_has_its_own_aisles():
    north = Polylines.each([arc(60.0), arc(62.5), arc(90.0), arc(94.0)])
    aisles = aisles_of(north, np.array([0, 0, 1, 1]), np.full(4, 2.5), 1.0)
    assert aisles.right.tolist() == [0, 1, 3, 4]
    assert aisles.left.tolist() == [1, 2, 4, 5]
    middle = [np.hypot(*aisles.lines.line(k)[2:-2].T).mean() for k in range(6)]
    assert middle == pytest.approx([58.75, 61.25, 63.75, 88.75, 92.0, 95.25], abs=0.05)


def test_an_aisle_crosses_neither_of_its_rows():
    rng = np.random.default_rng(2)
    lines = []
    for k in range(5):
        x = np.arange(0, 80, 1.5)
        lines.append(np.stack([x, 2.5 * k + 2 * np.sin(x / 20) + rng.normal(0, 0.1, len(x))], 1))
    rows = Polylines.each(lines)
    aisles = aisles_of(rows, np.zeros(5, int), np.full(5, 2.5), 3.0)
    middles = aisles.lines.shapes()
    for row, shape in enumerate(rows.shapes()):
        assert shapely.distance(middles, shape).min() > 0.8
        assert not shapely.intersects(middles, shape).any(), row
