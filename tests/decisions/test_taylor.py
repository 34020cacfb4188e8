"""Presence and mean: published sample numbers, and the distribution behind the formula."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from fieldmon.decisions.taylor import TaylorLaw
from fieldmon.errors import SettingError


def test_the_published_number_of_leaves_comes_out():
    """Tollerup et al. 2013: 23 leaves, counted, at five mites a leaf."""
    assert np.ceil(TaylorLaw().leaves_for(5.0, 0.25) - 0.5) == 23


@pytest.mark.parametrize("mean", [0.5, 2.0, 5.0, 20.0])
def test_the_share_infested_is_that_of_a_negative_binomial_of_that_variance(mean):
    law = TaylorLaw(2.5, 1.4)
    k = mean**2 / (law.variance(mean) - mean)
    empty = stats.nbinom(k, k / (k + mean)).pmf(0)
    assert law.share_infested(mean) == pytest.approx(1 - empty)


def test_random_counts_are_poisson():
    assert TaylorLaw(1.0, 1.0).share_infested([0.1, 1.0]) == pytest.approx(1 - np.exp([-0.1, -1]))


@given(st.floats(0.001, 0.97))
def test_the_mean_of_a_share_has_that_share(share):
    law = TaylorLaw()
    assert law.share_infested(law.mean_of(share)) == pytest.approx(share)


def test_what_says_nothing_is_refused():
    with pytest.raises(SettingError, match="all or none are infested"):
        TaylorLaw().mean_of(1.0)
    with pytest.raises(SettingError, match="Taylor's b must be"):
        TaylorLaw(b=0.0)
