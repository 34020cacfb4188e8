"""A robot takes the aisles of its way, and leaves its own when it has to wait."""

import numpy as np
import pytest

from fieldmon.drive.aisle_keeper import AisleKeeper
from fieldmon.drive.day import place_m, way_m
from fieldmon.drive.vda5050.crossing import Crossing

FIRST, SECOND = 3, 40


@pytest.fixture
def aisles(plot):
    return plot.aisles


def crossing(aisles, keeper, name, at):
    return Crossing(keeper, name, aisles, place_m(aisles, at))


def test_who_stands_in_an_aisle_has_it(aisles):
    keeper = AisleKeeper()
    crossing(aisles, keeper, "a", FIRST)
    other = crossing(aisles, keeper, "b", -1)
    assert not other.enter(FIRST)
    assert other.enter(SECOND)


def test_two_who_want_each_others_aisle_both_get_there(aisles):
    keeper = AisleKeeper()
    a, b = crossing(aisles, keeper, "a", FIRST), crossing(aisles, keeper, "b", SECOND)
    assert not a.enter(SECOND)
    assert not b.enter(FIRST)
    a.left()
    assert b.enter(FIRST)
    b.arrived(FIRST)
    assert a.enter(SECOND)


def test_a_way_is_parted_where_its_own_aisle_ends(aisles):
    line = way_m(aisles, FIRST, SECOND)
    out, rest = crossing(aisles, AisleKeeper(), "a", FIRST).parted(line, SECOND)
    np.testing.assert_allclose(out[0], line[0])
    np.testing.assert_allclose(rest[-1], line[-1])
    np.testing.assert_allclose(out[-1], rest[0])
    lanes = aisles.grid.lane_x_m
    row = aisles.grid.row[FIRST]
    assert np.abs(lanes[row] - out[-1][0]).min() < 0.01
    length = lambda way: np.hypot(*np.diff(way, axis=0).T).sum()  # noqa: E731
    assert length(out) + length(rest) == pytest.approx(length(line))


def test_from_the_gate_there_is_nothing_to_leave(aisles):
    line = way_m(aisles, -1, SECOND)
    out, rest = crossing(aisles, AisleKeeper(), "a", -1).parted(line, SECOND)
    assert len(out) == 1
    np.testing.assert_array_equal(rest, line)


def test_a_way_is_blocked_by_who_moves_no_more(aisles):
    keeper = AisleKeeper()
    a = crossing(aisles, keeper, "a", -1)
    crossing(aisles, keeper, "b", SECOND)
    assert not a.blocked(SECOND)
    keeper.end("b")
    assert a.blocked(SECOND)
    assert not a.blocked(-1)
