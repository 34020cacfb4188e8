"""What lands on plants: by sums as by Fourier transforms as by hand, and drawn plant by plant."""

import numpy as np
import pytest
from hypothesis import given

from fieldmon.compute.random_streams import RandomStreams
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


def test_adjacent_plants_share_what_is_sent():
    grid = rectangle(3, 3)
    sent = np.zeros(9)
    sent[0] = 1.0
    landed = ToAdjacent(grid.adjacent).landed(sent)
    assert landed.tolist() == [0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]


def test_a_clean_plant_stays_clean_as_a_poisson_number_is_nought():
    landed = np.full(20_000, 0.7)
    after = settle(np.zeros(20_000, bool), landed, RandomStreams(1).key("spread"))
    assert after.mean() == pytest.approx(1.0 - np.exp(-0.7), abs=0.012)


def test_a_plant_more_changes_nothing_where_no_more_lands():
    grid, key = rectangle(9, 60), RandomStreams(4).key("spread")
    kernel = Dispersal.of(grid, DistanceKernel("exponential", 2.0))
    one, two = np.zeros(540), np.zeros(540)
    one[5] = two[5] = two[500] = 3.0
    none = np.zeros(540, bool)
    after = [settle(none, kernel.by_sum(sent), key) for sent in (one, two)]
    assert (after[0][:300] == after[1][:300]).all()
    assert after[1].sum() > after[0].sum()


def test_hours_have_coins_of_their_own():
    landed, key = np.full(2000, 0.5), RandomStreams(1).key("spread")
    first, second = (settle(np.zeros(2000, bool), landed, key, turn) for turn in (0, 1))
    assert 0.1 < (first & second).mean() < 0.22
