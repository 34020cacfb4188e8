"""Samplers, hours and looking times against each other, in the background. No Streamlit in here.

Every arm meets the same insects: a seed's start, its nights and what an inspection would find are
drawn from streams that know nothing of the arm. So differences are taken seed by seed (paired).
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import FieldmonError
from fieldmon.simulation import executor
from fieldmon.simulation.design import Combination
from fieldmon.simulation.experiment import Experiment, Memory, run
from fieldmon.simulation.statistics import half_interval, summary_statistics
from fieldmon.simulation.worker import simulated_season

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.statistics import SummaryStatistics

    Floats = NDArray[np.float64]


@dataclass(frozen=True, order=True)
class Arm:
    """One way of working.

    Parameters
    ----------
    sampler
        Who chooses the plants.
    hours
        Working day.
    look_s
        Seconds at a plant; more of them find more of what is there (the thesis's viewpoints).
    """

    sampler: str
    hours: float
    look_s: float


@dataclass(frozen=True)
class Asked:
    """What is compared, and on how many seasons."""

    arms: tuple[Arm, ...]
    n_days: int
    share: float
    rate: float
    seeds: int


@dataclass(frozen=True)
class Outcome:
    """What an arm came to.

    Parameters
    ----------
    arm
        The way of working.
    loss
        Infested plant-days: the grower's loss, less is better.
    detection_pct
        Detection at the end of the season.
    visited_pct
        Plants inspected a day.
    half_day
        First day with half of all infestations found; the median over seeds, None if it is never.
    behind
        Loss beyond that of the best arm, seed by seed; None for the best.
    """

    arm: Arm
    loss: SummaryStatistics
    detection_pct: SummaryStatistics
    visited_pct: float
    half_day: float | None
    behind: SummaryStatistics | None


class Comparison:
    """A comparison that runs in a thread of its own and can be looked at and stopped."""

    def __init__(self, asked: Asked, plot: Plot, chance: Floats, robot: Robot) -> None:
        self.asked = asked
        self.problem: FieldmonError | None = None
        self._prepared, self._robot = (plot, chance), robot
        self._experiment = Experiment(
            settings=asked.arms,
            seeds=range(1, asked.seeds + 1),
            simulate=self._season,
            chunk_size=lambda _: 1,
            seed_by_seed=True,
        )
        self._made: Memory[SeasonMetrics] = Memory()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def total(self) -> int:
        """Return the number of seasons to simulate."""
        return len(self._experiment)

    @property
    def done(self) -> int:
        """Return the number of seasons simulated."""
        return len(self._made)

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

    def seasons(self) -> dict[Arm, list[SeasonMetrics]]:
        """Return the seasons of all seeds that every arm has been through."""
        made: dict[Arm, list[SeasonMetrics]] = {arm: [] for arm in self.asked.arms}
        for chunk in self._experiment.chunks():
            if chunk.key in self._made:
                made[chunk.setting].append(self._made[chunk.key])
        full = min(len(seasons) for seasons in made.values())
        return {arm: seasons[:full] for arm, seasons in made.items()}

    def _work(self) -> None:
        try:
            run(self._experiment, executor.here(), self._made, stop=self._stop.is_set)
        except FieldmonError as error:
            self.problem = error

    def _season(self, arm: Arm, seeds: range) -> SeasonMetrics:
        asked = self.asked
        levels = Combination(arm.sampler, arm.hours, arm.look_s, asked.share, asked.rate)
        return simulated_season(self._prepared, self._robot, levels, seeds.start, asked.n_days)


def outcomes(seasons: dict[Arm, list[SeasonMetrics]]) -> list[Outcome]:
    """Return what each arm came to, the best first; empty while no seed is complete."""
    if not all(seasons.values()):
        return []
    losses = {
        arm: np.array([s.infested_plant_days for s in made], float) for arm, made in seasons.items()
    }
    ranked = sorted(losses, key=lambda arm: losses[arm].mean())
    best = losses[ranked[0]]
    return [
        Outcome(
            arm,
            summary_statistics(losses[arm]),
            summary_statistics(np.array([s.detection_pct[-1] for s in seasons[arm]])),
            float(np.mean([s.visited_pct.mean() for s in seasons[arm]])),
            _half_day(seasons[arm]),
            None if arm == ranked[0] else summary_statistics(losses[arm] - best),
        )
        for arm in ranked
    ]


def curve(made: list[SeasonMetrics]) -> tuple[Floats, Floats, Floats]:
    """Return detection by day over the seeds, ``(d,)`` each: mean, and ends of its interval."""
    percent = np.stack([s.detection_pct for s in made])
    mean, n = percent.mean(axis=0), len(percent)
    if n < 2:
        return mean, mean, mean
    half = half_interval(percent.std(axis=0, ddof=1), n)
    return mean, np.maximum(mean - half, 0.0), np.minimum(mean + half, 100.0)


def _half_day(made: list[SeasonMetrics]) -> float | None:
    reached = [np.inf if (day := s.first_day(50.0)) is None else day for s in made]
    middle = float(np.median(reached))
    return middle if np.isfinite(middle) else None
