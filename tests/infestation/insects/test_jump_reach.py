"""Kernels hand on what they are given, and by Fourier transform as by hand."""

import numpy as np
import pytest
from hypothesis import given

from fieldmon.infestation.cells import Cells
from fieldmon.infestation.insects.jump_reach import (
    BEYOND,
    RADIUS,
    TO_ADJACENT,
    kernel_means,
    kernels,
    pest_kernels,
    pest_reach_of,
    reach_of,
)
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.plot.layout import rectangle
from tests.crooked import crooked_grids

SHARES = np.array([0.3, 0.1, 0.0, 0.2, 0.0, 0.4])


def by_hand(grid, values, shares):
    """Sum over all plants what each brings to each."""
    cells = Cells.of(grid)
    kernel = np.tensordot(shares, kernels(cells.size_m), 1)
    y, x = cells.of_plant // cells.shape[1], cells.of_plant % cells.shape[1]
    brought = np.zeros(len(grid))
    for i, value in enumerate(values):
        near = (np.abs(y - y[i]) <= RADIUS) & (np.abs(x - x[i]) <= RADIUS)
        brought[near] += value * kernel[(y - y[i])[near] + RADIUS, (x - x[i])[near] + RADIUS]
    return brought


@given(crooked_grids(max_plants=300))
def test_what_is_brought_is_the_sum_over_all_plants(grid):
    values = np.linspace(0.0, 1.0, len(grid))
    expected = by_hand(grid, values, SHARES)
    reach = reach_of(grid)
    assert reach.landed(values, reach.mixed(SHARES)) == pytest.approx(expected, abs=1e-9)


def test_back_is_from_where_it_would_land():
    reach, n = reach_of(rectangle(6, 9)), 54
    mixed = reach.mixed(SHARES)
    sent = np.array([reach.landed(np.eye(n)[i], mixed) for i in range(n)])
    back = np.array([reach.landed(np.eye(n)[i], np.conj(mixed)) for i in range(n)])
    assert back == pytest.approx(sent.T, abs=1e-9)


def test_each_kernel_hands_on_all_it_is_given_and_none_to_the_plant_itself():
    made = kernels(np.array([4.0, 3.0]))
    assert made.sum(axis=(1, 2)) == pytest.approx(1.0)
    assert (made[:, RADIUS, RADIUS] == 0.0).all()
    assert BEYOND.sum() + TO_ADJACENT == pytest.approx(1.0)


def test_the_four_ways_mirror_each_other_and_kernels_reach_as_far_as_they_are_named():
    size_m = np.array([3.0, 3.0])
    near, right, up, left, down, far = kernels(size_m)
    assert right == pytest.approx(left[:, ::-1])
    assert up == pytest.approx(down[::-1])
    assert up == pytest.approx(right.T)
    means = kernel_means(size_m)
    assert 2.0 < means[0] < means[1] < means[5] < RADIUS
    assert near.max() > far.max()


