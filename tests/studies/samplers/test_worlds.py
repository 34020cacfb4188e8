"""Worlds do what they are named for, and the same insects for everybody."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.plot.layout import rectangle
from fieldmon.studies.samplers.worlds import WORLDS, World, near_edge

GRID = rectangle(31, 31)
N, MIDDLE = 961, 480
ONE = np.array([MIDDLE])
KEYS = [RandomStreams(7).key("spread", night) for night in range(300)]


def jumps(world):
    """Return where infestations from the middle land, in plants along and across."""
    reached = [WORLDS[world].reached(GRID, np.random.default_rng(s), ONE)[0] for s in range(400)]
    landed = np.array([plant for plant in reached if plant >= 0])
    return landed % 31 - 15, landed // 31 - 15


def test_adjacent_is_beside_and_along_the_row_is_nearly_always_in_it():
    x, y = jumps("adjacent plants")
    assert set(np.abs(x) + np.abs(y)) == {1}
    x, y = jumps("along the row")
    assert np.mean(y == 0) == pytest.approx(0.9, abs=0.05)


@pytest.mark.parametrize(
    ("world", "mean"), [("exponential, mean 2", 2), ("exponential, mean 4", 4)]
)
def test_exponential_jumps_go_as_far_as_their_mean(world, mean):
    x, y = jumps(world)
    assert np.mean(np.hypot(x, y)) == pytest.approx(mean, rel=0.15)


def test_the_wind_blows_one_way_and_cauchy_goes_far():
    x, y = jumps("wind")
    assert x.mean() > 1.5
    assert y.mean() > 0.8
    x, y = jumps("Cauchy")
    assert np.median(np.hypot(x, y)) == pytest.approx(1.7, abs=0.6)
    assert np.hypot(x, y).max() > 10


def test_arrivals_are_as_many_as_said_and_by_the_edge_where_they_are_said_to_be():
    nobody = np.zeros(N, np.bool_)
    anywhere, edges = (
        np.array([WORLDS[w].night(GRID, nobody, key) for key in KEYS])
        for w in ("arrivals anywhere", "edges and road all season")
    )
    for arrived in (anywhere, edges):
        assert arrived.mean() == pytest.approx(0.001, rel=0.2)
    near = near_edge(GRID) > np.median(near_edge(GRID))
    assert edges[:, near].sum() > 3 * edges[:, ~near].sum()
    assert anywhere[:, near].sum() < 2 * anywhere[:, ~near].sum()


def test_who_is_infested_changes_nothing_for_the_others():
    few, more = np.zeros((2, N), np.bool_)
    few[[5, 400]], more[[5, 400, 700]] = True, True
    world = World(anywhere=1.0)
    for key in KEYS[:40]:
        one, other = world.night(GRID, few, key), world.night(GRID, more, key)
        assert (one <= other).all()
        assert np.count_nonzero(other & ~one) <= 2
