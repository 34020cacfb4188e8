"""What a season comes to, in the measures of the thesis and in the grower's."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.array_arguments import must_hold_shapes
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import counted

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray
    from pandas import DataFrame

    from fieldmon.simulation.season import SimulatedDay

DETECTION_LEVELS_PCT = (30.0, 50.0, 80.0, 100.0)


@checked
@dataclass(frozen=True, eq=False)
class SeasonMetrics:
    """The days of one season as columns, ``(d,)`` each, and what they add up to.

    Parameters
    ----------
    detection_pct
        All finds so far in percent of all infestations so far, at the end of each day's work.
    visited_pct
        Plants inspected on each day in percent of all plants.
    ever_visited_pct
        Plants inspected so far at least once in percent of all plants.
    found
        Plants found infested on each day.
    new
        Infestations of the night before each day (on day 0: those at the start).
    left
        Infested plants after each day's work.
    worked_h
        Hours worked on each day, of all who work.
    sprayed_m2, spent
        Area sprayed on each evening, and what that cost.
    visit
        Whether somebody came to inspect on each day.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance)
    >>> season = fm.simulate(plot, start, "naive", settings=fm.SimulationSettings(n_days=3))
    >>> bool(season.infested_plant_days == season.left.sum())
    True
    """

    detection_pct: NDArray[np.float64]
    visited_pct: NDArray[np.float64]
    ever_visited_pct: NDArray[np.float64]
    found: NDArray[np.int64]
    new: NDArray[np.int64]
    left: NDArray[np.int64]
    worked_h: NDArray[np.float64]
    sprayed_m2: NDArray[np.float64]
    spent: NDArray[np.float64]
    visit: NDArray[np.bool_]

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A season's")
        must_hold_shapes(self, "A season's", dict.fromkeys(vars(self), (self.found.size,)))

    def __repr__(self) -> str:
        days, finds = counted(len(self.left), "day"), counted(int(self.found.sum()), "find")
        visits = "" if self.visit.all() else f" with {counted(self.visits, 'visit')}"
        lost = f"{self.infested_plant_days} infested plant-days"
        return f"<SeasonMetrics: {days}{visits}, {finds}, {lost}>"

    @property
    def infested_plant_days(self) -> int:
        """Return the sum over all evenings of the plants still infested: the grower's loss."""
        return int(self.left.sum())

    @property
    def visits(self) -> int:
        """Return on how many days somebody came to inspect."""
        return int(np.count_nonzero(self.visit))

    @property
    def visited_each_time_pct(self) -> float:
        """Return the plants inspected on a visit in percent of all plants, on average."""
        return float(self.visited_pct[self.visit].mean())

    def to_pandas(self) -> DataFrame:
        """Return a line for each day (from 1), with its columns.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance)
        >>> season = fm.simulate(plot, start, "naive", settings=fm.SimulationSettings(n_days=3))
        >>> season.to_pandas().day.tolist()
        [1, 2, 3]
        """
        import pandas as pd  # noqa: PLC0415 - loaded when it is asked for

        columns = {one.name: getattr(self, one.name) for one in fields(self)}
        return pd.DataFrame({"day": np.arange(1, len(self.left) + 1), **columns})

    def first_day(self, level_pct: float) -> int | None:
        """Return the first day (from 1) at whose end `level_pct` of all so far were found.

        The thesis's D_x; None if the season never gets there.
        """
        reached = np.flatnonzero(self.detection_pct >= level_pct - 1e-9)
        return int(reached[0]) + 1 if reached.size else None


def season_metrics(days: Iterable[SimulatedDay]) -> SeasonMetrics:
    """Return the columns of a season from its days; nothing of a day is kept."""
    rows = [
        (
            day.detection_pct,
            day.visited_pct,
            day.ever_visited_pct,
            day.found,
            day.ever_infested,
            day.left,
            day.worked_s / 3600.0,
            day.visit is not None,
            *(
                (0.0, 0.0)
                if day.sprayed is None
                else (day.sprayed.zones.m2, day.sprayed.zones.cost)
            ),
        )
        for day in days
    ]
    columns = np.array(rows, dtype=np.float64).reshape(-1, 10).T
    found, ever, left = columns[3:6].astype(np.int64)
    new = np.diff(ever, prepend=0)
    detection, visited, ever_visited = columns[:3]
    worked, visit, sprayed, spent = columns[6:]
    by_day = detection, visited, ever_visited, found, new, left, worked, sprayed, spent
    return SeasonMetrics(*by_day, visit.astype(np.bool_))
