"""Presence and mean: published sample numbers, and the distribution behind the formula."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from fieldmon.decisions.taylor import PUBLISHED_LAWS, EmptyLeaves, TaylorLaw, mean_band
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


def test_at_the_mean_where_it_says_so_a_published_law_is_random():
    """Raworth 1986: during harvest counts are Poisson at 0.0644 mites a leaflet."""
    law = PUBLISHED_LAWS[2].law
    assert law.variance(0.0644) == pytest.approx(0.0644, rel=0.01)


def test_the_band_of_a_share_holds_what_each_law_says_and_narrows_with_leaves():
    few, many = mean_band(50, 20), mean_band(5000, 2000)
    for one in PUBLISHED_LAWS:
        assert many.low < one.law.mean_of(0.4) < many.high
    assert few.low < many.low < many.mean < many.high < few.high
    one_law = mean_band(5000, 2000, PUBLISHED_LAWS[:1])
    assert one_law.high / one_law.low < 1.2 < many.high / many.low


def samples(rng, n, scatter):
    """Return means and empty shares of samples about a line of ln m on ln(-ln P)."""
    x = rng.uniform(-2.0, 1.0, n)
    return np.exp(1.2 + 1.4 * x + rng.normal(0.0, scatter, n)), np.exp(-np.exp(x))


def test_the_line_of_samples_is_found():
    line = EmptyLeaves.fitted(*samples(np.random.default_rng(1), 40, 1e-6))
    assert (line.intercept, line.slope) == pytest.approx((1.2, 1.4), abs=1e-4)


def test_its_interval_holds_a_new_fields_mean_as_often_as_it_says():
    """All four terms of the spread: without the fields' own scatter it would hold far fewer."""
    rng, held = np.random.default_rng(2), []
    for _ in range(400):
        line = EmptyLeaves.fitted(*samples(rng, 15, 0.4))
        mean, empty = samples(rng, 1, 0.4)
        infested = int(np.clip(rng.binomial(100, 1 - empty[0]), 1, 99))
        band = line.mean_band(100, infested)
        held.append(band.low <= mean[0] <= band.high)
    assert np.mean(held) == pytest.approx(0.9, abs=0.05)


def test_what_says_nothing_of_a_mean_is_refused():
    with pytest.raises(SettingError, match="three samples or more"):
        EmptyLeaves.fitted([1.0, 2.0], [0.5, 0.4])
    with pytest.raises(SettingError, match="some must be infested"):
        mean_band(20, 20)
