"""The insects that a simulated robot finds: drawn as the season simulator draws them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.planning.workday import draw_detections

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.monitoring.estimates.asked_day import PlantToInspect
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.simulation.start import Start


class Insects:
    """Which plants are infested, what inspections find, and what happens at night.

    The streams are those of `fieldmon.simulation.season.simulated_days`: the same seed, the same
    insects, found at the same plants.

    Parameters
    ----------
    grid, start
        The plants, and the first morning.
    detects
        ``(t,)`` chance of each inspection time to find what is there, ascending.
    spread, streams
        What they do at night, and the season's random streams.
    """

    def __init__(
        self,
        grid: PlantGrid,
        start: Start,
        detects: NDArray[np.float64],
        spread: Spread | None = None,
        streams: RandomStreams | None = None,
    ) -> None:
        streams = streams or RandomStreams(1)
        self._grid, self._detects, self._spread = grid, detects, spread or Spread()
        self._inspect, self._night = streams.keys("inspect"), streams.keys("spread")
        self.infested = start.infested.copy()
        self._morning()

    def __repr__(self) -> str:
        """Say how many plants are infested."""
        return f"<Insects on {int(self.infested.sum())} of {len(self.infested)} plants>"

    def look(self, stop: PlantToInspect) -> bool:
        """Return whether so long an inspection finds a plant infested today; found ones die."""
        level = int(np.argmin(np.abs(self._detects - stop.detects)))
        found = 0 < int(self._would_find[stop.plant]) <= level + 1
        if found:
            self.infested[stop.plant] = False
        return found

    def pass_night(self) -> None:
        """Let those that were not found spread."""
        self.infested = night(self._grid, self.infested, self._spread, next(self._night))
        self._morning()

    def _morning(self) -> None:
        key = next(self._inspect)
        self._would_find = draw_detections(self.infested, self._detects, key)
