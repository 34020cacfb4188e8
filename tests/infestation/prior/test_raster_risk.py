import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.prior.raster_risk import RiskSettings, risk_chance

VALUES = arrays(
    np.float64, st.integers(2, 60), elements=st.floats(-1e6, 1e6, allow_nan=False, width=32)
)
RELATIVE = st.sampled_from(["rank", "score"])


def odds(chance):
    return chance / (1 - chance)


def test_chances_and_percent_are_taken_as_they_are_and_unknown_stays_unknown():
    values = np.array([0.0, 0.25, np.nan, 1.0])
    np.testing.assert_array_equal(risk_chance(values, RiskSettings("chance")), values)
    percent = RiskSettings(meaning="percent")
    np.testing.assert_array_equal(risk_chance(100 * values, percent), values)


@given(VALUES, RELATIVE, st.floats(0.001, 0.5))
def test_rank_and_score_keep_the_order_and_the_stated_mean(values, meaning, share):
    chance = risk_chance(values, RiskSettings(meaning, share))
    assert chance.mean() == pytest.approx(share, rel=1e-6)
    order = np.argsort(values)
    assert (np.diff(chance[order]) >= -1e-12).all()
    low = risk_chance(values, RiskSettings(meaning, share, low_is_risky=True))
    assert (np.diff(low[order]) <= 1e-12).all()


@given(VALUES, st.floats(0.001, 0.5))
def test_a_rank_hears_only_the_order(values, share):
    settings = RiskSettings("rank", share)
    cubed = np.sign(values) * np.abs(values.astype(np.float64)) ** 3
    assume(np.unique(values).size == np.unique(cubed).size)  # tiny ones vanish in the cube
    np.testing.assert_allclose(risk_chance(values, settings), risk_chance(cubed, settings))


def test_a_rank_before_90_percent_has_9_times_the_odds_of_the_middle():
    chance = risk_chance(np.arange(1001.0), RiskSettings("rank", 0.05))
    ratio = odds(chance[900]) / odds(chance[500])
    assert ratio == pytest.approx(9.0, rel=0.01)


def test_a_standard_deviation_multiplies_the_odds_by_e():
    values = np.tile([-1.0, 1.0], 50)
    chance = risk_chance(values, RiskSettings("score", 0.05))
    assert odds(chance[1]) / odds(chance[0]) == pytest.approx(np.e**2)


def test_where_all_values_are_equal_so_are_the_chances():
    for meaning in ("rank", "score"):
        chance = risk_chance(np.full(7, 3.0), RiskSettings(meaning, 0.03))
        np.testing.assert_allclose(chance, 0.03)


@pytest.mark.parametrize(
    ("values", "settings", "words"),
    [
        ([0.2, 1.01], RiskSettings("chance"), "0..1"),
        ([-0.1, 0.5], RiskSettings("chance"), "run from -0.1 to 0.5"),
        ([20.0, 101.0], RiskSettings("percent"), "0..100"),
        ([np.nan, np.nan], RiskSettings("chance"), "has none"),
    ],
)
def test_values_that_do_not_mean_it_are_refused(values, settings, words):
    with pytest.raises(ObservationError, match=words):
        risk_chance(np.array(values), settings)


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ({"meaning": "ndvi"}, "chance, percent, rank, score"),
        ({"meaning": "rank"}, "state the mean_share"),
        ({"meaning": "score", "mean_share": 1.0}, "between 0 and 1"),
        ({"meaning": "chance", "mean_share": 0.1}, "taken as it is"),
        ({"meaning": "percent", "low_is_risky": True}, "taken as it is"),
    ],
)
def test_what_a_raster_means_must_be_said_in_full(said, words):
    with pytest.raises(SettingError, match=words):
        RiskSettings(**said)
