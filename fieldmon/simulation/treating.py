"""A rule by which a simulated season is treated in the evening: zones above the threshold."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.arguments import must_be_in
from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.compute.ranges import DAYS, AllowedRange
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.zones import Zones, best_zones, whole_plot
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

ZONES, WHOLE = "zones", "whole"
_SHARE = AllowedRange(0.0, 1.0, above=True, below=True)


@dataclass(frozen=True)
class TreatmentRule:
    """Treat in the evening what the map says is above the threshold.

    Parameters
    ----------
    level
        Share of the plants expected infested from which on it is treated: of a zone, or of the
        plot where it is treated whole.
    treats
        ``"zones"``: those of the best zones that are above it; ``"whole"``: all or nothing.
    sprayer, costs
        What can be switched, and what it costs.
    every_days
        Days from one treatment to the next at least.
    seed
        Which plants a treatment cleans: the same seed, the same plants.

    Raises
    ------
    SettingError
        If the level is no share, nothing is treated by that name, or the days are below 1.

    Examples
    --------
    >>> import fieldmon as fm
    >>> rule = fm.TreatmentRule(0.02, costs=fm.TreatmentCosts(per_ha=120))
    >>> fm.SimulationSettings(treating=rule).treating.every_days
    7
    """

    level: float = 0.05
    treats: str = ZONES
    sprayer: Sprayer = field(default_factory=Sprayer)
    costs: TreatmentCosts = field(default_factory=TreatmentCosts)
    every_days: int = 7
    seed: int = 0

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A treatment rule's")
        must_be_in("A treatment rule's level", _SHARE, self.level)
        must_be_in("A treatment rule's every_days", DAYS, self.every_days)
        if self.treats not in {ZONES, WHOLE}:
            raise SettingError(
                f"A treatment rule's treats must be {ZONES!r} or {WHOLE!r}, but it is "
                f"{self.treats!r}."
            )

    def treated(self, grid: PlantGrid, chance: Floats) -> Zones | None:
        """Return what is treated of a `grid` of this `chance` ``(n,)``; None: nothing."""
        if self.treats == WHOLE:
            above = float(chance.mean()) >= self.level
            return whole_plot(grid, chance, self.costs) if above else None
        zones = best_zones(grid, chance, self.sprayer, self.costs)
        if not len(zones):
            return None
        of = zones.zone[zones.treated]
        share = np.bincount(of, chance[zones.treated]) / np.bincount(of)
        kept = zones.only(grid, chance, share >= self.level, self.costs)
        return kept if len(kept) else None

    def cleaned(self, zones: Zones, day: int) -> NDArray[np.bool_]:
        """Return which plants treating `zones` on a `day` cleans if infested, ``(n,)``."""
        draws = RandomStreams(self.seed).of("treat", day).random(len(zones.treated))
        cleaned: NDArray[np.bool_] = zones.treated & (draws < self.costs.works)
        return cleaned


@dataclass(frozen=True, eq=False)
class Sprayed:
    """What was sprayed on a simulated evening: the zones, and ``(n,)`` who was cleaned by it."""

    zones: Zones
    cleaned: NDArray[np.bool_]
    works: float

    @property
    def left(self) -> Floats:
        """Return which share of what is believed outlives it, ``(n,)``."""
        return np.where(self.zones.treated, 1.0 - self.works, 1.0)
