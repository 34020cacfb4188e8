"""How far the answer goes that a plot need not be treated: until when, where, and on what."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from fieldmon.compute.units import Units
from fieldmon.compute.wording import counted, joined, share_figure, worded
from fieldmon.infestation.insects.jump_reach import RADIUS

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings
    from fieldmon.plot.grid import PlantGrid

# plants out of reach of all inspections are said from this share on
_FEW = 0.1


@dataclass(frozen=True)
class InspectAgain:
    """Until when a plot stays below its threshold with a chance of 95 %, if nobody inspects it.

    Parameters
    ----------
    by
        The first day on which it may be above; None: none of those that are foretold.
    nights
        How many nights are foretold.
    """

    by: date | None
    nights: int

    @classmethod
    def of(cls, ahead: Forecast, on: date, infested: float) -> InspectAgain:
        """Return it by what is foretold from a day on, of so many infested plants."""
        (above,) = np.nonzero(ahead.high[1:] > infested)
        by = on + timedelta(days=int(above[0]) + 1) if len(above) else None
        return cls(by, ahead.nights)

    def sentence(self, units: Units | None = None) -> Worded:
        """Return it in words."""
        if self.by is None:
            return worded(
                "Without inspections it stays below the threshold for {nights} at least, with a "
                "chance of 95 %.",
                nights=counted(self.nights, "night"),
            )
        return worded(
            "Inspect again by {day}: before, it stays below the threshold with a chance of 95 %.",
            day=(units or Units()).day(self.by),
        )


@dataclass(frozen=True)
class NotReached:
    """Plants of which no inspection says anything, as all were too far away.

    Parameters
    ----------
    share
        So many of all plants.
    reach_m
        Farther from any inspected plant than this.
    """

    share: float
    reach_m: float

    @classmethod
    def of(cls, grid: PlantGrid, inspected: NDArray[np.integer]) -> NotReached:
        """Return them where these plants were inspected in the season, some perhaps often.

        An inspection reaches as far as insects are thought to jump otherwise than anywhere.
        """
        reach_m = RADIUS * float(np.sqrt(grid.row_spacing_m * grid.plant_spacing_m))
        if not len(inspected):
            return cls(1.0, reach_m)
        near = cKDTree(grid.xy_m[np.unique(inspected)])
        away_m, _ = near.query(grid.xy_m, distance_upper_bound=reach_m)
        return cls(float(np.mean(np.isinf(away_m))), reach_m)

    def sentences(self, units: Units | None = None) -> list[str]:
        """Return it in words; nothing where few are meant."""
        if self.share < _FEW:
            return []
        if self.share == 1.0:
            return [worded("Nobody has inspected yet: the answer rests on what was told before.")]
        return [
            worded(
                "{share:.0%} of the plants are more than {reach} from any inspection of the "
                "season: of them the answer rests on what was told before. Inspect there before "
                "you rely on it.",
                share=self.share, reach=(units or Units()).metres(self.reach_m),
            )
        ]  # fmt: skip


@dataclass(frozen=True)
class FewInspected:
    """So few plants were inspected that they alone would not tell whether treating pays.

    Parameters
    ----------
    inspected
        How many plants were.
    enough
        If so many were, all of them clean, they would tell it by themselves.
    background
        The chance of a plant of which nothing is known, where nobody told it nor gave records;
        None: something was told.
    """

    inspected: int
    enough: int
    background: float | None

    @classmethod
    def of(
        cls,
        plants: tuple[int, int],
        asked: AdviceSettings,
        detects: float,
        background: float | None,
    ) -> FewInspected | None:
        """Return it; None where half as many as would be enough were inspected, or all are too few.

        `plants` is how many were inspected, all of them clean, and how many there are. Enough are
        as many as would all be clean with a chance of 1 - `sure` at most, if as many plants were
        infested as the threshold says, anywhere, and inspections found a share `detects` of them.
        """
        inspected, n = plants
        infested = max(int(np.ceil(asked.level * n)), 1)
        # each of them is among the inspected, and found there
        enough = int(np.ceil(n * -np.expm1(np.log(1.0 - asked.sure) / infested) / detects))
        few = 2 * inspected < enough <= n
        return cls(inspected, enough, background) if few else None

    def sentence(self) -> str:
        """Return what the answer rests on instead."""
        alone = worded(
            "{plants} {n:was|were} inspected. By themselves they do not tell: about {enough} "
            "clean ones would.",
            plants=counted(self.inspected, "plant"), n=self.inspected, enough=self.enough,
        )  # fmt: skip
        if self.background is None:
            rests = worded("The answer rests mostly on what was told before.")
        else:
            rests = worded(
                "The answer rests mostly on our default, {share} infested where nothing is known, "
                "which nobody measured here.",
                share=share_figure(self.background),
            )
        return joined(" ", (alone, rests))
