"""Taylor's power law: how counts cluster, and what presence alone says of their mean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_STEPS = 60


@dataclass(frozen=True)
class TaylorLaw:
    """The variance of counts is ``a mean^b`` (L. R. Taylor, Nature 189 (1961) 732).

    The defaults are the generic ones of two-spotted spider mites on leaves: with them the 23
    leaves of Tollerup's (2013) plan for peppermint come out.

    Parameters
    ----------
    a, b
        Above 0; with a = b = 1 counts are random (Poisson).

    Raises
    ------
    SettingError
        If one of them is not above 0.

    Examples
    --------
    >>> float(TaylorLaw().leaves_for(mean=5.0, precision=0.25).round())
    23.0
    """

    a: float = 3.297
    b: float = 1.486

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0.0 < value < np.inf:
                raise SettingError(
                    f"Taylor's {name} must be a number above 0, but it is {value:g}."
                )

    def variance(self, mean: Any) -> Floats:  # noqa: ANN401 - an array or a number
        """Return the variance of counts of a mean ``(...)``."""
        return np.asarray(self.a * np.asarray(mean, float) ** self.b)

    def share_infested(self, mean: Any) -> Floats:  # noqa: ANN401 - an array or a number
        """Return which share of leaves has one animal or more, at a mean ``(...)``.

        L. T. Wilson and P. M. Room, Environ. Entomol. 12 (1983) 50: the empty share of a negative
        binomial whose clustering follows the law.
        """
        mean = np.asarray(mean, float)
        ratio = self.a * mean ** (self.b - 1.0)
        # random counts, and the law where it says that they are more even than random
        near = np.maximum(ratio, 1.0) - 1.0
        slope = np.where(near < 1e-6, 1.0, np.log1p(near) / np.maximum(near, 1e-12))
        return np.asarray(-np.expm1(-mean * slope))

    def mean_of(self, share: float) -> float:
        """Return the mean at which a share between 0 and 1 of the leaves is infested.

        Raises
        ------
        SettingError
            If the share is not between 0 and 1.
        """
        if not 0.0 < share < 1.0:
            raise SettingError(
                f"A share of leaves must lie between 0 and 1, but it is {share:g}: where all or "
                "none are infested, presence says nothing of the mean."
            )
        low, high = -20.0, 20.0
        for _ in range(_STEPS):
            middle = (low + high) / 2
            below = self.share_infested(np.exp(middle)) < share
            low, high = (middle, high) if below else (low, middle)
        return float(np.exp((low + high) / 2))

    def leaves_for(self, mean: float, precision: float) -> Floats:
        """Return how many leaves to count for a standard error of so much of the mean.

        Parameters
        ----------
        mean
            Animals a leaf.
        precision
            Standard error over mean, 0.25 as usual.
        """
        return np.asarray(self.variance(mean) / (precision * mean) ** 2)
