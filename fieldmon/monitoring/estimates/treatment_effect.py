"""Whether treatments worked, as plants tell that were looked at before and after.

Among the plants of a treated place that were inspected within three weeks before and after, the
share found infested is compared, with the same elsewhere beside it. How well the treatment works
is estimated from those that were found infested before: it begins from what was said of it, worth
as much as `PRIOR_PLANTS` plants. A plant that was infested anew counts as not cured.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import betaincinv

from fieldmon.compute.units import Units
from fieldmon.compute.wording import chance_figure, counted, figure, joined, worded
from fieldmon.decisions.labels import plain_name
from fieldmon.infestation.inspections import FOUND, SKIPPED
from fieldmon.pests.weather import DAY_S

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.monitoring.estimates.history import History
    from fieldmon.monitoring.treating.treatments import KeptTreatment

    Results = NDArray[np.int8]

#: as many plants as what was said beforehand of a treatment is worth
PRIOR_PLANTS = 4.0
#: days before and after a treatment whose inspections tell of it
WINDOW_DAYS = 21
_SURE = 0.9
_UNSEEN = np.int8(-1)
# moments, in seconds: a day with what goes on past midnight, and inspections without a time before
# all treatments of their day
_NEVER_S, _ROOM_S, _UNTIMED_S = 2.0 * DAY_S, 3.0 * DAY_S, -2.0


@dataclass(frozen=True)
class FoundShare:
    """So many found infested of so many inspected, and the interval of 90 % of their share.

    The interval is exact: Clopper and Pearson 1934, Biometrika 26:404.
    """

    found: int
    inspected: int

    @property
    def share(self) -> float:
        """Return the share; NaN of none."""
        return self.found / self.inspected if self.inspected else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        """Return the lower and the upper end."""
        k, n, tail = self.found, self.inspected, (1 - _SURE) / 2
        low = float(betaincinv(k, n - k + 1, tail)) if k else 0.0
        high = float(betaincinv(k + 1, n - k, 1 - tail)) if k < n else 1.0
        return low, high

    def sentence(self) -> str:
        """Return the share found infested, in words, with its interval."""
        low, high = self.interval
        return worded(
            "{share} ({found} of {n}; {low} to {high})",
            share=chance_figure(self.share), found=figure(self.found), n=figure(self.inspected),
            low=chance_figure(low), high=chance_figure(high),
        )  # fmt: skip


@dataclass(frozen=True)
class TreatmentEffect:
    """What plants that were looked at again tell of a treatment.

    Parameters
    ----------
    batch
        Of the treatment.
    product, day
        What it was, and its date as people write it.
    before, after
        Found infested among the plants of its place that were inspected before and after.
    elsewhere
        The same of plants that were not treated meanwhile.
    said
        How well it was said to work: chance that an infested plant is clean afterwards.
    efficacy, low, high
        How well it worked, and the interval of 90 %.
    cured_of
        Plants found infested before that were looked at again.
    """

    batch: int
    product: str
    day: str
    before: FoundShare
    after: FoundShare
    elsewhere: tuple[FoundShare, FoundShare]
    said: float
    efficacy: float
    low: float
    high: float
    cured_of: int

    def sentence(self) -> str:
        """Return how well the treatment worked, in words."""
        product = self.product or worded("a product that nobody named")
        if not self.before.inspected:
            return worded(
                "Whether {product} on {day} worked is not known yet: no plant there was inspected "
                "both before and after.", product=product, day=self.day,
            )  # fmt: skip
        said = [
            worded(
                "After {product} on {day}: of {plants} inspected before and after, {before} were "
                "found infested before and {after} after.",
                product=product, day=self.day, plants=counted(self.before.inspected, "plant"),
                before=self.before.sentence(), after=self.after.sentence(),
            )
        ]  # fmt: skip
        if self.elsewhere[0].inspected:
            before, after = self.elsewhere
            said.append(
                worded(
                    "Elsewhere {before} and {after}.",
                    before=before.sentence(), after=after.sentence(),
                )
            )  # fmt: skip
        if not self.cured_of:
            said.append(
                worded(
                    "None of those found infested before was inspected again: how well it works "
                    "is not known yet."
                )
            )
            return joined(" ", said)
        said.append(
            worded(
                "It cleans {efficacy} of infested plants ({low} to {high}), told by {plants}; "
                "{said} was said beforehand, which counts as {worth} plants.",
                efficacy=chance_figure(self.efficacy), low=chance_figure(self.low),
                high=chance_figure(self.high), plants=counted(self.cured_of, "plant"),
                said=chance_figure(self.said), worth=figure(PRIOR_PLANTS, "g"),
            )
        )  # fmt: skip
        return joined(" ", said)


def effects(
    treatments: Sequence[KeptTreatment], history: History, on: int, units: Units | None = None
) -> tuple[TreatmentEffect, ...]:
    """Return what inspections up to the evening of a day tell of each treatment before it."""
    written = units or Units()
    return tuple(
        _effect(one, treatments, (history, on), written) for one in treatments if one.day <= on
    )


def learnt_efficacy(found: Sequence[TreatmentEffect], product: str = "") -> TreatmentEffect | None:
    """Return the last effect of a product that any plant tells of; None: there is none.

    No product named: the last one that is named and of which any tells.
    """
    told = [one.product for one in found if one.cured_of and one.product]
    name = plain_name(product or "".join(told[-1:]))
    known = [one for one in found if one.cured_of and plain_name(one.product) == name]
    return known[-1] if name and known else None


def _effect(
    one: KeptTreatment, all_of_them: Sequence[KeptTreatment], known: tuple[History, int],
    units: Units,
) -> TreatmentEffect:  # fmt: skip
    history, on = known
    before, after, treated = _before_and_after(one, all_of_them, history, on)
    both = (before != _UNSEEN) & (after != _UNSEEN)
    here, there = both & one.place.plants, both & ~treated
    ill = here & (before == FOUND)
    still = int(np.count_nonzero(ill & (after == FOUND)))
    n = int(np.count_nonzero(ill))
    efficacy, low, high = _posterior(one.efficacy, still, n, history.mean_detection(on))
    return TreatmentEffect(
        one.batch, one.application.product, units.day(one.on),
        _share(before, here), _share(after, here), (_share(before, there), _share(after, there)),
        one.efficacy, efficacy, low, high, n,
    )  # fmt: skip


def _share(result: Results, of: NDArray[np.bool_]) -> FoundShare:
    return FoundShare(int(np.count_nonzero(result[of] == FOUND)), int(np.count_nonzero(of)))


def _before_and_after(
    one: KeptTreatment, all_of_them: Sequence[KeptTreatment], history: History, on: int
) -> tuple[Results, Results, NDArray[np.bool_]]:
    """Return each plant's last result before a treatment and its first after it, and who is out.

    ``(n,)`` each, -1: none. A treatment works after the inspections of its day that were made by
    when it was over, see `Treatment`. Results from beyond another treatment of the same plant tell
    nothing of this one.
    """
    n, over = len(history.grid), _over(one)
    first = np.full(n, (one.day - WINDOW_DAYS) * _ROOM_S + _UNTIMED_S)
    last = np.full(n, min(one.day + WINDOW_DAYS, on) * _ROOM_S + _NEVER_S)
    treated = one.place.plants.copy()
    for other in all_of_them:
        plants, its_over = other.place.plants, _over(other)
        if its_over < over:
            first[plants] = np.maximum(first[plants], its_over)
        elif its_over > over:
            last[plants] = np.minimum(last[plants], its_over)
        if other.day == one.day:
            treated |= plants
    done = history.inspections
    seen = done.result != SKIPPED
    plant, result = done.plant[seen], done.result[seen]
    at = history.days[seen] * _ROOM_S + np.nan_to_num(done.second[seen], nan=_UNTIMED_S + 1.0)
    before, after = np.full(n, _UNSEEN), np.full(n, _UNSEEN)
    early = (at > first[plant]) & (at <= over)
    before[plant[early]] = result[early]  # they are in order: the last one stays
    late = np.flatnonzero((at > over) & (at <= last[plant]))[::-1]
    after[plant[late]] = result[late]
    return before, after, treated


def _over(one: KeptTreatment) -> float:
    """Return the moment at which a treatment was over: later inspections are after it."""
    return one.day * _ROOM_S + min(one.application.over_s, _NEVER_S)


def _posterior(said: float, still: int, n: int, detection: float) -> tuple[float, float, float]:
    """Return mean and interval of how well a treatment works.

    Of n infested plants each is found afterwards if it was not cured and is not overlooked.
    """
    mean = min(max(said, 0.02), 0.98)
    at = (np.arange(1000) + 0.5) / 1000
    log = (PRIOR_PLANTS * mean - 1) * np.log(at) + (PRIOR_PLANTS * (1 - mean) - 1) * np.log1p(-at)
    seen = (1 - at) * detection
    log += still * np.log(seen) + (n - still) * np.log1p(-seen)
    weight = np.exp(log - log.max())
    below = np.cumsum(weight / weight.sum())
    low, high = (float(at[np.searchsorted(below, tail)]) for tail in (0.05, 0.95))
    return float((at * weight).sum() / weight.sum()), low, high
