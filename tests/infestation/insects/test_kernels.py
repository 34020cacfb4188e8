"""Kernels land all that leaves a plant, as far as published, and where the wind carries it."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.insects.kernels import DistanceKernel

FINE = np.array([0.1, 0.1])


def share_within(kernel, radius_m, size_m=FINE, wide=150):
    shares = kernel.on_cells(size_m, (wide, wide), own=True)
    steps = np.arange(-wide, wide + 1)
    away = np.hypot(steps[:, None] * size_m[0], steps[None, :] * size_m[1])
    return shares[away <= radius_m].sum()


@pytest.mark.parametrize(("mean_m", "far_m"), [(1.0, 3.912), (1.5, 5.868)])
def test_the_exponential_reaches_as_far_as_its_published_quantiles(mean_m, far_m):
    """98 % of a mean of 1 and of 1.5: the figures that the tests of PoPS have."""
    assert share_within(DistanceKernel("exponential", mean_m), far_m) == pytest.approx(
        0.98, abs=2e-3
    )


def test_the_exponential_goes_as_far_on_average_as_it_says():
    steps = np.arange(-150, 151) * 0.1
    shares = DistanceKernel("exponential", 2.0).on_cells(FINE, (150, 150), own=True)
    away = np.hypot(steps[:, None], steps[None, :])
    assert (shares * away).sum() == pytest.approx(2.0, rel=0.02)


def test_half_of_the_cauchy_jumps_go_beyond_the_root_of_three_scales():
    kernel = DistanceKernel("cauchy", 1.0)
    wide = share_within(kernel, np.sqrt(3.0), np.array([0.5, 0.5]), 600)
    assert wide == pytest.approx(0.5, abs=5e-3)


@pytest.mark.parametrize("shape", ["exponential", "cauchy"])
@pytest.mark.parametrize("wind", [(0.0, 0.0), (4.0, -2.0)])
def test_all_that_leaves_a_plant_lands_once(shape, wind):
    shares = DistanceKernel(shape, 5.0, across=0.5).on_cells(np.array([4.0, 3.0]), (9, 7), wind)
    assert shares.shape == (19, 15)
    assert shares.sum() == pytest.approx(1.0)
    assert shares[9, 7] == 0.0
    assert (shares >= 0.0).all()


def test_without_wind_a_kernel_is_the_same_both_ways():
    shares = DistanceKernel("exponential", 5.0).on_cells(np.array([3.0, 3.0]), (8, 8))
    assert shares == pytest.approx(shares[::-1])
    assert shares == pytest.approx(shares.T)


def test_wind_turns_and_stretches_a_kernel():
    x, y = np.meshgrid(np.arange(-40, 41), np.arange(-40, 41))
    kernel = DistanceKernel("exponential", 6.0)
    calm, along, across = (
        kernel.on_cells(np.array([3.0, 3.0]), (40, 40), wind)
        for wind in ((0.0, 0.0), (3.0, 0.0), (0.0, 3.0))
    )
    assert across == pytest.approx(along.T)
    assert (along * x).sum() > 2.0
    assert (along * y).sum() == pytest.approx(0.0, abs=1e-9)
    assert (along * np.hypot(x, y)).sum() > 1.3 * (calm * np.hypot(x, y)).sum()


def test_rows_can_be_followed():
    x, y = np.meshgrid(np.arange(-30, 31), np.arange(-30, 31))
    along = DistanceKernel("exponential", 6.0, across=0.25).on_cells(np.array([3.0, 3.0]), (30, 30))
    assert (along * np.abs(x)).sum() > 2.5 * (along * np.abs(y)).sum()


def test_a_kernel_far_below_a_plant_s_spacing_goes_to_the_plants_beside_it():
    shares = DistanceKernel("exponential", 1e-3).on_cells(np.array([3.0, 3.0]), (1, 1))
    assert shares.tolist() == [[0.0, 0.25, 0.0], [0.25, 0.0, 0.25], [0.0, 0.25, 0.0]]


@pytest.mark.parametrize(
    "bad", [{"shape": "flat"}, {"scale_m": 0.0}, {"across": -1.0}, {"long_share": 1.5}]
)
def test_impossible_kernels_are_refused(bad):
    with pytest.raises(SettingError):
        DistanceKernel(**{"shape": "cauchy", "scale_m": 1.0, **bad})


def test_both_shapes_are_cut_off_where_the_same_share_of_jumps_is_left():
    left = [
        np.exp(-DistanceKernel("exponential", 4.0).reach_m() / 4.0),
        1.0 / np.hypot(1.0, DistanceKernel("cauchy", 4.0).reach_m() / 4.0),  # of two dimensions
    ]
    assert left[0] == pytest.approx(left[1])
    assert 0.0 < left[0] < 0.1
