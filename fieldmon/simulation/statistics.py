"""What the replicates of a measure say: mean, interval and spread."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from scipy.special import stdtrit

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TWO_SIDED_95 = 0.975
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
