"""Degree-days are the area of a day's curve between thresholds, as published."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.pests.degree_days import Thresholds, degree_days, degree_days_of_hours

TURN = (np.arange(20_000) + 0.5) / 20_000


def curve(shape, low, high):
    """Return a day's temperatures from low to high and back, by many moments."""
    if shape == "sine":
        return (low + high) / 2 + (high - low) / 2 * np.sin(2 * np.pi * TURN)
    return low + (high - low) * (1 - np.abs(2 * TURN - 1))


def developing(temperature, thresholds):
    """Return what each moment brings, written out from Zalom's words."""
    above = np.clip(temperature - thresholds.lower_c, 0, None)
    if thresholds.upper_c is None:
        return above.mean()
    over = np.clip(temperature - thresholds.upper_c, 0, None)
    if thresholds.cutoff == "horizontal":
        return (above - over).mean()
    if thresholds.cutoff == "vertical":
        return np.where(over > 0, 0, above).mean()
    return max((above - 2 * over).mean(), 0)


temperatures = st.floats(-20, 45)


@given(
    low=temperatures,
    swing=st.floats(0, 30),
    lower=st.floats(0, 20),
    above=st.floats(0.5, 25),
    shape=st.sampled_from(["sine", "triangle"]),
    cutoff=st.sampled_from([None, "horizontal", "vertical", "intermediate"]),
)
def test_a_day_is_the_area_of_its_curve_between_the_thresholds(
    low, swing, lower, above, shape, cutoff
):
    thresholds = Thresholds(lower) if cutoff is None else Thresholds(lower, lower + above, cutoff)
    (made,) = degree_days(np.array([low]), np.array([low + swing]), thresholds, f"single {shape}")
    moments = curve(shape, low, low + swing)
    # a vertical cutoff falls from its whole height: one moment of the sum may be on either side
    assert made == pytest.approx(developing(moments, thresholds), abs=3e-3 + above / 10_000)


@pytest.mark.parametrize("shape", ["sine", "triangle"])
def test_a_double_curve_is_half_of_each_half(shape):
    low, high = np.array([5.0, 12.0, 3.0]), np.array([25.0, 20.0, 22.0])
    thresholds = Thresholds(10.0, 21.0, "horizontal")
    made = degree_days(low, high, thresholds, f"double {shape}")
    for day, following in enumerate([12.0, 3.0, 3.0]):
        halves = [curve(shape, low[day], high[day]), curve(shape, following, high[day])]
        wanted = sum(developing(half, thresholds) for half in halves) / 2
        assert made[day] == pytest.approx(wanted, abs=1e-3)


def test_days_of_hours_add_up_to_the_days_mean_above_the_threshold():
    hours = np.linspace(4.0, 27.0, 24)
    made = degree_days_of_hours(hours, Thresholds(10.0)).sum()
    assert made == pytest.approx(np.clip(hours - 10.0, 0, None).mean())


def test_a_day_without_a_low_has_no_degree_days():
    made = degree_days(np.array([np.nan, 10.0]), np.array([20.0, 20.0]), Thresholds(5.0))
    assert np.isnan(made[0])
    assert made[1] == pytest.approx(10.0)


def test_a_high_below_its_low_is_refused_with_its_day():
    with pytest.raises(SettingError, match="of day 2 they are 9 and 10 °C"):
        degree_days(np.array([1.0, 10.0]), np.array([5.0, 9.0]), Thresholds(5.0))


def test_a_method_that_is_none_is_refused():
    with pytest.raises(SettingError, match="'cosine'"):
        degree_days(np.array([1.0]), np.array([5.0]), Thresholds(5.0), "cosine")


def test_an_upper_threshold_below_the_lower_one_is_refused():
    with pytest.raises(SettingError, match="above the lower one"):
        Thresholds(12.0, 10.0)
