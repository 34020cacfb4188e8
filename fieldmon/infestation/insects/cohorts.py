"""Young infestations in a chance map: what cannot be seen yet, and what does not move yet."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.pest_in_weather import PestSpread
    from fieldmon.pests.pest import Pest

    Floats = NDArray[np.float64]

_LEAST = 1e-12


@dataclass(frozen=True)
class Age:
    """How far the infestations of one night have come: stage, degree-days in it, and days."""

    stage: int = 0
    progress: float = 0.0
    days: float = 0.0

    def older(self, pest: Pest, warmth: tuple[float, ...], days: float) -> Age:
        """Return it after so many degree-days for each stage, and so many days."""
        if self.stage == len(pest.stages):
            return replace(self, days=self.days + days)
        progress = self.progress + warmth[self.stage]
        if progress < pest.stages[self.stage].degree_days:
            return replace(self, progress=progress, days=self.days + days)
        return Age(self.stage + 1, 0.0, self.days + days)

    def visible(self, pest: Pest) -> bool:
        """Tell whether an inspection may see it."""
        seen = self.stage == len(pest.stages) or pest.stages[self.stage].visible
        return seen and self.days >= pest.hidden_days

    def mobile(self, pest: Pest) -> bool:
        """Tell whether insects go from it to other plants."""
        moves = self.stage == len(pest.stages) or pest.stages[self.stage].mobile
        return moves and self.days >= pest.latency_days


@dataclass(frozen=True, eq=False)
class Cohorts:
    """Which share of each plant's chance came in which of the last nights.

    Parameters
    ----------
    pest
        What lives on the plot.
    ages
        Of each night, the oldest first; grown infestations are not listed.
    shares
        ``(k, n)`` float32 of each plant's chance.
    """

    pest: Pest
    ages: tuple[Age, ...]
    shares: NDArray[np.float32]

    @classmethod
    def none(cls, pest: Pest, n: int) -> Cohorts:
        """Return those of a first morning, when all is taken to be grown."""
        return cls(pest, (), np.zeros((0, n), np.float32))

    @property
    def hidden(self) -> Floats:
        """Share of each plant's chance that no inspection can see, ``(n,)``."""
        return self._share([not age.visible(self.pest) for age in self.ages])

    @property
    def still(self) -> Floats:
        """Share of each plant's chance that sends nothing out, ``(n,)``."""
        return self._share([not age.mobile(self.pest) for age in self.ages])

    def inspected(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], detects: Floats
    ) -> Cohorts:
        """Return what is believed after inspections: what was overlooked rather is hidden.

        Parameters
        ----------
        plants, found
            ``(k,)`` what was inspected, with what result.
        detects
            ``(k,)`` chance to find what can be seen.
        """
        if not self.ages:
            return self
        shares, hidden = self.shares.copy(), self.hidden
        clean = ~found
        at, misses = plants[clean], 1.0 - detects[clean]
        stays = hidden[at] + (1.0 - hidden[at]) * misses
        for k, age in enumerate(self.ages):
            kept = misses if age.visible(self.pest) else 1.0
            shares[k, at] *= kept / np.maximum(stays, _LEAST)
        # a find is of what can be seen
        shares[:, plants[found]] = 0.0
        return replace(self, shares=shares)

    def overnight(self, before: Floats, gain: Floats, after: Floats, spread: PestSpread) -> Cohorts:
        """Return those of the next morning.

        Parameters
        ----------
        before, after
            ``(n,)`` chances in the evening and in the morning.
        gain
            ``(n,)`` what the night brought.
        spread
            How warm it was, and how long.
        """
        ages = [age.older(self.pest, spread.warmth, spread.days) for age in self.ages]
        young = [not (age.visible(self.pest) and age.mobile(self.pest)) for age in ages]
        new = Age()
        rest = (before / np.maximum(after, _LEAST)).astype(np.float32)
        parts = [self.shares[young] * rest]
        kept = [age for age, is_young in zip(ages, young, strict=True) if is_young]
        if not (new.visible(self.pest) and new.mobile(self.pest)):
            kept.append(new)
            came = (gain / np.maximum(after, _LEAST)).astype(np.float32)
            parts.append(np.clip(came, 0.0, 1.0)[None])
        return replace(self, ages=tuple(kept), shares=np.concatenate(parts))

    def _share(self, which: list[bool]) -> Floats:
        if not any(which):
            return np.zeros(self.shares.shape[1])
        share: Floats = self.shares[which].sum(axis=0, dtype=np.float64)
        return np.minimum(share, 1.0)
