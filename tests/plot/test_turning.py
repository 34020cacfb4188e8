"""A turn at one corner: which is cheapest, what it needs, and where none fits."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from fieldmon.plot.turning import TurningRoom, best_turn, length_m, turn_of

BOX = np.array([[-0.2, -0.3], [0.8, -0.3], [0.8, 0.3], [-0.2, 0.3]])
NOTHING = cKDTree(np.array([[99.0, 99.0]]))
CORNER = np.zeros(2)


def room(plants=NOTHING, radius_m=1.0, area=None):
    return TurningRoom(radius_m, BOX, plants, 0.3, area)


@pytest.mark.parametrize("left", [True, False])
@pytest.mark.parametrize("ahead", [True, False])
def test_with_room_a_corner_is_one_arc_in_the_gear_in_which_the_robot_comes(left, ahead):
    """Who comes backwards leaves by the way's other heading: no gear is changed."""
    error = math.pi / 2 if left else -math.pi / 2
    turn = best_turn(CORNER, 0.0, error, room(), ahead=ahead)
    (arc,) = turn.arcs
    assert arc.forward == ahead
    assert length_m(arc.line_m) == pytest.approx(math.pi / 2, abs=0.01)
    assert turn.yaw == pytest.approx(error if ahead else turn_of(error + math.pi))
    # it neither overshoots the corner nor comes back to it
    assert (turn.begins_m < 0) == ahead


def test_a_wall_ahead_is_not_driven_beyond():
    area = shapely.box(-9.0, -9.0, 0.05, 9.0)
    turn = best_turn(CORNER, 0.0, math.pi / 2, room(area=area))
    assert all((one.line_m[:, 0] <= 0.05 + 1e-9).all() for one in turn.arcs)


def test_where_no_turn_fits_there_is_none():
    posts = cKDTree(np.array([[0.6, 0.6], [-0.6, 0.6], [0.6, -0.6], [-0.6, -0.6]]))
    assert best_turn(CORNER, 0.0, math.pi / 2, room(posts)) is None


@settings(max_examples=60)
@given(
    line=st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=1, max_size=6),
    yaw=st.floats(-math.pi, math.pi),
    posts=st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=1, max_size=6),
)
def test_what_is_touched_is_what_the_outline_comes_near_to(line, yaw, posts):
    """As shapely has it, pose by pose."""
    places, posts = np.array(line), np.array(posts)
    headings = np.full(len(places), yaw)
    cos, sin = math.cos(yaw), math.sin(yaw)
    turned = BOX @ np.array([[cos, sin], [-sin, cos]])
    near_m = min(
        shapely.distance(shapely.polygons(turned + place), shapely.points(post))
        for place in places
        for post in posts
    )
    if abs(near_m - 0.3) > 1e-6:
        assert room(cKDTree(posts)).allows(places, headings) == (near_m >= 0.3)
