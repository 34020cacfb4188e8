"""Strategies against each other on a plot, in the background. No Streamlit in here.

Every strategy meets the same insects: a seed's start, its nights and what its inspections detect
are drawn from streams that know nothing of the strategy. So differences are taken seed by seed
(paired).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.planning.members import Teamwork
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Memory, run
from fieldmon.simulation.paired_seasons import met_by_all, paired
from fieldmon.simulation.statistics import half_interval, summary_statistics
from fieldmon.simulation.study_plot import Combination
from fieldmon.simulation.team_season import Team
from fieldmon.simulation.team_worth import marginal_gains
from fieldmon.simulation.worker import LaidPlot, simulated_season

from .background_work import BackgroundWork

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.robot import Robot
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.statistics import SummaryStatistics
    from fieldmon.simulation.team_worth import MarginalGain

    Floats = NDArray[np.float64]

#: several robots hear of each other's finds every half hour
TEAMWORK = Teamwork(contact_s=1800.0)


@dataclass(frozen=True, order=True)
class Strategy:
    """One way to work a season.

    Parameters
    ----------
    sampler
        Who chooses the plants.
    hours
        Working day.
    inspection_s
        Seconds at a plant; more of them find more of what is there (the thesis's viewpoints).
    robots
        How many work so, together.
    """

    sampler: str
    hours: float
    inspection_s: float
    robots: int = 1


@dataclass(frozen=True)
class ComparisonSettings:
    """What is compared, and on how many seasons of which kind.

    Parameters
    ----------
    strategies
        What is compared.
    n_days
        Days a season.
    share
        Plants infested at the start, 0 to 1.
    rate
        Chance a night that an infested plant infests each plant next to it, where no pest is known.
    visit_every
        Days from one visit to the next.
    seeds
        Seasons for each strategy.
    """

    strategies: tuple[Strategy, ...]
    n_days: int
    share: float
    rate: float
    visit_every: int
    seeds: int


@dataclass(frozen=True)
class Outcome:
    """What a strategy came to.

    Parameters
    ----------
    strategy
        What was done.
    loss
        Infested plant-days: the grower's loss, less is better.
    detection_pct
        Detection at the end of the season.
    visited_pct
        Plants inspected a visit.
    half_day
        First day with half of all infestations found; the median over seeds, None if it is never.
    behind
        Loss beyond that of the best strategy, seed by seed; None for the best.
    most_day
        First day with 80 % of all infestations found; the median over seeds, None if it is never.
    worked_h
        Hours worked in a season, of all robots.
    """

    strategy: Strategy
    loss: SummaryStatistics
    detection_pct: SummaryStatistics
    visited_pct: float
    half_day: float | None
    behind: SummaryStatistics | None
    most_day: float | None = None
    worked_h: float = 0.0


class WatchedComparison(BackgroundWork):
    """A comparison that runs in a thread of its own and can be watched and stopped."""

    def __init__(self, settings: ComparisonSettings, laid: LaidPlot, robot: Robot) -> None:
        super().__init__()
        self.settings = settings
        self._laid, self._robot = laid, robot
        self._experiment = paired(settings.strategies, range(1, settings.seeds + 1), self._season)
        self._made: Memory[SeasonMetrics] = Memory()

    @property
    def total(self) -> int:
        """Return the number of seasons to simulate."""
        return len(self._experiment)

    @property
    def done(self) -> int:
        """Return the number of seasons simulated."""
        return len(self._made)

    @property
    def is_answered(self) -> bool:
        """Tell whether a season of each strategy is there, of which a first answer can be said."""
        return self.done >= len(self.settings.strategies)

    def start(self) -> None:
        """Begin, or go on where it was stopped."""
        if not self.running and self.done < self.total:
            self.begin()

    def work(self) -> None:
        """Simulate what is not there yet; stopped after a season, what is there is kept."""
        run(self._experiment, executor.here(), self._made, stop=self._is_over_here)

    def seasons(self) -> dict[Strategy, list[SeasonMetrics]]:
        """Return the seasons of all seeds that every strategy has been through."""
        by_seed = met_by_all(self._experiment, self._made).values()
        return {
            strategy: [seasons[k] for seasons in by_seed]
            for k, strategy in enumerate(self.settings.strategies)
        }

    def _season(self, strategy: Strategy, seed: int) -> SeasonMetrics:
        settings = self.settings
        levels = Combination(
            strategy.sampler, strategy.hours, strategy.inspection_s, settings.share, settings.rate
        )
        team = Team(strategy.robots, TEAMWORK)
        days = settings.n_days, settings.visit_every
        return simulated_season(self._laid, self._robot, levels, seed, days, team)


def outcomes(seasons: dict[Strategy, list[SeasonMetrics]]) -> list[Outcome]:
    """Return what each strategy came to, the best first; empty while no seed is complete."""
    if not all(seasons.values()):
        return []
    losses = {
        strategy: np.array([s.infested_plant_days for s in made], float)
        for strategy, made in seasons.items()
    }
    ranked = sorted(losses, key=lambda strategy: losses[strategy].mean())
    best = losses[ranked[0]]
    return [
        Outcome(
            strategy,
            summary_statistics(losses[strategy]),
            summary_statistics(np.array([s.detection_pct[-1] for s in seasons[strategy]])),
            float(np.mean([s.visited_each_time_pct for s in seasons[strategy]])),
            _median_day(seasons[strategy], 50.0),
            None if strategy == ranked[0] else summary_statistics(losses[strategy] - best),
            _median_day(seasons[strategy], 80.0),
            float(np.mean([s.worked_h.sum() for s in seasons[strategy]])),
        )
        for strategy in ranked
    ]


def curve(made: list[SeasonMetrics]) -> tuple[Floats, Floats, Floats]:
    """Return detection by day over the seeds, ``(d,)`` each: mean, and ends of its interval."""
    percent = np.stack([s.detection_pct for s in made])
    mean, n = percent.mean(axis=0), len(percent)
    if n < 2:
        return mean, mean, mean
    half = half_interval(percent.std(axis=0, ddof=1), n)
    return mean, np.maximum(mean - half, 0.0), np.minimum(mean + half, 100.0)


def gains(seasons: dict[Strategy, list[SeasonMetrics]]) -> list[list[MarginalGain]]:
    """Return what more robots save, for each way to work that several numbers of them have."""
    ways: dict[Strategy, dict[int, Floats]] = {}
    for strategy, made in seasons.items():
        if made:
            losses = np.array([s.infested_plant_days for s in made], float)
            ways.setdefault(replace(strategy, robots=1), {})[strategy.robots] = losses
    return [marginal_gains(losses) for losses in ways.values() if len(losses) > 1]


def _median_day(made: list[SeasonMetrics], level_pct: float) -> float | None:
    reached = [np.inf if (day := s.first_day(level_pct)) is None else day for s in made]
    middle = float(np.median(reached))
    return middle if np.isfinite(middle) else None