def test_all_that_a_pest_s_plant_sends_lands_somewhere_and_only_once():
    for share in (0.0, 0.2, 1.0):
        kernel = DistanceKernel("exponential", 6.0, long_share=share)
        reach = pest_reach_of(rectangle(6, 9), kernel)
        assert reach.anywhere == share
        assert reach.adjacent + reach.beyond.sum() + reach.anywhere == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("scale_m", "wind_m_s", "scales_m"),
    # a wind of 5 m/s doubles how far jumps go
    [(14.0, (0.0, 0.0), 42.0), (10.0, (3.0, 4.0), 60.0), (28.0, (0.0, 0.0), 84.0)],
)
def test_a_pest_s_jumps_are_followed_three_scales_far(scale_m, wind_m_s, scales_m):
    """Of exponential jumps a twentieth goes farther; on plants 3 m apart."""
    kernel = DistanceKernel("exponential", scale_m)
    made = pest_kernels(np.array([3.0, 3.0]), kernel, wind_m_s)
    followed_m = 3.0 * (made.shape[1] // 2)
    assert scales_m <= followed_m < scales_m + 3.1


def test_short_jumps_are_followed_as_far_as_those_of_any_pest_and_the_farthest_are_cut():
    for scale_m, plants in ((1.0, RADIUS), (500.0, 30)):
        made = pest_kernels(np.array([3.0, 3.0]), DistanceKernel("exponential", scale_m))
        assert made.shape == (6, 2 * plants + 1, 2 * plants + 1)


def test_a_pest_may_jump_half_or_twice_as_far_and_farther_along_or_across_the_rows():
    made = pest_kernels(np.array([3.0, 3.0]), DistanceKernel("exponential", 6.0))
    away = np.arange(made.shape[1]) - made.shape[1] // 2
    # how far jumps go on average (rows run along the second axis)
    along, across = (np.sqrt((made.sum(axis=side) * away**2).sum(axis=1)) for side in (1, 2))
    far = np.hypot(along, across)
    assert along[:3] == pytest.approx(across[:3], rel=0.01)
    assert far[1] == pytest.approx(far[0] / 2, rel=0.2)
    assert 1.3 < far[2] / far[0] < 2.0, "cut where it is followed no farther"
    # and where nothing is cut: how fast chances fall from the third plant of a row to the ninth
    # (at 27 m three times as many plants share a jump as at 9 m)
    middle = made.shape[1] // 2
    falls = np.log(made[:3, middle, middle + 3] / made[:3, middle, middle + 9] / 3)
    assert falls[0] == pytest.approx(6 * 3.0 / 6.0, rel=0.02)
    assert falls[0] / falls[1:] == pytest.approx([0.5, 2.0], rel=0.02)
    assert along[3] == pytest.approx(along[0], rel=0.1)
    assert along[3] / across[3] == pytest.approx(3.0, rel=0.25)
    assert 1.5 < across[4] / along[4] < 3.0


def test_wind_carries_one_way_along_or_across_and_nothing_back():
    size_m = np.array([4.0, 3.0])
    _, right, up, left, down, _ = kernels(size_m)
    ahead = np.arange(-RADIUS, RADIUS + 1)
    for kernel, axis, way in ((right, 1, 1), (left, 1, -1), (up, 0, 1), (down, 0, -1)):
        beside = kernel.sum(axis=1 - axis)
        assert (beside[ahead * way <= 0] == 0.0).all()
        assert beside[ahead * way > 0].sum() == pytest.approx(1.0)
    # straight on, the cosine is 1; at 45 degrees its square is a half
    size_m = np.array([3.0, 3.0])
    right = kernels(size_m)[1]
    straight, aslant = right[RADIUS, RADIUS + 5], right[RADIUS + 3, RADIUS + 4]
    assert aslant / straight == pytest.approx((4 / 5) ** 2)


def test_chances_of_a_jump_fall_as_each_kernel_is_named():
    near, right, *_, far = kernels(np.array([3.0, 3.0]))
    plants = np.array([2.0, 5.0, 11.0])
    at = RADIUS + plants.astype(int)
    for kernel, mean in ((near, 2.0), (right, 4.0)):
        falls = np.log(kernel[RADIUS, at] * plants)
        assert np.diff(falls) == pytest.approx(-np.diff(plants) / mean)
    # two-dimensional Cauchy
    falls = (1.0 + (plants / 3.0) ** 2) ** -1.5
    assert far[RADIUS, at] / falls == pytest.approx(far[RADIUS, at[0]] / falls[0])


def test_a_plant_is_the_square_root_of_the_ground_that_it_has():
    long, square = kernels(np.array([8.0, 2.0])), kernels(np.array([4.0, 4.0]))
    # 16 m away: two cells across and eight along, or four either way
    for one, other in ((long[0], square[0]), (long[5], square[5])):
        ratio = one[RADIUS + 1, RADIUS] / one[RADIUS, RADIUS + 4]
        assert ratio == pytest.approx(1.0)
        falls = one[RADIUS + 1, RADIUS] / one[RADIUS, RADIUS + 8]
        assert falls == pytest.approx(other[RADIUS, RADIUS + 2] / other[RADIUS, RADIUS + 4])


@pytest.mark.parametrize("wind_m_s", [(0.0, 0.0), (2.0, -1.0)])
def test_what_a_pest_brings_to_the_plants_beside_and_beyond_is_its_kernels_own(wind_m_s):
    grid = rectangle(6, 9)
    kernel = DistanceKernel("exponential", 6.0, long_share=0.2)
    reach = pest_reach_of(grid, kernel, wind_m_s)
    made = pest_kernels(reach.cells.size_m, kernel, wind_m_s)
    h = made.shape[1] // 2
    first = 0.8 * np.array([0.6, 0.1, 0.1, 0.05, 0.05, 0.1])
    whole = np.einsum("k,kij->ij", first, made)
    cross = [(h - 1, h), (h + 1, h), (h, h - 1), (h, h + 1)]
    assert reach.adjacent == pytest.approx(sum(whole[at] for at in cross))
    left = np.einsum("k,kij->ij", reach.beyond, reach.kernels)
    for at in cross:
        whole[at] = 0.0
    assert left == pytest.approx(whole)
    assert reach.kernels.sum(axis=(1, 2)) == pytest.approx(1.0)


def test_what_arrives_by_the_edge_is_one_plant_s_share_on_average_and_falls_inwards():
    at_edge = reach_of(rectangle(15, 15)).at_edge.reshape(15, 15)
    assert at_edge.mean() == pytest.approx(1.0)
    assert at_edge[0, 0] > 1.0 > at_edge[7, 7]
    assert (np.diff(at_edge[7, :8]) <= 0.0).all()


def test_the_mean_of_a_kernel_is_measured_in_plants_however_long_they_are():
    size_m, one = np.array([8.0, 2.0]), np.zeros((1, 5, 5))
    one[0, 2, 4], one[0, 1, 2], one[0, 3, 3] = 0.5, 0.25, 0.25
    metres = 0.5 * 4.0 + 0.25 * 8.0 + 0.25 * np.hypot(8.0, 2.0)
    assert kernel_means(size_m, one) == pytest.approx([metres / 4.0])
