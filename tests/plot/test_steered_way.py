"""The way of a robot that cannot turn on the spot."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from fieldmon.plot.steered_way import way_of
from fieldmon.plot.turning import TurningRoom

BOX = np.array([[-0.2, -0.3], [0.6, -0.3], [0.6, 0.3], [-0.2, 0.3]])
NOTHING = cKDTree(np.array([[99.0, 99.0]]))
CORNER = np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 6.0]])


def room(plants=NOTHING, radius_m=1.0):
    return TurningRoom(radius_m, BOX, plants, 0.3)


def bends(pieces):
    """Return how sharp each way bends, 1/m, at most."""
    most = 0.0
    for one in pieces:
        step = np.diff(one.line_m, axis=0)
        length = np.hypot(*step.T)
        turned = np.abs(np.angle(np.exp(1j * np.diff(np.arctan2(step[:, 1], step[:, 0])))))
        most = max([most, *(2 * turned / (length[1:] + length[:-1])).tolist()])
    return most


def test_where_there_is_room_a_corner_is_one_arc():
    (piece,), stuck = way_of(CORNER, 0.0, room())
    assert stuck is None
    assert piece.forward
    assert bends([piece]) == pytest.approx(1.0, rel=0.1)
    assert piece.line_m[[0, -1]] == pytest.approx(CORNER[[0, 2]])


def test_where_there_is_none_it_shunts_and_touches_no_plant():
    """A post inside the corner, where the arc would pass."""
    posts = cKDTree(np.array([[5.3, 0.7], [5.3, 1.7], [4.3, 0.7]]))
    pieces, stuck = way_of(CORNER, 0.0, room(posts))
    assert stuck is None
    assert len(pieces) > 1
    assert [one.forward for one in pieces] != [True] * len(pieces)
    assert pieces[-1].line_m[-1] == pytest.approx(CORNER[-1])


def test_a_corner_among_plants_has_no_room_and_is_named():
    posts = cKDTree(np.array([[5.4, 0.6], [6.6, -0.6], [5.4, -0.6], [6.6, 0.6]]))
    pieces, stuck = way_of(CORNER, 0.0, room(posts))
    assert stuck == pytest.approx(CORNER[1])
    # it drives as far as it can
    assert pieces[-1].line_m[-1] == pytest.approx(CORNER[1])


def test_what_lies_behind_is_driven_to_backwards():
    (piece,), _ = way_of(np.array([[0.0, 0.0], [-3.0, 0.0]]), 0.0, room())
    assert not piece.forward


@given(
    corners=st.lists(st.tuples(st.integers(-2, 2), st.integers(-2, 2)), min_size=2, max_size=5),
    yaw=st.sampled_from([0.0, math.pi / 2, math.pi, -1.0]),
    radius_m=st.sampled_from([0.7, 1.3]),
)
def test_any_way_hangs_together_and_bends_no_sharper_than_the_wheels(corners, yaw, radius_m):
    line = 5.0 * np.array(corners, float)
    line = line[np.append(True, np.hypot(*np.diff(line, axis=0).T) > 0)]
    assume(len(line) > 1)
    pieces, stuck = way_of(line, yaw, room(radius_m=radius_m))
    assert stuck is None
    for before, after in itertools.pairwise(pieces):
        assert before.line_m[-1] == pytest.approx(after.line_m[0], abs=0.05)
        assert before.forward != after.forward
    assert pieces[0].line_m[0] == pytest.approx(line[0], abs=1e-6)
    assert pieces[-1].line_m[-1] == pytest.approx(line[-1], abs=1e-6)
    assert bends(pieces) < 1.35 / radius_m
