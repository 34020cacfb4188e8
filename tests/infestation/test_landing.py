"""Where jumps land: by Fourier transforms as plant by plant."""

import numpy as np
import pytest

from fieldmon.infestation.landing import landing_of
from fieldmon.plot.layout import rectangle

PLOT = rectangle(9, 8)
N = len(PLOT)
LANDING = landing_of(PLOT)
SHARES = np.array([0.3, 0.2, 0.2, 0.1, 0.05, 0.05, 0.05, 0.05])


def by_hand(shares):
    """Return what lands on each plant (columns) of what each sends (rows)."""
    half = LANDING.kernels.shape[1] // 2
    kernel = np.einsum("k,kij->ij", shares, LANDING.kernels)
    y, x = np.divmod(LANDING.cells.of_plant, LANDING.cells.shape[1])
    return kernel[half + y[None, :] - y[:, None], half + x[None, :] - x[:, None]]


def test_jumps_land_as_the_kernels_have_it():
    sent = np.random.default_rng(1).random(N)
    mixed = LANDING.mixed(SHARES)
    assert LANDING.landed(sent, mixed) == pytest.approx(sent @ by_hand(SHARES), abs=1e-12)
    back = LANDING.landed(sent, np.conj(mixed))
    assert back == pytest.approx(by_hand(SHARES) @ sent, abs=1e-12)


def test_what_is_met_by_each_kernel_is_what_lands_there():
    rng = np.random.default_rng(2)
    sent, there = rng.random((2, 3, N))
    for k, met in enumerate(LANDING.met(sent, there)):
        landed = sent @ by_hand(np.eye(8)[k])
        assert met == pytest.approx(float((landed * there).sum()))
