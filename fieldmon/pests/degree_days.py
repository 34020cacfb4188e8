"""Degree-days: how much warmth a day has between a lower and an upper threshold.

After Zalom, Goodell, Wilson, Barnett & Bentley 1983, Degree-days: the calculation and use of heat
units in pest management (University of California leaflet 21373). A day is a curve between its low
and its high; degree-days are the area of the curve above the threshold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.pests.pest import Cutoff

    Floats = NDArray[np.float64]

# a day that swings less is flat
_FLAT_C = 1e-9
#: how a day goes between its low and its high
DegreeDayMethod = Literal[
    "single sine", "double sine", "single triangle", "double triangle", "average", "clipped average"
]


@dataclass(frozen=True)
class Thresholds:
    """Between which temperatures a pest develops, and what happens above.

    Parameters
    ----------
    lower_c, upper_c
        No development below; above `upper_c` as `cutoff` says. None: no upper one.
    cutoff
        ``"horizontal"``: as at the upper threshold. ``"vertical"``: none above it.
        ``"intermediate"``: slower by as much as it is warmer.
    """

    lower_c: float
    upper_c: float | None = None
    cutoff: Cutoff = "horizontal"

    def __post_init__(self) -> None:
        if self.upper_c is not None and self.upper_c <= self.lower_c:
            raise SettingError(
                worded(
                    "An upper threshold must be above the lower one ({lower_c:g} °C), but it is "
                    "{upper_c:g} °C.",
                    lower_c=self.lower_c,
                    upper_c=self.upper_c,
                )
            )


def degree_days(
    low_c: Floats,
    high_c: Floats,
    thresholds: Thresholds,
    method: DegreeDayMethod = "single sine",
) -> Floats:
    """Return the degree-days of each day, ``(n,)``, NaN where a low or a high is.

    Parameters
    ----------
    low_c, high_c
        ``(n,)`` the extremes of days that follow each other. The double methods take the second
        half of a day to the low of the next; that of the last day to its own.
    thresholds
        Between which temperatures it develops.
    method
        ``"single sine"``, ``"double sine"``, ``"single triangle"``, ``"double triangle"``: the
        area under such curves. ``"average"``: of low and high, as it is; ``"clipped average"``:
        of low and high brought between the thresholds first (methods 1 and 2 of McMaster &
        Wilhelm 1997, Agricultural and Forest Meteorology 87:291-300).

    Raises
    ------
    SettingError
        If the method is not known, or a high is below its low.

    Examples
    --------
    >>> import numpy as np
    >>> degree_days(np.array([10.0]), np.array([30.0]), Thresholds(10.0), "average")
    array([10.])
    """
    low, high = np.atleast_1d(np.asarray(low_c, float)), np.atleast_1d(np.asarray(high_c, float))
    if method not in get_args(DegreeDayMethod):
        raise SettingError(
            worded(
                "Degree-days must be counted by one of {names}, but the method is {method!r}.",
                names=", ".join(get_args(DegreeDayMethod)),
                method=method,
            )
        )
    if (wrong := np.flatnonzero(high < low)).size:
        day = int(wrong[0])
        raise SettingError(
            worded(
                "A day's high must not be below its low, but of day {day} they are {high:g} "
                "and {low:g} °C.",
                day=day + 1,
                high=high[day],
                low=low[day],
            )
        )
    if method.endswith("average"):
        return _averages(low, high, thresholds, clipped=method.startswith("clipped"))
    curve = _sine if method.endswith("sine") else _triangle
    if method.startswith("single"):
        return _between(low, high, thresholds, curve)
    following = np.append(low[1:], low[-1:])
    # a night may be warmer than the next day: the way to its low is the same, whichever is above
    second = np.minimum(high, following), np.maximum(high, following)
    return (_between(low, high, thresholds, curve) + _between(*second, thresholds, curve)) / 2


def degree_days_of_hours(temperature_c: Floats, thresholds: Thresholds) -> Floats:
    """Return the degree-days that each hour brings, ``(n,)``: one 24th of its warmth."""
    return _averages(temperature_c, temperature_c, thresholds, clipped=True) / 24


def _between(low: Floats, high: Floats, thresholds: Thresholds, curve: _Curve) -> Floats:
    above, _ = curve(low, high, thresholds.lower_c)
    if thresholds.upper_c is None:
        return above
    over, share = curve(low, high, thresholds.upper_c)
    if thresholds.cutoff == "horizontal":
        return above - over
    stopped = np.maximum(above - over - share * (thresholds.upper_c - thresholds.lower_c), 0.0)
    if thresholds.cutoff == "vertical":
        return stopped
    # slower, but never slower than if it stopped
    return np.maximum(above - 2 * over, stopped)


def _sine(low: Floats, high: Floats, above_c: float) -> tuple[Floats, Floats]:
    """Return the area of a sine above a temperature, and the share of the day it is above it."""
    mean, swing = (low + high) / 2, (high - low) / 2
    swings = swing > _FLAT_C
    height = np.clip((above_c - mean) / np.where(swings, swing, 1.0), -1.0, 1.0)
    height = np.where(swings, height, np.where(above_c < mean, -1.0, 1.0))
    angle = np.arcsin(height)
    share = 0.5 - angle / np.pi
    area = (mean - above_c) * share + swing * np.cos(angle) / np.pi
    return np.where(low >= above_c, mean - above_c, area), share


def _triangle(low: Floats, high: Floats, above_c: float) -> tuple[Floats, Floats]:
    """Return the same of a triangle."""
    swing = high - low
    swings = swing > _FLAT_C
    share = np.clip((high - above_c) / np.where(swings, swing, 1.0), 0.0, 1.0)
    share = np.where(swings, share, np.where(above_c < low, 1.0, 0.0))
    area = share * (high - above_c) / 2
    return np.where(low >= above_c, (low + high) / 2 - above_c, np.maximum(area, 0.0)), share


def _averages(low: Floats, high: Floats, thresholds: Thresholds, *, clipped: bool) -> Floats:
    lower, upper = thresholds.lower_c, thresholds.upper_c
    if clipped:
        low, high = (_developing(one, thresholds) for one in (low, high))
        return (low + high) / 2 - lower
    mean = (low + high) / 2
    return (_developing(mean, thresholds) if upper is not None else np.maximum(mean, lower)) - lower


def _developing(temperature: Floats, thresholds: Thresholds) -> Floats:
    """Return temperatures as development has them: none below the lower threshold."""
    lower, upper = thresholds.lower_c, thresholds.upper_c
    if upper is not None:
        warmer = np.maximum(temperature - upper, 0.0)
        if thresholds.cutoff == "vertical":
            temperature = np.where(warmer > 0, lower, temperature)
        else:
            slower = {"horizontal": 1.0, "intermediate": 2.0}[thresholds.cutoff]
            temperature = temperature - slower * warmer
    return np.maximum(temperature, lower)


if TYPE_CHECKING:
    from collections.abc import Callable

    _Curve = Callable[[Floats, Floats, float], tuple[Floats, Floats]]
