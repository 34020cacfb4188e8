"""Where a season stands on a day."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.monitoring.estimates.day_figures import Progress, found_pct
from fieldmon.monitoring.estimates.plant_states import hot_spots_on

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.monitoring.estimates.history import History
    from fieldmon.pests.development import Development


@dataclass(frozen=True, eq=False)
class Status:
    """Where a season stands on a day, after what was recorded of it.

    Parameters
    ----------
    day
        Number of the day, from 0.
    on
        Its date.
    plants
        Plants of the plot.
    inspected, found
        Plants inspected so far at least once, and plants found infested so far.
    finds
        Finds so far, a plant once a day.
    inspected_today, found_today
        Plants inspected and found infested on this day.
    skipped
        Plants that nobody could inspect when they were asked for last.
    left_out
        How many of those are left out of the next day's plan.
    estimate
        How many are infested and not found yet, as believed.
    infested
        How many are still infested in all: not found yet, and flagged.
    flagged
        How many of the plants found are still infested, as expected: they were flagged only.
    learnt
        What the inspections so far tell of the insects; empty where finds are not traced.
    days_since
        ``(r,)`` days since any plant of each row was inspected; NaN: never.
    hot_spots
        Where finds cluster.
    development
        How far the pest has come; None: no pest or weather was given, or it is not known.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> season = fm.Season.create("of_status.gpkg", plot, begins="2026-11-18")
    >>> now = season.status("2026-11-18")
    >>> now.plants, now.inspected, now.found, now.estimate.high > 0
    (1320, 0, 0, True)
    """

    day: int
    on: date
    plants: int
    inspected: int
    found: int
    finds: int
    inspected_today: int
    found_today: int
    skipped: int
    left_out: int
    estimate: PlotEstimate
    infested: PlotEstimate
    flagged: float
    learnt: tuple[Learnt, ...]
    days_since: NDArray[np.float64]
    hot_spots: HotSpots
    development: Development | None = None

    @classmethod
    def of(cls, history: History, morning: Belief, day: int) -> Status:
        """Return how a history stands on a day, given by its number and its morning."""
        progress, skips = Progress.of(history, day), history.skips(day)
        return cls(
            day=day,
            on=history.date_of(day),
            plants=len(history.grid),
            **vars(progress),
            skipped=int(np.count_nonzero(skips.times)),
            left_out=int(np.count_nonzero(skips.left_out(day + 1))),
            estimate=history.estimate(morning, day),
            infested=history.infested(morning, day),
            flagged=history.flagged(morning, day),
            learnt=history.learnt(morning, day),
            hot_spots=hot_spots_on(history, day),
        )

    @property
    def detection_pct(self) -> float:
        """Return the finds in percent of finds and what is still expected out there."""
        return found_pct(self.found, self.estimate.expected)

    @property
    def detection_range_pct(self) -> tuple[float, float]:
        """Return the same at both ends of the 90 % interval of what is still out there."""
        ahead = self.estimate
        return found_pct(self.found, ahead.high), found_pct(self.found, ahead.low)
