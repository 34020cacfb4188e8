"""Sequential plans: look at leaves or plants one by one, and stop as soon as it is clear.

After n of them the cumulative count is held against two lines: below the lower one treating does
not pay, above the upper one it does, and in between one inspects more. When a plan stops, and what
it does on simulated counts, is in `stopping`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, Protocol

import numpy as np
from scipy.special import betaincc, gammaincc

from fieldmon.compute.arrays import read_only
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.decisions.taylor import TaylorLaw

    Floats = NDArray[np.float64]

TREAT: Final = "treat"
LEAVE: Final = "do not treat"
INSPECT_MORE: Final = "inspect more"
Verdict = Literal["treat", "do not treat", "inspect more"]
Counts = Literal["presence", "poisson", "negative binomial"]

_STEPS = 200


class StopLines(NamedTuple):
    """Stop once the cumulative count is at or beyond one of them, ``(n,)`` after 1, 2, ..."""

    low: Floats
    high: Floats

    def __repr__(self) -> str:
        return f"<StopLines: {len(self.low)} looks>"


class OperatingCurve(NamedTuple):
    """What a plan does at true means ``(k,)``."""

    mean: Floats
    leaves_it: Floats
    looks: Floats

    def __repr__(self) -> str:
        return f"<OperatingCurve: {len(self.mean)} means>"


class Plan(Protocol):
    """Whatever has stop lines."""

    @property
    def most_per_look(self) -> float:
        """Return the most that one look can count: 1 for presence."""
        ...

    def lines(self, n: int) -> StopLines:
        """Return the stop lines for 1 to n looks."""
        ...


def _most_per_look(*, is_share: bool) -> float:
    return 1.0 if is_share else np.inf


def _check_threshold(threshold: float, *, is_share: bool) -> None:
    if not 0.0 < threshold < _most_per_look(is_share=is_share):
        raise SettingError(
            "The threshold of a plan must be above 0"
            + (" and below 1" if is_share else "")
            + f", but it is {threshold:g}."
        )


def _check_clustering(k: float) -> None:
    if not 0.0 < k < np.inf:
        raise SettingError(
            worded(
                "The clustering k of counts must be a number above 0, but it is {k:g}.",
                k=k,
            )
        )


@dataclass(frozen=True)
class WaldPlan:
    """Wald's sequential probability ratio test (Ann. Math. Stat. 16 (1945) 117).

    Parameters
    ----------
    low, high
        Surely no treatment at this mean or share; surely one at that.
    counts
        What one look gives: ``"presence"`` (0 or 1), or a count that is random (``"poisson"``) or
        clustered (``"negative binomial"``).
    k
        Clustering of the negative binomial: the less, the more clustered.
    treats_wrongly, leaves_wrongly
        Tolerated chances of the two mistakes, at `low` and at `high`.

    Raises
    ------
    SettingError
        If the two levels, the chances or k cannot be.

    Examples
    --------
    The example of the R package sequential.pops:

    >>> plan = WaldPlan(2, 4, "negative binomial", k=4.6)
    >>> decided(plan, [2, 5, 6, 2, 7])
    ('treat', 5)
    """

    low: float
    high: float
    counts: Counts = "presence"
    k: float = np.inf
    treats_wrongly: float = 0.1
    leaves_wrongly: float = 0.1

    def __post_init__(self) -> None:
        most = 1.0 if self.counts == "presence" else np.inf
        if not 0.0 < self.low < self.high < most:
            raise SettingError(
                "The levels of a plan must rise from above 0"
                + (" to below 1" if most == 1.0 else "")
                + f", but they are {self.low:g} and {self.high:g}."
            )
        for name, chance in (("treats", self.treats_wrongly), ("leaves", self.leaves_wrongly)):
            if not 0.0 < chance < 0.5:
                raise SettingError(
                    worded(
                        "The chance that a plan {name} wrongly must lie between 0 and 0.5, but it "
                        "is {chance:g}.",
                        name=name,
                        chance=chance,
                    )
                )
        if self.counts == "negative binomial":
            _check_clustering(self.k)

    @property
    def most_per_look(self) -> float:
        """Return the most that one look can count: 1 for presence."""
        return _most_per_look(is_share=self.counts == "presence")

    @property
    def evidence(self) -> tuple[float, float]:
        """Return what one animal more, and a look as such, add to the logarithm of the ratio."""
        a, b, k = self.low, self.high, self.k
        if self.counts == "presence":
            return float(np.log(b * (1 - a) / (a * (1 - b)))), float(np.log((1 - b) / (1 - a)))
        if self.counts == "poisson":
            return float(np.log(b / a)), a - b
        return float(np.log(b * (a + k) / (a * (b + k)))), float(k * np.log((a + k) / (b + k)))

    @property
    def limits(self) -> tuple[float, float]:
        """Return the logarithms of the ratio at which it is clear, low and high."""
        treats, leaves = self.treats_wrongly, self.leaves_wrongly
        return float(np.log(leaves / (1 - treats))), float(np.log((1 - leaves) / treats))

    def lines(self, n: int) -> StopLines:
        """Return the stop lines for 1 to n looks: straight and parallel."""
        one_more, look = self.evidence
        below, above = self.limits
        looks = np.arange(1.0, n + 1.0)
        low: Floats = (below - look * looks) / one_more
        high: Floats = (above - look * looks) / one_more
        return StopLines(read_only(low), read_only(high))

    def operating_curve(self, mean: Any) -> OperatingCurve:  # noqa: ANN401 - an array or a number
        """Return how often it ends without treatment, and after how many looks, by true mean.

        Wald's approximations: what the last look oversteps a line by is left out, so that the
        true number of looks is a little higher and both mistakes are a little rarer.
        """
        mean = np.atleast_1d(np.asarray(mean, float))
        below, above = self.limits
        tilt = np.array([self._tilt(one) for one in mean])
        # at the mean where the ratio stays where it is in the long run
        flat = np.abs(tilt) < 1e-6
        safe = np.where(flat, 1.0, tilt)
        leaves = np.where(
            flat,
            above / (above - below),
            np.expm1(safe * above) / (np.exp(safe * above) - np.exp(safe * below)),
        )
        drift, spread = self._moments(mean)
        ends = leaves * below + (1.0 - leaves) * above
        looks = np.where(flat, -below * above / spread, ends / np.where(flat, 1.0, drift))
        return OperatingCurve(read_only(mean), read_only(leaves), read_only(looks))

    def _moments(self, mean: Floats) -> tuple[Floats, Floats]:
        """Return mean and mean square of what one look adds to the logarithm of the ratio."""
        one_more, look = self.evidence
        variance = {
            "presence": mean * (1.0 - mean),
            "poisson": mean,
            "negative binomial": mean + mean**2 / self.k,
        }[self.counts]
        drift = one_more * mean + look
        return drift, one_more**2 * variance + drift**2

    def _log_mgf(self, h: float, mean: float) -> float:
        """Return the logarithm of the mean of ratio^h after one look."""
        one_more, look = self.evidence
        grown = h * one_more
        if self.counts == "presence":
            return float(np.logaddexp(np.log1p(-mean), np.log(mean) + grown) + h * look)
        if self.counts == "poisson":
            return float(mean * np.expm1(grown) + h * look)
        share = mean / (mean + self.k)
        left = -share * np.expm1(grown) / (1.0 - share)
        if left <= -1.0:
            return float("inf")
        return float(-self.k * np.log1p(left) + h * look)

    def _tilt(self, mean: float) -> float:
        """Return the h other than 0 for which the mean of ratio^h stays 1 (0: there is none)."""
        drift = self._moments(np.array([mean]))[0][0]
        if abs(drift) < 1e-9:
            return 0.0
        side = -1.0 if drift > 0 else 1.0
        far = side
        while self._log_mgf(far, mean) < 0.0 and abs(far) < 1e6:
            far *= 2.0
        near = 0.0
        # the root lies where the convex function comes up again
        for _ in range(_STEPS):
            middle = (near + far) / 2
            near, far = (middle, far) if self._log_mgf(middle, mean) < 0.0 else (near, middle)
        return (near + far) / 2


@dataclass(frozen=True)
class IwaoPlan:
    """Iwao's plan: stop once a confidence interval round the threshold is left.

    S. Iwao, Res. Popul. Ecol. 16 (1975) 281. It has one threshold instead of two levels.

    Parameters
    ----------
    threshold
        Mean or share from which on treating pays.
    law
        How counts cluster; None: presence, 0 or 1 a look.
    z
        Standard errors on either side: 1.645 for 90 %.

    Raises
    ------
    SettingError
        If the threshold or z cannot be.
    """

    threshold: float
    law: TaylorLaw | None = None
    z: float = 1.645

    def __post_init__(self) -> None:
        _check_threshold(self.threshold, is_share=self.law is None)
        if not self.z > 0.0:
            raise SettingError(
                worded(
                    "A plan's z must be above 0, but it is {z:g}.",
                    z=self.z,
                )
            )

    @property
    def most_per_look(self) -> float:
        """Return the most that one look can count: 1 for presence."""
        return _most_per_look(is_share=self.law is None)

    def lines(self, n: int) -> StopLines:
        """Return the stop lines for 1 to n looks: they open like a parabola."""
        looks = np.arange(1, n + 1)
        level = self.threshold
        variance = level * (1 - level) if self.law is None else float(self.law.variance(level))
        wide = self.z * np.sqrt(looks * variance)
        return StopLines(read_only(looks * level - wide), read_only(looks * level + wide))


@dataclass(frozen=True)
class BayesPlan:
    """Stop once the mean is above the threshold, or below it, with a chance asked for.

    Before the first look every mean of counts is as likely as any other (Rincon, McCabe & Crowder
    2025, Methods Ecol. Evol., doi:10.1111/2041-210X.70053). A share is above the threshold with a
    chance of one half: were all shares as likely, the first clean look would say "treat". It has
    one threshold, as Iwao's.

    Parameters
    ----------
    threshold
        Mean or share from which on treating pays.
    counts
        What one look gives, see `WaldPlan`.
    k
        Clustering of the negative binomial.
    sure
        The chance at which it stops, above 0.5 and below 1.

    Raises
    ------
    SettingError
        If the threshold, k or `sure` cannot be.

    Examples
    --------
    The example of the R package sequential.pops:

    >>> round(BayesPlan(2, "poisson").chance_above(3, 6), 8)
    0.60630278
    """

    threshold: float
    counts: Counts = "presence"
    k: float = np.inf
    sure: float = 0.9

    def __post_init__(self) -> None:
        _check_threshold(self.threshold, is_share=self.counts == "presence")
        if not 0.5 < self.sure < 1.0:
            raise SettingError(
                worded(
                    "A plan must stop at a chance between 0.5 and 1, but it is {sure:g}.",
                    sure=self.sure,
                )
            )
        if self.counts == "negative binomial":
            _check_clustering(self.k)

    @property
    def most_per_look(self) -> float:
        """Return the most that one look can count: 1 for presence."""
        return _most_per_look(is_share=self.counts == "presence")

    def chance_above(self, looks: Any, total: Any) -> Any:  # noqa: ANN401 - arrays or numbers
        """Return the chance that the mean is above the threshold, `total` counted in `looks`."""
        looks, total = np.asarray(looks, float), np.asarray(total, float)
        level = self.threshold
        if self.counts == "presence":
            above = betaincc(total + 1.0, np.maximum(looks - total, 0.0) + 1.0, level)
            return above * level / (above * level + (1.0 - above) * (1.0 - level))
        if self.counts == "poisson":
            return gammaincc(total + 1.0, looks * level)
        # until this is above 0 the counts say nothing: any mean, however high, explains them
        told = looks * self.k - 1.0
        above = betaincc(total + 1.0, np.maximum(told, 1e-9), level / (level + self.k))
        return np.where(told > 0.0, above, 0.5)

    def lines(self, n: int) -> StopLines:
        """Return the stop lines for 1 to n looks."""
        looks = np.arange(1.0, n + 1.0)
        return StopLines(
            read_only(self._total_at(looks, 1.0 - self.sure)),
            read_only(self._total_at(looks, self.sure)),
        )

    def _total_at(self, looks: Floats, chance: float) -> Floats:
        """Return the total ``(n,)`` at which the mean is above the threshold with that chance."""
        low = np.full(len(looks), -1.0 + 1e-9)
        high = looks * self.threshold + 60.0 * (1.0 + np.sqrt(looks)) * (1.0 + self.threshold)
        for _ in range(_STEPS // 2):
            middle = (low + high) / 2
            below = self.chance_above(looks, middle) < chance
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return high
