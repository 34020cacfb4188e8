"""Taylor's power law: how counts cluster, and what presence alone says of their mean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import stdtrit

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_STEPS = 60
# standard errors on either side, for 90 %
_Z90 = 1.645


class MeanBand(NamedTuple):
    """Animals a leaf that a share of infested leaves speaks for: as likely, and from to."""

    mean: float
    low: float
    high: float

    def __repr__(self) -> str:
        return f"<MeanBand {self.mean:.3g} ({self.low:.3g} to {self.high:.3g})>"


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


@dataclass(frozen=True)
class PublishedLaw:
    """Taylor's law as somebody found it.

    Parameters
    ----------
    law
        The law.
    source
        Who found it, and where.
    log_a_error, b_error
        Standard errors of ln a and of b; 0: not said.
    """

    law: TaylorLaw
    source: str
    log_a_error: float = 0.0
    b_error: float = 0.0

    def laws(self, z: float) -> tuple[TaylorLaw, ...]:
        """Return the law, and those z standard errors from it either way."""
        a, b = self.law.a, self.law.b
        off = [(z, 0.0), (-z, 0.0), (0.0, z), (0.0, -z)]
        return self.law, *(
            TaylorLaw(a * float(np.exp(da * self.log_a_error)), b + db * self.b_error)
            for da, db in off
        )


#: how two-spotted spider mites cluster on leaves, as published
PUBLISHED_LAWS = (
    PublishedLaw(TaylorLaw(), "generic, Tollerup et al. 2013, J. Econ. Entomol. 106(4):1707"),
    PublishedLaw(
        TaylorLaw(float(np.exp(2.56)), 1.64),
        "strawberry before harvest, Raworth 1986, Can. Entomol. 118:807 (abstract)",
        0.0969, 0.0355,
    ),
    PublishedLaw(
        TaylorLaw(float(np.exp(1.76)), 1.64),
        "strawberry during harvest, Raworth 1986", 0.140, 0.0355,
    ),
)  # fmt: skip


def mean_band(
    leaves: int,
    infested: int,
    published: Iterable[PublishedLaw] = PUBLISHED_LAWS,
) -> MeanBand:
    """Return the animals a leaf by Wilson & Room, with all that is not known about it.

    From the least to the most that any of the laws says, 90 % sure of each, of any share that
    the leaves allow (Wilson's interval, J. Am. Stat. Assoc. 22 (1927) 209).

    Parameters
    ----------
    leaves, infested
        Leaves looked at, and those with an animal or more on them.
    published
        Laws; the first is what is held likely.

    Raises
    ------
    SettingError
        If there are no leaves, more infested than looked at, or all or none are.

    Examples
    --------
    >>> mean_band(50, 20)
    <MeanBand 0.977 (0.572 to 12.8)>
    """
    share, z = _share(leaves, infested), _Z90
    middle = (share + z**2 / (2 * leaves)) / (1 + z**2 / leaves)
    off = z * np.sqrt(share * (1 - share) / leaves + (z / (2 * leaves)) ** 2) / (1 + z**2 / leaves)
    laws = tuple(published)
    means = [
        law.mean_of(float(at))
        for one in laws
        for law in one.laws(z)
        for at in (middle - off, middle + off)
    ]
    return MeanBand(laws[0].law.mean_of(share), min(means), max(means))


def _share(leaves: int, infested: int) -> float:
    if not 0 < infested < leaves:
        raise SettingError(
            "Of the leaves some must be infested and some clean, for presence to say something of "
            f"the mean, but {infested} of {leaves} are infested."
        )
    return infested / leaves


@dataclass(frozen=True)
class EmptyLeaves:
    """ln m follows ln(-ln P), P the share of empty leaves, as samples of one's own have it.

    Kono & Sugino, Jpn. J. Appl. Entomol. Zool. 2 (1958) 184; Nachman, J. Appl. Ecol. 21 (1984) 903.
    It asks for no law of how animals cluster, only for samples that were counted whole. The spread
    is that of Binns & Bostanian, J. Econ. Entomol. 83 (1990) 420, all four terms: the share is of
    some leaves only, the line of some samples only (two), and fields differ.

    Parameters
    ----------
    intercept, slope
        ``ln m = intercept + slope ln(-ln P)``.
    scatter
        Mean square of the samples' ln m about the line.
    samples, centre, spread
        How many samples, and mean and sum of squares about it of their ln(-ln P).
    """

    intercept: float
    slope: float
    scatter: float
    samples: int
    centre: float
    spread: float

    @classmethod
    def fitted(cls, mean: Any, empty: Any) -> EmptyLeaves:  # noqa: ANN401 - arrays or lists
        """Return the line of samples: animals a leaf ``(k,)``, and their share of empty leaves.

        Raises
        ------
        SettingError
            If fewer than three samples have some leaves empty and some not, or all the same share.
        """
        mean, empty = np.asarray(mean, float), np.asarray(empty, float)
        told = (mean > 0.0) & (empty > 0.0) & (empty < 1.0)
        if np.count_nonzero(told) < 3 or np.ptp(empty[told]) == 0.0:
            raise SettingError(
                "A line needs three samples or more with some leaves empty and some not, of "
                f"different shares, but there are {np.count_nonzero(told)}."
            )
        x, y = np.log(-np.log(empty[told])), np.log(mean[told])
        spread = float(((x - x.mean()) ** 2).sum())
        slope = float(((x - x.mean()) * y).sum() / spread)
        intercept = float(y.mean() - slope * x.mean())
        off = y - intercept - slope * x
        scatter = float((off**2).sum() / (len(x) - 2))
        return cls(intercept, slope, scatter, len(x), float(x.mean()), spread)

    def mean_band(self, leaves: int, infested: int, sure: float = 0.9) -> MeanBand:
        """Return the animals a leaf, and the interval that holds them with chance `sure`.

        Raises
        ------
        SettingError
            If all or none of the leaves are infested.
        """
        empty = 1.0 - _share(leaves, infested)
        x = float(np.log(-np.log(empty)))
        of_leaves = self.slope**2 * (1.0 - empty) / (leaves * empty * np.log(empty) ** 2)
        of_line = self.scatter * (1.0 / self.samples + (x - self.centre) ** 2 / self.spread)
        t = float(stdtrit(self.samples - 2, 0.5 + sure / 2))
        off = t * float(np.sqrt(of_leaves + of_line + self.scatter))
        log_mean = self.intercept + self.slope * x
        low, mean, high = (float(np.exp(log_mean + k * off)) for k in (-1, 0, 1))
        return MeanBand(mean, low, high)
