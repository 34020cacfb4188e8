"""What lands on plants: by sums as by Fourier transforms as by hand, and drawn plant by plant."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import poisson

from fieldmon.compute.random_streams import RandomStreams, coin_table
from fieldmon.infestation.cells import Cells
from fieldmon.infestation.insects.dispersal import Dispersal, ToAdjacent, _jumps, cells_of, settle
from fieldmon.infestation.insects.kernels import DistanceKernel
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


@given(st.integers(1, 9), st.integers(1, 9), st.integers(0, 1000))
def test_a_cell_is_drawn_by_one_coin_as_often_as_its_share_says(across, along, seed):
    """The alias table read back: what each entry keeps, and whose the rest of it is."""
    a, b = 2 * across - 1, 2 * along - 1
    shares = np.random.default_rng(seed).random((a, b)) ** 6
    shares[0, 0] = 0.0
    shares /= max(shares.sum(), 1e-9)
    own, to, to_other = Dispersal(cells_of(rectangle(3, 3)), shares)._dealt
    drawn = np.zeros((a, b))
    for k, each in enumerate(own):
        drawn[tuple(to[k] + [a // 2, b // 2])] += each / own.size
        drawn[tuple(to_other[k] + [a // 2, b // 2])] += (1.0 - each) / own.size
    assert ((own >= 0.0) & (own <= 1.0)).all()
    if a * b > 1:
        assert drawn == pytest.approx(shares, abs=1e-12)


@pytest.mark.parametrize("mean", [0.05, 0.7, 4.0, 29.0, 30.0])
def test_by_one_coin_a_number_is_drawn_as_poisson_s_chances_add_up(mean):
    coins = (np.arange(400) + 0.5) / 400
    drawn = [_jumps.py_func(coin, mean, np.exp(-mean), np.uint64(3)) for coin in coins]
    assert drawn == poisson.ppf(coins, mean).tolist()


@pytest.mark.parametrize("mean", [31.0, 75.0])
def test_of_many_jumps_each_part_has_a_coin_of_its_own(mean):
    keys = np.random.default_rng(1).integers(0, 2**62, 3000).astype(np.uint64)
    first = np.random.default_rng(2).random(3000)
    drawn = np.array([_jumps(coin, mean, np.exp(-30.0), key)
                      for coin, key in zip(first, keys, strict=True)])  # fmt: skip
    assert drawn.mean() == pytest.approx(mean, abs=4.5 * np.sqrt(mean / 3000))
    assert drawn.var() == pytest.approx(mean, rel=0.15)
    # the first thirty by the first coin, the rest by others
    rest = drawn - poisson.ppf(first, 30.0)
    assert rest.min() >= 0
    assert rest.mean() == pytest.approx(mean - 30.0, abs=4.5 * np.sqrt(mean / 3000))


def test_jumps_of_any_length_land_as_often_on_each_plant_and_the_others_by_the_kernel():
    grid = rectangle(4, 5)
    sent = np.linspace(0.0, 2.0, 20)
    near = Dispersal.of(grid, DistanceKernel("exponential", 2.0))
    far = Dispersal(near.cells, near.shares, 0.3)
    assert far.landed(sent) == pytest.approx(0.7 * near.by_sum(sent) + 0.3 * sent.sum() / 20)
    lone = Dispersal(near.cells, near.shares, 1.0)
    assert lone.landed(sent) == pytest.approx(sent.mean())
    found = np.array([lone.reached(np.array([0]), 0.5, np.uint64(key)) for key in range(3000)])
    # a twentieth of a half each
    chance = -np.expm1(-0.025)
    assert found.mean(axis=0) == pytest.approx(chance, abs=4.5 * np.sqrt(chance / 3000))


def test_a_kernel_reaches_a_plant_at_least_and_no_farther_than_the_plot():
    short = DistanceKernel("exponential", 0.01)
    wide = DistanceKernel("exponential", 500.0)
    grid = rectangle(4, 7)
    across, along = (int(side) for side in cells_of(grid).shape)
    assert Dispersal.of(grid, short).shares.shape == (3, 3)
    assert Dispersal.of(grid, wide).shares.shape == (2 * across - 1, 2 * along - 1)


def test_a_plant_settled_is_one_that_was_or_on_which_its_own_coin_says_something_lands():
    n, key = 500, RandomStreams(6).key("spread")
    landed, infested = np.linspace(0.0, 3.0, n), np.arange(n) % 7 == 0
    for turn in (0, 3):
        coins = coin_table(key, (turn + 1) * n)[turn * n :]
        wanted = infested | (coins < 1.0 - np.exp(-landed))
        assert (settle(infested, landed, key, turn) == wanted).all()
