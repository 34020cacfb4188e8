"""Where jumps land: by Fourier transforms as plant by plant."""

import numpy as np
import pytest

from tests.infestation.landing_by_hand import LANDING, SHARES, N, by_hand


def test_jumps_land_as_the_kernels_have_it():
    sent = np.random.default_rng(1).random(N)
    mixed = LANDING.mixed(SHARES)
    assert LANDING.landed(sent, mixed) == pytest.approx(sent @ by_hand(SHARES), abs=1e-12)
    back = LANDING.landed(sent, np.conj(mixed))
    assert back == pytest.approx(by_hand(SHARES) @ sent, abs=1e-12)


def test_what_is_met_by_each_kernel_is_what_lands_there():
    rng = np.random.default_rng(2)
    sent, there = rng.random((2, 3, N))
    first, all_nights = LANDING.met(sent, there, 1)
    for k in range(8):
        meets = (sent @ by_hand(np.eye(8)[k]) * there).sum(axis=1)
        assert first[k] == pytest.approx(meets[0])
        assert all_nights[k] == pytest.approx(meets.sum())
