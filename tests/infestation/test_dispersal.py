"""What lands on plants: by sums as by Fourier transforms as by hand, and drawn plant by plant."""

import numpy as np
import pytest
from hypothesis import given

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.cells import Cells
from fieldmon.infestation.dispersal import Dispersal, ToAdjacent, settle
from fieldmon.infestation.kernels import DistanceKernel
from fieldmon.plot.layout import rectangle
from tests.crooked import crooked_grids

KERNEL = DistanceKernel("cauchy", 4.0, across=0.7)
WIND = (2.0, -1.0)


def by_hand(dispersal, sent):
    """Sum over all pairs of plants; those of a cell share what lands on it."""
    cells, shares = dispersal.cells, dispersal.shares
    a, b = shares.shape[0] // 2, shares.shape[1] // 2
    y, x = cells.of_plant // cells.shape[1], cells.of_plant % cells.shape[1]
    landed = np.zeros(len(sent))
    for i, value in enumerate(sent):
        near = (np.abs(y - y[i]) <= a) & (np.abs(x - x[i]) <= b)
        landed[near] += value * shares[(y - y[i])[near] + a, (x - x[i])[near] + b]
    return landed / np.bincount(cells.of_plant)[cells.of_plant]


@given(crooked_grids(max_plants=300))
def test_both_ways_to_sum_agree_with_a_sum_by_hand_on_any_plot(grid):
    sent = np.linspace(0.0, 1.0, len(grid)) * (np.arange(len(grid)) % 3 == 0)
    dispersal = Dispersal.of(grid, KERNEL, WIND)
    expected = by_hand(dispersal, sent)
    assert dispersal.by_sum(sent) == pytest.approx(expected, abs=1e-12)
    assert dispersal.by_fft(sent) == pytest.approx(expected, abs=1e-9)
    assert dispersal.landed(sent) == pytest.approx(expected, abs=1e-9)


def test_nothing_lands_that_was_not_sent_and_a_wide_kernel_loses_what_leaves_the_plot():
    grid = rectangle(9, 9)
    sent = np.zeros(81)
    sent[40] = 1.0
    near = Dispersal.of(grid, DistanceKernel("exponential", 1.0)).landed(sent).sum()
    far = Dispersal.of(grid, DistanceKernel("exponential", 30.0)).landed(sent).sum()
    assert near == pytest.approx(1.0, abs=1e-6)
    assert far < 1.0


def test_long_jumps_land_on_any_plant_alike():
    grid = rectangle(9, 9)
    sent = np.zeros(81)
    sent[0] = 4.0
    landed = Dispersal.of(grid, DistanceKernel("exponential", 1.0, long_share=0.25)).landed(sent)
    assert landed[-1] == pytest.approx(1.0 / 81, abs=1e-9)


def reached_how_often(landings, senders, sends, n, times=4000):
    """Return the share of draws in which each plant is reached, and the standard error."""
    key, often = RandomStreams(2).key("spread"), np.zeros(n)
    for turn in range(times):
        often += landings.reached(np.array(senders), sends, key, turn)
    share = often / times
    return share, np.sqrt(np.maximum(share * (1.0 - share), 0.25 / times) / times)


@pytest.mark.parametrize("sends", [0.3, 45.0])
@pytest.mark.parametrize("long_share", [0.0, 0.3])
def test_jumps_that_are_drawn_reach_plants_as_often_as_what_lands_on_average(sends, long_share):
    """So a night by its jumps is the night of `landed` and `settle`, whatever the kernel."""
    grid = rectangle(7, 9)
    kernel = DistanceKernel("cauchy", 4.0, across=0.7, long_share=long_share)
    dispersal, senders = Dispersal.of(grid, kernel, WIND), [3, 30, 31, 62]
    sent = np.zeros(63)
    sent[senders] = sends
    said = -np.expm1(-dispersal.landed(sent))
    share, error = reached_how_often(dispersal, senders, sends, 63)
    assert (np.abs(share - said) <= 4.5 * error).all()
    assert share.mean() == pytest.approx(said.mean(), abs=0.004)


def test_plants_of_one_cell_are_reached_alike():
    of_plant = np.repeat(np.arange(4), 5)
    two_by_two = np.array([2, 2])
    cells = Cells(of_plant, np.arange(5) * 5, np.arange(20), two_by_two, np.array([3.0, 3.0]))
    shares = DistanceKernel("exponential", 3.0).on_cells(cells.size_m, (1, 1), own=True)
    dispersal, sent = Dispersal(cells, shares), np.zeros(20)
    sent[7] = 4.0
    share, error = reached_how_often(dispersal, [7], 4.0, 20)
    assert (np.abs(share + np.expm1(-dispersal.landed(sent))) <= 4.5 * error).all()


def test_who_sends_more_adds_jumps_and_takes_none_back():
    grid, key = rectangle(9, 60), RandomStreams(4).key("spread")
    kernel = Dispersal.of(grid, DistanceKernel("exponential", 2.0, long_share=0.1))
    few, more = (kernel.reached(np.array([5, 500]), sends, key) for sends in (2.0, 9.0))
    assert (more >= few).all()
    assert more.sum() > few.sum()


def test_adjacent_plants_are_each_reached_by_what_is_sent_to_them():
    grid = rectangle(3, 3)
    share, error = reached_how_often(ToAdjacent(grid.adjacent), [0], 0.5, 9)
    said = np.zeros(9)
    said[[1, 3]] = -np.expm1(-0.5)
    assert (np.abs(share - said) <= 4.5 * error * (said > 0)).all()


def test_a_clean_plant_stays_clean_as_a_poisson_number_is_nought():
    landed = np.full(20_000, 0.7)
    after = settle(np.zeros(20_000, bool), landed, RandomStreams(1).key("spread"))
    assert after.mean() == pytest.approx(1.0 - np.exp(-0.7), abs=0.012)


def test_a_plant_more_changes_nothing_where_no_more_lands():
    grid, key = rectangle(9, 60), RandomStreams(4).key("spread")
    kernel = Dispersal.of(grid, DistanceKernel("exponential", 2.0))
    one, two = (kernel.reached(np.array(senders), 3.0, key) for senders in ([5], [5, 500]))
    assert (one[:300] == two[:300]).all()
    assert two.sum() > one.sum()


def test_hours_have_coins_of_their_own():
    landed, key = np.full(2000, 0.5), RandomStreams(1).key("spread")
    first, second = (settle(np.zeros(2000, bool), landed, key, turn) for turn in (0, 1))
    assert 0.1 < (first & second).mean() < 0.22
