"""From what a raster shows at each plant to a chance of infestation.

A raster seldom holds chances: what its numbers mean must be said. Chances and percent are taken as
they are; of anything else (NDVI, canopy temperature, elevation) only the order or the distance
from the average speaks, and how many plants are infested by this way must be stated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np
from scipy.special import expit

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, ObservationError, SettingError
from fieldmon.infestation.prior.prior import scaled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Meaning: TypeAlias = Literal["chance", "percent", "rank", "score"]
_MOST_SCORE = 4.0
#: meanings that say which plants are at more risk, but not at how much
RELATIVE = frozenset({"rank", "score"})
#: what a chance map written by fieldmon calls its band
CHANCE_BAND = "chance of infestation"


@dataclass(frozen=True)
class RiskSettings:
    """What the numbers of a risk raster mean.

    Parameters
    ----------
    meaning
        ``"chance"``: chances in 0..1. ``"percent"``: chances in 0..100. ``"rank"``: only the order
        of the plants counts; a plant's odds are those of its place in it (that before 90 % of the
        others has 9 times the odds of the middle one). ``"score"``: each standard deviation above
        the average multiplies the odds by e, 2.7 (up to 4 of them count).
    mean_share
        With rank and score: share of the plants infested for this reason; all odds are multiplied
        by one number so that the chances have this mean.
    low_is_risky
        With rank and score: low values are the risky ones, as of a vegetation index.
    """

    meaning: Meaning
    mean_share: float | None = None
    low_is_risky: bool = False

    def __post_init__(self) -> None:
        if self.meaning not in get_args(Meaning):
            raise SettingError(
                worded(
                    "What a risk raster means must be one of {names}, but it is {meaning!r}.",
                    names=", ".join(get_args(Meaning)),
                    meaning=self.meaning,
                )
            )
        relative = self.meaning in RELATIVE
        if relative and self.mean_share is None:
            raise SettingError(
                worded(
                    "A {meaning} says which plants are at more risk, but not "
                    "at how much: state the mean_share of plants infested for "
                    "this reason, for instance 0.02.",
                    meaning=self.meaning,
                )
            )
        if not relative and (self.mean_share is not None or self.low_is_risky):
            raise SettingError(
                worded(
                    "A {meaning} is taken as it is: mean_share and "
                    "low_is_risky go with rank and score only.",
                    meaning=self.meaning,
                )
            )
        if self.mean_share is not None and not 0.0 < self.mean_share < 1.0:
            raise SettingError(
                worded(
                    "The mean_share of a risk must be between 0 and 1, but it is {mean_share}.",
                    mean_share=self.mean_share,
                )
            )


def meaning_of(name: str, values: Floats, described: str = "") -> RiskSettings:
    """Return what a raster's numbers mean by what its band is called.

    Parameters
    ----------
    name
        What the raster is called.
    values
        ``(n,)`` at the plants.
    described
        What its file calls the band.

    Raises
    ------
    ChoiceNeeded
        If the file does not say it.
    """
    known = values[~np.isnan(values)]
    if described.strip().casefold() == CHANCE_BAND or not known.size:
        return RiskSettings("chance")
    low, high = float(known.min()), float(known.max())
    whole = {"chance": 1.0, "percent": 100.0}
    could = [one for one, most in whole.items() if low >= 0.0 and high <= most]
    raise ChoiceNeeded(
        worded(
            "The numbers of {name} are {low:.3g} to {high:.3g} at the plants, but nothing says "
            "what they mean: chance (0..1), percent, rank (only their order counts) or score. "
            "Say which.",
            name=name,
            low=low,
            high=high,
        ),
        "meaning",
        ("rank", "score", *could),
    )


def risk_chance(values: Floats, settings: RiskSettings) -> Floats:
    """Return chances ``(n,)`` in 0..1 from a raster's values at the plants; NaN stays NaN.

    Raises
    ------
    ObservationError
        If no plant has a value, or values are not what they are said to mean.
    """
    known = ~np.isnan(values)
    if not known.any():
        raise ObservationError(
            worded(
                "A risk raster must have a value at one plant at least, but "
                "it has none. Choose a raster that covers the plot."
            )
        )
    chance = np.full(len(values), np.nan)
    chance[known] = _chances(values[known], settings)
    return chance


def _chances(values: Floats, settings: RiskSettings) -> Floats:
    if settings.mean_share is None:
        whole = 100.0 if settings.meaning == "percent" else 1.0
        if values.min() < 0.0 or values.max() > whole:
            raise ObservationError(
                worded(
                    "A raster of {meaning} must hold values in 0..{whole:g}, "
                    "but at the plants they run from {low:.6g} to {high:.6g}. "
                    "Say what they mean: percent, rank or score.",
                    meaning=settings.meaning,
                    whole=whole,
                    low=values.min(),
                    high=values.max(),
                )
            )
        return values / whole
    upward = -values if settings.low_is_risky else values
    if settings.meaning == "rank":
        from scipy.stats import rankdata  # noqa: PLC0415 - half a second to import

        odds: Floats = (rankdata(upward) - 0.5) / len(upward)
    else:
        spread = float(upward.std())
        scores = (upward - upward.mean()) / spread if spread > 0.0 else np.zeros(len(upward))
        odds = expit(np.clip(scores, -_MOST_SCORE, _MOST_SCORE))
    return scaled(odds, settings.mean_share)
