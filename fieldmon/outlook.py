"""What a chance map says about the whole plot: how many are still infested, and is it clean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import norm

if TYPE_CHECKING:
    from numpy.typing import NDArray

_COVERAGE = 0.9


@dataclass(frozen=True)
class Outlook:
    """How many plants are infested, as believed.

    Parameters
    ----------
    expected
        Infested plants on average.
    low, high
        Limits of the interval that holds the number with a chance of 90 %.
    chance_clean
        Chance that no plant is infested.
    """

    expected: float
    low: int
    high: int
    chance_clean: float


def outlook(chance: NDArray[np.float64]) -> Outlook:
    """Return what a chance map ``(n,)`` says about the whole plot, plants taken as independent.

    The number is a sum of independent yes-or-no draws; its interval is that of the normal
    distribution with their mean and variance, and half a plant on either side.
    """
    expected = float(chance.sum())
    spread = float(np.sqrt((chance * (1.0 - chance)).sum()))
    tail = (1.0 - _COVERAGE) / 2
    low, high = norm.ppf([tail, 1.0 - tail], expected, spread) if spread else (expected, expected)
    return Outlook(
        expected=expected,
        low=max(0, int(np.floor(low))),
        high=min(len(chance), int(np.ceil(high))),
        chance_clean=float(np.exp(np.log1p(-chance).sum())),
    )
