"""Strategies against each other on a plot, in the background. No Streamlit in here.

Every strategy meets the same insects: a seed's start, its nights and what its inspections detect
are drawn from streams that know nothing of the strategy. So differences are taken seed by seed
(paired).
"""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import stdtrit

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FieldmonError
from fieldmon.infestation.prior import start_infested
from fieldmon.infestation.spread import Spread
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import SeasonFigures, figures
from fieldmon.simulation.season import SeasonSettings, Start, days

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot

    Floats = NDArray[np.float64]

_SURE = 0.975


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
    """

    sampler: str
    hours: float
    inspection_s: float


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
        Chance a night that an infested plant infests each plant next to it.
    seeds
        Seasons for each strategy.
    """

    strategies: tuple[Strategy, ...]
    n_days: int
    share: float
    rate: float
    seeds: int


@dataclass(frozen=True)
class Estimate:
    """A mean over seeds with its 95 % interval (Student's t)."""

    mean: float
    low: float
    high: float


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
        Plants inspected a day.
    half_day
        First day with half of all infestations found; the median over seeds, None if it is never.
    behind
        Loss beyond that of the best strategy, seed by seed; None for the best.
    """

    strategy: Strategy
    loss: Estimate
    detection_pct: Estimate
    visited_pct: float
    half_day: float | None
    behind: Estimate | None


class Comparison:
    """A comparison that runs in a thread of its own and can be watched and stopped."""

    def __init__(
        self, settings: ComparisonSettings, plot: Plot, chance: Floats, robot: Robot
    ) -> None:
        self.settings = settings
        self.problem: FieldmonError | None = None
        self._plot, self._chance, self._robot = plot, chance, robot
        self._seasons: dict[Strategy, list[SeasonFigures]] = {
            strategy: [] for strategy in settings.strategies
        }
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def total(self) -> int:
        """Return the number of seasons to simulate."""
        return len(self.settings.strategies) * self.settings.seeds

    @property
    def done(self) -> int:
        """Return the number of seasons simulated."""
        return sum(len(walked) for walked in list(self._seasons.values()))

    @property
    def running(self) -> bool:
        """Tell whether it is at work."""
        return self._thread is not None and self._thread.is_alive()

    def start(self) -> None:
        """Begin, or go on where it was stopped."""
        if not self.running and self.done < self.total:
            self._stop.clear()
            self._thread = threading.Thread(target=self._work, daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End after the season that is being simulated; what is there is kept."""
        self._stop.set()

    def wait(self, timeout_s: float) -> None:
        """Wait for the end."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def seasons(self) -> dict[Strategy, list[SeasonFigures]]:
        """Return the seasons of all seeds that every strategy has been through."""
        full = min(len(walked) for walked in self._seasons.values())
        return {strategy: walked[:full] for strategy, walked in self._seasons.items()}

    def _work(self) -> None:
        try:
            for seed in range(1, self.settings.seeds + 1):
                for strategy, walked in self._seasons.items():
                    if self._stop.is_set():
                        return
                    if len(walked) < seed:
                        walked.append(self._season(strategy, seed))
        except FieldmonError as error:
            self.problem = error

    def _season(self, strategy: Strategy, seed: int) -> SeasonFigures:
        streams = RandomStreams(seed)
        drawn = start_infested(self._chance, self.settings.share, streams.of("start"))
        begin = Start(drawn[self._plot.grid.vine], self._chance)
        settings = SeasonSettings(n_days=self.settings.n_days, spread=Spread(self.settings.rate))
        robot = replace(self._robot, hours=strategy.hours, look_s=strategy.inspection_s)
        decides = sampler(strategy.sampler)
        return figures(days(self._plot.aisles, robot, decides, begin, settings, streams))


def estimate(values: Floats) -> Estimate:
    """Return the mean of values ``(s,)`` and its interval; one value has no interval (NaN)."""
    mean, n = float(np.mean(values)), len(values)
    if n < 2:
        return Estimate(mean, np.nan, np.nan)
    half = float(stdtrit(n - 1, _SURE) * np.std(values, ddof=1) / np.sqrt(n))
    return Estimate(mean, mean - half, mean + half)


def outcomes(seasons: dict[Strategy, list[SeasonFigures]]) -> list[Outcome]:
    """Return what each strategy came to, the best first; empty while no seed is complete."""
    if not all(seasons.values()):
        return []
    losses = {
        strategy: np.array([s.infested_plant_days for s in walked], float)
        for strategy, walked in seasons.items()
    }
    ranked = sorted(losses, key=lambda strategy: losses[strategy].mean())
    best = losses[ranked[0]]
    return [
        Outcome(
            strategy,
            estimate(losses[strategy]),
            estimate(np.array([s.detection_pct[-1] for s in seasons[strategy]])),
            float(np.mean([s.visited_pct.mean() for s in seasons[strategy]])),
            _half_day(seasons[strategy]),
            None if strategy == ranked[0] else estimate(losses[strategy] - best),
        )
        for strategy in ranked
    ]


def curve(walked: list[SeasonFigures]) -> tuple[Floats, Floats, Floats]:
    """Return detection by day over the seeds, ``(d,)`` each: mean, and ends of its interval."""
    percent = np.stack([s.detection_pct for s in walked])
    mean, n = percent.mean(axis=0), len(percent)
    if n < 2:
        return mean, mean, mean
    half = stdtrit(n - 1, _SURE) * percent.std(axis=0, ddof=1) / np.sqrt(n)
    return mean, np.maximum(mean - half, 0.0), np.minimum(mean + half, 100.0)


def _half_day(walked: list[SeasonFigures]) -> float | None:
    reached = [np.inf if (day := s.first_day(50.0)) is None else day for s in walked]
    middle = float(np.median(reached))
    return middle if np.isfinite(middle) else None
