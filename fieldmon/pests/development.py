"""How far a pest has come in the weather that it met: its stage, its next generation."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.pests.degree_days import Thresholds, degree_days, degree_days_of_hours
from fieldmon.pests.usual_days import LEAST_HOURS, UsualDays

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.pests.pest import Pest, Stage
    from fieldmon.pests.weather import Weather

    Floats = NDArray[np.float64]
    Days = NDArray[np.datetime64]

_FARTHEST = 366


@dataclass(frozen=True, eq=False)
class DailyWarmth:
    """Degree-days of each day from one on, and which of them nobody measured.

    Parameters
    ----------
    days
        ``(d,)`` datetime64[D], every day of the stretch.
    degree_days
        ``(d,)`` that each brings.
    guessed
        ``(d,)`` whether it was filled in by the days that stand for it, see `UsualDays`.
    """

    days: Days
    degree_days: Floats
    guessed: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Development:
    """How far a pest has come since a day on which its generation is taken to have begun.

    Parameters
    ----------
    since, on
        That day, and the day that is asked about; both count whole.
    days
        ``(d,)`` datetime64[D] from `since` on, beyond `on` until the next generation.
    degree_days
        ``(d,)`` gathered until each evening.
    guessed
        ``(d,)`` whether the day's weather was filled in.
    threshold_c, per_generation
        Above which temperature they are counted, and how many a generation needs.
    stage
        The stage that those of `since` are in on the evening of `on`; empty: not known.
    next_generation
        The day on which the next generation is complete; None: not within a year.
    """

    since: date
    on: date
    days: Days
    degree_days: Floats
    guessed: NDArray[np.bool_]
    threshold_c: float
    per_generation: float
    stage: str
    next_generation: date | None

    @property
    def elapsed(self) -> int:
        """Return how many of the days have passed by the evening of `on`."""
        return int(np.searchsorted(self.days, np.datetime64(self.on, "D"), side="right"))

    @property
    def so_far(self) -> float:
        """Return the degree-days gathered until the evening of `on`."""
        return float(self.degree_days[self.elapsed - 1]) if self.elapsed else 0.0

    @property
    def generations(self) -> float:
        """Return how many generations have passed since `since`, parts included."""
        return self.so_far / self.per_generation

    def sentence(self) -> Worded:
        """Return where it stands, in words."""
        known = {
            "degree_days": self.so_far,
            "threshold": self.threshold_c,
            "since": self.since,
            "needed": self.per_generation,
        }
        if self.next_generation is None:
            return worded(
                "{degree_days:.0f} degree-days above {threshold:g} °C since {since} of {needed:g} "
                "a generation: at this warmth the next is more than a year away.",
                **known,
            )
        return worded(
            "{degree_days:.0f} degree-days above {threshold:g} °C since {since} of {needed:g} a "
            "generation: the next around {when}.",
            **known,
            when=self.next_generation,
        )


def daily_warmth(weather: Weather, thresholds: Thresholds, since: date, until: date) -> DailyWarmth:
    """Return the degree-days of each day from `since` to `until`, gaps filled and marked.

    Hours count as they are. Days count by the single sine; those of which only a mean is known by
    it. Without any day that is known, nothing is gathered.
    """
    measured, warmth = _measured(weather, thresholds)
    days = np.arange(np.datetime64(since, "D"), np.datetime64(until, "D") + 1)
    known = ~np.isnan(warmth)
    if not known.any():
        return DailyWarmth(days, np.zeros(len(days)), np.ones(len(days), np.bool_))
    usual, values = UsualDays(measured[known]), warmth[known]
    made = np.array([usual.of(day).mean(values) for day in days])
    return DailyWarmth(days, made, ~np.isin(days, usual.known))


def _measured(weather: Weather, thresholds: Thresholds) -> tuple[Days, Floats]:
    """Return the local days of a weather and the degree-days of each, NaN where not known."""
    days = weather.local_days()
    if not weather.hourly:
        low = np.where(np.isnan(weather.low_c), weather.temperature_c, weather.low_c)
        high = np.where(np.isnan(weather.high_c), weather.temperature_c, weather.high_c)
        return days, degree_days(low, np.maximum(low, high), thresholds)
    each = degree_days_of_hours(weather.temperature_c, thresholds)
    known = ~np.isnan(each)
    distinct, of_day = np.unique(days, return_inverse=True)
    n = np.bincount(of_day[known], minlength=len(distinct))
    total = np.bincount(of_day[known], each[known], minlength=len(distinct))
    # a day of 23 or 25 hours is a day, and so is one that lacks a few
    whole = np.where(n >= LEAST_HOURS, total * 24 / np.maximum(n, 1), np.nan)
    return distinct, whole


def development(pest: Pest, weather: Weather, since: date, on: date) -> Development | None:
    """Return how far a pest has come on a day; None where its development is not known.

    Parameters
    ----------
    pest
        With `stages` or a `generation`.
    weather
        By hours or days.
    since
        When its generation is taken to have begun: eggs of that day.
    on
        The day that is asked about.
    """
    whole = whole_generation(pest)
    if whole is None:
        return None
    farthest = max(on, since) + timedelta(days=_FARTHEST)
    warmth = daily_warmth(weather, _thresholds(pest, whole), since, farthest)
    gathered = np.cumsum(warmth.degree_days)
    today = int(np.searchsorted(warmth.days, np.datetime64(on, "D"), side="right"))
    so_far = float(gathered[today - 1]) if today else 0.0
    wanted = (np.floor(so_far / whole.degree_days) + 1) * whole.degree_days
    comes = int(np.searchsorted(gathered, wanted))
    found = comes < len(gathered)
    shown = comes + 1 if found else max(today, 1)
    return Development(
        since,
        on,
        warmth.days[:shown],
        gathered[:shown],
        warmth.guessed[:shown],
        whole.threshold_c,
        whole.degree_days,
        _stage_on(pest, weather, since, on),
        warmth.days[comes].astype(date) if found else None,
    )


def whole_generation(pest: Pest) -> Stage | None:
    """Return a generation as one stage: the published one, or all stages if they share a threshold.

    Where thresholds differ and nobody published the whole, it is counted above their mean, each
    stage weighing as much as it needs, to a tenth of a degree or to as many digits as theirs have.
    Below the mean of their upper thresholds, likewise: so no stage counts for all (our choice). A
    stage without one never stops, and then a generation has none.
    """
    if pest.generation is not None or not pest.stages:
        return pest.generation
    needs = np.array([stage.degree_days for stage in pest.stages])
    lower_c = _mean_c([stage.threshold_c for stage in pest.stages], needs)
    uppers = [stage.upper_c for stage in pest.stages if stage.upper_c is not None]
    upper_c = _mean_c(uppers, needs) if len(uppers) == len(needs) else None
    return replace(pest.stages[0], name="generation", threshold_c=lower_c, upper_c=upper_c,
                   degree_days=float(needs.sum()))  # fmt: skip


def _mean_c(thresholds_c: list[float], needs: NDArray[np.float64]) -> float:
    """Return the mean threshold of stages, each weighing as much as it needs."""
    digits = max(len(f"{one:g}".partition(".")[2]) for one in thresholds_c)
    return round(float(np.average(thresholds_c, weights=needs)), max(digits, 1))


def _thresholds(pest: Pest, stage: Stage) -> Thresholds:
    return Thresholds(stage.threshold_c, stage.upper_c, pest.cutoff)


def _stage_on(pest: Pest, weather: Weather, since: date, on: date) -> str:
    """Return the stage of those that were eggs on `since`, each by its own threshold."""
    if not pest.stages or on < since:
        return ""
    warmth = [
        daily_warmth(weather, _thresholds(pest, stage), since, on).degree_days
        for stage in pest.stages
    ]
    at, left = 0, pest.stages[0].degree_days
    for day in range(len(warmth[0])):
        share = 1.0
        while share > 0.0:
            brings = warmth[at][day] * share
            if brings < left:
                left -= brings
                break
            share *= 1.0 - left / brings
            at = (at + 1) % len(pest.stages)
            left = pest.stages[at].degree_days
    return pest.stages[at].name
