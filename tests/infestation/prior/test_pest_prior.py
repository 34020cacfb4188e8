"""Records count half once another generation sits on the plants."""

from datetime import date

import numpy as np

from fieldmon.infestation.prior.pest_prior import prior_for
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.pests.weather import DAY_S, weather_of

MITE, ON = shipped_pest("spider-mite"), date(2026, 11, 18)


def days(temperature_c, n=60):
    at = np.datetime64(ON, "D") - n + np.arange(n)
    return weather_of(
        at.astype("datetime64[s]"), DAY_S, temperature_c=np.full(n, float(temperature_c))
    )


def test_the_half_life_is_the_generation_before():
    """146.48 degree-days above 12.5 °C take 15 days at 22.5 °C, 8.4 at 30."""
    usual = PriorSettings(background_chance=0.02)
    mild = prior_for(usual, MITE, days(22.5), ON)
    assert mild == PriorSettings(background_chance=0.02, half_life_days=15.0)
    assert prior_for(usual, MITE, days(30), ON).half_life_days == 9
    # where it stays cold nothing follows for a season
    assert prior_for(usual, MITE, days(5), ON).half_life_days == 120


def test_without_pest_weather_or_development_all_stays():
    usual, warm = PriorSettings(), days(25)
    assert prior_for(usual, None, warm, ON) is usual
    assert prior_for(usual, MITE, None, ON) is usual
    assert prior_for(usual, shipped_pest("plum-pox-virus"), warm, ON) is usual
    later = weather_of(
        np.array(["2027-06-01"], "datetime64[s]"), DAY_S, temperature_c=np.array([20.0])
    )
    assert prior_for(usual, MITE, later, ON) is usual


def test_weather_of_the_day_itself_and_of_days_to_come_does_not_count():
    usual, before = PriorSettings(), days(22.5)
    at = np.concatenate([before.at, np.datetime64(ON, "s") + np.arange(3) * DAY_S])
    warm = np.concatenate([before.temperature_c, np.full(3, 31.0)])
    assert prior_for(usual, MITE, weather_of(at, DAY_S, temperature_c=warm), ON) == (
        prior_for(usual, MITE, before, ON)
    )
