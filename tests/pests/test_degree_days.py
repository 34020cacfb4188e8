"""Degree-days are the area of a day's curve between thresholds, as published."""

from io import StringIO

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.pests.degree_days import Thresholds, degree_days, degree_days_of_hours

#: lows and highs in Fahrenheit of Esparto, California, on days of 2020, and the degree-days between
#: 50 and 70 that the University of California's IPM site gives for them: single and double sine,
#: single and double triangle, each with the horizontal, vertical and intermediate cutoff
#: (Degree Days Validation Challenge, UCANR-IGIS 2021, ucanr-igis.github.io/degree-day-challenge)
PUBLISHED = np.loadtxt(
    StringIO("""
    48 62 5.33 5.33 5.33 6.16 6.16 6.16 5.14 5.14 5.14 6.07 6.07 6.07
    52 73 12.01 7.08 11.52 10.64 6.09 10.19 12.29 9.43 12.07 10.63 8.16 10.44
    44 76 10 4.3 8.88 9.26 3.91 8.2 10 6.25 9.44 8.9 5.56 8.4
    35 68 6.02 6.02 6.02 5.97 5.97 5.97 4.91 4.91 4.91 4.84 4.84 4.84
    58 87 16.57 5.46 10.63 15.58 5.03 9.9 17.52 5.79 12.53 16.63 5.77 12.02
    53 92 14.99 4.17 7.48 15.74 4.51 7.99 16.29 5.01 10.09 16.94 5.01 10.38
    57 96 16.69 4.53 6.89 17.65 4.61 7.3 17.83 4.5 9.17 18.55 4 9.09
    63 101 18.7 4.35 5.4 19.06 4.08 5.37 19.36 3.04 6.71 19.56 2.55 6.38
    61 98 18.07 4.63 6.63 17.91 4.63 6.58 18.91 3.77 8.31 18.79 3.86 8.34
    60 98 17.76 4.62 6.52 17.6 4.6 6.45 18.68 3.95 8.37 18.57 4.02 8.38
    59 103 17.6 4.27 4.27 17.6 4.27 4.27 18.63 3.63 6.25 18.63 3.63 6.25
    59 101 17.54 4.38 5.08 17.84 4.41 5.19 18.56 3.8 7.12 18.77 3.64 7.05
    60 97 17.73 4.69 6.96 18.86 2.34 6.48 18.65 4.05 8.8 19.32 2.03 7.4
    71 103 20 0 3 19.9 1.43 3.55 20 0 3 19.97 0.54 3.69
    68 107 19.81 2.72 2.72 18.9 3.41 3.41 19.95 0.97 2.4 19.44 2.08 3.38
    29 63 3.56 3.56 3.56 4.36 4.36 4.36 2.49 2.49 2.49 3.59 3.59 3.59
    45 67 7.04 7.04 7.04 6.06 6.06 6.06 6.57 6.57 6.57 5.19 5.19 5.19
    """)
)
#: those whose next day is in the table too
FOLLOWED = [0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 15]
CURVES = ("single sine", "double sine", "single triangle", "double triangle")
CUTOFFS = ("horizontal", "vertical", "intermediate")
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
    stopped = np.where(over > 0, 0, above).mean()
    return stopped if thresholds.cutoff == "vertical" else max((above - 2 * over).mean(), stopped)


@pytest.mark.parametrize(("number", "method"), list(enumerate(CURVES)))
@pytest.mark.parametrize(("column", "cutoff"), list(enumerate(CUTOFFS, 2)))
def test_degree_days_are_those_that_the_university_of_california_publishes(
    number, method, column, cutoff
):
    days = FOLLOWED if method.startswith("double") else slice(None)
    made = degree_days(*PUBLISHED.T[:2], Thresholds(50.0, 70.0, cutoff), method)
    assert np.allclose(made[days], PUBLISHED[days, column + 3 * number], atol=0.0051)


@pytest.mark.parametrize(
    ("low", "high", "first", "second"),
    [(10, 20, 15, 15), (-10, 20, 5, 10), (-20, 10, 0, 5), (-10, -1, 0, 0), (0, 1, 0.5, 0.5)],
)
def test_averages_are_the_two_readings_of_one_equation(low, high, first, second):
    """McMaster & Wilhelm 1997: the mean is compared with the base (0 °C), or both extremes are."""
    day = np.array([low]), np.array([high])
    assert degree_days(*day, Thresholds(0.0), "average") == pytest.approx(first)
    assert degree_days(*day, Thresholds(0.0), "clipped average") == pytest.approx(second)


def test_the_two_averages_differ_more_where_there_is_an_upper_threshold():
    """Corn, base 10 and upper threshold 30 °C: a day of 14 to 36 loses its heat by method 2."""
    day, corn = (np.array([14.0]), np.array([36.0])), Thresholds(10.0, 30.0)
    assert degree_days(*day, corn, "average") == pytest.approx(15.0)
    assert degree_days(*day, corn, "clipped average") == pytest.approx(12.0)


temperatures = st.floats(-20, 45)


@given(
    low=temperatures,
    # no thermometer tells a millionth; a vertical cutoff jumps within one
    swing=st.just(0.0) | st.floats(1e-6, 30),
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
