"""What each plant's chance would be if the whole plot had fewer, or more, than is expected."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.chance_bounds import MOST_CHANCE
from fieldmon.infestation.plot_estimate import doubted_level, level_doubt, must_be_sure
from fieldmon.infestation.prior.prior import odds_ratio
from fieldmon.infestation.tracing.traced_pairs import TracedPairs

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class LevelRange:
    """How far the level of a whole chance map may be off, on the odds of every plant.

    That the rates are not known makes all chances too low or too high together: so each plant's
    odds are multiplied by the same number. It is no range of what is there (a plant is infested or
    not), and says nothing of whether this plant rather than its neighbour is.

    Parameters
    ----------
    low, high
        What the odds are multiplied by at the ends of the interval; both 1: nothing is known of it.
    """

    low: float = 1.0
    high: float = 1.0

    def of(self, chance: Floats) -> tuple[Floats, Floats]:
        """Return the chances ``(n,)`` at the low and at the high end.

        Examples
        --------
        >>> import numpy as np
        >>> low, high = LevelRange(0.5, 2.0).of(np.array([0.0, 0.12, 0.5]))
        >>> low.round(3).tolist(), high.round(3).tolist()
        ([0.0, 0.064, 0.333], [0.0, 0.214, 0.667])
        """
        odds = 1.0 - chance
        low, high = (chance * each / (chance * each + odds) for each in (self.low, self.high))
        return low, high


def level_range(belief: Belief, sure: float = 0.9) -> LevelRange:
    """Return how far a belief's chances may be off as a whole.

    At its ends they add up to the ends of what the expected number may be, as `estimate_of` doubts
    it; what chance does to single plants is left out. `sure` is the chance that the interval holds
    the expected number.
    """
    must_be_sure(sure)
    chance, doubt, since = belief.chance, level_doubt(belief), belief.since_inspected
    share = float(np.mean(chance))
    if doubt <= 0.0 or not 0.0 < share < MOST_CHANCE:
        return LevelRange()
    factors = doubted_level(doubt)
    factors = factors if since is None else factors * since.times
    by = np.quantile(factors, [0.5 - sure / 2, 0.5 + sure / 2])
    ends = share * by / (1.0 + share * (by - 1.0))
    certain = float(np.mean(chance >= 1.0))
    possible = float(np.mean(chance > 0.0))
    # of the plants that can be infested no more than nearly all are, and no fewer than are for sure
    least, most = certain + 1e-3 * (share - certain), possible - 1e-3 * (possible - share)
    low, high = (odds_ratio(chance, end) for end in np.clip(ends, least, most).tolist())
    return LevelRange(low, high)


def first_level_range(grid: PlantGrid, chance: Floats) -> LevelRange:
    """Return the same of a plot of which nothing but a chance map ``(n,)`` is known.

    A season believes the same on its first morning.
    """
    return level_range(TracedPairs.of(grid, chance))
