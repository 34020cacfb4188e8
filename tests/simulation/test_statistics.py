"""Means and ratios, and their intervals."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import stats

from fieldmon.simulation.statistics import (
    half_interval,
    paired_ratio,
    summary_statistics,
    too_few_sentence,
)


def test_the_interval_is_students():
    values = np.array([3.0, 5.0, 4.0, 9.0, math.nan, 2.0])
    ours = summary_statistics(values)
    known = values[~np.isnan(values)]
    low, high = stats.t.interval(0.95, 4, known.mean(), stats.sem(known))
    assert (ours.low, ours.high) == pytest.approx((low, high))
    assert ours.replicates == 5


@given(arrays(float, st.integers(2, 30), elements=st.floats(-1e6, 1e6)))
def test_mean_and_quantiles_lie_between_the_ends(values):
    ours = summary_statistics(values)
    slack = 1e-9 * max(1.0, np.abs(values).max())
    assert values.min() - slack <= ours.q05 <= ours.q95 <= values.max() + slack
    assert ours.low - slack <= ours.mean <= ours.high + slack
    assert ours.sd == pytest.approx(values.std(ddof=1), abs=slack)


def test_one_value_has_no_interval_none_has_no_mean_and_equal_ones_no_spread():
    assert math.isnan(summary_statistics(np.array([3.0, math.nan])).low)
    assert math.isnan(summary_statistics(np.array([math.nan])).mean)
    tenths = summary_statistics(np.full(400, 52.8))
    assert (tenths.mean, tenths.sd, tenths.low) == (52.8, 0.0, 52.8)


def test_the_interval_holds_the_mean_as_often_as_it_says():
    rng = np.random.default_rng(1)
    inside = [
        (e := summary_statistics(rng.normal(5, 2, 8))).low <= 5 <= e.high for _ in range(2000)
    ]
    assert np.mean(inside) == pytest.approx(0.95, abs=0.02)


def test_half_an_interval_is_that_of_every_column():
    values = np.random.default_rng(2).normal(size=(7, 3))
    half = half_interval(values.std(axis=0, ddof=1), 7)
    for k in range(3):
        ours = summary_statistics(values[:, k])
        assert half[k] == pytest.approx((ours.high - ours.low) / 2)


def test_so_many_values_are_counted_and_from_two_on_there_is_an_interval():
    one, two = (summary_statistics(np.array(values)) for values in ([3.0], [3.0, 5.0]))
    assert (one.replicates, two.replicates) == (1, 2)
    # Student's t of one degree of freedom: 12.706 (ISO 2602), times sd / sqrt(2) = 1
    assert (two.low, two.high) == pytest.approx((4.0 - 12.706, 4.0 + 12.706), abs=1e-3)
    assert (two.sd, two.mean) == pytest.approx((2**0.5, 4.0))


def test_a_ratio_of_twice_as_much_is_two_and_its_interval_holds_it():
    values = np.random.default_rng(1).gamma(2.0, size=40)
    twice = paired_ratio(2 * values, values)
    assert (twice.value, twice.low, twice.high) == pytest.approx((2.0, 2.0, 2.0))
    noisy = paired_ratio(2 * np.random.default_rng(2).gamma(2.0, size=40), values)
    assert noisy.low < 2.0 < noisy.high
    assert str(twice) == "2.00 (2.00-2.00)"


def test_one_season_has_a_ratio_without_interval():
    alone = paired_ratio(np.array([3.0]), np.array([6.0]))
    assert (alone.value, str(alone)) == (0.5, "0.50")
    assert math.isnan(alone.low)
    assert math.isnan(alone.high)


def test_of_nothing_there_is_no_ratio_and_seasons_of_nothing_do_not_widen_its_interval():
    nothing = np.zeros(3)
    assert str(paired_ratio(nothing, nothing)) == "0 of 0"
    some = np.array([0.0, 4.0, 0.0])
    same = paired_ratio(some, some)
    assert (same.value, same.low, same.high) == (1.0, 1.0, 1.0)


def test_over_one_who_lost_nothing_a_ratio_is_infinite():
    some, nothing = np.array([3.0, 4.0]), np.zeros(2)
    over = paired_ratio(some, nothing)
    assert (over.value, over.low, over.high) == (math.inf, math.inf, math.inf)
    assert str(over) == "infinite"
    at_times = paired_ratio(np.array([3.0, 4.0, 5.0]), np.array([0.0, 0.0, 1.0]))
    assert (at_times.value, at_times.high) == (12.0, math.inf)
    assert str(at_times) == f"12.00 ({at_times.low:.2f}-infinite)"
    assert str(paired_ratio(nothing, some)) == "0.00 (0.00-0.00)"


def test_only_fewer_than_twenty_seasons_are_said_to_be_too_few():
    assert too_few_sentence(20, "--seeds") == ""
    assert too_few_sentence(19, "--seeds").startswith("With 19 seasons")
