"""How many plants are still infested: not found yet, and found and only flagged."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fieldmon.infestation.chance_bounds import KNOWN
from fieldmon.infestation.plot_estimate import estimate_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.plot.grid import PlantGrid


def still_certain(believed: Belief, flagged: NDArray[np.bool_] | None) -> NDArray[np.bool_] | None:
    """Return of which `flagged` plants ``(n,)`` it is certain that they are infested (None: none).

    A treatment, or a clean inspection, leaves them in doubt.
    """
    return None if flagged is None else flagged & (believed.chance > KNOWN)


def infested_in_all(
    grid: PlantGrid, believed: Belief, flagged: NDArray[np.bool_] | None, sure: float = 0.9
) -> PlotEstimate:
    """Return how many plants are infested: not found yet, and `flagged` ``(n,)`` (None: none).

    With one of which it is certain the plot is not clean. A treatment leaves them in doubt.
    """
    made = estimate_of(grid, believed, sure, still_certain(believed, flagged))
    return made.beside(made.found)


def not_found_yet(
    grid: PlantGrid, believed: Belief, flagged: NDArray[np.bool_] | None, sure: float = 0.9
) -> PlotEstimate:
    """Return how many plants are infested beside the `flagged`; all is as in `infested_in_all`.

    The chance that the plot is clean is of all plants, those that are flagged among them.
    """
    # what was found is known: it is not out there any more
    made = estimate_of(grid, believed, sure, flagged)
    if flagged is None or not made.found:
        return made
    if (believed.chance[flagged] > KNOWN).any():
        return replace(made, chance_clean=0.0)
    clean = infested_in_all(grid, believed, flagged, sure).chance_clean
    return replace(made, chance_clean=clean)
