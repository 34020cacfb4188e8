"""What the replicates of a measure say: mean, interval and spread, and ratios of paired ones."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from scipy.special import stdtrit

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TWO_SIDED_95 = 0.975
_RESAMPLES = 2000
# so many seasons before an interval drawn from them means what it says (our choice)
_ENOUGH = 20
Number = TypeVar("Number", float, "NDArray[np.float64]")


@dataclass(frozen=True)
class SummaryStatistics:
    """How the replicates of one measure lie; NaN where there are too few to tell.

    Parameters
    ----------
    mean, low, high
        Mean, and its 95 % interval (Student's t).
    sd, q05, q95
        Standard deviation and 5 % and 95 % quantiles of the replicates.
    replicates
        How many have a value.
    """

    mean: float
    low: float
    high: float
    sd: float
    q05: float
    q95: float
    replicates: int


def summary_statistics(values: NDArray[np.float64]) -> SummaryStatistics:
    """Return mean, 95 % interval and spread of the values that are not NaN, ``(replicates,)``."""
    known = values[~np.isnan(values)]
    n = known.size
    if n == 0:
        return SummaryStatistics(math.nan, math.nan, math.nan, math.nan, math.nan, math.nan, 0)
    mean = float(known.mean())
    q05, q95 = (float(q) for q in np.quantile(known, (0.05, 0.95)))
    if n == 1:
        return SummaryStatistics(mean, math.nan, math.nan, math.nan, q05, q95, 1)
    if known.min() == known.max():
        exact = float(known[0])
        return SummaryStatistics(exact, exact, exact, 0.0, exact, exact, n)
    sd = float(known.std(ddof=1))
    half = half_interval(sd, n)
    return SummaryStatistics(mean, mean - half, mean + half, sd, q05, q95, n)


def half_interval(sd: Number, n: int) -> Number:
    """Return half the 95 % interval (Student's t) of means of `n` values, by their deviations."""
    return float(stdtrit(n - 1, _TWO_SIDED_95)) * sd / math.sqrt(n)


@dataclass(frozen=True)
class Ratio:
    """A ratio of two means over the same seeds, with its 95 % interval (bootstrap over seeds).

    Parameters
    ----------
    value
        Mean of one over mean of the other; infinite where only the other is 0, NaN where both are.
    low, high
        Ends of the interval, infinite likewise; NaN for fewer than 2 seeds.

    Examples
    --------
    >>> import fieldmon as fm
    >>> print(fm.Ratio(0.451, 0.398, 0.52))
    0.45 (0.40-0.52)
    >>> print(fm.Ratio(float("inf"), 3.2, float("inf")))
    infinite (3.20-infinite)
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return the ratio as it is printed."""
        if math.isnan(self.value):
            return "0 of 0"
        value, low, high = ("infinite" if math.isinf(one) else f"{one:.2f}"
                            for one in (self.value, self.low, self.high))  # fmt: skip
        if math.isnan(self.low) or math.isinf(self.low):
            return value
        return f"{value} ({low}-{high})"


def paired_ratio(one: NDArray[np.float64], other: NDArray[np.float64]) -> Ratio:
    """Return mean of one over mean of the other, ``(seeds,)`` paired.

    Where only the other is 0 it is infinite, and so are those of its draws where that is so.

    Examples
    --------
    >>> print(paired_ratio(np.array([3.0, 4.0]), np.zeros(2)))
    infinite
    """
    if not one.any() and not other.any():
        return Ratio(math.nan, math.nan, math.nan)
    value = float(one.mean() / other.mean()) if other.any() else math.inf
    if len(one) < 2:
        return Ratio(value, math.nan, math.nan)
    draws = np.random.default_rng(0).integers(0, len(one), (_RESAMPLES, len(one)))
    means, others = one[draws].mean(axis=1), other[draws].mean(axis=1)
    # where nobody lost anything there is nothing to compare
    compared = (means > 0) | (others > 0)
    with np.errstate(divide="ignore"):
        ratios = means[compared] / others[compared]
    # between a number and infinity there is nothing
    how = "linear" if np.isfinite(ratios).all() else "inverted_cdf"
    low, high = np.quantile(ratios, [0.025, 0.975], method=how)  # type: ignore[call-overload]
    return Ratio(value, float(low), float(high))


def too_few_sentence(seeds: int, told_by: str) -> str:
    """Return for people that so many seasons are too few to choose by; empty where they are not.

    `told_by` is how more of them are asked for.

    Examples
    --------
    >>> too_few_sentence(10, "--seeds")
    'With 10 seasons intervals come out too narrow. Choose nothing by fewer than 20 (--seeds).'
    """
    if seeds >= _ENOUGH:
        return ""
    return (
        f"With {seeds} season{'s' if seeds > 1 else ''} intervals come out too narrow. Choose "
        f"nothing by fewer than {_ENOUGH} ({told_by})."
    )
