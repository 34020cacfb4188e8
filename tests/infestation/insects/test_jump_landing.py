"""Where jumps land: by Fourier transforms as plant by plant."""

import numpy as np
import pytest

from fieldmon.infestation.insects.jump_landing import landing_of
from fieldmon.plot.layout import rectangle
from tests.infestation.insects.landing_by_hand import LANDING, SHARES, N, by_hand


def test_jumps_land_as_the_kernels_have_it():
    sent = np.random.default_rng(1).random(N)
    mixed = LANDING.mixed(SHARES)
    assert LANDING.landed(sent, mixed) == pytest.approx(sent @ by_hand(SHARES), abs=1e-6)
    back = LANDING.landed(sent, np.conj(mixed))
    assert back == pytest.approx(by_hand(SHARES) @ sent, abs=1e-6)


@pytest.mark.parametrize("corner", [0, 30, 19 * 31, 20 * 31 - 1])
def test_nothing_that_goes_over_an_edge_comes_in_over_the_other(corner):
    """On a plot wider than the kernels reach, which is the case that a small plot cannot show."""
    plot = rectangle(20, 31)
    landing, sent = landing_of(plot), np.zeros(len(plot))
    sent[corner] = 1.0
    kernel, half = np.einsum("k,kij->ij", SHARES, landing.kernels), 12
    y, x = np.divmod(landing.cells.of_plant, landing.cells.shape[1])
    y, x = y - y[corner] + half, x - x[corner] + half
    near = (y >= 0) & (y <= 24) & (x >= 0) & (x <= 24)
    expected = np.zeros(len(plot))
    expected[near] = kernel[y[near], x[near]]
    assert landing.landed(sent, landing.mixed(SHARES)) == pytest.approx(expected, abs=1e-6)


def test_what_is_met_by_each_kernel_is_what_lands_there():
    rng = np.random.default_rng(2)
    sent, there = rng.random((2, 3, N))
    first, all_nights = LANDING.met(sent, there, 1)
    for k in range(8):
        meets = (sent @ by_hand(np.eye(8)[k]) * there).sum(axis=1)
        assert first[k] == pytest.approx(meets[0])
        assert all_nights[k] == pytest.approx(meets.sum())
