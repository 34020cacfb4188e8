"""What a pest and its weather say about records of before."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.pests.degree_days import Thresholds
from fieldmon.pests.development import daily_warmth, whole_generation

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.pests.pest import Pest
    from fieldmon.pests.weather import Weather

# looked back for a generation so far; a record older than that is of another season
_FARTHEST_DAYS = 120
_USUAL_DAYS = PriorSettings().half_life_days


def prior_of_now(
    settings: PriorSettings,
    on: date,
    now: tuple[Pest | None, Weather | None],
    before: tuple[Pest | None, Weather | None] = (None, None),
) -> PriorSettings:
    """Return `prior_for` of the pest and the weather of `now`, unless a half-life was chosen.

    One that is neither the usual nor that of those `before` was chosen, and stays.
    """
    usual = replace(settings, half_life_days=_USUAL_DAYS)
    made = prior_for(usual, *now, on)
    by_pest = usual, prior_for(usual, *before, on)
    return made if settings in by_pest else settings


def prior_for(
    settings: PriorSettings, pest: Pest | None, weather: Weather | None, on: date
) -> PriorSettings:
    """Return how records become chances where the pest and its weather are known.

    A record counts half once another generation sits on the plants: after as many days as the last
    one took, 120 at most. All else stays, and everything where the development or the weather of
    the days before is not known.

    Parameters
    ----------
    settings
        As they are for any pest.
    pest, weather
        What is looked for, and what it met; None: nobody said.
    on
        The day whose chances are asked for.
    """
    if pest is None or weather is None or (whole := whole_generation(pest)) is None:
        return settings
    thresholds = Thresholds(whole.threshold_c, whole.upper_c, pest.cutoff)
    until = on - timedelta(days=1)
    warmth = daily_warmth(weather, thresholds, on - timedelta(days=_FARTHEST_DAYS), until)
    if warmth.guessed.all():
        return settings
    back = np.cumsum(warmth.degree_days[::-1])
    took = int(np.searchsorted(back, whole.degree_days)) + 1
    return replace(settings, half_life_days=float(min(took, _FARTHEST_DAYS)))
