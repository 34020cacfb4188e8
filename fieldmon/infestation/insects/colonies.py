"""The insects of a plot, plant by plant: what stage they are in, who moves, and who can be seen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import coin_table
from fieldmon.infestation.insects.dispersal import ToAdjacent, dispersal_of, settle
from fieldmon.infestation.insects.pest_in_weather import kernel_of
from fieldmon.infestation.prior.prior import edge_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.dispersal import Landings
    from fieldmon.infestation.insects.pest_in_weather import Spell
    from fieldmon.pests.pest import Entry, Pest
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# coins of those that die are not those of which plants are infested
_DEATHS, _TREATED = np.uint64(0x5DEECE66D), np.uint64(0x2545F4914F6CDD1D)


@dataclass(frozen=True, eq=False)
class Colonies:
    """Which plants are infested, and how far each plant's insects have come; never changed.

    Parameters
    ----------
    grid, pest
        The plants, and what lives on them.
    infested
        ``(n,)``.
    stage
        ``(n,)`` number of the stage that a plant's first insects are in, as the pest's file lists
        them; their number where all stages are there.
    progress
        ``(n,)`` degree-days of that stage so far.
    age_days
        ``(n,)`` days since the plant was infested; infinite for those of the first morning.
    protected_days
        ``(n,)`` days for which nothing that lands on the plant lives.
    """

    grid: PlantGrid
    pest: Pest
    infested: NDArray[np.bool_]
    stage: NDArray[np.int8]
    progress: Floats
    age_days: Floats
    protected_days: Floats

    @classmethod
    def grown(cls, grid: PlantGrid, pest: Pest, infested: NDArray[np.bool_]) -> Colonies:
        """Return the colonies of a first morning: in all stages, where plants are infested."""
        n = len(grid)
        stage = np.full(n, len(pest.stages), np.int8)
        return cls(grid, pest, infested.copy(), stage, np.zeros(n), np.full(n, np.inf), np.zeros(n))

    @cached_property
    def mobile(self) -> NDArray[np.bool_]:
        """Plants from which insects go to others, ``(n,)``."""
        mobile = np.array([*(stage.mobile for stage in self.pest.stages), True])
        known: NDArray[np.bool_] = (
            self.infested & mobile[self.stage] & (self.age_days >= self.pest.latency_days)
        )
        return known

    @cached_property
    def visible(self) -> NDArray[np.bool_]:
        """Plants on which an inspection may find something, ``(n,)``."""
        seen = np.array([*(stage.visible for stage in self.pest.stages), True])
        showing: NDArray[np.bool_] = (
            self.infested & seen[self.stage] & (self.age_days >= self.pest.hidden_days)
        )
        return showing

    def after(self, spell: Spell, key: np.uint64, turn: int = 0) -> Colonies:
        """Return the colonies after some hours.

        Parameters
        ----------
        spell
            How long, how warm, how much moves, and the wind.
        key, turn
            Name the table of coins: one a plant, so that with the same insects it is the same.
        """
        reached = self._reached(spell, key, turn) & (self.protected_days <= 0.0)
        older = self.older(spell)
        return older.entered(reached).outlived(spell.days, key, turn)

    def settled(self, landed: Floats, key: np.uint64, turn: int = 0) -> Colonies:
        """Return the colonies after so much has landed on each plant ``(n,)``."""
        return self.entered(settle(self.infested, landed, key, turn))

    def without(self, plants: NDArray[np.integer]) -> Colonies:
        """Return the colonies after those on some plants were destroyed."""
        infested = self.infested.copy()
        infested[plants] = False
        return replace(self, infested=infested)

    def treated(self, dies: Floats, key: np.uint64, protects_days: float = 0.0) -> Colonies:
        """Return the colonies after a treatment.

        Parameters
        ----------
        dies
            ``(n,)`` chance that it works on a plant.
        key
            Names the coins.
        protects_days
            How long what it worked on stays free.
        """
        works = coin_table(key ^ _TREATED, len(dies)) < dies
        protected = np.where(
            works, np.maximum(self.protected_days, protects_days), self.protected_days
        )
        return replace(self, infested=self.infested & ~works, protected_days=protected)

    def older(self, spell: Spell) -> Colonies:
        """Return the same insects, so many hours further in their stages."""
        stage, progress = self.stage.copy(), self.progress.copy()
        for k, (of, warmth) in enumerate(zip(self.pest.stages, spell.warmth, strict=True)):
            at = np.flatnonzero(self.infested & (self.stage == k))
            progress[at] += warmth
            done = at[progress[at] >= of.degree_days]
            stage[done] += 1
            progress[done] = 0.0
        return replace(
            self,
            stage=stage,
            progress=progress,
            age_days=self.age_days + spell.days,
            protected_days=np.maximum(self.protected_days - spell.days, 0.0),
        )

    def _reached(self, spell: Spell, key: np.uint64, turn: int) -> NDArray[np.bool_]:
        """Return on which plants something lands in some hours, from the plot or from outside."""
        reached, entry = np.zeros(len(self.grid), np.bool_), self.pest.entry
        if spell.sends > 0.0 and (senders := np.flatnonzero(self.mobile)).size:
            reached = self._landings(spell).reached(senders, spell.sends, key, turn)
        if max(entry.edge_per_day, entry.anywhere_per_day) > 0.0:
            reached |= settle(self.infested, _entering(self.grid, entry) * spell.days, key, turn)
        return reached

    def _landings(self, spell: Spell) -> Landings:
        movement = self.pest.movement
        if movement.kernel == "adjacent":
            return ToAdjacent(self.grid.adjacent)
        return dispersal_of(self.grid, kernel_of(movement), spell.wind_m_s)

    def entered(self, reached: NDArray[np.bool_]) -> Colonies:
        """Return the same with new colonies, in their first stage, on clean plants of those."""
        new = reached & ~self.infested
        if not new.any():
            return self
        return replace(
            self,
            infested=self.infested | new,
            stage=np.where(new, 0, self.stage).astype(np.int8),
            progress=np.where(new, 0.0, self.progress),
            age_days=np.where(new, 0.0, self.age_days),
        )

    def outlived(self, days: float, key: np.uint64, turn: int) -> Colonies:
        """Return those that predators and the like have left."""
        dies = self.pest.mortality_per_day
        if dies == 0.0:
            return self
        gone = (
            coin_table(key ^ _DEATHS ^ np.uint64(turn), len(self.grid)) < 1.0 - (1.0 - dies) ** days
        )
        return replace(self, infested=self.infested & ~gone)


@lru_cache(maxsize=4)
def _entering(grid: PlantGrid, entry: Entry) -> Floats:
    """Return the chance a day that each plant is infested from outside, ``(n,)``."""
    by_edge = np.zeros(len(grid))
    if entry.edge_per_day > 0.0:
        settings = PriorSettings(edge_chance=entry.edge_per_day, edge_depth_m=entry.depth_m)
        by_edge = edge_chance(grid, settings)
    entering: Floats = by_edge + entry.anywhere_per_day
    return entering
