"""An outline that crosses itself is told from one that touches itself or slipped at a corner."""

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, Polygon, box

from fieldmon.io.parse.crossed_outline import crossed_at, in_order

SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])


def outline(*corners):
    return MultiPolygon([Polygon(corners)])


def kept_of(drawn):
    return shapely.make_valid(drawn, method="structure", keep_collapsed=False).area


def test_corners_in_the_wrong_order_cross_in_the_middle_and_are_put_in_order():
    tie = outline(*SQUARE[[0, 2, 1, 3]])
    assert crossed_at(tie) == (2.0, 2.0)
    made = in_order(tie, kept_of(tie))
    assert made.equals(box(0, 0, 4, 4))


@pytest.mark.parametrize("seed", range(5))
def test_whatever_the_order_the_corners_of_a_round_plot_are_put_around_it(seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(9)) * 2 * np.pi
    corners = np.column_stack([np.cos(angle), np.sin(angle)])
    order = rng.permutation(9)
    drawn = outline(*corners[order])
    made = in_order(drawn, 0.0)
    assert made.equals(Polygon(corners))


def test_a_walk_in_the_shape_of_an_eight_crosses_but_its_order_is_not_to_blame():
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    eight = outline(*np.column_stack([2 * np.sin(t), np.sin(2 * t + 0.1)]))
    assert crossed_at(eight) is not None
    assert in_order(eight, kept_of(eight)) is None


def test_a_slip_at_a_corner_and_an_outline_that_touches_itself_lose_nothing():
    slip = outline(*SQUARE, [0.0, -0.01], [0.01, 0.0])
    touching = outline([0, 0], [2, 2], [4, 0], [4, 4], [2, 2], [0, 4])
    assert crossed_at(slip) is None
    assert crossed_at(touching) is None
    assert crossed_at(MultiPolygon([box(0, 0, 4, 4)])) is None
